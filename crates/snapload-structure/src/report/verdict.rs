//! The verdict in words, and how far it can be trusted.

use crate::physics::gumbel::Gumbel;
use crate::physics::snap::SLOWEST_M_S;
use crate::physics::warnings::Warning;
use crate::runs::assess::Assessment;
use crate::runs::elastic_comparison::ElasticComparison;
use crate::runs::outcome::{LineOutcome, Outcome};
use crate::runs::quantile::{quantile, sorted};
use crate::runs::seas::Seas;
use crate::structure::{Structure, Water};
use crate::text_layout::{digits, kilo, paragraph, ratio, tenths};
use askama::Template;
use serde::Serialize;
use snapload::Stop;
use snapload::analysis::{HorizonCause, Share, Trust};
use std::cmp::Ordering;

/// The kind of verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum VerdictKind {
    /// No line's breaking load is reached.
    Holds,
    /// A line's breaking load is reached.
    Breaks,
    /// The body turned over or touched the floor.
    Exceeds,
    /// A tension or a breaking load is not known.
    Unknown,
    /// A rule is violated on which the tensions depend, so that another command has to decide. Or a
    /// line would break only before the judged time, or only in neighbours of the run.
    Open,
}

impl VerdictKind {
    /// The word that is shown.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Breaks => "breaks",
            Self::Exceeds => "fails",
            Self::Unknown => "not known",
            Self::Open => "open",
        }
    }
}

/// The verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// In one word.
    pub standing: VerdictKind,
    /// In a sentence or two.
    pub words: String,
}

/// Why a run stopped, in an engineer's words.
pub fn end_text(stop: Stop) -> &'static str {
    match stop {
        Stop::EndTime => "ran to the end of the time",
        Stop::RotationLimit => "stopped where the body had turned by 90 degrees",
        Stop::UpperBound => "stopped where the body touched the floor",
        Stop::ImpactLimit => "stopped at the largest number of snaps allowed",
        other => other.reason_text(),
    }
}

/// With fewer neighbours, no statement about 90 % of them is made.
const FEWEST_NEIGHBOURS: usize = 10;

