//! What of a case is uncertain, and what that makes of the result: the options, and the answer.
use crate::failure::Failure;
use crate::progress::Progress;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use snapload::analysis::{
    DEFAULT_MEMBERS, Doubt, Ensemble, Horizon, Loss, START_KEYS, Sensitivity, Share, Tally, Trust,
    Witness, sensitivity,
};
use snapload::{Case, Stop, Trajectory};
use snapload_study::reason;
use std::sync::atomic::{AtomicU64, Ordering};

/// The impacts of which it is told how they depend on every key.
const SENSITIVE_IMPACTS: usize = 3;

/// What is uncertain, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct DoubtArgs {
    /// How far every start value may be off, or one key; may be repeated
    #[arg(long, value_name = "SIZE|KEY=SIZE", allow_negative_numbers = true)]
    uncertainty: Vec<String>,
    /// Error of state and time above which a result counts as not known
    #[arg(
        long,
        value_name = "SIZE",
        default_value_t = 1e-3,
        allow_negative_numbers = true
    )]
    tolerance: f64,
    /// Which neighbours an ensemble draws
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
}

impl DoubtArgs {
    /// Reads them and checks them against a case.
    pub(crate) fn read(&self, case: &Case) -> Result<Doubt, Failure> {
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return Err(Failure::BadInput(format!(
                "--tolerance {}: allowed is a number above 0, such as 1e-3",
                self.tolerance
            )));
        }
        let mut doubt = Doubt {
            tolerance: self.tolerance,
            ..Doubt::default()
        };
        for text in &self.uncertainty {
            set(&mut doubt, text, case)?;
        }
        Ok(doubt)
    }

    /// Whether anything was said to be uncertain.
    pub(crate) fn is_given(&self) -> bool {
        !self.uncertainty.is_empty()
    }

    pub(crate) fn seed(&self) -> u64 {
        self.seed
    }
}

fn set(doubt: &mut Doubt, text: &str, case: &Case) -> Result<(), Failure> {
    let wrong = |what: &str| {
        Failure::BadInput(format!(
            "--uncertainty {text:?}: {what}; write a number such as 1e-3 for all start values, or \
             KEY=NUMBER such as f_o=0.01"
        ))
    };
    let parse = |size: &str| size.trim().parse::<f64>().map_err(|_| wrong("no number"));
    let (keys, size) = match text.split_once('=') {
        Some((key, size)) => {
            let (key, size) = (key.trim(), parse(size)?);
            if START_KEYS.contains(&key) && !case.parameters().moves_by(key) {
                return Err(wrong("this case has no such quantity"));
            }
            (vec![key], size)
        }
        None => (START_KEYS.to_vec(), parse(text)?),
    };
    for key in keys {
        doubt
            .set(key, size)
            .map_err(|error| Failure::BadInput(format!("--uncertainty: {error}")))?;
    }
    Ok(())
}

/// How many neighbours to run where one run can not tell.
#[derive(clap::Args)]
pub(crate) struct EnsembleArgs {
    /// Neighbours to run where the end is past the horizon; 0 for none
    #[arg(long, value_name = "N", default_value_t = DEFAULT_MEMBERS)]
    ensemble: u32,
}

/// A run with what is known of it.
pub(crate) struct Trusted {
    pub(crate) run: Trajectory,
    pub(crate) trust: Trust,
    pub(crate) doubt: Doubt,
    pub(crate) seed: u64,
    /// How neighbours end; none where the run is certain, or none were asked for.
    pub(crate) tally: Option<Tally>,
    pub(crate) sensitivity: Vec<Sensitivity>,
}

