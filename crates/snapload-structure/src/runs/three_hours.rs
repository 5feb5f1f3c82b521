//! The distribution of the largest load of a sea in three hours, or why none is given.

use super::outcome::{LineOutcome, Outcome};
use super::seas::Seas;
use crate::physics::gumbel::Gumbel;
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
    /// No line snaps in the records, but one may go slack within three hours, and then snap.
    MaySnap,
    /// No line snaps in the records, but one that is slack at rest may become taut within three
    /// hours, and then snap.
    MayBecomeTaut,
    /// All records have the same largest value.
    AllEqual,
}

impl fmt::Display for NoDistribution {
    /// The end of a sentence that begins with "no distribution is given, as".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let longer = "run longer records (run.duration)";
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
            Self::PartOfAWave => write!(f, "less than one period of the waves is judged: {longer}"),
            Self::NoSnaps => {
                f.write_str("no line snaps at 1 cm/s or more in any of the records")
            },
            Self::MaySnap => write!(
                f,
                "no line snaps in the records, but within three hours one may go slack and snap: {longer}"
            ),
            Self::MayBecomeTaut => write!(
                f,
                "no line snaps in the records, but within three hours one that is slack at rest may become taut and \
                 snap: {longer}"
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
        self.fit(&known(&self.speeds_m_s()))
    }

    /// The distribution of the largest ratio of a tension to the breaking load of its line in three
    /// hours, if that may reach one: the value that 90 % stay below is not less than one with
    /// 97.7 % confidence ([`Gumbel::at_most`]). Each line is compared with its own breaking load.
    pub(crate) fn overload_in_three_hours(&self) -> Option<Gumbel> {
        let structure = &self.prepared.structure;
        let of_record = |outcome: &Outcome| {
            let known: Option<Vec<f64>> = outcome.utilisations(structure).into_iter().collect();
            known?.into_iter().reduce(f64::max)
        };
        let largest: Option<Vec<f64>> = self.outcomes().map(of_record).collect();
        let fit = self.fit(&largest?).ok()?;
        may_reach_one(&fit, 0.9).then_some(fit)
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
        if without < self.records.len() {
            return Ok(());
        }
        let rest_n = self.prepared.rest.inextensible_tensions_n();
        let lost = |index: usize, line: &LineOutcome| {
            let least_n = line.least_n.filter(|_| rest_n[index] > 0.0)?;
            Some(1.0 - least_n / rest_n[index])
        };
        if self.part_may_reach_one(lost) {
            return Err(NoDistribution::MaySnap);
        }
        match self.part_may_reach_one(|_, line| line.slack_used) {
            true => Err(NoDistribution::MayBecomeTaut),
            false => Ok(()),
        }
    }

    /// Whether the largest part that a line of a record loses or uses up may reach one within three
    /// hours, in more than one of a hundred seas.
    fn part_may_reach_one(&self, part: impl Fn(usize, &LineOutcome) -> Option<f64>) -> bool {
        let of_record = |outcome: &Outcome| {
            let lines = outcome.lines.iter().enumerate();
            let parts = lines.filter_map(|(index, line)| part(index, line));
            parts.fold(0.0, f64::max)
        };
        let parts: Vec<f64> = self.outcomes().map(of_record).collect();
        match self.fit(&parts) {
            Ok(fit) => may_reach_one(&fit, 0.99),
            Err(_) => parts.iter().any(|part| *part >= 1.0),
        }
    }

    fn fit(&self, largest: &[f64]) -> Result<Gumbel, NoDistribution> {
        let judged_s = self.prepared.structure.judged_s();
        let fit = Gumbel::fit(largest).ok_or(NoDistribution::AllEqual)?;
        Ok(fit.over_times(THREE_HOURS_S / judged_s))
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
