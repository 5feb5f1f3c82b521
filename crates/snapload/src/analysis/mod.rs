//! Questions about many runs: one file for each question, which uses public items of the library
//! only.

mod critical;
mod digits;
mod ensemble;
mod exceedance;
mod known;
mod lyapunov;
mod outcomes;
mod progress;
mod sensitivity;
mod threads;
mod trust;

pub use critical::{CriticalForce, Exceedance, ForceScan};
pub use digits::digits_within;
pub use ensemble::{
    DEFAULT_CLOUD, DEFAULT_MEMBERS, Ensemble, EnsembleEnds, MEMBERS, SEED, SOME_MEMBERS, Share,
};
pub use exceedance::{ExceedanceCurve, Exceeding};
pub use known::NormErrors;
pub use lyapunov::Frame;
pub use outcomes::{Made, on_all_threads, on_all_threads_until, outcomes, outcomes_on_one_thread};
pub use progress::{
    Cancelled, Counter, OnProgress, Progress, Unfinished, outcome, record, unwatched,
};
pub use sensitivity::{Sensitivity, Slope, sensitivity};
pub use threads::in_parallel;
pub use trust::{
    Certainty, Graze, Horizon, HorizonCause, START_KEYS, Trust, TrustMonitor, UNCERTAIN_KEYS,
    Uncertainty, trusted_run,
};
