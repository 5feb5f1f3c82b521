//! Many records of one sea: the distribution of the lines' loads in it.

use super::design::{Check, RecordsCheck, checks, record_checks};
use super::outcome::Outcome;
use super::quantile::sorted;
use crate::options::{SEEDS, check};
use crate::physics::elastic::elastic_lines;
use crate::physics::emergence::Emergence;
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::sea_records::short_records;
use crate::physics::settling::Settling;
use crate::physics::warning::Warning;
use crate::physics::warnings::{limits_afloat, phase_warning, turning_warning, warnings};
use crate::schema::LAST_SEED;
use crate::structure::{IrregularSea, Structure, THREE_HOURS_S, Water};
use serde::Serialize;
use snapload::analysis::{Counter, OnProgress, Share, Unfinished, in_parallel};
use snapload::{CaseError, Stop};

/// The outcome of one record.
#[derive(Clone, Debug, PartialEq)]
pub struct SeaOutcome {
    /// Its seed.
    pub seed: u64,
    /// The rest.
    pub outcome: Outcome,
    /// The checks by the rule of the case.
    pub checks: Vec<Check>,
}

/// The outcomes of many records.
#[derive(Clone, Debug)]
pub struct Seas {
    /// The structure, with the first seed, about its position of rest on these lines.
    pub prepared: ModelAtRest,
    /// Rules of thumb that the case violates.
    pub warnings: Vec<Warning>,
    /// The model of the lines.
    pub lines: Lines,
    /// The outcomes in the order of the seeds.
    pub records: Vec<SeaOutcome>,
    /// The motion that becomes stationary last, if the waves have the period of any.
    pub(crate) settling: Option<Settling>,
}

/// The numbers of records that fail, and of which that is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Failing {
    /// A line's breaking load is reached, or the body turns over or touches the floor.
    pub count: usize,
    /// They ended early, or a tension or a breaking load is not known.
    pub unknown: usize,
    /// It depends on tensions of a floating body for which linear hydrostatics do not hold.
    pub unreliable: usize,
}

/// The model of the lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Lines {
    /// Inextensible lines, which snap.
    Inextensible,
    /// Elastic lines, as springs.
    Elastic,
}

/// Runs a structure in `count` records of its sea, with the seed of the case and the following
/// ones.
///
/// # Errors
/// A [`CaseError`] unless the count is of [`SEEDS`], if the case has no sea or too few seeds follow
/// its own, the structure rests nowhere, or elastic lines have no stiffness, and
/// [`Unfinished::Cancelled`].
pub fn seas(
    structure: Structure,
    count: u32,
    lines: Lines,
    on_progress: OnProgress,
) -> Result<Seas, Unfinished> {
    check(&SEEDS, i64::from(count))?;
    let Water::Sea(sea) = structure.water else {
        let allowed = "an irregular sea, to draw records from";
        let error = CaseError::value("[sea]", "(left out)", allowed).with_hint(
            "write [sea] with hs and tp in place of [wave]; one regular wave is for snapload assess",
        );
        return Err(error.into());
    };
    let further = u64::from(count) - 1;
    if sea.seed + further > LAST_SEED {
        let allowed = format!("at most {} for {count} records", LAST_SEED - further);
        return Err(CaseError::value("sea.seed", sea.seed, allowed).into());
    }
    let prepared = match lines {
        Lines::Inextensible => ModelAtRest::new(structure)?,
        Lines::Elastic => ModelAtRest::for_elastic_lines(structure)?,
    };
    // For elastic lines, the position of rest on them is reported.
    let reported = match lines {
        Lines::Inextensible => prepared.clone(),
        Lines::Elastic => prepared.with_elastic_lines(&elastic_lines(&prepared, 1.0)?)?,
    };
    let mut warnings = warnings(&reported);
    // Rules that are decided by elastic lines do not apply to them.
    warnings.retain(|warning| lines == Lines::Inextensible || warning.is_of_all_lines());
    let open = warnings.iter().any(|warning| warning.leaves_open);
    let records = run_records(&prepared, (sea, count), lines, open, on_progress)?;
    warnings.extend(warnings_of_records(&reported, &records));
    let settling = Settling::of(&reported, lines == Lines::Elastic);
    warnings.extend(
        settling
            .as_ref()
            .and_then(|settling| settling.warning(&reported)),
    );
    Ok(Seas {
        settling,
        records,
        lines,
        warnings,
        prepared: reported,
    })
}

