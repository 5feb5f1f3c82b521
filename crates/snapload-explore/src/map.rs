//! `/api/map`: what the cases of a map come to, told a few cells at a time.
use crate::order::coarse_first;
use crate::refusal::Refusal;
use crate::request::{self, Values};
use crate::work::Leash;
use axum::body::Bytes;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use snapload::analysis::outcomes;
use snapload::{Case, Kind, Outcome, Parameters, Stop, Value, key_named};
use snapload_study::{Grid, reason};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::Semaphore;
use tokio::sync::mpsc::{Sender, channel};
use tokio_stream::wrappers::ReceiverStream;
use tokio_stream::{Stream, StreamExt};

/// The most values of an axis.
const MOST_VALUES: u64 = 200;
/// A line is sent about so often.
const EVERY: Duration = Duration::from_millis(50);
/// The cells of a line: at first, at least, at most.
const CELLS: [usize; 3] = [16, 8, 2048];
/// What one cell may take.
const BUDGET: Duration = Duration::from_secs(2);
/// Runs that may go on for longer are run one by one, so that they can be ended.
const LONG: f64 = 1000.0;
/// The same for runs of more impacts than this.
const MANY: u64 = 20_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    #[serde(default)]
    values: Values,
    x: AxisGiven,
    y: AxisGiven,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AxisGiven {
    key: String,
    low: f64,
    high: f64,
    count: u64,
}

/// A key and its values.
struct Axis {
    key: &'static str,
    values: Vec<f64>,
}

impl AxisGiven {
    /// The values are those of `snapload sweep --vary`, each the decimal number that one would write.
    fn read(&self, name: &str) -> Result<Axis, Refusal> {
        let wrong = |words: String| Refusal::values(format!("{name}: {words}"));
        let key = key_named(&self.key).map_err(|error| wrong(error.to_string()))?;
        if !matches!(key.kind, Kind::Number { .. }) {
            return Err(wrong(format!(
                "{} holds no number that can be varied",
                key.name
            )));
        }
        let count = self.count;
        if !(1..=MOST_VALUES).contains(&count) {
            let allowed = format!("allowed: a whole number, 1 <= count <= {MOST_VALUES}");
            return Err(wrong(format!("count = {count} is not allowed; {allowed}")));
        }
        let (low, high) = (format!("{:e}", self.low), format!("{:e}", self.high));
        let grid = Grid::new(&low, &high, count);
        let grid = grid.ok_or_else(|| wrong(format!("{low} to {high} is no range of numbers")))?;
        Ok(Axis {
            key: key.name,
            values: (0..count).map(|k| grid.value(k)).collect(),
        })
    }
}

/// A map to be computed.
struct Map {
    base: Vec<(&'static str, Value)>,
    x: Axis,
    y: Axis,
}

impl Map {
    fn read(body: &[u8]) -> Result<Self, Refusal> {
        let Request { values, x, y } = request::read(body)?;
        let base = request::entries(values)?;
        let (x, y) = (x.read("x")?, y.read("y")?);
        if x.key == y.key {
            let words = format!("x and y are both {}; choose two different keys", x.key);
            return Err(Refusal::values(words));
        }
        Ok(Self { base, x, y })
    }

    fn case(&self, cell: usize) -> Result<Case, String> {
        let columns = self.x.values.len();
        let (x, y) = (self.x.values[cell % columns], self.y.values[cell / columns]);
        let varied = [(self.x.key, x.into()), (self.y.key, y.into())];
        let entries = self.base.iter().cloned().chain(varied);
        let parameters = Parameters::from_entries(entries);
        parameters
            .and_then(Case::new)
            .map_err(|error| error.to_string())
    }
}

/// The lines of the answer; dropping them ends the work.
pub(crate) fn lines(
    body: &[u8],
    mappers: Arc<Semaphore>,
) -> Result<impl Stream<Item = Result<Bytes, Infallible>> + use<>, Refusal> {
    let map = Map::read(body)?;
    let (send, receive) = channel(4);
    let (waiting, leash) = Leash::new();
    tokio::spawn(async move {
        // A semaphore that is closed has nobody waiting.
        let Ok(mapper) = mappers.acquire_owned().await else {
            return;
        };
        tokio::task::spawn_blocking(move || {
            let _mapper = mapper;
            compute(&map, &leash, &Lines(send));
        });
    });
    let lines = ReceiverStream::new(receive).map(move |line| {
        let _waiting = &waiting;
        Ok(line)
    });
    Ok(lines)
}

/// Where the lines go.
struct Lines(Sender<Bytes>);

impl Lines {
    /// Sends a line; false where nobody takes it.
    fn send(&self, line: &impl Serialize) -> bool {
        let Ok(mut line) = serde_json::to_vec(line) else {
            return false;
        };
        line.push(b'\n');
        self.0.blocking_send(line.into()).is_ok()
    }
}

/// The first line: what the cells stand at.
#[derive(Serialize)]
struct Axes<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

/// The last one.
#[derive(Serialize)]
struct Done {
    done: bool,
}

fn compute(map: &Map, leash: &Leash, lines: &Lines) {
    let (x, y) = (&map.x.values, &map.y.values);
    if !lines.send(&Axes { x, y }) {
        return;
    }
    let order = coarse_first(x.len(), y.len());
    let [mut size, least, most] = CELLS;
    let mut rest = order.as_slice();
    while !rest.is_empty() {
        let (now, later) = rest.split_at(size.min(rest.len()));
        let began = Instant::now();
        let cells = Cells::of(map, now, leash);
        if leash.is_left() || !lines.send(&cells) {
            return;
        }
        let pace = EVERY.as_secs_f64() / began.elapsed().as_secs_f64().max(1e-9);
        size = ((size as f64 * pace.clamp(0.25, 4.0)) as usize).clamp(least, most);
        rest = later;
    }
    lines.send(&Done { done: true });
}

/// What some cells come to, as columns; null where there is nothing.
#[derive(Default, Serialize)]
struct Cells<'a> {
    cells: &'a [usize],
    reason: Vec<Option<&'static str>>,
    t: Vec<Option<f64>>,
    rho1: Vec<Option<f64>>,
    rho3: Vec<Option<f64>>,
    y_max: Vec<Option<f64>>,
    theta_max: Vec<Option<f64>>,
    impacts: Vec<Option<u64>>,
    error: Vec<Option<String>>,
}

