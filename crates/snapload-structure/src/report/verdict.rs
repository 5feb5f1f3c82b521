//! The verdict in words.

use crate::physics::elastic::LEAST_RESTITUTION;
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::snap::SLOWEST_M_S;
use crate::physics::warning::Warning;
use crate::runs::assess::Assessment;
use crate::runs::elastic_comparison::ElasticComparison;
use crate::runs::outcome::{LineOutcome, Outcome};
use crate::runs::three_hours::{NoDistribution, one_run_is_too_little};
use crate::structure::{LineSi, Structure};
use crate::text_layout::{digits, kilo, paragraph, ratio, tenths};
use askama::Template;
use serde::Serialize;
use snapload::Stop;
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
    /// line would break only before the judged time, or only in neighbours of the run or in waves
    /// that differ by one percent. Or records of a sea are too short or too few to tell whether one
    /// breaks in three hours.
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

    /// The class of its colour on a page.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Breaks | Self::Exceeds => "fails",
            Self::Unknown | Self::Open => "open",
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

#[derive(Template)]
#[template(path = "verdict.txt")]
struct VerdictText<'a> {
    standing: VerdictKind,
    outcome: &'a Outcome,
    end: &'static str,
    /// Whether a line goes slack in the time that is judged, and in all.
    slack: [bool; 2],
    /// The lines that are slack at rest and stay so in the judged time.
    unloaded: Vec<usize>,
    /// Those that stay slack, and have tension at rest only as lines stretch.
    stretched: Vec<usize>,
    /// The lines that would break, each with its utilisation and how.
    broken: Vec<(usize, f64, &'static str)>,
    /// The line with the largest utilisation that is known.
    worst: (usize, f64),
    transient_s: f64,
    /// Whether there are waves, which begin at once.
    waves: bool,
    early: Option<Early>,
    /// The violated rules that leave the verdict open.
    open: Option<OpenRules>,
    /// Whether the run ended before the judged time.
    unjudged: bool,
    /// Why a run in which no line breaks does not tell whether one does.
    too_little: Option<NoDistribution>,
    /// Whether the restitution is too small for elastic lines.
    too_plastic: bool,
    elastic: bool,
    /// The factor by which the lines are stiffer than given.
    stiffer: f64,
    /// Whether each line's stiffness is known.
    stiffness_known: bool,
}

/// The violated rules on which tensions depend.
pub(super) struct OpenRules {
    /// Their names.
    pub(super) rules: String,
    /// The command that decides, if one does.
    pub(super) command: Option<&'static str>,
    /// Whether all of them apply to elastic lines, too.
    pub(super) of_all_lines: bool,
}

/// The lines whose tension at rest breaks them, by number from 1, each with the ratio of the two,
/// where the motion on elastic lines is to decide the rest.
pub(super) fn breaking_at_rest(prepared: &ModelAtRest, warnings: &[Warning]) -> Vec<(usize, f64)> {
    match undecided_by(warnings) {
        Some(open) if open.command.is_some() => prepared.breaking_at_rest(),
        _ => Vec::new(),
    }
}

