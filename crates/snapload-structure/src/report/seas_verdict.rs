//! The verdict on many records of a sea, in words.

use super::verdict::{OpenRules, VerdictKind, breaking_at_rest, undecided_by};
use crate::judged_time::ENOUGH;
use crate::physics::elastic::LEAST_RESTITUTION;
use crate::runs::gumbel::Gumbel;
use crate::runs::outcome::Outcome;
use crate::runs::quantile::{quantile, sorted};
use crate::runs::seas::{Failing, Seas};
use crate::runs::three_hours::NoDistribution;
use crate::text_layout::{digits, paragraph, ratio, tenths};
use askama::Template;
use snapload::Stop;
use snapload::analysis::Share;

/// Why records in which no line breaks do not tell whether one does in three hours.
enum TooShort {
    /// Less than one period of the waves is judged.
    PartOfAWave,
    /// Lines may snap that do not in the records, or there are too few.
    NoFit(NoDistribution),
    /// The distribution of the largest ratio of tension to breaking load of a line, which may reach
    /// one.
    Overload(usize, Gumbel),
}

#[derive(Template)]
#[template(path = "seas-words.txt")]
struct SeasVerdictText {
    /// The number of records in which a line would break only in the time that is not judged.
    early: usize,
    transient_s: f64,
    fit: Result<Gumbel, NoDistribution>,
    records: usize,
    length_s: f64,
    fastest_m_s: f64,
    median_m_s: f64,
    failing: Failing,
    /// Whether the distribution is of tensions as computed, which are not reliable on any lines.
    as_computed: bool,
    probability: Option<Share>,
    /// Of the records of which it is not known whether they fail, the number that ended early.
    cut_short: usize,
    /// Whether it is not known of some of them for a lack of a tension or a breaking load.
    lacking: bool,
    /// The violated rules that leave the verdict open.
    open: Option<OpenRules>,
    /// The lines that break at rest all the same, each with its ratio of tension to breaking load.
    at_rest: Vec<(usize, f64)>,
    /// Whether the restitution is too small for elastic lines.
    too_plastic: bool,
    /// What leaves it open for three hours.
    too_short: Option<TooShort>,
    /// Whether it is firm in waves, and if so, whether by distributions and not by the number of
    /// records.
    by_distributions: Option<bool>,
    /// Whether a record judges more than three hours.
    judges_more: bool,
    standing: VerdictKind,
}

impl Seas {
    /// Whether a rule is violated on which tensions depend.
    pub fn is_open(&self) -> bool {
        undecided_by(&self.warnings).is_some()
    }

    fn breaking_at_rest(&self) -> Vec<(usize, f64)> {
        breaking_at_rest(&self.prepared, &self.warnings)
    }

    /// The judged records and time, as a part of a sentence.
    pub(crate) fn judged_text(&self) -> String {
        let from = tenths(&self.prepared.structure.transient_s);
        match (self.records.len(), self.unjudged()) {
            (1, _) => format!("in the one record from {from} s on"),
            (count, 0) => format!("in all {count} records from {from} s on"),
            (count, unjudged) => format!(
                "in the {} of {count} records that last longer than {from} s, from then on",
                count - unjudged
            ),
        }
    }

    /// The kind of verdict.
    pub fn standing(&self) -> VerdictKind {
        let failing = self.failing();
        if !self.breaking_at_rest().is_empty() {
            VerdictKind::Breaks
        } else if self.is_open() {
            VerdictKind::Open
        } else if failing.count > 0 {
            VerdictKind::Breaks
        } else if failing.unknown > 0 {
            VerdictKind::Unknown
        } else if self.breaking_only_early() > 0 || self.too_short().is_some() {
            VerdictKind::Open
        } else {
            VerdictKind::Holds
        }
    }

    /// Why records, however long, do not tell whether a line breaks in three hours: what their
    /// distribution says is never contradicted, and without one only the judged time counts.
    /// Whether lines may snap can be known without their tensions. Where no line may break in more
    /// than three hours, none may in three.
    fn too_short(&self) -> Option<TooShort> {
        let structure = &self.prepared.structure;
        if structure.judges_too_little() {
            return Some(TooShort::PartOfAWave);
        }
        match self.check_extrapolation() {
            Err(_) if self.judge_enough() => None,
            Err(reason) => Some(TooShort::NoFit(reason)),
            Ok(()) => {
                let (line, fit) = self.overload_in_three_hours()?;
                Some(match self.check_length() {
                    Ok(()) => TooShort::Overload(line, fit),
                    Err(reason) => TooShort::NoFit(reason),
                })
            }
        }
    }

    /// The answer in a sentence or two.
    pub fn words(&self) -> String {
        let speeds = sorted(self.speeds_m_s().into_iter().flatten());
        let structure = &self.prepared.structure;
        let standing = self.standing();
        let unknown = || self.outcomes().filter(|one| one.lacks_an_answer(structure));
        let open = undecided_by(&self.warnings);
        let beyond = || self.outcomes().any(Outcome::exceeds_hydrostatics);
        paragraph(&SeasVerdictText {
            early: self.breaking_only_early(),
            transient_s: structure.transient_s,
            fit: self.peak_in_three_hours(),
            records: self.records.len(),
            length_s: structure.duration_s,
            fastest_m_s: speeds.last().copied().unwrap_or(0.0),
            median_m_s: quantile(&speeds, 0.5).unwrap_or(0.0),
            failing: self.failing(),
            probability: self.probability(),
            cut_short: unknown().filter(|one| one.stop != Stop::EndTime).count(),
            lacking: unknown().any(|one| one.lacks_a_load(structure)),
            as_computed: open.as_ref().map_or_else(beyond, |open| open.of_all_lines),
            open,
            at_rest: self.breaking_at_rest(),
            too_plastic: structure.restitution < LEAST_RESTITUTION,
            too_short: self.too_short().filter(|_| standing == VerdictKind::Open),
            by_distributions: (standing == VerdictKind::Holds && structure.has_waves())
                .then(|| self.check_extrapolation().is_ok()),
            judges_more: structure.judges_more(),
            standing,
        })
    }

    /// Whether the records of every line have one distribution, which is that of longer ones, too.
    fn check_extrapolation(&self) -> Result<(), NoDistribution> {
        self.check_beyond()?;
        self.check_lines()?;
        self.check_stationary()
    }
}
