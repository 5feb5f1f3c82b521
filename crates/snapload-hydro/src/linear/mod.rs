//! Results from the coefficients that need no simulation.

mod body;
mod damped;
mod decay;
mod natural;
mod resonance;
mod response;
mod rest;
mod small_motion;
mod swings;

pub(crate) use body::BALANCED_ANGLE;
pub use body::{Body, Weight};
pub use damped::{Mode, natural_of_the_memory};
pub use decay::{Decay, decay, decay_of_the_damping};
pub use natural::{Natural, eigenvalues, natural_of_the_file};
pub use resonance::{Peak, fine_responses};
pub use response::{Response, response_of_the_file, response_of_the_memory, significant};
pub use rest::{Line, Rest, rest, rest_without_tension};
pub(crate) use small_motion::beyond_hydrostatics;
pub use small_motion::{LARGE_PITCH, far_from_the_file, large_motion};
pub use swings::{Swing, Turn, swings};
