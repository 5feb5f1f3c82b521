//! `/api/run`: a run, with everything that the page draws.
use crate::motion::{Columns, Times};
use crate::refusal::Refusal;
use crate::request::{Values, case};
use crate::work::Allowance;
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};
use snapload::analysis::{Cancelled, Progress, record};
use snapload::{
    Case, CaseError, Impact, ModeInterval, Parameters, Playback, Shape, State, System, Trajectory,
    Value,
};
use snapload_report::tables::{Cell, IMPACTS, ImpactRow};
use snapload_report::{
    CaseEcho, EndRow, HorizonRow, NormsKnown, NormsRow, RunWithHorizon, accumulation_in_words,
    end_in_words, python_lines, shell_line,
};
use std::time::{Duration, Instant};

/// The time budget of a run with its trust, and again of its neighbour.
pub(crate) const BUDGET: Duration = Duration::from_secs(2);
/// The most impacts, and the most intervals, that a page shows.
const MOST_SHOWN: usize = 10_000;
/// The allowed numbers of times at which the motion is sent, besides its impacts.
const SAMPLES: std::ops::RangeInclusive<u32> = 2..=20_000;
/// The largest distance of the neighbour at the start.
const FARTHEST: f64 = 0.1;
/// Two runs have separated if x, y or θ differ by more than this.
const SEPARATED: f64 = 1e-3;
/// The times per T, and at most, at which two runs are compared besides their impacts.
const LOOKS_PER_T: f64 = 20.0;
const MOST_LOOKS: u32 = 200_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    #[serde(default)]
    ghost: Option<f64>,
    #[serde(default)]
    samples: Option<u32>,
    /// A time window that has the same number of samples of its own.
    #[serde(default)]
    window: Option<[f64; 2]>,
}

impl Request {
    /// The times at which the motion is sent, once all but the values is known to be allowed.
    fn times(&self) -> Result<Times, CaseError> {
        let samples = self.samples.unwrap_or(3000);
        if !SAMPLES.contains(&samples) {
            let allowed = format!("{} <= samples <= {}", SAMPLES.start(), SAMPLES.end());
            return Err(CaseError::value("samples", samples, allowed));
        }
        if let Some(by) = self.ghost.filter(|by| !(*by > 0.0 && *by <= FARTHEST)) {
            let allowed = format!("a number, 0 < ghost <= {FARTHEST}, or null");
            return Err(CaseError::value("ghost", Value::Number(by), allowed));
        }
        let window = self.window;
        if let Some([from, to]) = window.filter(|[from, to]| !(0.0 <= *from && from < to)) {
            let allowed = "two times, 0 <= from < to, or null";
            return Err(CaseError::value(
                "window",
                format!("[{from}, {to}]"),
                allowed,
            ));
        }
        Ok(Times { samples, window })
    }
}

/// The answer, as JSON.
pub(crate) fn answer(request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let began = Instant::now();
    let sampling = request.times()?;
    let case = case(request.values)?;
    let followed = follow(&case, allowance)?;
    let (parameters, run) = (case.parameters(), &followed.run);
    let ghost = request
        .ghost
        .map(|by| Ghost::of(&case, by, sampling, run, allowance));
    let (ghost, ghost_error) = match ghost.transpose() {
        Ok(ghost) => (ghost, None),
        Err(refusal) => (None, Some(refusal.message().to_owned())),
    };
    let until = listed_until(run);
    let [impacts, modes] = listed(run, until);
    let shown = &run.impacts()[..impacts];
    let answer = Answer {
        values: CaseEcho(parameters),
        geometry: Geometry::of(parameters, run.system()),
        end: EndWithText::of(run, end_and_accumulation(&followed, parameters)),
        outcome: followed.outcome_if_certain(),
        norms: NormsRow::new(run.norms()),
        norms_known: &followed.norms_known,
        horizon: HorizonWithText::of(&followed),
        modes: Modes::of(&run.modes()[..modes]),
        impacts: Impacts {
            shown,
            digits: &followed.digits,
        },
        snaps: run
            .impacts()
            .iter()
            .filter(|impact| impact.v_n > 0.0)
            .count(),
        cut: until.map(|until| Cut {
            impacts: run.impacts().len(),
            shown: impacts,
            until,
        }),
        motion: Columns::of(run, shown, sampling),
        ghost,
        ghost_error,
        shell: shell_line(parameters),
        python: python_lines(parameters),
        took_ms: 1e3 * began.elapsed().as_secs_f64(),
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}

/// A run with its trust, within the budget.
pub(crate) fn follow(case: &Case, allowance: &Allowance) -> Result<RunWithHorizon, Refusal> {
    let allowance = allowance.within(BUDGET);
    let run = RunWithHorizon::run(case, &|progress| allowance.check(progress));
    run.map_err(|cancelled| too_long(case.parameters(), cancelled))
}

/// The refusal of a run that did not end within the budget.
pub(crate) fn too_long(parameters: &Parameters, Cancelled { done }: Cancelled) -> Refusal {
    Refusal::values(format!(
        "after {} s of computing this run has reached t = {done:.4} of {}\nhint: lower t_end or max_impacts, or run it \
         on the command line: {}",
        BUDGET.as_secs(),
        parameters.t_end,
        shell_line(parameters)
    ))
}

#[derive(Serialize)]
struct Answer<'a> {
    values: CaseEcho<'a>,
    geometry: Geometry,
    end: EndWithText,
    /// None where neighbours have to show it.
    outcome: Option<String>,
    norms: NormsRow,
    /// The number of known digits of each norm, in words.
    norms_known: &'a NormsKnown,
    horizon: HorizonWithText,
    modes: Modes,
    impacts: Impacts<'a>,
    /// The number of impacts of the whole run: the rows without those of impulses
    /// that passed into a taut cable.
    snaps: usize,
    cut: Option<Cut>,
    motion: Columns,
    ghost: Option<Ghost>,
    ghost_error: Option<String>,
    shell: String,
    python: String,
    took_ms: f64,
}

