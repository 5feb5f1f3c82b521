//! The shape of a run in JSON. Names and order here are a promise to whoever reads the files.
use crate::{OutcomeRow, TrustRow, Trusted};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use snapload::{
    End, Impact, ModeInterval, Motion, Norms, Parameters, Playback, State, Trajectory, Value,
};
use snapload_study::reason;
use std::io::{self, Write};

/// Everything there is to say about a run.
#[derive(Serialize)]
pub struct Report<'a> {
    case: CaseEcho<'a>,
    end: EndRow,
    outcome: OutcomeRow,
    trust: TrustRow<'a>,
    impacts: ImpactRows<'a>,
    modes: Rows<'a, ModeInterval, ModeRow>,
    norms: NormsRow,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<MotionRows<'a>>,
}

impl<'a> Report<'a> {
    /// The report of a run, with the motion sampled if asked for. `watch` is told the time that the motion is
    /// written up to.
    pub fn new(
        parameters: &'a Parameters,
        trusted: &'a Trusted,
        sampling: Option<Sampling>,
        watch: &'a dyn Fn(f64),
    ) -> Self {
        let trajectory = &trusted.run;
        let end = trajectory.end();
        Self {
            case: CaseEcho(parameters),
            end: EndRow::new(end),
            outcome: OutcomeRow::new(trusted),
            trust: TrustRow::new(trusted),
            impacts: ImpactRows(trusted),
            modes: Rows(trajectory.modes(), ModeRow::new),
            norms: NormsRow::new(trajectory.norms()),
            motion: sampling.map(|sampling| MotionRows {
                trajectory,
                sampling,
                watch,
            }),
        }
    }
}

/// Writes something as one line of JSON.
///
/// # Errors
/// Those of the writer.
pub fn write_json(value: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer(&mut *out, value)?;
    writeln!(out)
}

/// Every key in effect, in the order of the schema.
pub struct CaseEcho<'a>(pub &'a Parameters);

impl Serialize for CaseEcho<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (key, value) in self.0.entries() {
            match value {
                None => map.serialize_entry(key, &None::<f64>)?,
                Some(Value::Number(number)) => map.serialize_entry(key, &number)?,
                Some(Value::Integer(number)) => map.serialize_entry(key, &number)?,
                Some(Value::Bool(flag)) => map.serialize_entry(key, &flag)?,
                Some(Value::Text(text)) => map.serialize_entry(key, &text)?,
            }
        }
        map.end()
    }
}

/// `"end"` in the JSON of a run.
#[derive(Serialize)]
pub struct EndRow {
    reason: &'static str,
    t: f64,
    t_limit: Option<f64>,
}

impl EndRow {
    /// Of an end.
    pub fn new(end: &End) -> Self {
        Self {
            reason: reason(end.reason),
            t: end.t,
            t_limit: end.t_limit,
        }
    }
}

/// A list whose rows are shaped one at a time, while they are written.
struct Rows<'a, T, R>(&'a [T], fn(&T) -> R);

impl<T, R: Serialize> Serialize for Rows<'_, T, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(self.1))
    }
}

/// The impacts with the digits that are known of each.
struct ImpactRows<'a>(&'a Trusted);

impl Serialize for ImpactRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Trusted { run, trust, .. } = self.0;
        let rows = run.impacts().iter().zip(trust.digits());
        serializer.collect_seq(rows.map(|(impact, digits)| ImpactRow::new(impact, digits)))
    }
}

#[derive(Serialize)]
struct ImpactRow {
    t: f64,
    cable: usize,
    v_n: f64,
    impulse: f64,
    energy_lost: f64,
    before: [f64; 6],
    after: [f64; 6],
    digits: f64,
}

impl ImpactRow {
    fn new(impact: &Impact, digits: f64) -> Self {
        Self {
            t: impact.t,
            cable: impact.cable + 1,
            v_n: impact.v_n,
            impulse: impact.impulse,
            energy_lost: impact.energy_lost,
            before: components(&impact.before),
            after: components(&impact.after),
            digits,
        }
    }
}

/// x, y, theta, vx, vy, vtheta.
pub fn components(state: &State) -> [f64; 6] {
    state.components()
}

#[derive(Serialize)]
struct ModeRow {
    mode: &'static str,
    taut: Vec<usize>,
    t_start: f64,
    t_end: f64,
}

impl ModeRow {
    fn new(interval: &ModeInterval) -> Self {
        Self {
            mode: interval.taut.mode().name(),
            taut: interval.taut.iter().map(|cable| cable + 1).collect(),
            t_start: interval.t_start,
            t_end: interval.t_end,
        }
    }
}

/// `"norms"` in the JSON of a run.
#[derive(Serialize)]
pub struct NormsRow {
    rho1: f64,
    rho2: f64,
    rho3: f64,
    y_max: f64,
    theta_max: f64,
}

impl NormsRow {
    /// Of a run's norms.
    pub fn new(norms: &Norms) -> Self {
        let Norms {
            rho1,
            rho2,
            rho3,
            y_max,
            theta_max,
        } = *norms;
        Self {
            rho1,
            rho2,
            rho3,
            y_max,
            theta_max,
        }
    }
}

/// The times at which a motion is written down: every multiple of a step before the end, and the
/// end itself once.
#[derive(Clone, Copy)]
pub struct Sampling {
    dt: f64,
    most: u64,
    end: f64,
}

/// The most rows of a sampled motion.
pub const MOST_ROWS: u64 = 10_000_000;

impl Sampling {
    /// Steps of `dt`; none if they would give too many rows.
    pub fn every(dt: f64, end: f64) -> Option<Self> {
        let most = MOST_ROWS - 1;
        // Rounding may keep the last multiple below the end, so what is counted is the exact test.
        ((most as f64) * dt >= end).then_some(Self { dt, most, end })
    }

    /// A thousand equal steps.
    pub fn thousand(end: f64) -> Self {
        Self {
            dt: end / 1000.0,
            most: 1000,
            end,
        }
    }

    /// The times.
    pub fn times(self) -> impl Iterator<Item = f64> {
        let multiples = (0..self.most).map(move |k| k as f64 * self.dt);
        multiples
            .take_while(move |t| *t < self.end)
            .chain(std::iter::once(self.end))
    }
}

/// One line of the sampled motion.
#[derive(Serialize)]
pub struct MotionRow {
    t: f64,
    x: f64,
    y: f64,
    theta: f64,
    vx: f64,
    vy: f64,
    vtheta: f64,
    #[serde(rename = "T1")]
    tension_1: f64,
    #[serde(rename = "T2")]
    tension_2: f64,
    energy: f64,
}

impl MotionRow {
    /// Of a motion.
    pub fn new(motion: &Motion) -> Self {
        let State {
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
        } = motion.state;
        Self {
            t: motion.t,
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
            tension_1: motion.tensions[0],
            tension_2: motion.tensions[1],
            energy: motion.energy,
        }
    }
}

impl MotionRow {
    /// Its numbers in their order.
    pub fn numbers(&self) -> [f64; 10] {
        [
            self.t,
            self.x,
            self.y,
            self.theta,
            self.vx,
            self.vy,
            self.vtheta,
            self.tension_1,
            self.tension_2,
            self.energy,
        ]
    }
}

struct MotionRows<'a> {
    trajectory: &'a Trajectory,
    sampling: Sampling,
    watch: &'a dyn Fn(f64),
}

impl Serialize for MotionRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut playback = Playback::new(self.trajectory);
        let rows = self.sampling.times().map(|t| {
            (self.watch)(t);
            MotionRow::new(&playback.at(t))
        });
        serializer.collect_seq(rows)
    }
}
