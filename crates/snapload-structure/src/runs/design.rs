//! Checks by the user's design rule.
//!
//! ```text
//! strength:          (γ_pret T_0 + γ_env (T_max − T_0))/S_C ≤ 1,    S_C = strength_factor × breaking load
//! no slack:          T_min/T_0 > least_share
//! factored least:    γ₁ T_0 + γ₂ (T_min − T_0) > 0
//! wave force:        max |f_z|/F ≤ force_share
//! ```
//!
//! T_0 is a line's tension at rest, T_max the larger of its largest tension while taut and the peak
//! of its snaps, T_min its least tension, 0 if it goes slack; f_z is the vertical force of the
//! waves on the body at rest and F its net buoyancy. The forms are those of DNV-OS-E301 (position
//! mooring), of DNV-ST-0119 (tension legs of floating wind turbines) and of DNV-RP-N103 (slings);
//! the factors are the user's, as editions and classes differ.

use super::outcome::Outcome;
use super::quantile::{quantile, sorted};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::sea_records::few_components;
use crate::structure::{Structure, Water};
use serde::Serialize;
use snapload::{Harmonic, Stop};

/// The criterion of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// The factored tension divided by the characteristic strength.
    Strength,
    /// The least tension divided by that at rest.
    NoSlack,
    /// The least tension, with factors, divided by the tension at rest.
    FactoredLeast,
    /// The vertical force of the waves divided by the net buoyancy.
    WaveForce,
}

impl Criterion {
    /// The words that are shown.
    pub fn words(self) -> &'static str {
        match self {
            Self::Strength => "factored tension over strength, at most",
            Self::NoSlack => "least tension over tension at rest, above",
            Self::FactoredLeast => "factored least tension over tension at rest, above",
            Self::WaveForce => "vertical wave force over net buoyancy, at most",
        }
    }

    fn passes(self, value: f64, limit: f64) -> bool {
        match self {
            Self::Strength | Self::WaveForce => value <= limit,
            Self::NoSlack | Self::FactoredLeast => value > limit,
        }
    }
}

/// The result of a check, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// It passes.
    Passes,
    /// It passes up to the end of a run that ended early, after which it might fail.
    #[serde(rename = "unknown")]
    Unfinished,
    /// A tension, a strength or a force is not known, or there is no judged time, or
    /// too little for a check to pass.
    Unknown,
    /// A rule of thumb is violated on which the tensions depend.
    Open,
    /// It fails.
    Fails,
}

impl Answer {
    /// The words that are shown.
    pub fn words(self) -> &'static str {
        match self {
            Self::Passes => "passes",
            Self::Fails => "fails",
            Self::Open => "open",
            Self::Unknown => "not known",
            Self::Unfinished => "not known, as the run ended early",
        }
    }

    /// The class of its colour on a page.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Passes => "holds",
            Self::Fails => "fails",
            Self::Open | Self::Unknown | Self::Unfinished => "open",
        }
    }
}

/// One criterion of one line, or of the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// The criterion.
    pub criterion: Criterion,
    /// The line, by number from 1; none for the body.
    pub line: Option<usize>,
    /// The value that is compared with the limit.
    pub value: Option<f64>,
    /// The limit.
    pub limit: f64,
    /// The result.
    pub answer: Answer,
}

impl Check {
    /// The check of a value; `open` says that the value is not reliable.
    fn new(
        criterion: Criterion,
        line: Option<usize>,
        value: Option<f64>,
        limit: f64,
        open: bool,
    ) -> Self {
        let answer = match value {
            None => Answer::Unknown,
            Some(_) if open => Answer::Open,
            Some(value) if criterion.passes(value, limit) => Answer::Passes,
            Some(_) => Answer::Fails,
        };
        Self {
            criterion,
            line,
            value,
            limit,
            answer,
        }
    }

