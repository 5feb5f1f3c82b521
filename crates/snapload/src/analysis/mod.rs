//! Questions asked of many runs: one file a question, public items of the library only.

mod critical;
mod outcome;

pub use critical::{CriticalForce, Exceedance, ForceScan};
pub use outcome::Outcome;
