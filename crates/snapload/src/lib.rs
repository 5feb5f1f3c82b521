//! Dynamics of bodies on cables that go slack and snap taut.
//!
//! A rigid body in the plane hangs on inextensible cables under forces that vary in time. With no
//! cable taut it flies freely; where a cable closes it snaps taut, an impact with restitution; with
//! one cable taut the body slides along a circle like a double pendulum, with two it rocks. Flight
//! of a body of unit mass under up to eight sinusoids, without drag and not afloat, is computed in
//! closed form, all other motion as a Taylor series. A [`Simulation`] goes from event to event;
//! each is located with a proof that none is earlier.
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
mod arithmetic;
mod batch;
mod case;
mod model;
mod motion;

pub use arithmetic::{dual::Dual, plane::Vector2, precise::Precise, real::Real};
pub use batch::lanes::{Lanes, Usage};
pub use case::Case;
pub use case::entries::{Entries, Fields, FromValue};
pub use case::error::{CaseError, Fault};
pub use case::key::{Bounds, DefaultValue, Key, Kind};
pub use case::keys::{CASE, CASE_KEYS, check_entry, key_named};
pub use case::named::{NamedCase, named_case, named_cases, series_of, table_6_1};
pub use case::parameters::{
    Get, KEYS, Parameters, ROTATION_LIMIT, SETTLING_HEIGHT, natural_inertia,
};
#[cfg(feature = "toml")]
pub use case::read::{parse_value, table_names};
pub use case::schema::{Heading, Schema, Table};
pub use case::value::Value;
pub use model::body::{Body, Outline, Shape};
pub use model::cable::{Cable, Normal, Stretch};
pub use model::drag::Drag;
pub use model::floating::{Complex, Excitation, Exponential, Floating};
pub use model::floating_units::FloatingUnits;
pub use model::forcing::{Forcing, Harmonic};
pub use model::mass::Matrix3;
pub use model::quantity::{QUANTITIES, Quantity, quantity, title_of};
pub use model::rules::{Limit, LimitBounds, MOST_HALTED, Rules, SLOW_FLIGHT, SLOW_SNAPS, Stop};
pub use model::state::State;
pub use model::surroundings::Surroundings;
pub use model::system::{System, anchor_height};
pub use model::taut_set::{MAX_CABLES, Mode, PerCable, TautSet};
pub use motion::free_motion::FreeMotion;
pub use motion::impact::Impact;
pub use motion::outcome::{FirstImpact, Outcome};
pub use motion::playback::{Motion, Playback};
pub use motion::prescribed_motion::{Path, PrescribedTaut};
pub use motion::sampling::Sampling;
#[cfg(feature = "comparisons")]
pub use motion::simulation::comparisons::BounceStages;
pub use motion::simulation::{Simulation, Step, Steps};
pub use motion::start::{START_TOLERANCE, StartError};
pub use motion::step_map::{Deviation, Matrix, StepMap};
pub use motion::tangent::Tangent;
pub use motion::trajectory::{End, ModeInterval, Norms, Trajectory};