    /// The same of a run that ended so, of which enough may be judged or not.
    fn within(mut self, stop: Stop, too_little: bool) -> Self {
        if self.answer == Answer::Passes {
            self.answer = match stop {
                Stop::EndTime if too_little => Answer::Unknown,
                Stop::EndTime => Answer::Passes,
                _ => Answer::Unfinished,
            };
        }
        self
    }
}

/// The checks of the lines and of the waves' force, from the outcome of a run that stands alone: one
/// record of a sea passes none.
pub(crate) fn checks(prepared: &ModelAtRest, outcome: &Outcome, open: bool) -> Vec<Check> {
    let too_little = prepared.structure.one_run_is_too_little();
    all_checks(prepared, outcome, open, too_little)
}

/// The same of one record of several.
pub(crate) fn record_checks(prepared: &ModelAtRest, outcome: &Outcome, open: bool) -> Vec<Check> {
    let too_little = prepared.structure.judges_too_little();
    all_checks(prepared, outcome, open, too_little)
}

fn all_checks(
    prepared: &ModelAtRest,
    outcome: &Outcome,
    open: bool,
    too_little: bool,
) -> Vec<Check> {
    let lines = line_checks(prepared, outcome, open, too_little).into_iter();
    lines.chain(force_check(prepared, too_little)).collect()
}

/// One criterion over many records.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordsCheck {
    /// The check of the record with the worst result, and among those with the worst value.
    #[serde(flatten)]
    pub worst: Check,
    /// The median of its values over all records.
    pub median: Option<f64>,
    /// The number of records in which it passes.
    pub passing: usize,
    /// The number of records of which it is not known whether it passes.
    #[serde(skip)]
    unknown: usize,
    /// The number of all records.
    pub of: usize,
}

impl RecordsCheck {
    /// The checks of many records, each of which has the same ones.
    pub(crate) fn of_records(records: &[&[Check]]) -> Vec<Self> {
        let count = records.first().map_or(0, |checks| checks.len());
        (0..count).map(|index| Self::of(records, index)).collect()
    }

    /// The words that are shown.
    pub(crate) fn words(&self) -> String {
        let Self {
            passing,
            unknown,
            of,
            ..
        } = self;
        match self.worst.answer {
            Answer::Open => self.worst.answer.words().to_owned(),
            _ if unknown == of => self.worst.answer.words().to_owned(),
            _ if *unknown > 0 => {
                format!("passes in {passing} of {of} records, not known in {unknown}")
            }
            _ => format!("passes in {passing} of {of} records"),
        }
    }

    fn of(records: &[&[Check]], index: usize) -> Self {
        let all = || records.iter().map(|checks| &checks[index]);
        let mut worst = records[0][index].clone();
        let high = matches!(worst.criterion, Criterion::Strength | Criterion::WaveForce);
        for check in all() {
            let is_worse = match (worst.value, check.value) {
                (Some(before), Some(now)) if high => now > before,
                (Some(before), Some(now)) => now < before,
                _ => false,
            };
            if check.answer > worst.answer || check.answer == worst.answer && is_worse {
                worst = check.clone();
            }
        }
        let known: Option<Vec<f64>> = all().map(|check| check.value).collect();
        let count = |answers: &[Answer]| all().filter(|c| answers.contains(&c.answer)).count();
        Self {
            worst,
            unknown: count(&[Answer::Unknown, Answer::Unfinished]),
            median: known.and_then(|known| quantile(&sorted(known.into_iter()), 0.5)),
            passing: count(&[Answer::Passes]),
            of: records.len(),
        }
    }
}

