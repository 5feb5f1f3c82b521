//! The critical force, and the probability of exceeding the limits against the force amplitude: in
//! JSON and in words.
use crate::run_with_trust::{neighbours, percent};
use serde::Serialize;
use snapload::analysis::{CriticalForce, ExceedanceCurve, Exceeding};
use std::fmt::Write;

/// The form of one answer in JSON.
#[derive(Serialize)]
pub struct CriticalRow {
    /// The smallest amplitude that exceeds; none if none does.
    pub f_cr: Option<f64>,
    /// Whether its run ends before its horizon, and no smaller amplitude is uncertain or cut short.
    pub certain: bool,
    /// The limit that its run reaches.
    pub reason: Option<&'static str>,
    /// The time at which it is reached.
    pub t: Option<f64>,
    exceeding: Vec<[f64; 2]>,
    uncertain: Vec<[f64; 2]>,
    cut_short: Vec<[f64; 2]>,
    /// The largest amplitude of the scan.
    pub up_to: f64,
}

impl CriticalRow {
    /// The row of a result.
    pub fn new(found: CriticalForce) -> Self {
        let CriticalForce {
            first,
            exceeding,
            uncertain,
            cut_short,
            up_to,
            certain,
        } = found;
        Self {
            f_cr: first.map(|first| first.f_o),
            certain,
            reason: first.map(|first| first.reason.name()),
            t: first.map(|first| first.t),
            exceeding,
            uncertain,
            cut_short,
            up_to,
        }
    }

    /// The amplitudes that exceed, in words.
    pub fn exceeding(&self) -> String {
        in_words(&self.exceeding)
    }

    /// Those at which rounding decides, in words; none if there are none.
    pub fn uncertain(&self) -> Option<String> {
        (!self.uncertain.is_empty()).then(|| in_words(&self.uncertain))
    }

    /// Those whose run is cut short, in words; none if there are none.
    pub fn cut_short(&self) -> Option<String> {
        (!self.cut_short.is_empty()).then(|| in_words(&self.cut_short))
    }
}

fn in_words(intervals: &[[f64; 2]]) -> String {
    let interval = |[from, to]: &[f64; 2]| match from == to {
        true => format!("{from}"),
        false => format!("{from}-{to}"),
    };
    let all: Vec<String> = intervals.iter().map(interval).collect();
    all.join(", ")
}

/// The probability of exceeding, in JSON: a curve with the numbers from which it was computed.
#[derive(Serialize)]
pub struct Probability {
    members: u32,
    seed: u64,
    passes: Passes,
    probability: Vec<Point>,
}

/// The smallest amplitudes at which at least 5, 50 and 95 % of the neighbours exceed.
#[derive(Serialize)]
struct Passes {
    p05: Option<f64>,
    p50: Option<f64>,
    p95: Option<f64>,
}

#[derive(Serialize)]
struct Point {
    f_o: f64,
    certain: bool,
    cut_short: bool,
    /// None where no neighbour is run.
    count: Option<usize>,
    part: f64,
    low: f64,
    high: f64,
}

impl Point {
    fn new(point: &Exceeding) -> Self {
        let [low, high] = point.interval();
        let cut_short = point.is_cut_short();
        Self {
            f_o: point.f_o,
            certain: point.share.is_none() && !cut_short,
            cut_short,
            count: point.share.map(|share| share.count),
            part: point.part,
            low,
            high,
        }
    }
}

impl Probability {
    /// The row of a curve for `members` neighbours at each amplitude that one run does not decide,
    /// drawn with this seed.
    pub fn new(curve: &ExceedanceCurve, members: u32, seed: u64) -> Self {
        Self {
            members,
            seed,
            passes: Passes {
                p05: curve.passes(0.05),
                p50: curve.passes(0.5),
                p95: curve.passes(0.95),
            },
            probability: curve.points.iter().map(Point::new).collect(),
        }
    }

    /// A line for every amplitude at which the share is neither none nor all, or not known for some
    /// of the neighbours.
    pub fn in_words(&self, text: &mut String) {
        let Passes { p05, p50, p95 } = self.passes;
        let from = |f_o: Option<f64>| match f_o {
            Some(f_o) => f_o.to_string(),
            None => "none".to_owned(),
        };
        let points = &self.probability;
        let open = points.iter().filter(|point| point.count.is_some()).count();
        let cut_short = points.iter().filter(|point| point.cut_short).count();
        let _ = writeln!(
            text,
            "Ensemble  {} at each f_o that one run does not decide ({open} of {}); \
             the first f_o at which 5 % exceed a limit: {}, 50 %: {}, 95 %: {}",
            neighbours(self.members as usize),
            points.len(),
            from(p05),
            from(p50),
            from(p95)
        );
        // Of a run that is cut short itself the interval is from 0 to 1.
        let is_split = |point: &&Point| match point.cut_short {
            true => point.low > 0.0 || point.high < 1.0,
            false => 0.0 < point.part && point.part < 1.0,
        };
        let split: Vec<&Point> = points.iter().filter(is_split).collect();
        let decided = points.iter().filter(|point| !point.cut_short).count()
            - split.iter().filter(|point| !point.cut_short).count();
        if !split.is_empty() {
            let _ = writeln!(text, "          {:<8} {:>8}  95 %", "f_o", "exceed");
        }
        for point in &split {
            let _ = writeln!(
                text,
                "          {:<8} {:>6} %  {}-{} %",
                point.f_o,
                percent(point.part, f64::round),
                percent(point.low, f64::floor),
                percent(point.high, f64::ceil)
            );
        }
        let all_or_none = points
            .iter()
            .filter(|point| point.count.is_some() && !point.cut_short);
        let unseen = all_or_none.filter_map(|point| match point.part {
            0.0 => Some(point.high),
            1.0 => Some(1.0 - point.low),
            _ => None,
        });
        let unseen = match unseen.reduce(f64::max) {
            Some(unseen) => format!(
                "; up to {} % of all neighbours may do otherwise than all that were run",
                percent(unseen, f64::ceil)
            ),
            None => String::new(),
        };
        let _ = writeln!(
            text,
            "          all or none exceed at {decided} of {} f_o{unseen}",
            points.len()
        );
        if cut_short > 0 {
            let _ = writeln!(
                text,
                "          not known at {cut_short} f_o, where runs are cut short: the first f_o above may be smaller"
            );
        }
    }
}
