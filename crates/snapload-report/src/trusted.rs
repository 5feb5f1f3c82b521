//! A run with what is known of it: how far it can be trusted, and how its neighbours end.
use snapload::analysis::{
    Doubt, Ensemble, Horizon, Loss, Sensitivity, Tally, Trust, Witness, sensitivity,
};
use snapload::{Case, CaseError, Stop, Trajectory};
use snapload_study::reason;

/// The impacts of which it is told how they depend on every key.
const SENSITIVE_IMPACTS: usize = 3;

/// A run with what is known of it.
pub struct Trusted {
    /// The run.
    pub run: Trajectory,
    /// How far it can be trusted.
    pub trust: Trust,
    /// What was taken to be uncertain.
    pub doubt: Doubt,
    /// Which neighbours were drawn.
    pub seed: u64,
    /// How neighbours end; none where the run is certain, or none were asked for.
    pub tally: Option<Tally>,
    /// How the first impacts depend on every key.
    pub sensitivity: Vec<Sensitivity>,
}

impl Trusted {
    /// Runs a case, and so many of its neighbours where it takes them. `running` is told the time reached
    /// after every step, `neighbour` of every neighbour that is done, from any thread.
    ///
    /// # Errors
    /// A [`CaseError`] if a key that is in doubt can not be varied about this start.
    pub fn run(
        case: &Case,
        doubt: Doubt,
        members: u32,
        seed: u64,
        mut running: impl FnMut(f64),
        neighbour: impl Fn() + Sync,
    ) -> Result<Self, CaseError> {
        let mut witness = Witness::of_case(case, &doubt)?;
        let run = Trajectory::record_watched(case.simulation(), |simulation, step| {
            witness.follow(simulation, step);
            running(simulation.time());
        });
        let trust = witness.verdict();
        let tally = if trust.decides_the_end() || members == 0 {
            None
        } else {
            Some(Ensemble::about(case, &doubt, members, seed).tally(neighbour)?)
        };
        Ok(Self {
            sensitivity: sensitivity(case, SENSITIVE_IMPACTS),
            run,
            trust,
            doubt,
            seed,
            tally,
        })
    }

    /// Where trust ends, as pictures show it.
    pub fn horizon(&self) -> Option<f64> {
        self.trust.horizon.map(|horizon| horizon.t)
    }
}

/// `rotation limit: certain`, or a line for each end: `rotation limit: 63 % of 1,000 neighbours (95 %: 60-66 %)`.
pub fn outcome_in_words(trusted: &Trusted) -> String {
    let end = in_words(trusted.run.end().reason);
    let Some(tally) = &trusted.tally else {
        return if trusted.trust.decides_the_end() {
            format!("{end}: certain")
        } else {
            format!("{end}: not certain, as it is past the horizon")
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
            in_words(reason),
            percent(share.part(), f64::round),
            percent(low, f64::floor),
            percent(high, f64::ceil),
        ));
    }
    parts.join("\n")
}

/// Where trust ends, and on a second line why.
pub fn trust_in_words(trusted: &Trusted) -> String {
    let known = format!("known to {:e}", trusted.doubt.tolerance);
    let impacts = trusted.run.impacts().len();
    let Some(horizon) = &trusted.trust.horizon else {
        return format!("{known} to the end");
    };
    let Horizon { t, impact, loss } = *horizon;
    let what = match loss {
        Loss::Start { cable } => {
            let cable = cable + 1;
            return format!(
                "none: it begins at the end of cable {cable}, and may in truth begin slack"
            );
        }
        Loss::Tolerance => "there errors have grown past it".to_owned(),
        Loss::Graze { cable } => {
            format!(
                "cable {} is only grazed there, and may be missed",
                cable + 1
            )
        }
        Loss::NearMiss { cable } => {
            format!("cable {} all but snaps there, and may in truth", cable + 1)
        }
        Loss::Simultaneous => {
            "there cables snap at one instant, in an order that decides".to_owned()
        }
        Loss::StopRule => "there a stop rule may or may not be met".to_owned(),
    };
    let place = if impact <= impacts {
        format!("before impact {impact} of {impacts}")
    } else {
        format!("for all {impacts} impacts")
    };
    format!("{known} {place}, up to t = {t:.4}\n{what}")
}

/// How many of them, in words.
pub fn neighbours(count: usize) -> String {
    let noun = if count == 1 {
        "neighbour"
    } else {
        "neighbours"
    };
    format!("{} {noun}", thousands(count))
}

/// The name of a reason to stop, without its underscore.
pub(crate) fn in_words(stop: Stop) -> String {
    reason(stop).replace('_', " ")
}

/// A part in per cent, rounded as told: to tenths near none and near all, else to whole ones.
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
