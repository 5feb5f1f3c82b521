//! What the runs besides that of the case add to its verdict, and how far it can be trusted, in
//! words.

use super::verdict::{Verdict, VerdictKind, end_text, undecided_by};
use crate::physics::warning::Warning;
use crate::runs::assess::{Assessment, TOLERANCE};
use crate::runs::elastic_comparison::{ElasticComparison, Repeated};
use crate::runs::neighbours::FEWEST_NEIGHBOURS;
use crate::runs::outcome::Outcome;
use crate::structure::{Structure, Water};
use crate::text_layout::{digits, kilo, paragraph, ratio};
use askama::Template;
use snapload::Stop;
use snapload::analysis::{HorizonCause, Trust};
use std::slice;

/// The relative difference of two largest tensions from which on both are told.
const NOTABLE: f64 = 0.005;
/// The relative difference of neighbours' largest tensions from which on rounding decides them.
const SCATTERED: f64 = 0.02;

/// How far a motion on elastic lines is known.
#[derive(Template)]
#[template(path = "repeated.txt")]
struct RepeatedText {
    horizon_s: Option<f64>,
    error_m: f64,
    /// How and when the motion in shorter steps ends, if early.
    other_end: Option<(&'static str, f64)>,
    /// The largest tension of each line in that motion, if it is judged.
    peaks_n: Vec<f64>,
    neighbours: Neighbours,
}

#[derive(Template)]
#[template(path = "trust.txt")]
struct TrustText<'a> {
    trust: &'a Trust,
    horizon_s: Option<f64>,
    /// The error up to which the run is certain.
    error_m: f64,
    neighbours: Neighbours,
}

/// The neighbours of a run, for its row of trust.
struct Neighbours {
    count: usize,
    /// Those that turn over or touch the floor.
    failing: usize,
    /// The quantiles of their largest tension, as they are shown; of inextensible lines, of that in
    /// a snap.
    spread_kn: Option<[String; 3]>,
    elastic: bool,
    /// Whether no line snaps in any of them, so that inextensible lines have no such tension.
    snapless: bool,
    /// Whether their peaks differ by more than rounding.
    scattered: bool,
    irregular: bool,
}