/// Runs the records side by side; `open` says that a rule is violated on which tensions depend.
fn run_records(
    prepared: &ModelAtRest,
    (sea, count): (IrregularSea, u32),
    lines: Lines,
    open: bool,
    on_progress: OnProgress,
) -> Result<Vec<SeaOutcome>, Unfinished> {
    let counter = Counter::new("records", 0, count.into(), on_progress);
    in_parallel(count as usize, |index| {
        let seed = sea.seed + index as u64;
        let record = prepared.in_water(Water::Sea(IrregularSea { seed, ..sea }))?;
        let (record, outcome) = counter.part(|within| match lines {
            Lines::Inextensible => {
                let outcome = Outcome::of(&record, 1.0, within)?;
                Ok::<_, Unfinished>((record, outcome))
            }
            Lines::Elastic => Outcome::with_elastic_lines(&record, within),
        })?;
        let open = open || outcome.depends_on_hydrostatics(&record.structure);
        let checks = match count {
            1 => checks(&record, &outcome, open),
            _ => record_checks(&record, &outcome, open),
        };
        Ok(SeaOutcome {
            checks,
            seed,
            outcome,
        })
    })
}

/// The warnings that follow from the motion in all records.
fn warnings_of_records(reported: &ModelAtRest, records: &[SeaOutcome]) -> Vec<Warning> {
    let structure = &reported.structure;
    let outcomes = || records.iter().map(|record| &record.outcome);
    let most = |of: fn(&Outcome) -> f64| outcomes().map(of).fold(0.0, f64::max);
    let turned = most(|outcome| outcome.turned_rad);
    let excursion = most(|outcome| outcome.excursion_m);
    let seen = outcomes().filter_map(|outcome| outcome.waterline);
    let seen = seen.reduce(|all, one| all.with(&one));
    let emergences = outcomes().map(|outcome| outcome.emergence);
    let emergence = emergences.fold(Emergence::default(), Emergence::with);
    // A record in which a line breaks while linear hydrostatics hold
    // decides, whatever the others do.
    let depends = |outcome: &Outcome| outcome.depends_on_hydrostatics(structure);
    let firm = outcomes().any(|one| !depends(one) && one.fails(structure) == Some(true));
    let depends = !firm && outcomes().any(depends);
    let found = short_records(structure).into_iter();
    found
        .chain(phase_warning(
            structure,
            reported.rest.place_m[1],
            excursion,
        ))
        .chain(turning_warning(structure, turned))
        .chain(limits_afloat(structure, seen.as_ref(), turned, depends))
        .chain(emergence.warning(depends))
        .collect()
}

impl Seas {
    /// The checks by the rule of the case, over all records.
    pub fn checks(&self) -> Vec<RecordsCheck> {
        let records: Vec<&[Check]> = self.records.iter().map(|r| &r.checks[..]).collect();
        RecordsCheck::of_records(&records)
    }

