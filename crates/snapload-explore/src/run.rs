//! `/api/run`: a run, all that the page draws of it.
use crate::refusal::Refusal;
use crate::request::{self, Values};
use crate::work::Leash;
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use snapload::{
    Case, CaseError, Impact, ModeInterval, Parameters, Playback, Shape, State, System, Trajectory,
    Value,
};
use snapload_report::{
    CaseEcho, EndRow, Followed, MotionRow, NormsRow, because, end_in_words, python_lines,
    shell_line, tables,
};
use std::time::{Duration, Instant};

/// What a run may take, its trust included, and the same again its neighbour.
const BUDGET: Duration = Duration::from_secs(2);
/// A page can not show more impacts than this, nor more intervals.
const MOST_SHOWN: usize = 10_000;
/// How many times the motion is told at, beside its impacts.
const SAMPLES: std::ops::RangeInclusive<u32> = 2..=20_000;
/// The neighbour's distance at the start is no larger than this.
const FARTHEST: f64 = 0.1;
/// Two runs have parted where x, y or θ differ by more than this.
const PARTED: f64 = 1e-3;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    #[serde(default)]
    values: Values,
    #[serde(default)]
    ghost: Option<f64>,
    #[serde(default)]
    samples: Option<u32>,
}

/// The answer, as JSON.
pub(crate) fn answer(body: &[u8], leash: &Leash) -> Result<Vec<u8>, Refusal> {
    let began = Instant::now();
    let Request {
        values,
        ghost,
        samples,
    } = request::read(body)?;
    let samples = samples.unwrap_or(3000);
    if !SAMPLES.contains(&samples) {
        let words = format!("samples = {samples} is not allowed; allowed: 2 <= samples <= 20000");
        return Err(Refusal::values(words));
    }
    if let Some(by) = ghost.filter(|by| !(*by > 0.0 && *by <= FARTHEST)) {
        let allowed = format!("a number, 0 < ghost <= {FARTHEST}, or null");
        return Err(CaseError::value("ghost", Value::Number(by), allowed).into());
    }
    let case = request::case(values)?;
    let followed = follow(&case, leash)?;
    let ghost = ghost.map(|by| ghost_of(&case, by, samples, &followed.run, leash));
    let (ghost, ghost_error) = match ghost.transpose() {
        Ok(ghost) => (ghost, None),
        Err(error) => (None, Some(error.words())),
    };
    let answer = Answer::new(&case, &followed, samples, ghost, ghost_error, began);
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}

/// A run with its trust, within the budget.
pub(crate) fn follow(case: &Case, leash: &Leash) -> Result<Followed, Refusal> {
    let leash = leash.within(BUDGET);
    let mut reached = 0.0;
    let run = Followed::run(case, |simulation| {
        reached = simulation.time();
        leash.holds()
    });
    run.ok_or_else(|| too_long(case.parameters(), reached))
}

fn too_long(parameters: &Parameters, reached: f64) -> Refusal {
    Refusal::values(format!(
        "after {} s of computing this run has come to t = {reached:.4} of {}\nhint: lower t_end or max_impacts, or run it \
         without the page: {}",
        BUDGET.as_secs(),
        parameters.t_end,
        shell_line(parameters)
    ))
}

#[derive(Serialize)]
struct Answer<'a> {
    values: CaseEcho<'a>,
    geometry: Geometry,
    end: EndTold,
    norms: NormsRow,
    horizon: HorizonTold,
    modes: Modes<'a>,
    impacts: Impacts<'a>,
    cut: Option<Cut>,
    motion: Columns,
    ghost: Option<Ghost>,
    ghost_error: Option<String>,
    shell: String,
    python: String,
    took_ms: f64,
}