#[derive(Template)]
#[template(path = "verdict.txt")]
struct VerdictText<'a> {
    standing: VerdictKind,
    outcome: &'a Outcome,
    end: &'static str,
    /// Whether a line goes slack in the time that is judged, and in all.
    slack: [bool; 2],
    /// The lines that would break, each with its utilisation and how.
    broken: Vec<(usize, f64, &'static str)>,
    /// The line with the largest utilisation that is known.
    worst: (usize, f64),
    transient_s: f64,
    early: Option<Early>,
    /// The violated rules that leave the verdict open, and the command that decides.
    open: Option<(String, &'static str)>,
    /// Whether the run ended before the judged time.
    unjudged: bool,
    elastic: bool,
}

#[derive(Template)]
#[template(path = "trust.txt")]
struct TrustText<'a> {
    trust: &'a Trust,
    horizon_s: Option<f64>,
    /// The unit of length, L.
    length_m: f64,
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

#[derive(Template)]
#[template(path = "seas-words.txt")]
struct SeasVerdictText {
    /// The number of records in which a line would break only in the time that is not judged.
    early: usize,
    transient_s: f64,
    fit: Option<Gumbel>,
    exceeding: usize,
    cut_short: usize,
    /// The number of records in which no line snaps.
    without_snaps: usize,
    records: usize,
    length_s: f64,
    max_snaps: u64,
    tensions_known: bool,
    fastest_m_s: f64,
    median_m_s: f64,
    failing: Option<Share>,
    /// The violated rules that leave the verdict open, and the command that decides.
    open: Option<(String, &'static str)>,
    /// Whether there are too few records for a fit, whatever their values.
    few: bool,
}

/// The violated rules on which tensions depend, and the command that decides.
fn undecided_by(warnings: &[Warning]) -> Option<(String, &'static str)> {
    let deciding = warnings
        .iter()
        .filter_map(|w| Some((w.rule, w.decided_by?)));
    let (rules, commands): (Vec<_>, Vec<_>) = deciding.unzip();
    Some((rules.join(" and "), *commands.first()?))
}

/// A load within the transient, which is not judged.
struct Early {
    line: usize,
    how: EarlyLoad,
    /// 0 for the tension of a taut line.
    speed_m_s: f64,
    peak_n: Option<f64>,
    utilisation: Option<f64>,
}

/// The kind of load.
#[derive(PartialEq)]
enum EarlyLoad {
    Snap,
    ImpactWhileTaut,
    Taut,
}

impl Early {
    /// The largest early load of each line, while taut or in a snap, if tensions are known.
    fn taut_or_snap<'a>(
        structure: &'a Structure,
        outcome: &'a Outcome,
    ) -> impl Iterator<Item = Self> {
        let lines = outcome.lines.iter().zip(&structure.lines).enumerate();
        let loaded =
            lines.filter(|(_, (outcome, _))| structure.tensions_known() && outcome.early_n > 0.0);
        loaded.map(|(line, (outcome, known))| Self {
            line,
            how: EarlyLoad::Taut,
            speed_m_s: 0.0,
            peak_n: Some(outcome.early_n),
            utilisation: known.breaking_load_n.map(|load| outcome.early_n / load),
        })
    }

    /// The order of loads: the part of the line's breaking load, else the tension, else the speed.
    fn severity(&self) -> (Option<f64>, Option<f64>, f64) {
        (self.utilisation, self.peak_n, self.speed_m_s)
    }

    /// Whether its line would break.
    fn breaks(&self) -> bool {
        self.utilisation.is_some_and(|part| part >= 1.0)
    }

    /// The hardest of them, if it is harder than all judged loads.
    fn hardest(
        all: impl Iterator<Item = Self>,
        structure: &Structure,
        outcome: &Outcome,
    ) -> Option<Self> {
        let order = |a: &Self, b: &Self| a.severity().partial_cmp(&b.severity());
        let hardest = all.max_by(|a, b| order(a, b).unwrap_or(Ordering::Equal))?;
        let judged = outcome.utilisations(structure).into_iter().flatten();
        let harder = match (hardest.utilisation, hardest.peak_n) {
            (Some(part), _) => judged.reduce(f64::max).is_none_or(|judged| part > judged),
            (None, Some(peak)) => peak > outcome.largest_n(),
            (None, None) => hardest.speed_m_s > outcome.speed_m_s(),
        };
        harder.then_some(hardest)
    }
}

/// The verdict: whether the lines go slack, how hard they snap, and whether one breaks;
/// `elastic` says whether the lines are elastic.
fn verdict(
    structure: &Structure,
    outcome: &Outcome,
    warnings: &[Warning],
    early: Option<Early>,
    elastic: bool,
) -> Verdict {
    let lines = (1..)
        .zip(&outcome.lines)
        .zip(outcome.utilisations(structure));
    let known: Vec<_> = lines
        .filter_map(|((number, line), u)| Some((number, line, u?)))
        .collect();
    let worst = known.iter().max_by(|a, b| a.2.total_cmp(&b.2));
    let broken = known.iter().filter(|(_, _, u)| *u >= 1.0);
    let broken: Vec<_> = broken
        .map(|(number, line, u)| (*number, *u, how_it_breaks(line, elastic)))
        .collect();
    let all_known = known.len() == outcome.lines.len();
    let open = undecided_by(warnings);
    let standing = if outcome.stop.exceeds() {
        VerdictKind::Exceeds
    } else if open.is_some() {
        VerdictKind::Open
    } else if !broken.is_empty() {
        VerdictKind::Breaks
    } else if outcome.stop == Stop::ImpactLimit || !all_known {
        VerdictKind::Unknown
    } else if early.as_ref().is_some_and(Early::breaks) {
        VerdictKind::Open
    } else {
        VerdictKind::Holds
    };
    let text = VerdictText {
        standing,
        outcome,
        end: end_text(outcome.stop),
        slack: [
            outcome.lines.iter().any(|line| line.least_n == Some(0.0)),
            outcome.lines.iter().any(|line| line.slack_fraction > 0.0),
        ],
        worst: worst.map_or((0, 0.0), |(number, _, u)| (*number, *u)),
        broken,
        transient_s: structure.transient_s,
        early,
        open,
        unjudged: outcome.is_unjudged(),
        elastic,
    };
    Verdict {
        standing,
        words: paragraph(&text),
    }
}

/// How a line would break.
fn how_it_breaks(line: &LineOutcome, elastic: bool) -> &'static str {
    if elastic {
        "as an elastic line"
    } else if line.peak_n.is_some_and(|peak| peak >= line.largest_taut_n) {
        "in a snap"
    } else {
        "while taut"
    }
}

