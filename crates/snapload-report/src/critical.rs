//! The critical force, and the probability of exceeding the limits against the force amplitude: in JSON and
//! in words.
use crate::trusted::{neighbours, percent};
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use snapload::analysis::{CriticalForce, ExceedanceCurve, Exceeding};
use snapload_study::reason;
use std::fmt::Write;

/// The shape of one answer in JSON.
pub struct CriticalRow(pub CriticalForce);

impl CriticalRow {
    /// The entries of the JSON.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn entries<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        let first = self.0.first;
        map.serialize_entry("f_cr", &first.map(|first| first.f_o))?;
        map.serialize_entry("reason", &first.map(|first| reason(first.reason)))?;
        map.serialize_entry("t", &first.map(|first| first.t))?;
        map.serialize_entry("exceeding", &self.0.exceeding)
    }

    /// The amplitudes that exceed, as one writes them.
    pub fn exceeding(&self) -> String {
        let interval = |[from, to]: &[f64; 2]| {
            if from == to {
                format!("{from}")
            } else {
                format!("{from}-{to}")
            }
        };
        let all: Vec<String> = self.0.exceeding.iter().map(interval).collect();
        all.join(", ")
    }
}

/// The parts of the neighbours at which it is told which amplitude they exceed at.
const LEVELS: [f64; 3] = [0.05, 0.5, 0.95];

/// A curve with what it was computed from.
pub struct Probability {
    /// The curve.
    pub curve: ExceedanceCurve,
    /// How many neighbours at each amplitude.
    pub members: u32,
    /// Which.
    pub seed: u64,
}

impl Probability {
    /// The entries of the JSON.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn entries<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry("members", &self.members)?;
        map.serialize_entry("seed", &self.seed)?;
        map.serialize_entry("passes", &Passes(&self.curve))?;
        let points: Vec<Point> = self.curve.points.iter().map(Point::new).collect();
        map.serialize_entry("probability", &points)
    }

    /// A line for every amplitude at which it is neither none nor all, or not for certain.
    pub fn told(&self, text: &mut String) {
        let passes: Vec<String> = LEVELS
            .iter()
            .map(|level| {
                let part = percent(*level, f64::round);
                match self.curve.passes(*level) {
                    Some(f_o) => format!("{part} % from f_o = {f_o}"),
                    None => format!("{part} % nowhere"),
                }
            })
            .collect();
        let members = neighbours(self.members as usize);
        let _ = writeln!(
            text,
            "Ensemble  of {members} at each f_o exceed: {}",
            passes.join(", ")
        );
        let points = &self.curve.points;
        let split: Vec<&Exceeding> = points
            .iter()
            .filter(|point| (1..point.share.of).contains(&point.share.count))
            .collect();
        if !split.is_empty() {
            let _ = writeln!(text, "          {:<8} {:>8}  95 %", "f_o", "exceed");
        }
        for point in &split {
            let [low, high] = point.share.interval();
            let _ = writeln!(
                text,
                "          {:<8} {:>6} %  {}-{} %",
                point.f_o,
                percent(point.share.part(), f64::round),
                percent(low, f64::floor),
                percent(high, f64::ceil)
            );
        }
        let certain = points.iter().filter(|point| point.certain).count();
        let _ = writeln!(
            text,
            "          all or none at {} of {} f_o, {certain} of them for certain",
            points.len() - split.len(),
            points.len()
        );
    }
}

impl Serialize for CriticalRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        self.entries(&mut map)?;
        map.end()
    }
}

impl Serialize for Probability {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        self.entries(&mut map)?;
        map.end()
    }
}

struct Passes<'a>(&'a ExceedanceCurve);

impl Serialize for Passes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let name = |level: f64| format!("p{:02.0}", 100.0 * level);
        let levels = LEVELS.map(|level| (name(level), self.0.passes(level)));
        serializer.collect_map(levels)
    }
}

#[derive(Serialize)]
struct Point {
    f_o: f64,
    certain: bool,
    count: usize,
    part: f64,
    low: f64,
    high: f64,
}

impl Point {
    fn new(point: &Exceeding) -> Self {
        let [low, high] = point.share.interval();
        Self {
            f_o: point.f_o,
            certain: point.certain,
            count: point.share.count,
            part: point.share.part(),
            low,
            high,
        }
    }
}
