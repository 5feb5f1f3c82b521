//! The distribution of the largest load of a sea in three hours, or why none is given.

use super::outcome::{LineOutcome, Outcome};
use super::seas::Seas;
use crate::judged_time::ENOUGH;
use crate::runs::gumbel::Gumbel;
use crate::structure::{Structure, THREE_HOURS_S};
use snapload::Stop;
use std::fmt;

/// Why a single run in which no line breaks does not tell whether one does.
pub(crate) fn one_run_is_too_little(structure: &Structure) -> Option<NoDistribution> {
    match structure.judges_too_little() {
        true => Some(NoDistribution::PartOfAWave),
        false => (structure.one_run_is_too_little()).then_some(NoDistribution::TooFew(1)),
    }
}

/// Why no distribution of a largest value in three hours is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoDistribution {
    /// The body turns over or touches the floor in so many of the records.
    Exceeds(usize, usize),
    /// So many of the records ended after more snaps than allowed.
    CutShort(usize, usize, u64),
    /// Tensions of snaps are not known.
    TensionsUnknown,
    /// The motion is not stationary in the larger part of records that are shorter.
    NotStationary,
    /// The line, by number from 1, snaps in so many of the records only.
    LineSnapsInSome(usize, usize, usize),
    /// A line snaps in some of the records, and in so many of them none does.
    SomeWithoutSnaps(usize, usize),
    /// The same of snaps that are counted.
    SomeWithoutCountedSnaps(usize, usize),
    /// There are too few records.
    TooFew(usize),
    /// Less than one period of the waves is judged in each record.
    PartOfAWave,
    /// No snap is counted in any of the records.
    NoSnaps,
    /// The line, by number from 1, does not snap in the records, but it may go slack within three
    /// hours, and then snap.
    MaySnap(usize),
    /// The line, by number from 1, is slack at rest and does not snap in the records, but it may
    /// become taut within three hours, and then snap.
    MayBecomeTaut(usize),
    /// A record judges more than three hours, so that its largest value is that of a longer sea.
    TooLong,
    /// All records have the same largest value.
    AllEqual,
}

impl fmt::Display for NoDistribution {
    /// The end of a sentence that begins with "no distribution is given, as".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let longer = format!(
            "run records of three hours (run.duration, --seeds), of which {ENOUGH} need no distribution for a verdict"
        );
        match self {
            Self::Exceeds(count, of) => write!(
                f,
                "in {count} of {of} records the body turns over or touches the floor"
            ),
            Self::CutShort(count, of, snaps) => write!(
                f,
                "{count} of {of} records ended after more than run.max_snaps = {snaps} snaps, before their time"
            ),
            Self::TensionsUnknown => f.write_str(
                "tensions are not known: give each line type and diameter, or stiffness and mass_per_length",
            ),
            Self::SomeWithoutSnaps(count, of) => {
                write!(f, "in {count} of {of} records no line snaps: {longer}")
            }
            Self::SomeWithoutCountedSnaps(count, of) => write!(
                f,
                "in {count} of {of} records no line snaps at 1 cm/s or more: {longer}"
            ),
            Self::TooFew(1) => f.write_str("one record is too few: run more (--seeds)"),
            Self::TooFew(count) => write!(f, "{count} records are too few: run more (--seeds)"),
            Self::PartOfAWave => f.write_str(
                "less than one period of the waves is judged: run longer records (run.duration)",
            ),
            Self::NoSnaps => {
                f.write_str("no line snaps at 1 cm/s or more in any of the records")
            },
            Self::MaySnap(line) => write!(
                f,
                "line {line} does not snap at 1 cm/s or more in the records, but within three hours it may go slack and \
                 snap: {longer}"
            ),
            Self::MayBecomeTaut(line) => write!(
                f,
                "line {line}, which is slack at rest, does not snap at 1 cm/s or more in the records, but within \
                 three hours it may become taut and snap: {longer}"
            ),
            Self::NotStationary => f.write_str(
                "the motion grows for longer than the records last (see settling): run records of three hours \
                 (run.duration)",
            ),
            Self::LineSnapsInSome(line, count, of) => write!(
                f,
                "line {line} snaps at 1 cm/s or more in {count} of {of} records only: {longer}"
            ),
            Self::TooLong => f.write_str(
                "each record judges more than three hours, so that its largest value is that of a longer sea: \
                 records of three hours have one (run.duration)",
            ),
            Self::AllEqual => f.write_str("all records have the same largest value"),
        }
    }
}

