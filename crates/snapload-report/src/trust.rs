//! The form of trust and outcome in JSON.
use crate::RunWithTrust;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use snapload::Stop;
use snapload::analysis::{Horizon, NormErrors, START_KEYS, Sensitivity, Share, Trust, Uncertainty};

/// Where trust ends, in JSON: nulls if the whole run can be trusted.
#[derive(Serialize)]
pub struct HorizonRow {
    t: Option<f64>,
    impact: Option<usize>,
    because: Option<&'static str>,
}

impl HorizonRow {
    /// The row of a horizon; without values if there is none.
    pub fn new(horizon: Option<Horizon>) -> Self {
        Self {
            t: horizon.map(|horizon| horizon.t),
            impact: horizon.map(|horizon| horizon.impact),
            because: horizon.map(|horizon| horizon.cause.name()),
        }
    }
}

/// `"trust"` in the JSON of a run.
#[derive(Serialize)]
pub struct TrustRow<'a> {
    #[serde(flatten)]
    horizon: HorizonRow,
    tolerance: f64,
    uncertainty: UncertaintyJson<'a>,
    end_error: Option<f64>,
    norm_errors: NormErrorRow,
    exponents: &'a [f64],
    grazes: Vec<GrazeRow>,
    sensitivity: Vec<SensitivityRow<'a>>,
}

impl<'a> TrustRow<'a> {
    /// The row of a run.
    pub fn new(trusted: &'a RunWithTrust) -> Self {
        let Trust {
            horizon,
            end_error,
            grazes,
            exponents,
            ..
        } = &trusted.trust;
        Self {
            horizon: HorizonRow::new(*horizon),
            tolerance: trusted.uncertainty.tolerance,
            uncertainty: UncertaintyJson(&trusted.uncertainty),
            end_error: Some(*end_error).filter(|error| error.is_finite()),
            norm_errors: NormErrorRow::new(NormErrors::of(&trusted.run, &trusted.trust)),
            exponents,
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

/// Errors of the norms; null if impacts past the horizon are included.
#[derive(Serialize)]
struct NormErrorRow {
    rho1: Option<f64>,
    rho2: Option<f64>,
    rho3: Option<f64>,
    y_max: Option<f64>,
    theta_max: Option<f64>,
}

impl NormErrorRow {
    fn new(errors: NormErrors) -> Self {
        let NormErrors {
            rho1,
            rho2,
            rho3,
            y_max,
            theta_max,
        } = errors;
        Self {
            rho1,
            rho2,
            rho3,
            y_max,
            theta_max,
        }
    }
}

/// The uncertainty of each key that has one.
struct UncertaintyJson<'a>(&'a Uncertainty);

impl Serialize for UncertaintyJson<'_> {
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
pub struct OutcomeRow {
    certain: bool,
    ensemble: Option<EnsembleRow>,
}

#[derive(Serialize)]
struct EnsembleRow {
    members: usize,
    seed: u64,
    ends: Vec<ShareRow>,
}

/// The part of an ensemble that ends in one way, with its confidence interval.
#[derive(Serialize)]
pub struct ShareRow {
    reason: &'static str,
    count: usize,
    part: f64,
    low: f64,
    high: f64,
}

impl OutcomeRow {
    /// The row of a run.
    pub fn new(trusted: &RunWithTrust) -> Self {
        Self {
            certain: trusted.trust.decides_the_end(),
            ensemble: trusted.tally.as_ref().map(|tally| EnsembleRow {
                members: tally.members(),
                seed: trusted.seed,
                ends: tally.shares().into_iter().map(ShareRow::new).collect(),
            }),
        }
    }
}

impl ShareRow {
    /// The row of a kind of end and its share.
    pub fn new((stop, share): (Stop, Share)) -> Self {
        let [low, high] = share.interval();
        Self {
            reason: stop.name(),
            count: share.count,
            part: share.part(),
            low,
            high,
        }
    }
}
