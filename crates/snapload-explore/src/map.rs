//! `/api/map`: the results of the cases of a map, sent a few cells at a time.
use crate::order::coarse_first;
use crate::refusal::Refusal;
use crate::request::{Values, entries};
use crate::work::{Allowance, lines_of, on_a_worker};
use axum::body::Bytes;
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};
use snapload::analysis::{
    Cancelled, Certainty, Counter, Progress, in_parallel, on_all_threads, outcome,
};
use snapload::{Case, CaseError, Kind, Lanes, Outcome, Parameters, Stop, Value, key_named};
use snapload_report::tables::Cell;
use snapload_study::{Column, ColumnValue, Grid, Run};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::Semaphore;
use tokio::sync::mpsc::Sender;
use tokio_stream::Stream;

/// The most values of an axis.
const MOST_VALUES: u64 = 200;
/// The approximate time between lines.
const EVERY: Duration = Duration::from_millis(50);
/// The number of cells in a line: at first, at least, at most. Slow cells are sent one by one, so
/// that each is seen as it comes.
const CELLS: [usize; 3] = [16, 1, 2048];
/// The time budget of one cell.
const BUDGET: Duration = Duration::from_secs(2);
/// Runs whose end time is later are run one by one, so that they can be stopped.
const LONGEST_AT_ONCE: f64 = 1000.0;
/// The same for runs with more impacts than this.
const MOST_IMPACTS_AT_ONCE: u64 = 20_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    x: AxisGiven,
    y: AxisGiven,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisGiven {
    key: String,
    low: f64,
    high: f64,
    count: u64,
}

/// A key and its values.
pub(crate) struct Axis {
    pub(crate) key: &'static str,
    pub(crate) values: Vec<f64>,
}

impl AxisGiven {
    /// The values are those of `snapload sweep --vary`, each the double nearest to the exact
    /// decimal number.
    pub(crate) fn read(&self) -> Result<Axis, Refusal> {
        let key = key_named(&self.key)?;
        if !matches!(key.kind, Kind::Number { .. }) {
            let message = format!(
                "{} is not a real number and can not be varied; choose another key",
                key.name
            );
            return Err(Refusal::values(message));
        }
        let count = self.count;
        if !(1..=MOST_VALUES).contains(&count) {
            let allowed = format!("a whole number, 1 <= count <= {MOST_VALUES}");
            return Err(CaseError::value("count", count, allowed).into());
        }
        let (low, high) = (format!("{:e}", self.low), format!("{:e}", self.high));
        let grid = Grid::new(&low, &high, count)
            .ok_or_else(|| Refusal::values(format!("{low} to {high} is not a range of numbers")))?;
        Ok(Axis {
            key: key.name,
            values: (0..count).map(|k| grid.value(k)).collect(),
        })
    }
}

/// A map to be computed.
pub(crate) struct Map {
    pub(crate) base: Vec<(&'static str, Value)>,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
}

impl Map {
    pub(crate) fn of(values: Values, x: AxisGiven, y: AxisGiven) -> Result<Self, Refusal> {
        let base = entries(values)?;
        let axis = |name: &str, given: AxisGiven| given.read().map_err(|no| no.of_field(name));
        let (x, y) = (axis("x", x)?, axis("y", y)?);
        if x.key == y.key {
            let message = format!("x and y are both {}; choose two different keys", x.key);
            return Err(Refusal::values(message));
        }
        Ok(Self { base, x, y })
    }

