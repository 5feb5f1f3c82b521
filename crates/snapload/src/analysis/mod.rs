//! Questions asked of many runs: one file a question, public items of the library only.

mod critical;
mod ensemble;
mod exceedance;
mod lyapunov;
mod many;
mod sensitivity;
mod trust;
mod verify;

pub use critical::{CriticalForce, Exceedance, ForceScan};
pub use ensemble::{DEFAULT_CLOUD, DEFAULT_MEMBERS, Ensemble, Share, Tally};
pub use exceedance::{ExceedanceCurve, Exceeding};
pub use lyapunov::Frame;
pub use many::{on_all_threads, outcomes};
pub use sensitivity::{Sensitivity, Slope, sensitivity};
pub use trust::{
    Certainty, Doubt, Graze, Horizon, Loss, START_KEYS, Trust, UNCERTAIN_KEYS, Witness, trusted_run,
};
pub use verify::{MOST_DIGITS, Verification, verify};
