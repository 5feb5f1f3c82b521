//! Moored bodies in SI units: kilograms, metres, newtons and seconds.
//!
//! A case names a body, its lines, the site and the waves; [`Structure`] is that case, checked.
//! [`Model`] is the same in the units of the engine, [`snapload::System`], which computes the
//! motion. The derivations, with sources, are in `docs/structures.md`.
//!
//! The axes are the usual ones: x to the right, z up from the still water, waves along x. The
//! engine's y points down; see [`Scales`].

mod catalogue;
mod judged_time;
pub mod moordyn;
pub mod note;
mod options;
mod physics;
mod report;
mod runs;
mod schema;
mod structure;
mod text_layout;

pub use catalogue::{Section, section};
pub use options::{EVERY, NEIGHBOURS, PAIRS, SEEDS, SEGMENTS, STIFFER, checked_every};
pub use physics::afloat::TautMode;
pub use physics::elastic::{
    ElasticLine, ElasticRun, Pull, Sample, damping_ratio, elastic_lines, run_elastic,
};
pub use physics::emergence::Emergence;
pub use physics::equilibrium::{Equilibrium, equilibrium};
pub use physics::model::{Groups, Model, Scales, force_per_acceleration};
pub use physics::model_at_rest::ModelAtRest;
pub use physics::periods::{NaturalMode, NaturalPeriods};
pub use physics::sea::{Component, Spectrum, components};
pub use physics::snap::{SLOWEST_M_S, Snap, snaps};
pub use physics::warning::Warning;
pub use physics::warnings::warnings;
pub use physics::waterline::Waterline;
pub use physics::wave::LinearWave;
pub use report::{Verdict, VerdictKind, end_text};
pub use runs::assess::{Assessment, DEFAULT_NEIGHBOURS, assess};
pub use runs::design::{Answer, Check, Criterion, RecordsCheck};
pub use runs::elastic_comparison::{
    DEFAULT_ELASTIC_NEIGHBOURS, ElasticComparison, Inextensible, Repeated, compare_elastic,
};
pub use runs::gumbel::{Estimate, Gumbel, reduced_variate};
pub use runs::motion::MotionSi;
pub use runs::neighbours::NEIGHBOUR;
pub use runs::outcome::{LineOutcome, Outcome};
pub use runs::quantile::quantile;
pub use runs::seas::{Failing, Lines, SeaOutcome, Seas, seas};
pub use runs::three_hours::NoDistribution;
pub use runs::variations::{ByRestitution, ByWave, VerdictNumbers};
pub use schema::{STRUCTURE, is_structure};
pub use snapload_hydro::wave_number;
pub use structure::{
    AddedMass, AddedMassDefaults, Afloat, BodySi, DesignRule, IrregularSea, LineSi, NO_FILES_HERE,
    Outline, Project, Site, SpectrumShape, Structure, THREE_HOURS_S, Water, Wave, files_beside,
};
pub use text_layout::labelled_row;
