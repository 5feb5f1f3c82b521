//! The composed map: flow to an event, law, flow to the next, for a given sequence of events, and
//! its derivatives.
//!
//! The times from event to event are unknowns in addition to the state, so that neither an orbit's
//! instability nor a snap of zero velocity is a problem for Newton's method:
//!
//! ```text
//! F(z, s) = ( P(z, s) − z,  h_1, …, h_N ) = 0,      h_k the gap, or the tension, at event k
//! ```
//!
//! If the times follow from the state, δs_k = −(∂h_k δz + ∂_t h_k δt)/(∂_s h_k), the same
//! derivatives give the saltation matrices and their product, the monodromy matrix.

use crate::hybrid::{
    DURATION, Family, Hybrid, Jet, PARAMETER, Point, TIME, distance, values, variable,
};
use crate::sequence::{Event, EventKind, Sequence, Timed};
use nalgebra::{DMatrix, DVector};
use snapload::TautSet;

/// A sequence of events of a system, with its duration.
pub struct Lap<'a, F: Family> {
    /// The systems.
    pub family: &'a F,
    /// The values of the two parameters.
    pub at: [f64; 2],
    /// The events.
    pub sequence: &'a Sequence,
    /// Time of the section, in periods of the forcing.
    pub phase: f64,
    /// Its duration in periods of the forcing.
    pub periods: u32,
}

/// One leg of a lap over plain numbers: from after an event to before the next.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// The held surfaces.
    pub taut: TautSet,
    /// When it begins.
    pub t: f64,
    /// The state then.
    pub start: Point,
    /// How long it lasts.
    pub s: f64,
    /// The state at its end, before the event there.
    pub end: Point,
}

/// Two section states closer than this are the same.
pub(crate) const SAME: f64 = 1e-8;

/// Up to this number of events all unknowns of a lap are solved for together.
const SOLVED_TOGETHER: usize = 64;

/// The derivatives of a jet, without its value.
type Slopes = [f64; 10];

/// One leg and the event at its end, linearised.
struct Linear {
    /// Zero at the event, and its derivatives; none at the section.
    event: Option<(f64, Slopes)>,
    /// The state after the event, and its derivatives by the variables at the leg's start.
    after: Point,
    slopes: [Slopes; 6],
}

/// A lap, linearised.
pub struct Linearised {
    /// The derivatives of the state at the section, projected onto its surfaces: by the state given,
    /// and by the parameters, as lengths move the surfaces.
    placed: [Slopes; 6],
    legs: Vec<Linear>,
    /// Derivatives of the lap's length by the two parameters, and of the time of the section.
    length_slopes: [f64; 2],
    start_slopes: [f64; 2],
}

impl<F: Family> Lap<'_, F> {
    /// The time of the section and the length of the lap.
    pub fn times(&self) -> (f64, f64) {
        let period = self.family.forcing_period(self.at).value;
        (self.phase * period, f64::from(self.periods) * period)
    }

    /// The duration of the last leg, from the last event to the section.
    pub(crate) fn last_leg(&self, durations: &[f64]) -> f64 {
        let (t_start, length) = self.times();
        t_start + length - durations.iter().fold(t_start, |t, s| t + s)
    }

    /// Its legs over doubles.
    pub fn legs(&self, system: &F::Plain, z: &Point, durations: &[f64]) -> Vec<Leg> {
        let (mut t, _) = self.times();
        let start = self.sequence.start;
        let mut z = system.placed(start, start, z);
        let taut_sets = self.sequence.taut_sets();
        let mut legs = Vec::with_capacity(taut_sets.len());
        for (k, taut) in taut_sets.into_iter().enumerate() {
            let s = durations.get(k).copied();
            let s = s.unwrap_or_else(|| self.last_leg(durations));
            let end = system.flow(taut, t, &z, s);
            legs.push(Leg {
                taut,
                t,
                start: z,
                s,
                end,
            });
            t += s;
            if let Some(event) = self.sequence.events.get(k) {
                z = after(system, event, &end);
            }
        }
        legs
    }

    /// Its events with their times and velocities, from its legs.
    pub(crate) fn timed(&self, system: &F::Plain, legs: &[Leg]) -> Timed {
        let events = self.sequence.events.iter().zip(legs);
        let speed = |(event, leg): (&Event, &Leg)| {
            let struck = event.struck().iter().next();
            struck.map_or(0.0, |surface| system.speed(surface, &leg.end))
        };
        Timed {
            sequence: self.sequence.clone(),
            durations: events.clone().map(|(_, leg)| leg.s).collect(),
            speeds: events.map(speed).collect(),
        }
    }

    /// The state at the section after a number of periods of the forcing, from its legs.
    fn section(&self, system: &F::Plain, legs: &[Leg], periods: u32) -> Point {
        let (t_start, length) = self.times();
        let t = t_start + length / f64::from(self.periods) * f64::from(periods);
        let leg = legs.iter().rfind(|leg| leg.t <= t).unwrap_or(&legs[0]);
        match periods {
            0 => leg.start,
            _ => system.flow(leg.taut, leg.t, &leg.start, t - leg.t),
        }
    }

    /// The states at all of its sections, one for each period of the forcing, from its legs.
    pub fn sections(&self, system: &F::Plain, legs: &[Leg]) -> Vec<Point> {
        let section = |k| self.section(system, legs, k);
        (0..self.periods).map(section).collect()
    }

    /// The number of periods after which it first returns to within 1e-8 of its start; it is
    /// smaller than `periods` if the lap repeats a shorter orbit.
    pub fn smallest_periods(&self, system: &F::Plain, legs: &[Leg]) -> u32 {
        let is_back = |k: &u32| {
            self.periods.is_multiple_of(*k)
                && distance(&self.section(system, legs, *k), &legs[0].start) < SAME
        };
        (1..self.periods).find(is_back).unwrap_or(self.periods)
    }

    /// Its derivatives.
    pub fn linearise(&self, z: &Point, durations: &[f64]) -> Linearised {
        let system = self.family.jets(self.at);
        let period = self.family.forcing_period(self.at);
        let (mut t, _) = self.times();
        let start = self.sequence.start;
        let placed = system.placed(start, start, &variable(z));
        let mut state = values(&placed);
        let mut legs = Vec::new();
        for (k, taut) in self.sequence.taut_sets().into_iter().enumerate() {
            let s = durations.get(k).copied();
            let s = s.unwrap_or_else(|| self.last_leg(durations));
            let [at, lasts] = [Jet::variable(t, TIME), Jet::variable(s, DURATION)];
            let reached = system.flow(taut, at, &variable(&state), lasts);
            let leg = match self.sequence.events.get(k) {
                None => Linear::new(None, &reached),
                Some(event) => {
                    let zero = match event.kind {
                        EventKind::Snap { .. } => system.gap(event.surface(), &reached),
                        EventKind::Release(_) => {
                            system.tension(event.surface(), taut, at + lasts, &reached)
                        }
                    };
                    Linear::new(Some(zero), &after(&system, event, &reached))
                }
            };
            state = leg.after;
            t += s;
            legs.push(leg);
        }
        let by = |factor: f64| [0, 1].map(|i| period.slope[PARAMETER + i] * factor);
        Linearised {
            placed: placed.map(|row| row.slope),
            legs,
            length_slopes: by(f64::from(self.periods)),
            start_slopes: by(self.phase),
        }
    }
}

