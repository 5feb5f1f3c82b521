//! A run with its trust, and the ends of its neighbours.
use snapload::analysis::{
    DEFAULT_MEMBERS, Ensemble, EnsembleEnds, Horizon, HorizonCause, OnProgress, Sensitivity, Trust,
    Uncertainty, Unfinished, sensitivity, trusted_run,
};
use snapload::{Case, Impact, Stop, Trajectory};

/// The number of impacts whose derivatives by every key are given.
const SENSITIVE_IMPACTS: usize = 3;

/// A run with its trust and the ends of its neighbours.
pub struct RunWithTrust {
    /// The run.
    pub run: Trajectory,
    /// How far it can be trusted.
    pub trust: Trust,
    /// The uncertainties that were assumed.
    pub uncertainty: Uncertainty,
    /// The seed of the neighbours.
    pub seed: u64,
    /// The ends of the neighbours; none if the run is certain, or none were asked for.
    pub tally: Option<EnsembleEnds>,
    /// The derivatives of the first impacts by every key.
    pub sensitivity: Vec<Sensitivity>,
}

impl RunWithTrust {
    /// Runs a case, and `members` of its neighbours if its end is not certain; if no number is
    /// given, as many as are needed to determine how they end, up to [`DEFAULT_MEMBERS`].
    ///
    /// # Errors
    /// A [`snapload::CaseError`] if a key that is uncertain can not be varied about this start, and
    /// [`Unfinished::Cancelled`].
    pub fn run(
        case: &Case,
        uncertainty: Uncertainty,
        members: Option<u32>,
        seed: u64,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let run = Self::run_alone(case, uncertainty, on_progress)?;
        run.completed(case, members, seed, on_progress)
    }

    /// The run alone, and how far it can be trusted: without neighbours and derivatives, which take
    /// longer.
    ///
    /// # Errors
    /// As for [`RunWithTrust::run`].
    pub fn run_alone(
        case: &Case,
        uncertainty: Uncertainty,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let (run, trust) = trusted_run(case, &uncertainty, on_progress)?;
        Ok(Self {
            run,
            trust,
            uncertainty,
            seed: 0,
            tally: None,
            sensitivity: Vec::new(),
        })
    }

    /// The result of [`RunWithTrust::run`], completed with the derivatives and the
    /// neighbours if the end is not certain.
    ///
    /// # Errors
    /// As for [`RunWithTrust::run`].
    pub fn completed(
        mut self,
        case: &Case,
        members: Option<u32>,
        seed: u64,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        self.sensitivity = sensitivity(case, SENSITIVE_IMPACTS, on_progress)?;
        self.seed = seed;
        if self.needs_neighbours(members) {
            let count = members.unwrap_or(DEFAULT_MEMBERS);
            let ensemble = Ensemble::about(case, &self.uncertainty, count, seed);
            self.tally = Some(match members {
                Some(_) => ensemble.tally(on_progress)?,
                None => ensemble.tally_until_clear(on_progress)?,
            });
        }
        Ok(self)
    }

    fn needs_neighbours(&self, members: Option<u32>) -> bool {
        members != Some(0) && !self.trust.decides_the_end()
    }

    /// Where trust ends, for pictures.
    pub fn horizon(&self) -> Option<f64> {
        self.trust.horizon.map(|horizon| horizon.t)
    }
}

/// `rotation limit: certain`, or a line for each end: `rotation limit: 63 % of 1,000 neighbours (95
/// %: 60-66 %)`.
pub fn outcome_in_words(trusted: &RunWithTrust) -> String {
    let end = trusted.run.end().reason;
    let Some(tally) = &trusted.tally else {
        return if trusted.trust.decides_the_end() {
            certain_outcome(end)
        } else {
            format!("{}: not certain, as it is past the horizon", end.label())
        };
    };
    let mut parts = Vec::new();
    for (i, (reason, share)) in tally.shares().into_iter().enumerate() {
        let of = if i == 0 {
            format!(" of {}", neighbours(share.of))
        } else {
            String::new()
        };
        let [low, high] = share.interval();
        parts.push(format!(
            "{}: {} %{of} (95 %: {}-{} %)",
            reason.label(),
            percent(share.part(), f64::round),
            percent(low, f64::floor),
            percent(high, f64::ceil),
        ));
    }
    parts.join("\n")
}

