//! The shape of a run in JSON. Names and order are a stable interface.
use crate::motion::MotionRow;
use crate::{CertificateRow, Certified, OutcomeRow, RunWithTrust, TrustRow};
use serde::ser::{Error, SerializeSeq};
use serde::{Serialize, Serializer};
use snapload::analysis::{OnProgress, Progress};
use snapload::{
    End, Impact, ModeInterval, Norms, Parameters, Playback, Sampling, Trajectory, Value,
};
use std::io::{self, Write};

/// The whole report on a run.
#[derive(Serialize)]
pub struct Report<'a> {
    case: CaseEcho<'a>,
    end: EndRow,
    outcome: OutcomeRow,
    trust: TrustRow<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<CertificateRow<'a>>,
    impacts: ImpactRows<'a>,
    modes: Rows<'a, ModeInterval, ModeRow>,
    norms: NormsRow,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<MotionRows<'a>>,
}

impl<'a> Report<'a> {
    /// The report on a run, with the motion sampled if asked for; the progress is that of writing
    /// the motion.
    pub fn new(
        parameters: &'a Parameters,
        trusted: &'a RunWithTrust,
        sampling: Option<Sampling>,
        on_progress: OnProgress<'a>,
    ) -> Self {
        let trajectory = &trusted.run;
        let end = trajectory.end();
        Self {
            case: CaseEcho(parameters),
            end: EndRow::new(end),
            outcome: OutcomeRow::new(trusted),
            trust: TrustRow::new(trusted),
            certificate: None,
            impacts: ImpactRows(trusted),
            modes: Rows(trajectory.modes(), ModeRow::new),
            norms: NormsRow::new(trajectory.norms()),
            motion: sampling.map(|sampling| MotionRows {
                trajectory,
                sampling,
                on_progress,
            }),
        }
    }

    /// The same with the proof of the run.
    pub fn with_certificate(self, certified: Option<&'a Certified>) -> Self {
        Self {
            certificate: certified.map(Certified::row),
            ..self
        }
    }
}

/// Writes a value as one line of JSON.
///
/// # Errors
/// Those of the writer.
pub fn write_json(value: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer(&mut *out, value)?;
    writeln!(out)
}

/// The value of every key, in the order of the schema.
pub struct CaseEcho<'a>(pub &'a Parameters);

impl Serialize for CaseEcho<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let entries = self.0.entries();
        serializer.collect_map(entries.map(|(key, value)| (key, value.map(ValueRow))))
    }
}

/// A value of a key.
pub struct ValueRow(pub Value);

impl Serialize for ValueRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0 {
            Value::Number(number) => number.serialize(serializer),
            Value::Integer(number) => number.serialize(serializer),
            Value::Bool(flag) => flag.serialize(serializer),
            Value::Text(text) => text.serialize(serializer),
            Value::List(values) => serializer.collect_seq(values.iter().cloned().map(ValueRow)),
        }
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
    /// The row of an end.
    pub fn new(end: &End) -> Self {
        Self {
            reason: end.reason.name(),
            t: end.t,
            t_limit: end.t_limit,
        }
    }
}

/// A list whose rows are made one at a time, while they are written.
struct Rows<'a, T, R>(&'a [T], fn(&T) -> R);

impl<T, R: Serialize> Serialize for Rows<'_, T, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(self.1))
    }
}

/// The impacts with the known digits of each.
struct ImpactRows<'a>(&'a RunWithTrust);

impl Serialize for ImpactRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let RunWithTrust { run, trust, .. } = self.0;
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
            before: impact.before.components(),
            after: impact.after.components(),
            digits,
        }
    }
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
    /// The row of a run's norms.
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

/// The number of rows that are written between two progress reports.
const ROWS: usize = 1024;

struct MotionRows<'a> {
    trajectory: &'a Trajectory,
    sampling: Sampling,
    on_progress: OnProgress<'a>,
}

impl Serialize for MotionRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut playback = Playback::new(self.trajectory);
        let end = self.trajectory.end().t;
        let mut rows = serializer.serialize_seq(None)?;
        for (k, t) in self.sampling.times().enumerate() {
            if k.is_multiple_of(ROWS) {
                let progress = Progress::new("writing the motion", t, end);
                progress
                    .report(self.on_progress)
                    .map_err(S::Error::custom)?;
            }
            rows.serialize_element(&MotionRow::new(&playback.at(t)))?;
        }
        rows.end()
    }
}
