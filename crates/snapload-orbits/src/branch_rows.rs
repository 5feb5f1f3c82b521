//! Branches in the form of their JSON, and as text.

use crate::branch::Branch;
use crate::branch_events::BranchEvent;
use crate::half_branch::{BranchEnd, BranchPoint};
use crate::hybrid::Point;
use crate::orbit_row::StabilityRow;
use serde::Serialize;
use std::fmt::Write;

/// A branch.
#[derive(Serialize)]
pub struct BranchRow {
    along: &'static str,
    from: Vec<EventRow>,
    points: Vec<PointRow>,
    events: Vec<EventRow>,
    ends: Vec<EndRow>,
}

#[derive(Serialize)]
struct PointRow {
    value: f64,
    section: Point,
    symbol: Vec<String>,
    multipliers: Vec<[f64; 2]>,
    stable: StabilityRow,
    admissible: bool,
    why_not: Vec<String>,
    return_error: Option<f64>,
    arclength: f64,
}

#[derive(Serialize)]
pub(crate) struct EventRow {
    kind: &'static str,
    value: f64,
    state: Point,
    cable: Option<usize>,
    t: Option<f64>,
    normal_acceleration: Option<f64>,
    sqrt_coefficient: Option<f64>,
    multipliers: Vec<[f64; 2]>,
    admissible: bool,
    arclength: f64,
    /// Between which values it lies, where it is not located.
    between: Option<[f64; 2]>,
}

#[derive(Serialize)]
struct EndRow {
    at: f64,
    because: String,
}

impl BranchRow {
    /// A branch along a key, which was reached through events of others, the last of which is its
    /// start.
    pub fn new(along: &'static str, branch: &Branch, from: &[BranchEvent]) -> Self {
        let end = |end: &BranchEnd| EndRow {
            at: end.at,
            because: end.because.clone(),
        };
        Self {
            along,
            from: from.iter().map(EventRow::new).collect(),
            points: branch.points.iter().map(PointRow::new).collect(),
            events: branch.events.iter().map(EventRow::new).collect(),
            ends: branch.ends.iter().map(end).collect(),
        }
    }
}

impl PointRow {
    fn new(point: &BranchPoint) -> Self {
        let orbit = &point.orbit;
        Self {
            value: orbit.at[0],
            section: orbit.z,
            symbol: orbit.lap.sequence.symbol(),
            multipliers: orbit.multipliers.values.clone(),
            stable: StabilityRow(orbit.stability()),
            admissible: orbit.is_admissible(),
            why_not: orbit.why_not.clone(),
            return_error: orbit.return_error,
            arclength: point.arclength,
        }
    }
}

impl EventRow {
    pub(crate) fn new(event: &BranchEvent) -> Self {
        Self {
            kind: event.kind.name(),
            value: event.value[0],
            state: event.orbit.z,
            cable: event.surface.map(|surface| surface + 1),
            t: event.t,
            normal_acceleration: event.normal_acceleration,
            sqrt_coefficient: event.sqrt_coefficient,
            multipliers: event.orbit.multipliers.values.clone(),
            admissible: event.orbit.is_admissible(),
            arclength: event.arclength,
            between: event.between,
        }
    }
}

/// A summary of a branch in a few lines.
pub fn branch_summary(along: &str, branch: &Branch) -> String {
    let real = branch
        .points
        .iter()
        .filter(|point| point.orbit.is_admissible());
    let mut text = format!(
        "Branch    {} points, {} of them admissible orbits\n",
        branch.points.len(),
        real.count()
    );
    for event in &branch.events {
        let kind = event.kind.name().replace('_', " ");
        let _ = match event.between {
            None => write!(
                text,
                "          {kind:<16} {along} = {:.12}",
                event.value[0]
            ),
            Some([a, b]) => write!(
                text,
                "          {kind:<16} {along} between {a:.9} and {b:.9}, not located"
            ),
        };
        if let (Some(surface), Some(t)) = (event.surface, event.t) {
            let _ = write!(text, "  cable {} at t = {t:.6}", surface + 1);
        }
        text.push('\n');
    }
    for end in &branch.ends {
        let _ = writeln!(
            text,
            "Ends      at {along} = {:.6}: {}",
            end.at, end.because
        );
    }
    text
}