/// The outcome of a run whose neighbours all end as it does.
pub(crate) fn certain_outcome(end: Stop) -> String {
    format!("{}: certain", end.label())
}

/// Where trust ends, and on a second line why.
pub fn trust_in_words(trusted: &RunWithTrust) -> String {
    let (horizon, tolerance) = (trusted.trust.horizon, trusted.uncertainty.tolerance);
    trust_of_impacts_in_words(horizon, tolerance, trusted.run.impacts())
}

/// The same for a run with these impacts.
pub(crate) fn trust_of_impacts_in_words(
    horizon: Option<Horizon>,
    tolerance: f64,
    impacts: &[Impact],
) -> String {
    let horizon = horizon.map(|horizon| Horizon {
        impact: 1 + snaps_before(horizon, impacts),
        ..horizon
    });
    horizon_in_words(horizon, tolerance, snaps(impacts))
}

/// The number of impacts in the rows of their table: an impulse that passes into a taut cable, with
/// v_n = 0, has a row but is not an impact.
pub(crate) fn snaps(impacts: &[Impact]) -> usize {
    impacts.iter().filter(|impact| impact.v_n > 0.0).count()
}

/// The number of those before the horizon, whose number is that of a row.
pub(crate) fn snaps_before(horizon: Horizon, impacts: &[Impact]) -> usize {
    let rows = horizon.impact.saturating_sub(1).min(impacts.len());
    snaps(&impacts[..rows])
}

/// The same for a run with this number of impacts.
pub(crate) fn horizon_in_words(horizon: Option<Horizon>, tolerance: f64, impacts: usize) -> String {
    let known = format!("known to {tolerance:e}");
    let Some(Horizon { t, impact, cause }) = horizon else {
        return format!("{known} to the end");
    };
    let what = match cause {
        HorizonCause::Start { cable } => {
            let cable = cable + 1;
            return format!(
                "none: cable {cable} has its full length at the start, and may be slack or snap there"
            );
        }
        HorizonCause::Tolerance => format!("the error exceeds {tolerance:e} there"),
        HorizonCause::Graze { cable } => {
            format!(
                "cable {} snaps so slowly there that the snap may not occur",
                cable + 1
            )
        }
        HorizonCause::NearMiss { cable } => {
            format!(
                "cable {} comes so close to a snap there that it may occur",
                cable + 1
            )
        }
        HorizonCause::Sticking { cable } => format!(
            "cable {} snaps there about as slowly as v_stick, and may stick or bounce once more",
            cable + 1
        ),
        HorizonCause::Tension { cable } => format!(
            "the tension of cable {} comes so close to zero there that it may or may not go slack",
            cable + 1
        ),
        HorizonCause::PassedImpulse { cable } => format!(
            "a snap there hardly loads or unloads cable {}, which is taut and may or may not go slack",
            cable + 1
        ),
        HorizonCause::Simultaneous => {
            "cables snap at the same instant there; which is first decides what follows".to_owned()
        }
        HorizonCause::StopRule => "a stop rule may or may not be met there".to_owned(),
    };
    let place = match impacts {
        0 => String::new(),
        _ if impact <= impacts => format!(" before impact {impact} of {impacts},"),
        1 => " for its one impact,".to_owned(),
        _ => format!(" for all {impacts} impacts,"),
    };
    format!("{known}{place} up to t = {t:.4}\n{what}")
}

/// A number of neighbours, in words.
pub fn neighbours(count: usize) -> String {
    let noun = if count == 1 {
        "neighbour"
    } else {
        "neighbours"
    };
    format!("{} {noun}", thousands(count))
}

/// A part in per cent, rounded by the given function: to tenths near none and near all, otherwise
/// to whole numbers.
pub fn percent(part: f64, round: impl Fn(f64) -> f64) -> String {
    let percent = 100.0 * part;
    if (1.0..=99.0).contains(&percent) || percent == 0.0 || percent == 100.0 {
        format!("{}", round(percent))
    } else {
        format!("{}", round(10.0 * percent) / 10.0)
    }
}

fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