/// What is left out of a run of many events.
#[derive(Serialize)]
struct Cut {
    /// Rows of impacts.
    impacts: usize,
    shown: usize,
    /// The time of the first event that is left out.
    until: f64,
}

/// Up to when all events are listed; none if all of the run's are.
fn listed_until(run: &Trajectory) -> Option<f64> {
    let impact = run.impacts().get(MOST_SHOWN).map(|impact| impact.t);
    let mode = run.modes().get(MOST_SHOWN).map(|mode| mode.t_start);
    impact.into_iter().chain(mode).reduce(f64::min)
}

/// How many impacts and intervals are listed, given that time.
fn listed(run: &Trajectory, until: Option<f64>) -> [usize; 2] {
    let until = until.unwrap_or(f64::INFINITY);
    [
        run.impacts().partition_point(|impact| impact.t < until),
        run.modes().partition_point(|mode| mode.t_start < until),
    ]
}

/// The body and cables to draw, at rest.
#[derive(Serialize)]
struct Geometry {
    body: BodyGeometry,
    cables: Vec<CableGeometry>,
}

#[derive(Serialize)]
struct BodyGeometry {
    kind: &'static str,
    shape: &'static str,
    a: f64,
    b: f64,
}

/// A cable: its anchor, its end in the body's frame, its length.
#[derive(Serialize)]
struct CableGeometry {
    anchor: [f64; 2],
    arm: [f64; 2],
    length: f64,
}

impl Geometry {
    fn of(parameters: &Parameters, system: &System) -> Self {
        let shape = match system.body.shape() {
            Shape::Point => "point",
            Shape::Circle { .. } => "circle",
            Shape::Rectangle { .. } => "rectangle",
        };
        let body = BodyGeometry {
            kind: if parameters.is_point() {
                "point"
            } else {
                "rigid"
            },
            shape,
            a: parameters.a,
            b: parameters.b,
        };
        let cables = system.cables.iter().map(|cable| CableGeometry {
            anchor: cable.anchor().components(),
            arm: cable.fairlead().components(),
            length: cable.length(),
        });
        Self {
            body,
            cables: cables.collect(),
        }
    }
}

#[derive(Serialize)]
struct EndWithText {
    #[serde(flatten)]
    end: EndRow,
    words: String,
}

/// How a run ends, with the time at which impacts accumulate on a line of its own.
fn end_and_accumulation(followed: &RunWithHorizon, parameters: &Parameters) -> String {
    let end = followed.end_in_words(parameters);
    match accumulation_in_words(&followed.run) {
        Some(accumulation) => format!("{end}\n{accumulation}"),
        None => end,
    }
}

impl EndWithText {
    fn of(run: &Trajectory, words: String) -> Self {
        let end = EndRow::new(run.end());
        Self { end, words }
    }
}

#[derive(Serialize)]
struct HorizonWithText {
    #[serde(flatten)]
    horizon: HorizonRow,
    certain: bool,
    words: String,
}

impl HorizonWithText {
    fn of(followed: &RunWithHorizon) -> Self {
        Self {
            horizon: HorizonRow::new(followed.horizon),
            certain: followed.horizon.is_none(),
            words: followed.in_words(),
        }
    }
}