    fn case(&self, cell: usize) -> Result<Case, CaseError> {
        let columns = self.x.values.len();
        let (x, y) = (self.x.values[cell % columns], self.y.values[cell / columns]);
        let varied = [(self.x.key, x.into()), (self.y.key, y.into())];
        Case::new(Parameters::from_entries(
            self.base.iter().cloned().chain(varied),
        )?)
    }
}

/// The lines of the answer; dropping them ends the work.
pub(crate) fn lines(
    request: Request,
    mappers: Arc<Semaphore>,
) -> Result<impl Stream<Item = Result<Bytes, Infallible>> + use<>, Refusal> {
    let map = Arc::new(Map::of(request.values, request.x, request.y)?);
    Ok(lines_of(async move |allowance, send| {
        let drawing = Drawing {
            map,
            mappers,
            allowance,
            send,
        };
        // If a line can not be sent, the client is gone.
        let _ = drawing.draw().await;
    }))
}

/// The first line: the values of the axes.
#[derive(Serialize)]
struct Axes<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

/// The last line.
#[derive(Serialize)]
struct Done {
    done: bool,
}

/// A map that is being computed and sent.
struct Drawing {
    map: Arc<Map>,
    /// Limits the lines that are computed at a time.
    mappers: Arc<Semaphore>,
    allowance: Allowance,
    send: Sender<Bytes>,
}

/// The client no longer takes the lines.
struct Abandoned;

impl Drawing {
    /// Sends the cells, coarse ones first. Each line waits for its turn, so that a slow map does
    /// not block another one.
    async fn draw(&self) -> Result<(), Abandoned> {
        let (x, y) = (&self.map.x.values, &self.map.y.values);
        self.send(&Axes { x, y }).await?;
        let mut rest: Arc<[usize]> = coarse_first(x.len(), y.len()).into();
        let [mut size, least, most] = CELLS;
        while !rest.is_empty() {
            let (now, later) = rest.split_at(size.min(rest.len()));
            let (now, later): (Arc<[usize]>, Arc<[usize]>) = (now.into(), later.into());
            let (map, mappers) = (Arc::clone(&self.map), Arc::clone(&self.mappers));
            let cells = on_a_worker(mappers, self.allowance.clone(), move |allowance| {
                let began = Instant::now();
                Ok((Cells::of(&map, now, allowance), began.elapsed()))
            });
            let (cells, took) = cells.await.map_err(|_| Abandoned)?;
            if self.allowance.is_abandoned() {
                return Err(Abandoned);
            }
            self.send(&cells).await?;
            let pace = EVERY.as_secs_f64() / took.as_secs_f64().max(1e-9);
            size = ((size as f64 * pace.clamp(0.25, 4.0)) as usize).clamp(least, most);
            rest = later;
        }
        self.send(&Done { done: true }).await
    }

    async fn send(&self, line: &impl Serialize) -> Result<(), Abandoned> {
        let mut line = serde_json::to_vec(line).map_err(|_| Abandoned)?;
        line.push(b'\n');
        self.send.send(line.into()).await.map_err(|_| Abandoned)
    }
}

/// The values of each cell, by which it can be coloured.
#[rustfmt::skip] // one row a column
pub(crate) static COLUMNS: [Column; 12] = [
    Column::new("reason", "", "", ColumnValue::Word(|run| run.outcome.end.reason.name()), "how the run ends"),
    Column::new("t", "", "T", ColumnValue::Number(|run| Some(run.outcome.end.t)), "time of the end"),
    Column::new("impacts", "", "", ColumnValue::Count(|run| Some(run.outcome.snaps())), "number of impacts"),
    Column::quantity("rho1", ColumnValue::Number(|run| Some(run.outcome.norms.rho1))),
    Column::quantity("rho2", ColumnValue::Number(|run| Some(run.outcome.norms.rho2))),
    Column::quantity("rho3", ColumnValue::Number(|run| Some(run.outcome.norms.rho3))),
    Column::quantity("y_max", ColumnValue::Number(|run| Some(run.outcome.norms.y_max))),
    Column::quantity("theta_max", ColumnValue::Number(|run| Some(run.outcome.norms.theta_max))),
    Column::new("t_sliding", "", "T", ColumnValue::Number(|run| Some(run.outcome.sliding)), "time with one taut cable"),
    Column::new("t_rocking", "", "T", ColumnValue::Number(|run| Some(run.outcome.rocking)), "time with both cables taut"),
    Column::new("horizon_t", "", "T", ColumnValue::Number(|run| run.certainty?.horizon.map(|horizon| horizon.t)),
        "time up to which the run can be trusted, if not to its end"),
    Column::new("certain", "", "", ColumnValue::Flag(|run| Some(run.certainty?.decides_the_end())),
        "whether neighbours end in the same way"),
];

/// The results of some cells, as columns; null where there is none.
struct Cells {
    cells: Arc<[usize]>,
    runs: Vec<Result<Run, Refusal>>,
}

impl Cells {
    fn of(map: &Map, cells: Arc<[usize]>, allowance: &Allowance) -> Self {
        let cases = cells.iter().map(|cell| map.case(*cell)).collect();
        Self {
            cells,
            runs: all_runs(cases, allowance),
        }
    }
}

impl Serialize for Cells {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(COLUMNS.len() + 2))?;
        map.serialize_entry("cells", &*self.cells)?;
        for column in &COLUMNS {
            let runs = self.runs.iter().map(|run| run.as_ref().ok());
            let values = runs.map(|run| run.map(|run| Cell::new(column, run)));
            map.serialize_entry(column.name, &values.collect::<Vec<_>>())?;
        }
        let errors = self.runs.iter().map(|run| run.as_ref().err());
        let errors = errors.map(|error| error.map(Refusal::message));
        map.serialize_entry("error", &errors.collect::<Vec<_>>())?;
        map.end()
    }
}