/// The violated rules that leave a verdict open.
pub(super) fn undecided_by(warnings: &[Warning]) -> Option<OpenRules> {
    let open = || warnings.iter().filter(|warning| warning.leaves_open);
    // A rule may be violated at rest and again in the motion.
    let mut rules: Vec<&str> = Vec::new();
    for warning in open() {
        if !rules.contains(&warning.rule) {
            rules.push(warning.rule);
        }
    }
    let commands: Option<Vec<_>> = open().map(|warning| warning.decided_by).collect();
    (!rules.is_empty()).then(|| OpenRules {
        rules: rules.join(" and "),
        command: commands.and_then(|all| all.first().copied()),
        of_all_lines: open().all(Warning::is_of_all_lines),
    })
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
/// elastic lines are so many times stiffer than given.
fn verdict(
    prepared: &ModelAtRest,
    outcome: &Outcome,
    warnings: &[Warning],
    early: Option<Early>,
    stiffer: Option<f64>,
) -> Verdict {
    let elastic = stiffer.is_some();
    let structure = &prepared.structure;
    let parts = (1..).zip(outcome.utilisations(structure));
    let known: Vec<(usize, f64)> = parts.filter_map(|(line, u)| Some((line, u?))).collect();
    let worst = known.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let at_rest = breaking_at_rest(prepared, warnings);
    let broken = broken_lines(structure, outcome, elastic, &at_rest);
    let all_known = known.len() == outcome.lines.len();
    let open = undecided_by(warnings);
    let too_little = one_run_is_too_little(structure);
    let standing = if outcome.stop.exceeds() {
        VerdictKind::Exceeds
    } else if open.is_some() && at_rest.is_empty() {
        VerdictKind::Open
    } else if !broken.is_empty() {
        VerdictKind::Breaks
    } else if outcome.stop.cuts_short() || !all_known {
        VerdictKind::Unknown
    } else if early.as_ref().is_some_and(Early::breaks) || too_little.is_some() {
        VerdictKind::Open
    } else {
        VerdictKind::Holds
    };
    let (stretched, unloaded) = (1..=outcome.lines.len())
        .filter(|line| outcome.lines[line - 1].stays_slack())
        .partition(|line| prepared.rest.stretched_n(line - 1) > Some(0.0));
    let text = VerdictText {
        standing,
        outcome,
        end: end_text(outcome.stop),
        slack: goes_slack(outcome),
        unloaded,
        stretched,
        worst: worst.copied().unwrap_or_default(),
        broken,
        transient_s: structure.transient_s,
        waves: structure.has_waves(),
        early,
        open,
        unjudged: outcome.is_unjudged(),
        too_little,
        too_plastic: structure.restitution < LEAST_RESTITUTION,
        elastic,
        stiffer: stiffer.unwrap_or(1.0),
        stiffness_known: structure.tensions_known(),
    };
    Verdict {
        standing,
        words: paragraph(&text),
    }
}

/// The subject and the verb of a sentence about lines, by number from 1.
fn lines_are(lines: &[usize]) -> String {
    let numbers: Vec<String> = lines.iter().map(usize::to_string).collect();
    match &numbers[..] {
        [one] => format!("Line {one} is"),
        [one, other] => format!("Lines {one} and {other} are"),
        _ => format!("Lines {} are", numbers.join(", ")),
    }
}

/// Whether a line goes slack in the time that is judged, and in all. One that is never taut there
/// does not.
fn goes_slack(outcome: &Outcome) -> [bool; 2] {
    let judged = |line: &LineOutcome| line.least_n == Some(0.0) && !line.stays_slack();
    // The time in which it is slack is a sum of steps.
    let always_slack = |line: &LineOutcome| line.stays_slack() && line.slack_fraction > 1.0 - 1e-9;
    let in_all = |line: &LineOutcome| line.slack_fraction > 0.0 && !always_slack(line);
    [
        outcome.lines.iter().any(judged),
        outcome.lines.iter().any(in_all),
    ]
}

/// The lines that are known to break, which they do by tensions for which linear hydrostatics hold:
/// by number from 1, each with its utilisation and how; those that break at rest if there are any.
fn broken_lines(
    structure: &Structure,
    outcome: &Outcome,
    elastic: bool,
    at_rest: &[(usize, f64)],
) -> Vec<(usize, f64, &'static str)> {
    if !at_rest.is_empty() {
        let words = |(line, part): &(usize, f64)| (*line, *part, "at rest");
        return at_rest.iter().map(words).collect();
    }
    let breaks = |((number, line), known): ((usize, &LineOutcome), &LineSi)| {
        let reliable_n = outcome.reliable_n(line);
        let part = reliable_n? / known.breaking_load_n?;
        let how = match line.largest_n() > reliable_n {
            true if outcome.waterline.is_none() => "before the body comes out of the water",
            true => "while linear hydrostatics hold",
            false => how_it_breaks(line, elastic),
        };
        (part >= 1.0).then_some((number, part, how))
    };
    let lines = (1..).zip(&outcome.lines).zip(&structure.lines);
    lines.filter_map(breaks).collect()
}

/// How a line would break.
fn how_it_breaks(line: &LineOutcome, elastic: bool) -> &'static str {
    if elastic {
        "as an elastic line"
    } else if line.peak_n.is_some_and(|peak| peak >= line.largest_taut_n) {
        match line.counted() {
            0 => "in a slower snap",
            _ => "in a snap",
        }
    } else {
        "while taut"
    }
}

impl ElasticComparison {
    /// Whether elastic lines go slack, and whether one breaks.
    pub fn verdict(&self) -> Verdict {
        let (prepared, outcome) = (&self.elastic_case, &self.outcome);
        let structure = &prepared.structure;
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
        let (warnings, stiffer) = (self.warnings(), Some(self.stiffer));
        self.with_other_runs(verdict(prepared, outcome, &warnings, early, stiffer))
    }
}

impl Assessment {
    /// Whether the lines go slack, how hard they snap, and whether one breaks.
    pub fn verdict(&self) -> Verdict {
        let (structure, outcome) = (&self.prepared.structure, &self.outcome);
        let early = self.snaps.iter();
        let early = early.filter(|snap| snap.t_s < structure.transient_s);
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
        let alone = verdict(&self.prepared, outcome, &self.warnings, early, None);
        self.with_other_runs(alone)
    }
}

#[cfg(test)]
mod tests {
    use super::undecided_by;
    use crate::physics::warning::Warning;

    /// A rule that is violated at rest and again in the motion is named once.
    #[test]
    fn each_rule_is_named_once() {
        let violated = |rule| Warning {
            rule,
            message: String::new(),
            decided_by: None,
            leaves_open: true,
        };
        let all = ["hydrostatics", "few components", "hydrostatics"].map(violated);
        let rules = undecided_by(&all).map(|open| open.rules);
        assert_eq!(rules.as_deref(), Some("hydrostatics and few components"));
    }
}
