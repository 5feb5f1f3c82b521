//! The forces of water on a floating body: added mass, radiation damping and wave forces from the
//! files of panel codes, the memory of the waves that the body makes, and results that need no
//! simulation: natural periods, response to waves, free decay, rest on lines.
//!
//! Coefficients are of surge, heave and pitch in the vertical plane x–z, in kg, m, N, s and rad. x
//! goes to the right, z up from the still water; pitch turns z to x. The derivations, with sources,
//! are in `docs/hydrodynamics.md`.

mod coefficients;
pub mod digits;
mod error;
mod linear;
mod memory;
mod read;
mod report;
mod section_body;
mod sections;
mod shortest;
mod spline;
mod textbook;
mod water;
mod waves;

pub use coefficients::{
    Excitation, ExcitationCurve, FREEDOMS, Hydrodynamics, Hydrostatics, MatrixCurve, transport,
};
pub use error::{GivenSource, HydroError, Warning};
pub use linear::{
    Body, Decay, LARGE_PITCH, Line, Mode, Natural, Peak, Response, Rest, Swing, Turn, Weight,
    decay, decay_of_the_damping, eigenvalues, far_from_the_file, fine_responses, large_motion,
    natural_of_the_file, natural_of_the_memory, response_of_the_file, response_of_the_memory, rest,
    rest_without_tension, significant, swings,
};
pub use memory::{
    BlockQuality, DampingCurve, EntryQuality, Fit, FitOptions, MOST_PAIRS, Memory, Term, TermRow,
    added_mass_at_infinity, fit, given,
};
pub use read::{
    Dataset, FirstColumn, Format, Given, Reading, Values, Variable, WamitText, files_of,
    from_dataset, from_nemoh, from_wamit, read,
};
pub use report::{
    Floating, GivenMemory, Json, Report, Request, held_summary, page, periods_summary,
};
pub use section_body::SectionBody;
pub use sections::{Place, Shape, added_mass_of_section};
pub use shortest::shortest_solution;
pub use spline::Spline;
pub use water::Water;
pub use waves::{water_acceleration, wave_number};
