//! Dynamics of bodies on cables that go slack and snap taut.
//!
//! A rigid body in the plane hangs on inextensible cables under forces that vary in time. With no
//! cable taut it flies freely, in closed form; where a cable closes it snaps taut, an impact with
//! restitution; with one cable taut the body slides along a circle like a double pendulum, with two it
//! rocks. A [`Simulation`] goes from event to event; each is located with a proof that none is earlier.
//!
//! All quantities are nondimensional, in the units of the breakwater of `docs/model.md`.
//!
//! ```
//! use snapload::{Case, Parameters};
//!
//! let case = Case::new(Parameters { e: 0.5, ..Parameters::STANDARD })?;
//! let run = case.run();
//! let first = run.impacts()[0];
//! assert_eq!(first.cable, 1); // the left one: cables count from 0 here
//! assert!((first.t - 0.406703543).abs() < 1e-9);
//! assert!(run.at(0.5).energy < run.at(0.0).energy + 0.02);
//! # Ok::<(), snapload::CaseError>(())
//! ```
//!
//! [`Case`] is the thesis's breakwater, described by [`Parameters`]. The engine below it takes any
//! [`System`]: a body, a list of cables, a constant force and sinusoids.

pub mod analysis;
mod body;
mod bounce;
mod bundle;
mod cable;
mod case;
mod complementarity;
mod contact;
mod drag;
mod dual;
mod elementary;
mod error;
mod event;
mod extremes;
mod flight;
mod forcing;
mod fused;
mod impact;
mod lane;
mod lanes;
mod mooring;
mod named;
mod outcome;
mod pairs;
mod parameters;
mod playback;
mod polynomial;
mod precise;
mod real;
mod rules;
mod schema;
mod series;
mod simulate;
mod start;
mod state;
mod system;
mod takeoff;
mod tangent;
mod taut;
mod taut_set;
mod tether;
mod trajectory;
mod value;
mod vector;

pub use body::{Body, Outline, Shape};
pub use cable::{Cable, Normal};
pub use case::Case;
pub use drag::Drag;
pub use dual::Dual;
pub use error::{CaseError, Fault};
pub use forcing::{Forcing, Harmonic};
pub use lanes::{Lanes, Usage};
pub use named::{NamedCase, TABLE_6_1, named_case, named_cases, series_of};
pub use outcome::{FirstImpact, Outcome};
pub use parameters::{BodyKind, Parameters, natural_inertia};
pub use playback::{Motion, Playback};
pub use precise::Precise;
pub use real::Real;
pub use rules::StopRules;
pub use schema::{
    Group, KEYS, Key, Kind, ROTATION_LIMIT, SETTLING_HEIGHT, check_entry, key_named, nearest_key,
};
pub use simulate::{Simulation, Step};
pub use start::{START_TOLERANCE, StartError};
pub use state::State;
pub use system::{System, anchor_height};
pub use tangent::{Deviation, Matrix, StepMap, Tangent};
pub use taut_set::{MAX_CABLES, TautSet};
pub use trajectory::{End, Impact, ModeInterval, Norms, Stop, Trajectory};
pub use value::Value;