/// The mode intervals as columns.
#[derive(Serialize)]
struct Modes {
    taut: Vec<Vec<usize>>,
    t_start: Vec<f64>,
    t_end: Vec<f64>,
}

impl Modes {
    fn of(modes: &[ModeInterval]) -> Self {
        let taut = |mode: &ModeInterval| mode.taut.iter().map(|cable| cable + 1).collect();
        Self {
            taut: modes.iter().map(taut).collect(),
            t_start: modes.iter().map(|mode| mode.t_start).collect(),
            t_end: modes.iter().map(|mode| mode.t_end).collect(),
        }
    }
}

/// The impacts that the page shows as columns, under the names of `impacts.csv`.
struct Impacts<'a> {
    shown: &'a [Impact],
    /// Up to the horizon.
    digits: &'a [f64],
}

impl Serialize for Impacts<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        // An impact does not change the body's position.
        for column in IMPACTS
            .iter()
            .take_while(|column| column.name != "before_vx")
        {
            let rows = self.shown.iter().map(|impact| ImpactRow(*impact, 0.0));
            let cells: Vec<Cell> = rows.map(|row| Cell::new(column, &row)).collect();
            map.serialize_entry(column.name, &cells)?;
        }
        let digits = (0..self.shown.len()).map(|k| self.digits.get(k));
        map.serialize_entry("digits", &digits.collect::<Vec<_>>())?;
        map.end()
    }
}

/// The same run from a slightly different start.
#[derive(Serialize)]
struct Ghost {
    /// The key that differs, and the difference.
    key: &'static str,
    by: f64,
    motion: Columns,
    end: EndWithText,
    parts_at: Option<f64>,
}

impl Ghost {
    fn of(
        case: &Case,
        by: f64,
        sampling: Times,
        run: &Trajectory,
        allowance: &Allowance,
    ) -> Result<Self, Refusal> {
        let (key, by, neighbour) = neighbour(case, by)?;
        let allowance = allowance.within(BUDGET);
        let on_progress = |progress: Progress| allowance.check(progress);
        let other = record(neighbour.simulation(), &on_progress, |_, _| ())
            .map_err(|cancelled| too_long(neighbour.parameters(), cancelled))?;
        let shown = &other.impacts()[..other.impacts().len().min(MOST_SHOWN)];
        Ok(Self {
            key,
            by,
            motion: Columns::of(&other, shown, sampling),
            end: EndWithText::of(&other, end_in_words(&other, neighbour.parameters())),
            parts_at: separation_time(run, &other),
        })
    }
}

/// A neighbour of a case within reach of its cables: to the right, to the left, or higher.
fn neighbour(case: &Case, by: f64) -> Result<(&'static str, f64, Case), CaseError> {
    let at = |key, by| {
        let mut parameters = *case.parameters();
        match key {
            "x" => parameters.x += by,
            _ => parameters.y += by,
        }
        Case::new(parameters).map(|case| (key, by, case))
    };
    at("x", by)
        .or_else(|_| at("x", -by))
        .or_else(|_| at("y", by))
}

/// When two runs have separated, while both last: to rounding, whatever the times of the answer.
fn separation_time(run: &Trajectory, other: &Trajectory) -> Option<f64> {
    let (mut one, mut two) = (Playback::new(run), Playback::new(other));
    let apart = |p: &State, q: &State| {
        let distances = [p.x - q.x, p.y - q.y, p.theta - q.theta];
        distances.iter().any(|distance| distance.abs() > SEPARATED)
    };
    let end = run.end().t.min(other.end().t);
    let looks = ((LOOKS_PER_T * end).ceil() as u32).clamp(1, MOST_LOOKS);
    let evenly = (0..=looks).map(|k| end * f64::from(k) / f64::from(looks));
    // In slack flight the distances change evenly, so that they are largest at an impact of either.
    let impacts = [run, other].into_iter().flat_map(Trajectory::impacts);
    let mut times: Vec<f64> = impacts.map(|impact| impact.t).chain(evenly).collect();
    times.retain(|t| *t <= end);
    times.sort_unstable_by(f64::total_cmp);
    let mut apart_at = |t| apart(&one.at(t).state, &two.at(t).state);
    let at = times.iter().position(|t| apart_at(*t))?;
    let mut after = times[at];
    let mut before = if at == 0 {
        return Some(after);
    } else {
        times[at - 1]
    };
    loop {
        let middle = before + (after - before) / 2.0;
        if middle <= before || middle >= after {
            return Some(after);
        }
        match apart_at(middle) {
            true => after = middle,
            false => before = middle,
        }
    }
}
