//! Dynamics of bodies on cables that go slack and snap taut.

mod body;
mod cable;
mod complementarity;
mod contact;
mod event;
mod extremes;
mod flight;
mod forcing;
mod impact;
mod polynomial;
mod real;
mod rules;
mod series;
mod simulate;
mod start;
mod state;
mod system;
mod taut;
mod taut_set;
mod trajectory;

pub use body::{Body, Outline, Shape};
pub use cable::{Cable, Normal};
pub use forcing::{Forcing, Harmonic};
pub use real::Real;
pub use rules::StopRules;
pub use simulate::{Simulation, Step};
pub use start::{START_TOLERANCE, StartError};
pub use state::State;
pub use system::{System, anchor_height};
pub use taut_set::{MAX_CABLES, TautSet};
pub use trajectory::{End, Impact, ModeInterval, Motion, Norms, Stop, Trajectory};