impl<'a> Answer<'a> {
    fn new(
        case: &'a Case,
        followed: &'a Followed,
        samples: u32,
        ghost: Option<Ghost>,
        ghost_error: Option<String>,
        began: Instant,
    ) -> Self {
        let (parameters, run) = (case.parameters(), &followed.run);
        let shown = &run.impacts()[..run.impacts().len().min(MOST_SHOWN)];
        let modes = &run.modes()[..run.modes().len().min(MOST_SHOWN)];
        let motion = Columns::of(run, shown, samples);
        Self {
            values: CaseEcho(parameters),
            geometry: Geometry::of(parameters, run.system()),
            end: EndTold::of(run, parameters),
            norms: NormsRow::new(run.norms()),
            horizon: HorizonTold::of(followed),
            modes: Modes(modes),
            impacts: Impacts {
                shown,
                digits: (0..shown.len())
                    .map(|k| followed.digits.get(k).copied())
                    .collect(),
            },
            cut: (shown.len() < run.impacts().len()).then(|| Cut {
                impacts: run.impacts().len(),
                shown: shown.len(),
            }),
            motion,
            ghost,
            ghost_error,
            shell: shell_line(parameters),
            python: python_lines(parameters),
            took_ms: 1e3 * began.elapsed().as_secs_f64(),
        }
    }
}

#[derive(Serialize)]
struct Cut {
    impacts: usize,
    shown: usize,
}

/// What there is to draw, at rest.
#[derive(Serialize)]
struct Geometry {
    body: BodyTold,
    cables: Vec<CableTold>,
}

#[derive(Serialize)]
struct BodyTold {
    kind: &'static str,
    shape: &'static str,
    a: f64,
    b: f64,
}

/// A cable: its anchor, its end in the body's frame, its length.
#[derive(Serialize)]
struct CableTold {
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
        let body = BodyTold {
            kind: parameters.body.name(),
            shape,
            a: parameters.a,
            b: parameters.b,
        };
        let cables = system.cables.iter().map(|cable| CableTold {
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
struct EndTold {
    #[serde(flatten)]
    end: EndRow,
    words: String,
}

impl EndTold {
    fn of(run: &Trajectory, parameters: &Parameters) -> Self {
        Self {
            end: EndRow::new(run.end()),
            words: end_in_words(run, parameters),
        }
    }
}

#[derive(Serialize)]
struct HorizonTold {
    t: Option<f64>,
    impact: Option<usize>,
    because: Option<&'static str>,
    certain: bool,
    words: String,
}

impl HorizonTold {
    fn of(followed: &Followed) -> Self {
        let horizon = followed.horizon;
        Self {
            t: horizon.map(|horizon| horizon.t),
            impact: horizon.map(|horizon| horizon.impact),
            because: horizon.map(|horizon| because(horizon.cause)),
            certain: horizon.is_none(),
            words: followed.in_words(),
        }
    }
}

struct Modes<'a>(&'a [ModeInterval]);

impl Serialize for Modes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Told {
            taut: Vec<Vec<usize>>,
            t_start: Vec<f64>,
            t_end: Vec<f64>,
        }
        let taut = |mode: &ModeInterval| mode.taut.iter().map(|cable| cable + 1).collect();
        Told {
            taut: self.0.iter().map(taut).collect(),
            t_start: self.0.iter().map(|mode| mode.t_start).collect(),
            t_end: self.0.iter().map(|mode| mode.t_end).collect(),
        }
        .serialize(serializer)
    }
}

/// The impacts as columns; where the body is does not change in an impact.
struct Impacts<'a> {
    shown: &'a [Impact],
    /// Told as far as the horizon.
    digits: Vec<Option<f64>>,
}