impl ElasticComparison {
    /// Whether elastic lines go slack, and whether one breaks.
    pub fn verdict(&self) -> Verdict {
        let (structure, outcome) = (&self.elastic_case.structure, &self.outcome);
        let pulls = self.elastic.pulls.iter();
        let early = pulls.filter(|pull| pull.peak_s < structure.transient_s);
        let early = early.map(|pull| Early {
            line: pull.line,
            how: if pull.speed_m_s < SLOWEST_M_S {
                EarlyLoad::Taut
            } else {
                EarlyLoad::Snap
            },
            speed_m_s: pull.speed_m_s,
            peak_n: Some(pull.peak_n),
            utilisation: structure.lines[pull.line]
                .breaking_load_n
                .map(|load| pull.peak_n / load),
        });
        let early = Early::hardest(early, structure, outcome);
        verdict(structure, outcome, &self.warnings(), early, true)
    }
}

impl Assessment {
    /// Whether the lines go slack, how hard they snap, and whether one breaks.
    pub fn verdict(&self) -> Verdict {
        let (structure, outcome) = (&self.prepared.structure, &self.outcome);
        let early = self.snaps.iter();
        let early = early.filter(|snap| snap.counts() && snap.t_s < structure.transient_s);
        let early = early.map(|snap| Early {
            line: snap.line,
            how: if snap.is_impact_while_taut {
                EarlyLoad::ImpactWhileTaut
            } else {
                EarlyLoad::Snap
            },
            speed_m_s: snap.speed_m_s,
            peak_n: snap.peak_n,
            utilisation: snap.utilisation,
        });
        // Of equal loads the snap is named, as it has a speed.
        let early = Early::taut_or_snap(structure, outcome).chain(early);
        let early = Early::hardest(early, structure, outcome);
        let alone = verdict(structure, outcome, &self.warnings, early, false);
        self.with_neighbours_in(alone)
    }

    /// A verdict that no line breaks does not stand if a line breaks in a neighbour, and says with
    /// which restitution one would.
    fn with_neighbours_in(&self, mut verdict: Verdict) -> Verdict {
        if verdict.standing != VerdictKind::Holds {
            return verdict;
        }
        let structure = &self.prepared.structure;
        let fails = |outcome: &Outcome| outcome.fails(structure) == Some(true);
        let failing = self.neighbours.iter().filter(|n| fails(n)).count();
        if failing > 0 {
            verdict.standing = VerdictKind::Open;
            verdict.words += &format!(
                " In {failing} of {} neighbours a line would break or the mooring fail, so the verdict is open.",
                self.neighbours.len()
            );
        }
        let others = self
            .restitutions
            .iter()
            .filter(|(_, outcome)| fails(outcome));
        let others: Vec<String> = others.map(|(e, _)| format!("{e:.2}")).collect();
        if !others.is_empty() {
            verdict.words += &format!(
                " With a restitution of {} a line would break or the mooring fail; the restitution must be known.",
                others.join(" or ")
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
            length_m: self.prepared.model.scales.length_m,
            spread_kn: spread.map(|spread| spread.map(|newtons| kilo(&newtons, 0))),
            count: self.neighbours.len(),
            failing: self.neighbours.iter().filter(|n| n.stop.exceeds()).count(),
            irregular: matches!(self.prepared.structure.water, Water::Sea(_)),
        })
    }
}

impl Seas {
    /// Whether a rule is violated on which tensions depend.
    pub fn is_open(&self) -> bool {
        undecided_by(&self.warnings).is_some()
    }

    /// The judged time, as the beginning of a sentence.
    pub(crate) fn judged_text(&self) -> String {
        let from = self.prepared.structure.transient_s;
        match self.records.len() {
            1 => format!("in the one record from {from:.0} s on"),
            count => format!("in all {count} records from {from:.0} s on"),
        }
    }

    /// The answer in a sentence or two.
    pub fn words(&self) -> String {
        let speeds = sorted(self.speeds_m_s().into_iter());
        paragraph(&SeasVerdictText {
            early: self.breaking_only_early(),
            transient_s: self.prepared.structure.transient_s,
            fit: self.peak_in_three_hours(),
            exceeding: self.exceeding(),
            cut_short: self.cut_short(),
            without_snaps: self.without_snaps(),
            records: self.records.len(),
            length_s: self.prepared.structure.duration_s,
            max_snaps: self.prepared.structure.max_snaps,
            tensions_known: self.prepared.structure.tensions_known(),
            fastest_m_s: speeds.last().copied().unwrap_or(0.0),
            median_m_s: quantile(&speeds, 0.5).unwrap_or(0.0),
            failing: self.failing(),
            open: undecided_by(&self.warnings),
            few: self.records.len() < Gumbel::FEWEST,
        })
    }
}
