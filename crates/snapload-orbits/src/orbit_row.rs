//! An orbit in the form of its JSON.

use crate::hybrid::Point;
use crate::multipliers::Stability;
use crate::orbit::{Orbit, Proof};
use crate::survey::Extreme;
use serde::{Serialize, Serializer};
use snapload::TautSet;

/// An orbit.
#[derive(Serialize)]
pub struct OrbitRow {
    period: PeriodRow,
    section: SectionPoint,
    symbol: Vec<String>,
    events: Vec<EventOfOrbit>,
    modes: Vec<ModeRow>,
    multipliers: Vec<[f64; 2]>,
    zeros_from_contact: usize,
    product: ProductRow,
    stable: StabilityRow,
    exponents: Vec<Option<f64>>,
    admissible: AdmissibleRow,
    return_error: Option<f64>,
    error_bound: Option<f64>,
    proved: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    proof: Option<ProofRow>,
}

/// The proved orbit, or why it is not proved.
#[derive(Serialize)]
#[serde(untagged)]
enum ProofRow {
    Proved {
        state: [String; 6],
        events: Vec<ProvedSnap>,
        alone_within: f64,
        prime: bool,
    },
    NotProved {
        why_not: String,
    },
}

/// Decimals, each within half a unit of its last digit of the true number.
#[derive(Serialize)]
struct ProvedSnap {
    t: String,
    cable: usize,
    v_n: String,
}

impl ProofRow {
    fn new(proof: &Proof) -> Self {
        match proof {
            Ok(proved) => Self::Proved {
                state: proved.state.clone(),
                events: proved
                    .snaps
                    .iter()
                    .map(|(cable, t, v_n)| ProvedSnap {
                        t: t.clone(),
                        cable: cable + 1,
                        v_n: v_n.clone(),
                    })
                    .collect(),
                alone_within: proved.unique_within,
                prime: proved.is_prime(),
            },
            Err(why_not) => Self::NotProved {
                why_not: why_not.clone(),
            },
        }
    }
}

#[derive(Serialize)]
struct PeriodRow {
    forcing_periods: u32,
    smallest: u32,
    t: f64,
}

#[derive(Serialize)]
struct SectionPoint {
    phase: f64,
    state: Point,
}

#[derive(Serialize)]
struct EventOfOrbit {
    t: f64,
    kind: &'static str,
    cable: usize,
    v_n: f64,
    impulse: f64,
}

#[derive(Serialize)]
struct ModeRow {
    from: f64,
    to: f64,
    taut: Vec<usize>,
}

#[derive(Serialize)]
struct ProductRow {
    value: f64,
    rule: Option<f64>,
}

#[derive(Serialize)]
struct AdmissibleRow {
    yes: bool,
    largest_gap: Option<f64>,
    least_tension: Option<f64>,
    least_v_n: Option<f64>,
    y_max: f64,
    theta_max: f64,
    why_not: Vec<String>,
}

/// true, false, or a word.
pub(crate) struct StabilityRow(pub(crate) Stability);

impl Serialize for StabilityRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Stability::Stable => serializer.serialize_bool(true),
            Stability::Unstable => serializer.serialize_bool(false),
            Stability::Neutral => serializer.serialize_str("neutral"),
            Stability::Superstable => serializer.serialize_str("superstable"),
        }
    }
}

/// Cables by their numbers from 1.
fn numbers(set: TautSet) -> Vec<usize> {
    set.iter().map(|cable| cable + 1).collect()
}

impl OrbitRow {
    /// Of an orbit.
    pub fn new(orbit: &Orbit) -> Self {
        let value = |extreme: Option<Extreme>| extreme.map(|extreme| extreme.value);
        let survey = &orbit.survey;
        let proved = orbit.proof.as_ref().and_then(|proof| proof.as_ref().ok());
        let event = |row: &crate::orbit::EventRow| EventOfOrbit {
            t: row.t,
            kind: row.kind,
            cable: row.surface + 1,
            v_n: row.speed,
            impulse: row.impulse,
        };
        let exponent = |[re, im]: &[f64; 2]| {
            let size = re.hypot(*im);
            (size > 0.0).then(|| size.ln() / orbit.length)
        };
        Self {
            period: PeriodRow {
                forcing_periods: orbit.periods,
                smallest: orbit.smallest_periods,
                t: orbit.length,
            },
            section: SectionPoint {
                phase: orbit.phase,
                state: orbit.z,
            },
            symbol: orbit.lap.sequence.symbol(),
            events: orbit.rows.iter().map(event).collect(),
            modes: modes(orbit),
            multipliers: orbit.multipliers.values.clone(),
            zeros_from_contact: orbit.multipliers.zeros_from_contact,
            product: ProductRow {
                value: orbit.multipliers.product,
                rule: orbit.rule,
            },
            stable: StabilityRow(orbit.stability()),
            exponents: orbit.multipliers.values.iter().map(exponent).collect(),
            admissible: AdmissibleRow {
                yes: orbit.is_admissible(),
                largest_gap: orbit.largest_gap,
                least_tension: value(survey.least_tension),
                least_v_n: value(survey.least_speed),
                y_max: survey.y_max,
                theta_max: survey.theta_max,
                why_not: orbit.why_not.clone(),
            },
            return_error: orbit.return_error,
            error_bound: proved.map(|proved| proved.error_of(&orbit.z)),
            proved: proved.is_some(),
            proof: orbit.proof.as_ref().map(ProofRow::new),
        }
    }
}

fn modes(orbit: &Orbit) -> Vec<ModeRow> {
    let t_start = orbit.phase / f64::from(orbit.periods) * orbit.length;
    let mut from = t_start;
    let mut rows: Vec<ModeRow> = Vec::new();
    let ends = orbit.lap.durations.iter().copied().map(Some).chain([None]);
    for (set, lasts) in orbit.lap.sequence.taut_sets().into_iter().zip(ends) {
        let to = lasts.map_or(t_start + orbit.length, |s| from + s);
        let taut = numbers(set);
        match rows.last_mut() {
            Some(last) if last.taut == taut => last.to = to,
            _ => rows.push(ModeRow { from, to, taut }),
        }
        from = to;
    }
    rows
}
