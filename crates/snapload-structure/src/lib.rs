//! Moored bodies in SI units: kilograms, metres, newtons and seconds.
//!
//! A case names a body, its lines, the place and the waves; [`Structure`] is that case, checked. [`Model`] is the same
//! in the units of the engine, [`snapload::System`], which computes the motion. How the one follows from the other,
//! with sources, is told in `docs/structures.md`.
//!
//! The picture is the usual one: x to the right, z up from the still water, waves along x. The engine's is upside
//! down; see [`Scales`].

mod assess;
mod catalogue;
mod elastic;
mod entries;
mod equilibrium;
mod gumbel;
mod listing;
mod model;
pub mod moordyn;
pub mod note;
mod plausible;
mod schema;
mod sea;
mod seas;
mod snap;
mod structure;
mod verdict;
mod wave;

pub use assess::{Assessment, LineOutcome, NEIGHBOUR, Outcome, Prepared, assess, quantile};
pub use catalogue::{Section, section};
pub use elastic::{ElasticRun, Look, Pull, Spring, damping_ratio, run_elastic, springs};
pub use entries::{Entries, InputError, Value, is_structure};
pub use equilibrium::{Equilibrium, equilibrium};
pub use gumbel::{Estimate, Gumbel};
pub use model::{Groups, Model, PhasedWave, Scales, force_per_acceleration};
pub use plausible::{Warning, warnings};
pub use schema::{Key, Kind, Need, TABLES, Table, table_named};
pub use sea::{Component, Spectrum, components};
pub use seas::{SeaOutcome, Seas, seas};
pub use snap::{SLOWEST_M_S, Snap, SnapLaw};
pub use structure::{
    BodySi, IrregularSea, LineSi, Outline, Site, SpectrumShape, Structure, THREE_HOURS_S, Water,
    Wave,
};
pub use verdict::{Standing, Verdict, end_words};
pub use wave::{LinearWave, wave_number};