/// The checks of the lines from the outcome of a run; `open` says that its tensions are not
/// reliable, and `too_little` that no check passes by them.
fn line_checks(
    prepared: &ModelAtRest,
    outcome: &Outcome,
    open: bool,
    too_little: bool,
) -> Vec<Check> {
    let structure = &prepared.structure;
    let rule = structure.design;
    let of_line = |line: usize| {
        let tensions = Tensions::new(prepared, outcome, line);
        let load_n = structure.lines[line].breaking_load_n;
        let check = |criterion, value, limit| {
            let check = Check::new(criterion, Some(line + 1), value, limit, open);
            check.within(outcome.stop, too_little)
        };
        let least = tensions.least_part();
        let strength = rule.strength.map(|factors| {
            check(
                Criterion::Strength,
                tensions.over_strength(factors, load_n),
                1.0,
            )
        });
        let slack = rule
            .least_share
            .map(|share| check(Criterion::NoSlack, least, share));
        let factored = rule.least_factors.map(|[rest, dynamic]| {
            let value = least.map(|part| rest + dynamic * (part - 1.0));
            check(Criterion::FactoredLeast, value, 0.0)
        });
        [strength, slack, factored]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
    };
    (0..structure.lines.len()).flat_map(of_line).collect()
}

/// The check of the waves' force on the body, if a rule asks for it and there are waves. In a sea
/// it does not pass by too little of it; the force of a regular wave is the same in each period.
fn force_check(prepared: &ModelAtRest, too_little: bool) -> Option<Check> {
    let structure = &prepared.structure;
    let share = structure.design.force_share?;
    let value = wave_force_part(prepared);
    // On lines that stretch considerably the body rests higher, where the waves are larger. A sea
    // of few sinusoids has too few high waves: what exceeds the share in it does so in any.
    let too_low = few_components(structure).is_some() && value.is_none_or(|part| part <= share);
    let open = prepared.rest.by_stiffness.is_some() || too_low;
    let check = Check::new(Criterion::WaveForce, None, value, share, open);
    let is_sea = matches!(structure.water, Water::Sea(_));
    // The force is that on the body at rest, whatever ended the run.
    Some(check.within(Stop::EndTime, is_sea && too_little))
}

/// The tensions of one line.
struct Tensions {
    /// None where no place of rest is known.
    rest_n: Option<f64>,
    largest_n: Option<f64>,
    least_n: Option<f64>,
}

impl Tensions {
    fn new(prepared: &ModelAtRest, outcome: &Outcome, line: usize) -> Self {
        let (of_line, rest) = (&outcome.lines[line], &prepared.rest);
        Self {
            // Of inextensible lines, like the tensions of the run.
            rest_n: rest.rests.then(|| rest.inextensible_tensions_n()[line]),
            largest_n: of_line.largest_n(),
            least_n: of_line.least_n,
        }
    }

    fn over_strength(
        &self,
        [rest, environment, strength]: [f64; 3],
        load_n: Option<f64>,
    ) -> Option<f64> {
        let rest_n = self.rest_n?;
        let largest = self.largest_n?.max(rest_n);
        let factored = rest * rest_n + environment * (largest - rest_n);
        Some(factored / (strength * load_n?))
    }

    /// T_min/T_0; none for a line without tension at rest.
    fn least_part(&self) -> Option<f64> {
        let rest_n = self.rest_n.filter(|rest_n| *rest_n > 0.0)?;
        self.least_n.map(|least| least / rest_n)
    }
}

/// The times, per peak period of a sea, at which its force is evaluated.
const SAMPLES_PER_PERIOD: f64 = 40.0;

/// max |f_z|/F of the waves within the time that is judged; none in still water. A floating body,
/// which the waves lift by its waterplane, has no such check.
fn wave_force_part(prepared: &ModelAtRest) -> Option<f64> {
    let Structure {
        duration_s,
        transient_s,
        ..
    } = prepared.structure;
    let forcing = &prepared.model.system.forcing;
    let step_s = match prepared.structure.water {
        Water::Still => return None,
        Water::Wave(_) => return forcing.harmonics.first().map(Harmonic::amplitude_y),
        Water::Sea(sea) => sea.peak_period_s / SAMPLES_PER_PERIOD,
    };
    let samples = ((duration_s - transient_s) / step_s).ceil() as u64;
    let forces = (0..=samples).map(|k| {
        let t_s = (transient_s + k as f64 * step_s).min(duration_s);
        let force = forcing.at(t_s / prepared.model.scales.time_s) - forcing.constant;
        force.y.abs()
    });
    Some(forces.fold(0.0, f64::max))
}