impl Serialize for Impacts<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Told<'a> {
            t: Vec<f64>,
            cable: Vec<usize>,
            v_n: Vec<f64>,
            impulse: Vec<f64>,
            energy_lost: Vec<f64>,
            x: Vec<f64>,
            y: Vec<f64>,
            theta: Vec<f64>,
            digits: &'a [Option<f64>],
        }
        let numbers = |of: fn(&Impact) -> f64| self.shown.iter().map(of).collect();
        Told {
            t: numbers(|impact| impact.t),
            cable: self.shown.iter().map(|impact| impact.cable + 1).collect(),
            v_n: numbers(|impact| impact.v_n),
            impulse: numbers(|impact| impact.impulse),
            energy_lost: numbers(|impact| impact.energy_lost),
            x: numbers(|impact| impact.before.x),
            y: numbers(|impact| impact.before.y),
            theta: numbers(|impact| impact.before.theta),
            digits: &self.digits,
        }
        .serialize(serializer)
    }
}

/// A motion as columns, under the names of `motion.csv`.
struct Columns([Vec<f64>; 10]);

impl Columns {
    /// At evenly spaced times, and just before and just after each impact.
    fn of(run: &Trajectory, impacts: &[Impact], samples: u32) -> Self {
        let mut columns = Self(Default::default());
        let mut playback = Playback::new(run);
        let mut instants = impacts.chunk_by(|p, q| p.t == q.t).peekable();
        let mut latest = f64::NEG_INFINITY;
        for t in times(run, samples) {
            while let Some([first, ..]) = instants.next_if(|instant| instant[0].t <= t) {
                let mut before = playback.at(first.t.next_down());
                before.t = first.t;
                before.state = first.before;
                before.energy = run.system().energy(&first.before);
                columns.push(&MotionRow::new(&before));
                columns.push(&MotionRow::new(&playback.at(first.t)));
                latest = first.t;
            }
            if t > latest {
                columns.push(&MotionRow::new(&playback.at(t)));
            }
        }
        columns
    }

    fn push(&mut self, row: &MotionRow) {
        for (column, number) in self.0.iter_mut().zip(row.numbers()) {
            column.push(number);
        }
    }
}

impl Serialize for Columns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(tables::MOTION.iter().zip(&self.0))
    }
}

/// Evenly spaced times from the start to the end.
fn times(run: &Trajectory, samples: u32) -> impl Iterator<Item = f64> {
    let (end, last) = (run.end().t, samples - 1);
    (0..samples).map(move |k| match k == last {
        true => end,
        false => end * f64::from(k) / f64::from(last),
    })
}

/// The same run from a start that differs a little.
#[derive(Serialize)]
struct Ghost {
    /// The key that differs, and by how much.
    key: &'static str,
    by: f64,
    motion: Columns,
    end: EndTold,
    parts_at: Option<f64>,
}

fn ghost_of(
    case: &Case,
    by: f64,
    samples: u32,
    run: &Trajectory,
    leash: &Leash,
) -> Result<Ghost, Refusal> {
    let (key, by, neighbour) = neighbour(case, by)?;
    let leash = leash.within(BUDGET);
    let mut reached = 0.0;
    let other = Trajectory::record_while(neighbour.simulation(), |simulation, _| {
        reached = simulation.time();
        leash.holds()
    });
    let other = other.ok_or_else(|| too_long(neighbour.parameters(), reached))?;
    let shown = &other.impacts()[..other.impacts().len().min(MOST_SHOWN)];
    Ok(Ghost {
        key,
        by,
        motion: Columns::of(&other, shown, samples),
        end: EndTold::of(&other, neighbour.parameters()),
        parts_at: parting(run, &other, samples),
    })
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

/// When two runs have come apart, while both last.
fn parting(run: &Trajectory, other: &Trajectory, samples: u32) -> Option<f64> {
    let (mut one, mut two) = (Playback::new(run), Playback::new(other));
    let apart = |p: &State, q: &State| {
        let distances = [p.x - q.x, p.y - q.y, p.theta - q.theta];
        distances.iter().any(|distance| distance.abs() > PARTED)
    };
    times(run, samples)
        .take_while(|t| *t <= other.end().t)
        .find(|t| apart(&one.at(*t).state, &two.at(*t).state))
}