impl Seas {
    /// The distribution of the largest tension in three hours \[N\].
    ///
    /// # Errors
    /// Why there is none.
    pub fn peak_in_three_hours(&self) -> Result<Gumbel, NoDistribution> {
        self.check_whole()?;
        let largest = self.largest_n().ok_or(NoDistribution::TensionsUnknown)?;
        self.check_beyond()?;
        self.check_stationary()?;
        self.check_length()?;
        self.fit(&known(&largest))
    }

    /// The same of the fastest snap \[m/s\].
    ///
    /// # Errors
    /// Why there is none.
    pub fn speed_in_three_hours(&self) -> Result<Gumbel, NoDistribution> {
        self.check_whole()?;
        let without = self.without_counted_snaps();
        self.check_snaps(without, NoDistribution::SomeWithoutCountedSnaps)?;
        if without == self.records.len() {
            return Err(NoDistribution::NoSnaps);
        }
        self.check_stationary()?;
        self.check_length()?;
        self.fit(&known(&self.speeds_m_s()))
    }

    /// The first line, by number from 1, that may break in three hours, with the distribution of
    /// its largest ratio of tension to breaking load: the value that 90 % stay below is not less
    /// than one with 97.7 % confidence ([`Gumbel::at_most`]).
    pub(crate) fn overload_in_three_hours(&self) -> Option<(usize, Gumbel)> {
        let structure = &self.prepared.structure;
        let utilisations = self
            .outcomes()
            .map(|outcome| outcome.utilisations(structure));
        let utilisations: Vec<_> = utilisations.collect();
        let overload = |line: usize| {
            let parts: Option<Vec<f64>> = utilisations.iter().map(|of| of[line]).collect();
            let fit = self.fit(&parts?).ok()?;
            may_reach_one(&fit, 0.9).then_some((line + 1, fit))
        };
        (0..structure.lines.len()).find_map(overload)
    }

    /// Records that ended early would be records of a shorter time.
    fn check_whole(&self) -> Result<(), NoDistribution> {
        let records = self.records.len();
        let exceeding = self.exceeding();
        if exceeding > 0 {
            return Err(NoDistribution::Exceeds(exceeding, records));
        }
        match self.ended(|stop| stop != Stop::EndTime) {
            0 => Ok(()),
            cut_short => {
                let most = self.prepared.structure.max_snaps;
                Err(NoDistribution::CutShort(cut_short, records, most))
            }
        }
    }

    /// A snap begins at twice the tension at rest. Records with snaps and without them therefore
    /// have two distributions, to which one fit is of no use. Records of less than a wave have the
    /// distribution of a part of a wave.
    fn check_snaps(
        &self,
        without: usize,
        some: fn(usize, usize) -> NoDistribution,
    ) -> Result<(), NoDistribution> {
        let records = self.records.len();
        if self.prepared.structure.judges_too_little() {
            return Err(NoDistribution::PartOfAWave);
        }
        if (1..records).contains(&without) {
            return Err(some(without, records));
        }
        if records < Gumbel::FEWEST {
            return Err(NoDistribution::TooFew(records));
        }
        Ok(())
    }

    /// The distribution of tensions without snaps ends where a line goes slack that has tension at
    /// rest, or becomes taut that has none. If no line snaps in the records, neither may happen
    /// within three hours.
    pub(crate) fn check_beyond(&self) -> Result<(), NoDistribution> {
        let without = self.without_snaps();
        self.check_snaps(without, NoDistribution::SomeWithoutSnaps)?;
        match without < self.records.len() {
            true => Ok(()),
            false => self.lines().try_for_each(|line| self.check_slack(line)),
        }
    }

    /// The same of every line by itself, as the snaps of one say nothing of those of another. Only
    /// those that are counted show how hard a line snaps: slower ones are its settling, also after
    /// the snap of another.
    pub(crate) fn check_lines(&self) -> Result<(), NoDistribution> {
        let records = self.records.len();
        self.lines().try_for_each(|line| {
            let snaps = |outcome: &&Outcome| outcome.lines[line].snaps > 0;
            match self.outcomes().filter(snaps).count() {
                0 => self.check_slack(line),
                some if some < records => {
                    Err(NoDistribution::LineSnapsInSome(line + 1, some, records))
                }
                _ => Ok(()),
            }
        })
    }