impl Trusted {
    /// Runs a case, and its neighbours where it takes them.
    pub(crate) fn run(
        case: &Case,
        doubt: &DoubtArgs,
        ensemble: &EnsembleArgs,
    ) -> Result<Self, Failure> {
        let seed = doubt.seed();
        let doubt = doubt.read(case)?;
        let mut witness = Witness::of_case(case, &doubt)
            .map_err(|error| Failure::BadInput(format!("--uncertainty: {error}")))?;
        let mut progress = Progress::new("running", case.parameters().t_end);
        let run = Trajectory::record_watched(case.simulation(), |simulation, step| {
            witness.follow(simulation, step);
            progress.at(simulation.time());
        });
        drop(progress);
        let trust = witness.verdict();
        let tally = if trust.decides_the_end() || ensemble.ensemble == 0 {
            None
        } else {
            let ensemble = Ensemble::about(case, &doubt, ensemble.ensemble, seed);
            Some(tally(&ensemble)?)
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

    /// Where the pictures turn grey.
    pub(crate) fn horizon(&self) -> Option<f64> {
        self.trust.horizon.map(|horizon| horizon.t)
    }
}

/// Runs the neighbours under a progress bar.
fn tally(ensemble: &Ensemble) -> Result<Tally, Failure> {
    let progress = std::sync::Mutex::new(Progress::new("neighbours", f64::from(ensemble.count)));
    let done = AtomicU64::new(0);
    let watch = || {
        let count = done.fetch_add(1, Ordering::Relaxed);
        if let Ok(mut progress) = progress.try_lock() {
            progress.show(count as f64);
        }
    };
    ensemble
        .tally(watch)
        .map_err(|error| Failure::BadInput(format!("--uncertainty: {error}")))
}

/// `rotation limit: certain`, or a line for each end: `rotation limit: 63 % of 1,000 neighbours (95 %: 60-66 %)`.
pub(crate) fn outcome_in_words(trusted: &Trusted) -> String {
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
pub(crate) fn trust_in_words(trusted: &Trusted) -> String {
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
pub(crate) fn neighbours(count: usize) -> String {
    let noun = if count == 1 {
        "neighbour"
    } else {
        "neighbours"
    };
    format!("{} {noun}", thousands(count))
}

fn in_words(stop: Stop) -> String {
    reason(stop).replace('_', " ")
}

/// A part in per cent, rounded as told: to tenths near none and near all, else to whole ones.
pub(crate) fn percent(part: f64, round: impl Fn(f64) -> f64) -> String {
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

/// The name of a loss of trust.
fn because(loss: Loss) -> &'static str {
    match loss {
        Loss::Tolerance => "tolerance",
        Loss::Graze { .. } => "graze",
        Loss::NearMiss { .. } => "near_miss",
        Loss::Simultaneous => "simultaneous",
        Loss::Start { .. } => "start",
        Loss::StopRule => "stop_rule",
    }
}

/// `"trust"` in the JSON of a run.
#[derive(Serialize)]
pub(crate) struct TrustRow<'a> {
    t: Option<f64>,
    impact: Option<usize>,
    because: Option<&'static str>,
    tolerance: f64,
    uncertainty: Uncertainty<'a>,
    end_error: Option<f64>,
    exponents: [f64; 6],
    grazes: Vec<GrazeRow>,
    sensitivity: Vec<SensitivityRow<'a>>,
}

impl<'a> TrustRow<'a> {
    pub(crate) fn new(trusted: &'a Trusted) -> Self {
        let Trust {
            horizon,
            end_error,
            grazes,
            exponents,
            ..
        } = &trusted.trust;
        Self {
            t: horizon.map(|horizon| horizon.t),
            impact: horizon.map(|horizon| horizon.impact),
            because: horizon.map(|horizon| because(horizon.loss)),
            tolerance: trusted.doubt.tolerance,
            uncertainty: Uncertainty(&trusted.doubt),
            end_error: Some(*end_error).filter(|error| error.is_finite()),
            exponents: *exponents,
            grazes: grazes
                .iter()
                .map(|graze| GrazeRow {
                    impact: graze.impact,
                    v_n: graze.v_n,
                    factor: graze.factor,
                })
                .collect(),
            sensitivity: trusted.sensitivity.iter().map(SensitivityRow).collect(),
        }
    }
}

/// The uncertainty of each key that has one.
struct Uncertainty<'a>(&'a Doubt);

impl Serialize for Uncertainty<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let start = START_KEYS.into_iter().zip(self.0.start);
        let all = start.chain(self.0.keys.iter().copied());
        serializer.collect_map(all.filter(|(_, size)| *size > 0.0))
    }
}

#[derive(Serialize)]
struct GrazeRow {
    impact: usize,
    v_n: f64,
    factor: f64,
}

/// The derivatives of one impact: by quantity, then by key.
struct SensitivityRow<'a>(&'a Sensitivity);

impl Serialize for SensitivityRow<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Sensitivity { impact, slopes } = self.0;
        let mut map = serializer.serialize_map(Some(4))?;
        map.serialize_entry("impact", impact)?;
        let by_key = |of: fn(&snapload::analysis::Slope) -> f64| -> serde_json::Map<_, _> {
            slopes
                .iter()
                .map(|slope| (slope.key.to_owned(), of(slope).into()))
                .collect()
        };
        map.serialize_entry("t", &by_key(|slope| slope.t))?;
        map.serialize_entry("v_n", &by_key(|slope| slope.v_n))?;
        map.serialize_entry("impulse", &by_key(|slope| slope.impulse))?;
        map.end()
    }
}

/// `"outcome"` in the JSON of a run.
#[derive(Serialize)]
pub(crate) struct OutcomeRow {
    certain: bool,
    ensemble: Option<EnsembleRow>,
}

#[derive(Serialize)]
struct EnsembleRow {
    members: usize,
    seed: u64,
    ends: Vec<ShareRow>,
}

#[derive(Serialize)]
struct ShareRow {
    reason: &'static str,
    count: usize,
    part: f64,
    low: f64,
    high: f64,
}

impl OutcomeRow {
    pub(crate) fn new(trusted: &Trusted) -> Self {
        let share = |(stop, share): (Stop, Share)| {
            let [low, high] = share.interval();
            ShareRow {
                reason: reason(stop),
                count: share.count,
                part: share.part(),
                low,
                high,
            }
        };
        Self {
            certain: trusted.trust.decides_the_end(),
            ensemble: trusted.tally.as_ref().map(|tally| EnsembleRow {
                members: tally.members(),
                seed: trusted.seed,
                ends: tally.shares().into_iter().map(share).collect(),
            }),
        }
    }
}