impl Neighbours {
    fn new(
        all: &[Outcome],
        spread: Option<[f64; 3]>,
        structure: &Structure,
        elastic: bool,
    ) -> Self {
        let no_snap = all.iter().all(|n| n.peak_n().is_none());
        Self {
            count: all.len(),
            failing: all.iter().filter(|n| n.stop.exceeds()).count(),
            elastic,
            spread_kn: spread.map(|spread| spread.map(|newtons| kilo(&newtons, 0))),
            snapless: !elastic && spread.is_some() && no_snap,
            scattered: spread.is_some_and(|[low, _, high]| high > (1.0 + SCATTERED) * low),
            irregular: matches!(structure.water, Water::Sea(_)),
        }
    }
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

/// Adds how many neighbours fail where the run does not, or the other way round; and where none
/// does, the largest ratio of tension to breaking load in them, if that of the run is lower.
fn with_neighbours(
    verdict: &mut Verdict,
    fails: bool,
    [run, neighbours]: [&[Outcome]; 2],
    structure: &Structure,
) {
    let otherwise = |outcome: &&Outcome| outcome.fails_as_computed(structure) == Some(!fails);
    let differing = neighbours.iter().filter(otherwise).count();
    if differing > 0 {
        let so = left_open(verdict);
        let of = match neighbours.len() {
            1 => "the one neighbour".to_owned(),
            count => format!("{differing} of {count} neighbours"),
        };
        let answer = otherwise_in_words(fails, true);
        verdict.words += &format!(" In {of} {answer}{so}.");
        return;
    }
    let largest = |outcomes: &[Outcome]| {
        let all = outcomes.iter().flat_map(|n| n.utilisations(structure));
        all.flatten().fold(0.0, f64::max)
    };
    let [own, theirs] = [largest(run), largest(neighbours)];
    if verdict.standing == VerdictKind::Holds && theirs > (1.0 + SCATTERED) * own {
        verdict.words += &format!(" In neighbours the ratio is up to {}.", ratio(&theirs));
    }
}

impl ElasticComparison {
    /// A verdict that no line breaks does not stand if a line breaks or the mooring fails where the
    /// motion is integrated in shorter steps, or in a neighbour, nor where the motion is not known to
    /// its end and few neighbours were run; any verdict says what is otherwise there.
    pub(super) fn with_other_runs(&self, mut verdict: Verdict) -> Verdict {
        let structure = &self.elastic_case.structure;
        let (first, other) = (&self.outcome, &self.repeated.outcome);
        let Some(fails) = failing(&verdict, &self.warnings()) else {
            return verdict;
        };
        let mut otherwise = Vec::new();
        match (first.stop.exceeds(), other.stop.exceeds()) {
            (true, false) => otherwise.push("the mooring does not fail".to_owned()),
            (false, true) => {
                let end = end_text(other.stop);
                otherwise.push(format!(
                    "the mooring fails: the run {end} at {:.1} s",
                    other.end_s
                ));
            }
            _ => {}
        }
        let parts = [first, other].map(|outcome| outcome.utilisations(structure));
        for (line, parts) in (1..).zip(parts[0].iter().zip(&parts[1])) {
            if let (Some(first), Some(other)) = parts
                && (*first >= 1.0) != (*other >= 1.0)
            {
                let holds = if *other < 1.0 { "holds" } else { "would break" };
                otherwise.push(format!("line {line} {holds} ({})", ratio(other)));
            }
        }
        if !otherwise.is_empty() {
            let so = match !fails && other.fails_as_computed(structure) == Some(true) {
                true => left_open(&mut verdict),
                false => "",
            };
            verdict.words += &format!(" Integrated in shorter steps {}{so}.", otherwise.join(", "));
        }
        let runs = [slice::from_ref(&self.outcome), &self.neighbours];
        with_neighbours(&mut verdict, fails, runs, structure);
        if let Some(until_s) = self.known_in_part_s()
            && verdict.standing == VerdictKind::Holds
        {
            let so = left_open(&mut verdict);
            let neighbours = match structure.has_waves() {
                true => format!("fewer than {FEWEST_NEIGHBOURS} neighbours were run"),
                false => "in still water there are no neighbours to run".to_owned(),
            };
            verdict.words +=
                &format!(" The motion is known only up to {until_s:.1} s, and {neighbours}{so}.");
        }
        verdict
    }

    /// How far the motion is known, with the numbers; the largest tensions in shorter steps are
    /// told where the motion is not known to its end, or they are others.
    pub fn trust_text(&self) -> String {
        let Repeated { outcome, horizon_s } = &self.repeated;
        let judged = outcome.lines.iter().filter(|line| line.least_n.is_some());
        let peaks_n: Vec<f64> = judged.map(|line| line.largest_taut_n).collect();
        let mut both = peaks_n.iter().zip(&self.elastic.peaks_n);
        let differ = both.any(|(other, peak)| (other - peak).abs() > NOTABLE * peak);
        paragraph(&RepeatedText {
            horizon_s: *horizon_s,
            error_m: TOLERANCE * self.elastic_case.model.scales.length_m,
            other_end: (outcome.stop != Stop::EndTime)
                .then(|| (end_text(outcome.stop), outcome.end_s)),
            peaks_n: match horizon_s.is_some() || differ {
                true => peaks_n,
                false => Vec::new(),
            },
            neighbours: Neighbours::new(
                &self.neighbours,
                self.spread(),
                &self.elastic_case.structure,
                true,
            ),
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
        let runs = [slice::from_ref(&self.outcome), &self.neighbours];
        with_neighbours(&mut verdict, fails, runs, structure);
        let otherwise = |outcome: &Outcome| outcome.fails_as_computed(structure) == Some(!fails);
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
        paragraph(&TrustText {
            trust: &self.trust,
            horizon_s: self.horizon_s(),
            error_m: TOLERANCE * self.prepared.model.scales.length_m,
            neighbours: Neighbours::new(
                &self.neighbours,
                self.spread(),
                &self.prepared.structure,
                false,
            ),
        })
    }
}