/// The state after an event.
pub(crate) fn after<T: snapload::Real>(
    system: &impl Hybrid<T>,
    event: &Event,
    z: &Point<T>,
) -> Point<T> {
    match event.kind {
        EventKind::Snap { struck, pulling } => {
            let (z, _) = system.law(struck, pulling, z);
            system.placed(TautSet::SLACK, event.after, &z)
        }
        EventKind::Release(_) => *z,
    }
}

impl Linear {
    fn new(event: Option<Jet>, after: &Point<Jet>) -> Self {
        Self {
            event: event.map(|jet| (jet.value, jet.slope)),
            after: values(after),
            slopes: after.map(|jet| jet.slope),
        }
    }
}

/// A row of derivatives by the unknowns: of the state in columns, of the durations, of parameters.
type Rows = DMatrix<f64>;

impl Linearised {
    /// How many events there are.
    pub fn events(&self) -> usize {
        self.legs.len() - 1
    }

    /// F and its derivatives by the state's `variables`, the durations, and `parameters` of the
    /// two.
    pub fn equations(
        &self,
        z: &Point,
        variables: &[usize],
        parameters: usize,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let (m, n) = (variables.len(), self.events());
        let columns = m + n + parameters;
        let mut residual = DVector::zeros(m + n);
        let mut jacobian = DMatrix::zeros(m + n, columns);
        let mut state = self.start(variables, columns);
        let mut time = DMatrix::zeros(1, columns);
        for i in 0..parameters {
            time[m + n + i] = self.start_slopes[i];
            for (row, slopes) in self.placed.iter().enumerate() {
                state[(row, m + n + i)] = slopes[PARAMETER + i];
            }
        }
        let t_start = time.clone();
        for (k, leg) in self.legs.iter().enumerate() {
            let mut lasts = DMatrix::zeros(1, columns);
            match leg.event {
                Some((zero, slopes)) => {
                    lasts[m + k] = 1.0;
                    residual[m + k] = zero;
                    let row = chained(&slopes, &state, &time, &lasts, m + n, parameters);
                    jacobian.row_mut(m + k).copy_from(&row);
                }
                None => {
                    lasts = &t_start - &time;
                    for i in 0..parameters {
                        lasts[m + n + i] += self.length_slopes[i];
                    }
                }
            }
            state = moved(&leg.slopes, &state, &time, &lasts, m + n, parameters);
            time += lasts;
        }
        if let Some(last) = self.legs.last() {
            for (row, &i) in variables.iter().enumerate() {
                residual[row] = last.after[i] - z[i];
                jacobian.row_mut(row).copy_from(&state.row(i));
                jacobian[(row, row)] -= 1.0;
            }
        }
        (residual, jacobian)
    }

