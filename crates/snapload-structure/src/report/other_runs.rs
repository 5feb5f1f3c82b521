//! What the runs besides that of the case add to its verdict, and how far it can be trusted, in
//! words.

use super::verdict::{Verdict, VerdictKind, undecided_by};
use crate::runs::assess::{Assessment, TOLERANCE};
use crate::runs::outcome::Outcome;
use crate::structure::Water;
use crate::text_layout::{digits, kilo, paragraph};
use askama::Template;
use snapload::analysis::{HorizonCause, Trust};

/// With fewer neighbours, no statement about 90 % of them is made.
const FEWEST_NEIGHBOURS: usize = 10;

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

impl Assessment {
    /// A verdict that no line breaks does not stand if a line breaks in a neighbour or in a
    /// slightly other wave, and any verdict says with which restitution the answer would be
    /// another.
    pub(super) fn with_other_runs(&self, mut verdict: Verdict) -> Verdict {
        let fails = match verdict.standing {
            VerdictKind::Holds => false,
            VerdictKind::Open if undecided_by(&self.warnings).is_none() => false,
            VerdictKind::Breaks | VerdictKind::Exceeds => true,
            VerdictKind::Open | VerdictKind::Unknown => return verdict,
        };
        let structure = &self.prepared.structure;
        let otherwise = |outcome: &Outcome| outcome.fails_as_computed(structure) == Some(!fails);
        let is_open = |verdict: &mut Verdict| match verdict.standing {
            VerdictKind::Holds => {
                verdict.standing = VerdictKind::Open;
                ", so the verdict is open"
            }
            _ => "",
        };
        let differing = self.neighbours.iter().filter(|n| otherwise(n)).count();
        if differing > 0 {
            let so = is_open(&mut verdict);
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
            let so = is_open(&mut verdict);
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