/// The results of cases: side by side if none can take long, and otherwise one by one, without
/// their certainty.
fn all_runs(
    cases: Vec<Result<Case, CaseError>>,
    allowance: &Allowance,
) -> Vec<Result<Run, Refusal>> {
    let short: Vec<Case> = cases.iter().flatten().filter_map(limited).collect();
    // If the client is gone there are none, and the rest ends at once, too.
    let mut short = side_by_side(&short, allowance)
        .unwrap_or_default()
        .into_iter();
    let tried: Vec<Result<_, CaseError>> = cases
        .into_iter()
        .map(|case| {
            let case = case?;
            let quick = is_short(&case).then(|| short.next()).flatten();
            let whole = quick.filter(|run| !hit_limit(&case, &run.outcome));
            Ok((case, whole))
        })
        .collect();
    let whole = in_parallel(tried.len(), |index| {
        Ok::<_, Infallible>(match &tried[index] {
            Ok((_, Some(run))) => Ok(*run),
            Ok((case, None)) => run_one(case, allowance),
            Err(error) => Err(error.clone().into()),
        })
    });
    whole.unwrap_or_else(|never| match never {})
}

fn side_by_side(cases: &[Case], allowance: &Allowance) -> Result<Vec<Run>, Cancelled> {
    let on_progress = |progress: Progress| allowance.check(progress);
    let counter = Counter::new("running", 0, cases.len() as u64, &on_progress);
    let made = on_all_threads(cases.len(), |numbers| {
        let cases = &mut numbers.map(|k| cases[k].clone());
        Certainty::with_outcomes(Lanes::best(), cases, &counter)
    });
    let run = |(outcome, certainty)| Run {
        outcome,
        certainty: Some(certainty),
    };
    Ok(made?.into_vec().into_iter().map(run).collect())
}

/// Whether a run can not take long: a light body turns quickly, and its taut motion takes
/// correspondingly many steps (docs/limits.md).
fn is_short(case: &Case) -> bool {
    let Parameters {
        t_end,
        a,
        b,
        inertia,
        ..
    } = *case.parameters();
    let quickness = inertia.map_or(1.0, |inertia| ((a * a + b * b) / inertia).sqrt().max(1.0));
    t_end * quickness <= LONGEST_AT_ONCE
}

/// The case limited to so few impacts that it can not take long.
fn limited(case: &Case) -> Option<Case> {
    let parameters = *case.parameters();
    let limited = Parameters {
        max_impacts: parameters.max_impacts.min(MOST_IMPACTS_AT_ONCE),
        ..parameters
    };
    is_short(case).then(|| Case::new(limited).ok()).flatten()
}

/// Whether the limited case ended where the case itself would not.
fn hit_limit(case: &Case, outcome: &Outcome) -> bool {
    outcome.end.reason == Stop::ImpactLimit && case.parameters().max_impacts > MOST_IMPACTS_AT_ONCE
}

fn run_one(case: &Case, allowance: &Allowance) -> Result<Run, Refusal> {
    let allowance = allowance.within(BUDGET);
    let done = outcome(case, &|progress| allowance.check(progress));
    let run = |outcome| Run {
        outcome,
        certainty: None,
    };
    done.map(run).map_err(|_| {
        let seconds = BUDGET.as_secs();
        Refusal::values(format!(
            "not finished after {seconds} s of computing\nhint: lower t_end or max_impacts"
        ))
    })
}