    /// A line that does not snap in the records may not do so within three hours either.
    fn check_slack(&self, line: usize) -> Result<(), NoDistribution> {
        let rest_n = self.prepared.rest.inextensible_tensions_n()[line];
        let lost = |line: &LineOutcome| {
            let least_n = line.least_n.filter(|_| rest_n > 0.0)?;
            Some(1.0 - least_n / rest_n)
        };
        if self.part_may_reach_one(line, lost) {
            return Err(NoDistribution::MaySnap(line + 1));
        }
        match self.part_may_reach_one(line, |line| line.slack_used) {
            true => Err(NoDistribution::MayBecomeTaut(line + 1)),
            false => Ok(()),
        }
    }

    /// Whether the largest part that a line loses or uses up in a record may reach one within three
    /// hours, in more than one of a hundred seas.
    fn part_may_reach_one(&self, line: usize, part: impl Fn(&LineOutcome) -> Option<f64>) -> bool {
        let parts = self.outcomes().map(|outcome| part(&outcome.lines[line]));
        let parts: Vec<f64> = parts.map(|part| part.unwrap_or(0.0)).collect();
        match self.fit(&parts) {
            Ok(fit) => may_reach_one(&fit, 0.99),
            Err(_) => parts.iter().any(|part| *part >= 1.0),
        }
    }

    fn lines(&self) -> std::ops::Range<usize> {
        0..self.prepared.structure.lines.len()
    }

    /// Records of less than three hours have the distribution of a longer sea only if the motion is
    /// stationary in their larger part.
    pub(crate) fn check_stationary(&self) -> Result<(), NoDistribution> {
        let structure = &self.prepared.structure;
        let is_short = structure.has_waves() && !structure.judges_three_hours();
        match is_short && 2.0 * self.stationary_s() < structure.judged_s() {
            true => Err(NoDistribution::NotStationary),
            false => Ok(()),
        }
    }

    /// The largest value of a record of more than three hours is not less than that of three, which
    /// is enough for a verdict. How much less is not known, as its largest values alone do not tell
    /// whether there is a snap in each three hours.
    pub(crate) fn check_length(&self) -> Result<(), NoDistribution> {
        match self.prepared.structure.judges_more() {
            true => Err(NoDistribution::TooLong),
            false => Ok(()),
        }
    }

    /// The part of the judged time of a record in which the motion is stationary \[s\].
    fn stationary_s(&self) -> f64 {
        let settling = self.settling.as_ref();
        settling.map_or(self.prepared.structure.judged_s(), |settling| {
            settling.stationary_s(&self.prepared)
        })
    }

    /// Whether the records judge enough of a sea to tell without a distribution that no line
    /// breaks.
    pub(crate) fn judge_enough(&self) -> bool {
        let structure = &self.prepared.structure;
        structure.judges_enough(self.records.len()) && self.check_stationary().is_ok()
    }

    /// The largest of three hours from that of a record. Of a shorter record only the stationary
    /// part counts, and of a longer one all counts as three hours, both on the safe side.
    fn fit(&self, largest: &[f64]) -> Result<Gumbel, NoDistribution> {
        let (structure, stationary_s) = (&self.prepared.structure, self.stationary_s());
        let judged_s = structure.judged_s();
        let fit = Gumbel::fit(largest).ok_or(NoDistribution::AllEqual)?;
        let counts = !structure.judges_three_hours() && 2.0 * stationary_s >= judged_s;
        let counted_s = if counts { stationary_s } else { judged_s };
        Ok(fit.over_times((THREE_HOURS_S / counted_s).max(1.0)))
    }
}

/// Whether the value that a part of all stay below is not less than one with 97.7 % confidence.
fn may_reach_one(fit: &Gumbel, part: f64) -> bool {
    fit.at_most(part) >= 1.0
}

/// The values of the judged records.
fn known(values: &[Option<f64>]) -> Vec<f64> {
    values.iter().copied().flatten().collect()
}
