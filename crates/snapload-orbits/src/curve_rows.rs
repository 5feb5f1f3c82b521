//! Curves in the form of their JSON, and as text.

use crate::branch_events::BranchEvent;
use crate::branch_rows::EventRow;
use crate::curve::{Curve, CurveEnd, CurvePoint};
use crate::hybrid::Point;
use crate::orbit_row::StabilityRow;
use serde::Serialize;
use std::fmt::Write;

/// A curve.
#[derive(Serialize)]
pub struct CurveRow {
    follow: &'static str,
    along: [&'static str; 2],
    from: EventRow,
    points: Vec<PointRow>,
    ends: Vec<EndRow>,
}

#[derive(Serialize)]
struct PointRow {
    values: [f64; 2],
    section: Point,
    symbol: Vec<String>,
    multipliers: Vec<[f64; 2]>,
    others: StabilityRow,
    admissible: bool,
    why_not: Vec<String>,
    arclength: f64,
    coefficient: Option<f64>,
    normal_acceleration: Option<f64>,
    sqrt_coefficient: Option<f64>,
}

#[derive(Serialize)]
struct EndRow {
    at: [f64; 2],
    because: String,
}

impl CurveRow {
    /// A curve along two keys, through an event of a branch along the first.
    pub fn new(along: [&'static str; 2], curve: &Curve, from: &BranchEvent) -> Self {
        let end = |end: &CurveEnd| EndRow {
            at: end.at,
            because: end.because.clone(),
        };
        Self {
            follow: curve.kind.name(),
            along,
            from: EventRow::new(from),
            points: curve.points.iter().map(PointRow::new).collect(),
            ends: curve.ends.iter().map(end).collect(),
        }
    }
}

impl PointRow {
    fn new(point: &CurvePoint) -> Self {
        let orbit = &point.orbit;
        Self {
            values: orbit.at,
            section: orbit.z,
            symbol: orbit.lap.sequence.symbol(),
            multipliers: orbit.multipliers.values.clone(),
            others: StabilityRow(point.others),
            admissible: orbit.is_admissible(),
            why_not: orbit.why_not.clone(),
            arclength: point.arclength,
            coefficient: point.coefficient,
            normal_acceleration: point.normal_acceleration,
            sqrt_coefficient: point.sqrt_coefficient,
        }
    }
}

/// A summary of a curve in a few lines.
pub fn curve_summary(along: [&str; 2], curve: &Curve, from: &BranchEvent) -> String {
    let name = curve.kind.name().replace('_', " ");
    let [first, second] = along;
    let real = curve.points.iter();
    let real = real.filter(|point| point.orbit.is_admissible()).count();
    let mut text = format!(
        "From      the {name} at {first} = {:.12}, {second} = {}\n",
        from.value[0], from.value[1]
    );
    let _ = writeln!(
        text,
        "Curve     {} points, {real} of them admissible orbits",
        curve.points.len()
    );
    for (key, place) in [(first, 0), (second, 1)] {
        let values = || curve.points.iter().map(|point| point.orbit.at[place]);
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        let _ = writeln!(text, "          {key} from {low:.6} to {high:.6}");
    }
    for end in &curve.ends {
        let [a, b] = end.at;
        let _ = writeln!(
            text,
            "Ends      at {first} = {a:.6}, {second} = {b:.6}: {}",
            end.because
        );
    }
    text
}
