//! Questions about many runs: one file for each question, which uses public items of the library
//! only.

mod critical;
mod digits;
mod ensemble;
mod exceedance;
mod lyapunov;
mod norm_errors;
mod outcomes;
mod progress;
mod sensitivity;
mod threads;
mod trust;

pub use critical::{CriticalForce, Exceedance, ForceScan, NEIGHBOURS};
pub use digits::digits_within;
pub use ensemble::{
    DEFAULT_CLOUD, DEFAULT_MEMBERS, Ensemble, EnsembleEnds, MEMBERS, NONZERO_MEMBERS, SEED, Share,
    UNCERTAINTY,
};
pub use exceedance::{ExceedanceCurve, Exceeding};
pub use lyapunov::Frame;
pub use norm_errors::NormErrors;
pub use outcomes::{
    ThreadResults, on_all_threads, on_all_threads_until, outcomes, outcomes_on_one_thread,
};
pub use progress::{
    Cancelled, Counter, OnProgress, Progress, Unfinished, follow, no_progress, outcome, record,
};
pub use sensitivity::{Sensitivity, Slope, sensitivity};
pub use threads::in_parallel;
#[cfg(feature = "comparisons")]
pub use trust::LimitDerivatives;
pub use trust::{
    Certainty, Graze, Horizon, HorizonCause, START_KEYS, Trust, TrustMonitor, UNCERTAIN_KEYS,
    Uncertainty, trusted_run,
};
