//! Questions asked of many runs: one file a question, public items of the library only.

mod account;
mod critical;
mod lyapunov;
mod outcome;
mod trust;
mod verify;

pub use account::{Account, Certainty, FirstImpact};
pub use critical::{CriticalForce, Exceedance, ForceScan};
pub use lyapunov::Frame;
pub use outcome::Outcome;
pub use trust::{
    Doubt, Graze, Horizon, Loss, START_KEYS, Trust, UNCERTAIN_KEYS, Witness, trusted_run,
};
pub use verify::{MOST_DIGITS, Verification, verify};