impl<'a> Cells<'a> {
    fn of(map: &Map, cells: &'a [usize], leash: &Leash) -> Self {
        let cases: Vec<Result<Case, String>> = cells.iter().map(|cell| map.case(*cell)).collect();
        let mut told = Self {
            cells,
            ..Self::default()
        };
        for outcome in all_outcomes(cases, leash) {
            told.push(outcome);
        }
        told
    }

    fn push(&mut self, outcome: Result<Outcome, String>) {
        let (outcome, error) = match outcome {
            Ok(outcome) => (Some(outcome), None),
            Err(words) => (None, Some(words)),
        };
        let end = outcome.map(|outcome| outcome.end);
        let norms = outcome.map(|outcome| outcome.norms);
        self.reason.push(end.map(|end| reason(end.reason)));
        self.t.push(end.map(|end| end.t));
        self.rho1.push(norms.map(|norms| norms.rho1));
        self.rho3.push(norms.map(|norms| norms.rho3));
        self.y_max.push(norms.map(|norms| norms.y_max));
        self.theta_max.push(norms.map(|norms| norms.theta_max));
        self.impacts.push(outcome.map(|outcome| outcome.snaps()));
        self.error.push(error);
    }
}

/// What cases come to: side by side as far as that can not take long, else by themselves.
fn all_outcomes(
    cases: Vec<Result<Case, String>>,
    leash: &Leash,
) -> impl Iterator<Item = Result<Outcome, String>> {
    let short: Vec<Case> = cases.iter().flatten().filter_map(cut).collect();
    let mut short = outcomes(&short).into_iter();
    let tried: Vec<_> = cases
        .into_iter()
        .map(|case| {
            let case = case?;
            let quick = is_short(&case).then(|| short.next()).flatten();
            let whole = quick.filter(|outcome| !was_cut(&case, outcome));
            Ok((case, whole))
        })
        .collect();
    let done: Vec<_> = tried
        .into_par_iter()
        .map(|tried: Result<_, String>| match tried? {
            (_, Some(outcome)) => Ok(outcome),
            (case, None) => alone(&case, leash),
        })
        .collect();
    done.into_iter()
}

/// Whether a run can not take long: a light body turns quickly, and its taut motion takes as many more steps
/// (docs/limits.md).
fn is_short(case: &Case) -> bool {
    let Parameters {
        t_end,
        a,
        b,
        inertia,
        ..
    } = *case.parameters();
    let quickness = inertia.map_or(1.0, |inertia| ((a * a + b * b) / inertia).sqrt().max(1.0));
    t_end * quickness <= LONG
}

/// The case with so few impacts that it can not take long.
fn cut(case: &Case) -> Option<Case> {
    let parameters = *case.parameters();
    let cut = Parameters {
        max_impacts: parameters.max_impacts.min(MANY),
        ..parameters
    };
    is_short(case).then(|| Case::new(cut).ok()).flatten()
}

/// Whether the cut case came to an end that is not the case's own.
fn was_cut(case: &Case, outcome: &Outcome) -> bool {
    outcome.end.reason == Stop::ImpactLimit && case.parameters().max_impacts > MANY
}

fn alone(case: &Case, leash: &Leash) -> Result<Outcome, String> {
    let leash = leash.within(BUDGET);
    Outcome::of_while(case, |_| leash.holds()).ok_or_else(|| {
        let seconds = BUDGET.as_secs();
        format!("not done after {seconds} s of computing\nhint: lower t_end or max_impacts")
    })
}
