//! Nonlinear dynamics of bodies on cables: periodic orbits, branches, safe basins.
//!
//! A long motion of a body on cables may come to rest, repeat itself, or neither. This crate finds
//! periodic motions by Newton's method on the sequence of their events, and computes their Floquet
//! multipliers, and whether a body can have them at all: a sequence that closes need not be a
//! motion.
//!
//! ```
//! use snapload::Parameters;
//! use snapload_orbits::{Moored, Orbit, OrbitRequest, Stability};
//!
//! let case = Parameters {
//!     inertia: None, a: 0.0, r: 1.7, e: 0.35, f_o: 1.4, nu: 0.8, omega: 3.1,
//!     ..Parameters::STANDARD
//! };
//! let family = Moored::case(case, [None; 2]);
//! let near = [-0.27, 0.38, 0.0, 0.81, -0.43, 0.0];
//! let orbit = Orbit::find(&family, [0.0; 2], &near, &OrbitRequest::default())?;
//! assert_eq!(orbit.lap.sequence.symbol(), ["2", "1"]);
//! assert_eq!(orbit.stability(), Stability::Stable);
//! # Ok::<(), snapload_orbits::NoOrbit>(())
//! ```

mod arrived;
mod attraction;
mod attraction_summary;
mod attractor;
mod basin;
mod bordered;
mod branch;
mod branch_events;
mod branch_point;
mod branch_rows;
mod condition;
mod continuation;
mod curve;
mod curve_borders;
mod curve_rows;
mod diagram;
mod distances;
mod eigenvalues;
mod erosion;
mod exponents;
mod exponents_text;
mod follower;
mod growth;
mod half_branch;
mod hybrid;
mod impact_map;
mod lap;
mod measures;
mod moored;
mod moored_searches;
mod multipliers;
mod newton;
mod normal_form;
mod on_curve;
mod options;
mod orbit;
mod orbit_row;
mod orbit_search;
mod proof;
mod quantities;
mod roots;
mod rows;
mod scan;
mod section;
mod sequence;
mod summary;
mod survey;
mod switch;
mod window;

pub use attraction::{AttractedCell, Attraction, Attractor, CellOutcome};
pub use attraction_summary::attraction_summary;
pub use attractor::{ATTRACTOR_PERIODS, Starts, TRANSIENT, attracts, find_orbits, of_attractor};
pub use basin::Basin;
pub use branch::Branch;
pub use branch_events::{BranchEvent, Kind};
pub use branch_rows::{BranchRow, branch_summary};
pub use curve::{Curve, CurveEnd, CurveOptions, CurvePoint};
pub use curve_rows::{CurveRow, curve_summary};
pub use diagram::{DiagramPoint, diagram};
pub use erosion::{Erosion, KNEE};
pub use follower::BranchOptions;
pub use growth::Growth;
pub use half_branch::{BranchEnd, BranchPoint};
pub use hybrid::{
    DURATION, Family, Hybrid, Jet, Limits, PARAMETER, Point, Simulated, TIME, constant, distance,
    values, variable,
};
pub use impact_map::{ImpactPoint, Impacts, MOST_KEPT};
pub use lap::{Lap, Leg, Linearised};
pub use measures::{Distances, Measures};
pub use moored::{Cables, Moored, period_of};
pub use moored_searches::OnLap;
pub use multipliers::{Multipliers, Stability, multipliers};
pub use newton::{Closed, close};
pub use options::{
    BASIN_TRANSIENT, KEEP, ORBIT_PERIODS, PERIODS, POINTS, STARTS, branch_options, check_start,
    check_start_of_system, checked_phase, curve_options, followed_key, section_options,
};
pub use orbit::{EventRow, NoOrbit, Orbit, OrbitRequest, Proof};
pub use orbit_row::OrbitRow;
pub use proof::{Proofs, prove_all};
pub use quantities::QUANTITIES;
pub use rows::{AttractionRow, BasinRow, DiagramRow, ErosionRow, SectionRow};
pub use scan::scan;
pub use section::{LONGEST_PERIOD, Section, SectionOptions, start_of};
pub use sequence::{Event, EventKind, Sequence, Timed, symbol_text};
pub use summary::{
    basin_summary, diagram_summary, erosion_summary, orbit_summary, section_summary,
    without_points_summary,
};
pub use survey::{Extreme, Survey, survey};
pub use window::{Cell, Window};