    /// The outcome of every record.
    pub(crate) fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        self.records.iter().map(|record| &record.outcome)
    }

    /// The largest tension of each record, in a snap or while taut, and none for one that ended
    /// before the judged time; none at all if tensions of snaps are not known \[N\].
    pub fn largest_n(&self) -> Option<Vec<Option<f64>>> {
        let known = self.prepared.structure.tensions_known();
        known.then(|| self.of_judged(Outcome::largest_n))
    }

    /// The fastest snap of each record; none for one that ended before the judged time \[m/s\].
    pub fn speeds_m_s(&self) -> Vec<Option<f64>> {
        self.of_judged(Outcome::speed_m_s)
    }

    fn of_judged(&self, value: fn(&Outcome) -> f64) -> Vec<Option<f64>> {
        let of = |one: &Outcome| (!one.is_unjudged()).then(|| value(one));
        self.outcomes().map(of).collect()
    }

    /// The number of records that ended before the judged time.
    pub(crate) fn unjudged(&self) -> usize {
        self.outcomes().filter(|one| one.is_unjudged()).count()
    }

    /// The number of judged records in which no line snaps, however slowly.
    pub(crate) fn without_snaps(&self) -> usize {
        let judged = self.outcomes().filter(|one| !one.is_unjudged());
        judged.filter(|one| !one.has_snaps()).count()
    }

    /// The number of those in which none is counted.
    pub(crate) fn without_counted_snaps(&self) -> usize {
        let speeds = self.speeds_m_s();
        speeds.iter().filter(|speed| **speed == Some(0.0)).count()
    }

    /// The number of records that ended in one of some ways.
    pub(crate) fn ended(&self, how: impl Fn(Stop) -> bool) -> usize {
        self.outcomes().filter(|one| how(one.stop)).count()
    }

    /// Records in which the body turned over or touched the floor.
    pub(crate) fn exceeding(&self) -> usize {
        self.ended(Stop::exceeds)
    }

    /// The records in which a line's breaking load is reached, or the body turns over or touches
    /// the floor, and those of which that is not known.
    pub fn failing(&self) -> Failing {
        let structure = &self.prepared.structure;
        let mut failing = Failing::default();
        for outcome in self.outcomes() {
            match outcome.fails(structure) {
                Some(fails) => failing.count += usize::from(fails),
                None if outcome.lacks_an_answer(structure) => failing.unknown += 1,
                None => failing.unreliable += 1,
            }
        }
        failing
    }

    /// The share of records that fail; none if that is not known of all, or a rule is violated on
    /// which tensions depend.
    pub fn probability(&self) -> Option<Share> {
        let failing = self.failing();
        let known = failing.unknown + failing.unreliable == 0;
        (known && !self.is_open()).then_some(Share {
            count: failing.count,
            of: self.records.len(),
            clear: false,
        })
    }

    /// The number of records in which a line would break before the judged time, and which do not
    /// fail after that.
    pub fn breaking_only_early(&self) -> usize {
        let structure = &self.prepared.structure;
        self.outcomes()
            .filter(|outcome| outcome.breaks_early(structure))
            .filter(|outcome| outcome.fails(structure) != Some(true))
            .count()
    }

    /// Part of the time that each line is slack, the mean over records.
    pub fn slack_fractions(&self) -> Vec<f64> {
        let records = self.records.len().max(1) as f64;
        let slack = |line: usize| {
            let all = self
                .outcomes()
                .map(|outcome| outcome.lines[line].slack_fraction);
            all.sum::<f64>() / records
        };
        (0..self.prepared.structure.lines.len())
            .map(slack)
            .collect()
    }

    /// The largest tension of each line in all judged records, in a snap or while taut; none if
    /// that is not known of one of them, or nothing is judged \[N\].
    pub fn largest_of_lines_n(&self) -> Vec<Option<f64>> {
        let largest = |line: usize| {
            let judged = self.outcomes().filter(|one| !one.is_unjudged());
            let of_records = judged.map(|outcome| outcome.lines[line].largest_n());
            let known: Option<Vec<f64>> = of_records.collect();
            known?.into_iter().reduce(f64::max)
        };
        let lines = 0..self.prepared.structure.lines.len();
        lines.map(largest).collect()
    }

    /// Snaps of all lines in three hours, the mean over records.
    pub fn snaps_in_three_hours(&self) -> f64 {
        let snaps: u64 = self.outcomes().map(Outcome::snaps).sum();
        snaps as f64 * THREE_HOURS_S / self.judged_s().max(f64::MIN_POSITIVE)
    }

    /// The judged time of all records together \[s\].
    pub fn judged_s(&self) -> f64 {
        let transient = self.prepared.structure.transient_s;
        self.outcomes()
            .map(|outcome| (outcome.end_s - transient).max(0.0))
            .sum()
    }

    /// Speeds of all snaps, sorted \[m/s\].
    pub fn all_speeds_m_s(&self) -> Vec<f64> {
        sorted(
            self.outcomes()
                .flat_map(|outcome| outcome.speeds_m_s.iter().copied()),
        )
    }

    /// Whether the crests of all waves of tension are known, those in snaps too.
    pub(crate) fn crests_known(&self) -> bool {
        let judged = |outcome: &&Outcome| !outcome.is_unjudged();
        self.outcomes()
            .filter(judged)
            .all(|outcome| outcome.known_largest_n().is_some())
    }

    /// Crests and troughs of all waves of tension, each sorted \[N\].
    pub fn crests_and_troughs_n(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|k| {
            sorted(
                self.outcomes()
                    .flat_map(|outcome| &outcome.waves_n)
                    .map(|wave| wave[k]),
            )
        })
    }

    /// Tensions of all snaps, sorted \[N\].
    pub fn all_peaks_n(&self) -> Vec<f64> {
        sorted(
            self.outcomes()
                .flat_map(|outcome| outcome.peaks_n.iter().copied()),
        )
    }
}