    /// The largest residual of F, and Newton's step of the state's `variables` and the durations;
    /// none if the equations are singular.
    ///
    /// Up to `SOLVED_TOGETHER` events all unknowns are solved for together, so that a snap of zero
    /// velocity does no harm. Longer sequences are those in which snaps accumulate; there the
    /// durations are eliminated one after the other, each by the event that ends it, as the cost of
    /// solving all together grows with the cube of their number.
    pub fn step(&self, z: &Point, variables: &[usize]) -> (f64, Option<DVector<f64>>) {
        if self.events() > SOLVED_TOGETHER {
            return self.step_in_turn(z, variables);
        }
        let (residual, jacobian) = self.equations(z, variables, 0);
        let size = residual.amax();
        let step = jacobian.lu().solve(&(-residual));
        (size, step)
    }

    /// The same with the durations eliminated: rows are over the state, with a constant at the end.
    pub fn step_in_turn(&self, z: &Point, variables: &[usize]) -> (f64, Option<DVector<f64>>) {
        let m = variables.len();
        let mut state = self.start(variables, m + 1);
        let mut time = DMatrix::zeros(1, m + 1);
        let zero = DMatrix::zeros(1, m + 1);
        let mut durations = Vec::with_capacity(self.events());
        let mut largest = 0.0_f64;
        for leg in &self.legs {
            let lasts = match leg.event {
                Some((value, slopes)) => {
                    largest = largest.max(value.abs());
                    let mut row = chained(&slopes, &state, &time, &zero, m, 0);
                    row[m] += value;
                    durations.push(row * (-1.0 / slopes[DURATION]));
                    durations[durations.len() - 1].clone()
                }
                None => -&time,
            };
            state = moved(&leg.slopes, &state, &time, &lasts, m, 0);
            time += lasts;
        }
        let Some(last) = self.legs.last() else {
            return (largest, None);
        };
        let off = DVector::from_fn(m, |i, _| last.after[variables[i]] - z[variables[i]]);
        largest = largest.max(off.amax());
        let matrix = DMatrix::from_fn(m, m, |i, j| {
            state[(variables[i], j)] - f64::from(u8::from(i == j))
        });
        let constant = DVector::from_fn(m, |i, _| state[(variables[i], m)]);
        let solved = matrix.lu().solve(&(-(off + constant)));
        let step = solved.map(|solved| {
            let by = |row: &Rows| (row.columns(0, m) * &solved)[0] + row[m];
            let parts = durations.iter().map(by);
            let all: Vec<f64> = solved.iter().copied().chain(parts).collect();
            DVector::from_vec(all)
        });
        (largest, step)
    }

    /// The monodromy matrix ∂P/∂z over the `variables`, with the times those of the events.
    pub fn monodromy(&self, variables: &[usize]) -> DMatrix<f64> {
        let m = variables.len();
        let state = self.start(variables, m);
        let end = self.carried(state, |_, _| ());
        DMatrix::from_fn(m, m, |i, j| end[(variables[i], j)])
    }

    /// Deviations of the state, as columns, carried through the lap. `after_leg` may replace them,
    /// with the delays of the event, by combinations of them after each of its legs.
    pub(crate) fn carried(
        &self,
        mut state: Rows,
        mut after_leg: impl FnMut(&mut Rows, &mut Rows),
    ) -> Rows {
        let m = state.ncols();
        let mut time = DMatrix::zeros(1, m);
        for leg in &self.legs {
            let zero = DMatrix::zeros(1, m);
            let lasts = match leg.event {
                Some((_, slopes)) => {
                    chained(&slopes, &state, &time, &zero, m, 0) * (-1.0 / slopes[DURATION])
                }
                None => -&time,
            };
            state = moved(&leg.slopes, &state, &time, &lasts, m, 0);
            time += lasts;
            after_leg(&mut state, &mut time);
        }
        state
    }

    /// Deviations of the `variables` at the start, as columns.
    pub(crate) fn start(&self, variables: &[usize], columns: usize) -> Rows {
        let mut rows = DMatrix::zeros(6, columns);
        for i in 0..6 {
            for (column, &j) in variables.iter().enumerate() {
                rows[(i, column)] = self.placed[i][j];
            }
        }
        rows
    }
}

/// The derivatives of a number by the unknowns, from those by the variables at the leg's start.
fn chained(
    slopes: &Slopes,
    state: &Rows,
    time: &Rows,
    lasts: &Rows,
    first: usize,
    parameters: usize,
) -> Rows {
    let mut row = time * slopes[TIME] + lasts * slopes[DURATION];
    for (i, slope) in slopes[..6].iter().enumerate() {
        if *slope != 0.0 {
            row += state.row(i) * *slope;
        }
    }
    for i in 0..parameters {
        row[first + i] += slopes[PARAMETER + i];
    }
    row
}

fn moved(
    slopes: &[Slopes; 6],
    state: &Rows,
    time: &Rows,
    lasts: &Rows,
    first: usize,
    parameters: usize,
) -> Rows {
    let mut rows = DMatrix::zeros(6, state.ncols());
    for (i, slopes) in slopes.iter().enumerate() {
        let row = chained(slopes, state, time, lasts, first, parameters);
        rows.row_mut(i).copy_from(&row);
    }
    rows
}
