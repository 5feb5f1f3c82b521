//! What the runs besides that of the case add to its verdict, and how far it can be trusted, in
//! words.

use super::verdict::{Verdict, VerdictKind, undecided_by};
use crate::physics::warning::Warning;
use crate::runs::assess::{Assessment, TOLERANCE};
use crate::runs::elastic_comparison::{ElasticComparison, Repeated};
use crate::runs::outcome::Outcome;
use crate::structure::Water;
use crate::text_layout::{digits, kilo, paragraph};
use askama::Template;
use snapload::analysis::{HorizonCause, Trust};

/// With fewer neighbours, no statement about 90 % of them is made.
const FEWEST_NEIGHBOURS: usize = 10;

/// How far a motion on elastic lines is known.
#[derive(Template)]
#[template(path = "repeated.txt")]
struct RepeatedText {
    horizon_s: Option<f64>,
    error_m: f64,
    /// The largest tension of each line in the motion in shorter steps, if it is judged.
    peaks_n: Vec<f64>,
}

#[derive(Template)]
#[template(path = "trust.txt")]
struct TrustText<'a> {
    trust: &'a Trust,
    horizon_s: Option<f64>,
    /// The error up to which the run is certain.
    error_m: f64,
    /// The quantiles of the neighbours' largest tensions, as they are shown.
    spread_kn: Option<[String; 3]>,
    /// Whether no line snaps in any of the neighbours.
    snapless: bool,
    /// Whether the neighbours' peaks differ by more than rounding.
    scattered: bool,
    count: usize,
    failing: usize,
    irregular: bool,
}

/// The opposite of a run's answer: of neighbours as a fact, of other cases as what would be.
fn otherwise_in_words(fails: bool, is_fact: bool) -> &'static str {
    match (fails, is_fact) {
        (false, _) => "a line would break or the mooring fail",
        (true, true) => "no line breaks and the mooring holds",
        (true, false) => "no line would break and the mooring would hold",
    }
}

/// Whether lines break or the mooring fails by a verdict, if it is one that other runs can
/// contradict.
fn failing(verdict: &Verdict, warnings: &[Warning]) -> Option<bool> {
    match verdict.standing {
        VerdictKind::Holds => Some(false),
        VerdictKind::Open if undecided_by(warnings).is_none() => Some(false),
        VerdictKind::Breaks | VerdictKind::Exceeds => Some(true),
        VerdictKind::Open | VerdictKind::Unknown => None,
    }
}

/// Leaves a verdict open that no line breaks, and returns the words for it.
fn left_open(verdict: &mut Verdict) -> &'static str {
    match verdict.standing {
        VerdictKind::Holds => {
            verdict.standing = VerdictKind::Open;
            ", so the verdict is open"
        }
        _ => "",
    }
}

impl ElasticComparison {
    /// A verdict that no line breaks does not stand if a line breaks where the motion is integrated
    /// in shorter steps.
    pub(super) fn with_repeated(&self, mut verdict: Verdict) -> Verdict {
        let structure = &self.elastic_case.structure;
        let repeated = self.repeated.outcome.fails_as_computed(structure);
        if let Some(fails) = failing(&verdict, &self.warnings())
            && repeated == Some(!fails)
        {
            let so = left_open(&mut verdict);
            let otherwise = otherwise_in_words(fails, true);
            verdict.words += &format!(" Integrated in shorter steps {otherwise}{so}.");
        }
        verdict
    }

    /// How far the motion is known, with the numbers.
    pub fn trust_text(&self) -> String {
        let Repeated { outcome, horizon_s } = &self.repeated;
        let judged = outcome.lines.iter().filter(|line| line.least_n.is_some());
        paragraph(&RepeatedText {
            horizon_s: *horizon_s,
            error_m: TOLERANCE * self.elastic_case.model.scales.length_m,
            peaks_n: judged.map(|line| line.largest_taut_n).collect(),
        })
    }
}

impl Assessment {
    /// A verdict that no line breaks does not stand if a line breaks in a neighbour or in a
    /// slightly other wave, and any verdict says with which restitution the answer would be
    /// another.
    pub(super) fn with_other_runs(&self, mut verdict: Verdict) -> Verdict {
        let Some(fails) = failing(&verdict, &self.warnings) else {
            return verdict;
        };
        let structure = &self.prepared.structure;
        let otherwise = |outcome: &Outcome| outcome.fails_as_computed(structure) == Some(!fails);
        let differing = self.neighbours.iter().filter(|n| otherwise(n)).count();
        if differing > 0 {
            let so = left_open(&mut verdict);
            verdict.words += &format!(
                " In {differing} of {} neighbours {}{so}.",
                self.neighbours.len(),
                otherwise_in_words(fails, true)
            );
        }
        let waves = self.waves.iter().filter(|(_, outcome)| otherwise(outcome));
        let waves = waves.map(|(wave, _)| format!("{} m and {} s", wave.height_m, wave.period_s));
        let waves: Vec<String> = waves.collect();
        if !waves.is_empty() {
            let so = left_open(&mut verdict);
            verdict.words += &format!(
                " In waves of {} {}{so}: height and period must be known to better than \
                 1 %.",
                waves.join(", or of "),
                otherwise_in_words(fails, false)
            );
        }
        let others = self.restitutions.iter();
        let others = others.filter(|(_, outcome)| otherwise(outcome));
        let others: Vec<String> = others.map(|(e, _)| format!("{e:.2}")).collect();
        if !others.is_empty() {
            verdict.words += &format!(
                " With a restitution of {} {}; the restitution must be known.",
                others.join(" or "),
                otherwise_in_words(fails, false)
            );
        }
        verdict
    }

    /// How far the run can be trusted, with the numbers.
    pub fn trust_text(&self) -> String {
        let spread = self.spread();
        paragraph(&TrustText {
            scattered: spread.is_some_and(|[low, _, high]| high > 1.02 * low),
            trust: &self.trust,
            snapless: spread.is_some() && self.neighbours.iter().all(|n| n.peak_n().is_none()),
            horizon_s: self.horizon_s(),
            error_m: TOLERANCE * self.prepared.model.scales.length_m,
            spread_kn: spread.map(|spread| spread.map(|newtons| kilo(&newtons, 0))),
            count: self.neighbours.len(),
            failing: self.neighbours.iter().filter(|n| n.stop.exceeds()).count(),
            irregular: matches!(self.prepared.structure.water, Water::Sea(_)),
        })
    }
}
