//! Stroboscopic sections of long motions, and diagrams of them against a key.

use crate::exponents::{Directions, exponents};
use crate::growth::Growth;
use crate::hybrid::{Point, distance};
use crate::impact_map::Impacts;
use crate::moored::period_of;
use snapload::analysis::{Cancelled, OnProgress, Progress};
use snapload::{CaseError, Parameters, PrescribedTaut, Simulation, State, Step, Stop, Tangent};

/// The section points of a long motion, at t = (phase + k) T.
#[derive(Clone, Debug)]
pub struct Section {
    /// The state at each kept instant.
    pub points: Vec<Point>,
    /// The index k of the first of them, which is the number of periods left out.
    pub first: u64,
    /// The time at which the motion began, and the period of the forcing.
    pub(crate) clock: [f64; 2],
    /// Snaps in each of the kept periods.
    pub snaps: Vec<u64>,
    /// The impacts one by one, if they were requested.
    pub impacts: Option<Impacts>,
    /// The Lyapunov exponents over the kept periods, the largest first, each with its standard
    /// error, which is NaN if there are too few periods; empty if they were not requested. For a
    /// direction that contact closes it is −∞.
    pub exponents: Vec<[f64; 2]>,
    /// How often in the kept periods one more cable became taut to stay so: the number of times
    /// that at least one was, at least two, and so on.
    pub contacts: Vec<u64>,
    /// The state at the end of the motion, and its time.
    pub end: (Point, f64),
    /// The highest y and the largest |θ|.
    pub y_max: f64,
    /// The largest |θ|.
    pub theta_max: f64,
    /// Why it stopped, if it did so early.
    pub stop: Option<Stop>,
    /// How far deviations have grown; none if exponents were not requested.
    pub growth: Option<Growth>,
}

/// How long a motion is followed.
#[derive(Clone, Copy, Debug)]
pub struct SectionOptions {
    /// Time of the section, in periods of the forcing.
    pub phase: f64,
    /// Periods that are left out.
    pub skip: u64,
    /// Periods that are kept.
    pub keep: u64,
    /// Whether exponents are computed.
    pub exponents: bool,
    /// Whether impacts are kept one by one.
    pub impacts: bool,
}

/// A motion counts as periodic if its section points agree to within this, over the number of laps
/// that follows.
const SAME: f64 = 1e-8;
pub(crate) const LAPS: usize = 8;
/// Whether the motion still approaches one of fewer periods is seen in at least this many laps, if
/// the changes of distances differ by more than this, and by more than this many roundings of the
/// time, to which the phase of the forcing is known.
const FEWEST_LAPS: usize = 5;
const KNOWN_DISTANCE: f64 = 1e-12;
const ROUNDINGS: f64 = 4.0;
/// A lap whose ends differ by more than this part of the distance between points fewer periods
/// apart does not follow the motion that is approached, but comes to it.
const FOLLOWED: f64 = 0.25;
/// The longest period that is searched for.
pub const LONGEST_PERIOD: usize = 64;

impl Section {
    /// Follows the motion of a case from its start; settling and sliding do not stop it.
    ///
    /// # Errors
    /// A [`CaseError`] if the start or an option is not legal; [`Cancelled`] if the work is
    /// cancelled.
    pub fn of(
        parameters: &Parameters,
        options: &SectionOptions,
        on_progress: OnProgress,
    ) -> Result<Self, snapload::analysis::Unfinished> {
        let period = period_of(parameters)?;
        let z = start_of(parameters);
        let t_start = options.phase * period;
        Self::from(parameters, (t_start, &z), options, on_progress)
    }

    /// The same from a state at a time.
    ///
    /// # Errors
    /// As for [`Section::of`].
    pub fn from(
        parameters: &Parameters,
        (t, z): (f64, &Point),
        options: &SectionOptions,
        on_progress: OnProgress,
    ) -> Result<Self, snapload::analysis::Unfinished> {
        let period = period_of(parameters)?;
        if !options.phase.is_finite() {
            let error = CaseError::value("phase", options.phase, "a finite number of periods");
            return Err(error.into());
        }
        let Some(last) = options.skip.checked_add(options.keep) else {
            let allowed = format!("at most {} more periods", u64::MAX - options.skip);
            return Err(CaseError::value("keep", options.keep, allowed).into());
        };
        let mut rules = parameters.rules();
        (rules.settled_below, rules.sliding_above) = (None, None);
        rules.t_end = t + period * last as f64;
        rules.max_impacts = u64::MAX;
        let state = State::from_components(*z);
        let simulation = Simulation::new(parameters.system(), rules, t, state);
        let simulation = simulation.map_err(|error| {
            CaseError::value(
                "start",
                snapload::Value::Text(format!("{z:?}")),
                error.to_string(),
            )
        })?;
        let prescribed = PrescribedTaut::new(parameters.system());
        let mut follow = Follow {
            linearised: options.exponents.then(|| {
                (
                    Tangent::new(prescribed.system()),
                    Directions::new(parameters),
                )
            }),
            prescribed,
            logs: Vec::new(),
            taut_steps: 0,
            next: options.skip,
            period,
            t_start: t,
            section: Section {
                points: Vec::new(),
                first: options.skip,
                clock: [t, period],
                snaps: Vec::new(),
                impacts: options.impacts.then(Impacts::default),
                exponents: Vec::new(),
                contacts: Vec::new(),
                end: (*z, t),
                y_max: z[1],
                theta_max: z[2].abs(),
                stop: None,
                growth: options.exponents.then(Growth::default),
            },
        };
        follow.run(simulation, last, on_progress)?;
        Ok(follow.section)
    }

    /// The points with the indices k of their instants, and the instants themselves.
    pub fn points_with_times(&self) -> impl Iterator<Item = (u64, f64, &Point)> {
        let [begun, period] = self.clock;
        let points = (self.first..).zip(&self.points);
        points.map(move |(k, point)| (k, begun + period * k as f64, point))
    }

    /// Its shortest period in periods of the forcing, if it is periodic.
    pub fn period(&self) -> Option<usize> {
        let points = &self.points;
        let repeats = |n: &usize| {
            let from = points.len() - n * self.laps();
            (from..points.len()).all(|k| distance(&points[k], &points[k - n]) <= SAME)
        };
        let found = (1..=self.longest_period()).find(repeats)?;
        let approached = |d: &usize| found.is_multiple_of(*d) && self.approaches(found, *d);
        (1..found).find(approached).or(Some(found))
    }

    /// Whether a motion that returns after `n` periods to within the accuracy approaches one of `d`
    /// periods, a part of them: slowly, so that points `d` apart still differ by more, but by less
    /// from lap to lap. The slowest approach shows only over all laps that follow the motion of `n`
    /// periods; those before them say nothing about its end.
    fn approaches(&self, n: usize, d: usize) -> bool {
        let all = (self.points.len() - n) / n;
        let follows = |back: &usize| {
            let [lap, part] = [n, d].map(|by| self.apart(*back, n, by));
            lap <= FOLLOWED * part
        };
        let followed = (0..all).take_while(follows).count();
        let enough = |laps: &usize| (FEWEST_LAPS..=all).contains(laps);
        let mut laps = [self.laps(), followed].into_iter().filter(enough);
        laps.any(|laps| self.approaches_over(laps, n, d))
    }

    /// The largest distance of points `by` periods apart in a lap of `n` periods, counted back from
    /// the last one.
    fn apart(&self, back: usize, n: usize, by: usize) -> f64 {
        let end = self.points.len() - n * back;
        let apart = (end - n..end).map(|k| distance(&self.points[k], &self.points[k - by]));
        apart.fold(0.0, f64::max)
    }

    fn approaches_over(&self, laps: usize, n: usize, d: usize) -> bool {
        let off = |lap: usize| self.apart(laps - 1 - lap, n, d);
        // A geometric sequence of distances, from its values at three laps.
        let half = (laps - 1) / 2;
        let [first, middle, last] = [0, half, 2 * half].map(off);
        let [before, after] = [first - middle, middle - last];
        let known = KNOWN_DISTANCE.max(ROUNDINGS * f64::EPSILON * self.end.1.abs());
        if after <= 0.0 || before - after < known {
            return false;
        }
        let limit = last - after * after / (before - after);
        limit < 0.5 * last
    }

    /// The mean number of snaps in a period of the forcing, over whole laps of a motion of `period`
    /// periods; none if there is no whole lap, or a lap has no period.
    pub fn snaps_per_period(&self, period: Option<usize>) -> Option<f64> {
        let count = self.snaps.len();
        let over = period.map_or(Some(count), |n| Some(count - count.checked_rem(n)?))?;
        let snaps: u64 = self.snaps[count - over..].iter().sum();
        (over > 0).then(|| snaps as f64 / over as f64)
    }

    fn count_contacts(&mut self, before: usize, after: usize) {
        self.contacts.resize(self.contacts.len().max(after), 0);
        for count in self.contacts.iter_mut().take(after).skip(before) {
            *count += 1;
        }
    }

    /// Whether the time at which it stopped is known in spite of rounding, as far as deviations
    /// grow smoothly; none if it did not stop, or their growth was not followed.
    pub fn stop_is_certain(&self) -> Option<bool> {
        self.stop?;
        self.end_is_certain()
    }

    /// The same of the state at its end, whether or not it stopped; none if the growth of
    /// deviations was not followed.
    pub fn end_is_certain(&self) -> Option<bool> {
        self.growth.map(Growth::end_is_known)
    }

    /// The longest period that can be detected with this many points.
    pub fn longest_period(&self) -> usize {
        let laps = self.laps();
        (self.points.len() / (laps + 1)).min(LONGEST_PERIOD)
    }

    /// The number of laps that have to agree.
    fn laps(&self) -> usize {
        LAPS.min((self.points.len() / 2).max(1))
    }
}

/// The start of a case.
pub fn start_of(p: &Parameters) -> Point {
    [p.x, p.y, p.theta, p.vx, p.vy, p.vtheta]
}

/// A motion that is followed.
struct Follow {
    prescribed: PrescribedTaut,
    /// The deviations, if exponents are computed.
    linearised: Option<(Tangent, Directions)>,
    /// The logarithms of the growth at the beginning of each kept period.
    logs: Vec<Vec<f64>>,
    /// The steps of the kept periods in which cables were taut.
    taut_steps: u64,
    /// The next section.
    next: u64,
    period: f64,
    t_start: f64,
    section: Section,
}

impl Follow {
    fn run(
        &mut self,
        mut simulation: Simulation,
        last: u64,
        on_progress: OnProgress,
    ) -> Result<(), Cancelled> {
        let kept_from = self.t_start + self.period * self.section.first as f64;
        while let Some(step) = simulation.step() {
            self.sections_within(&step, last);
            if step.t_end > kept_from {
                self.taut_steps += u64::from(!step.taut.is_empty());
                let snaps = step.impacts().filter(|impact| impact.v_n > 0.0);
                let count = snaps.count() as u64;
                self.section.snaps.resize(self.section.points.len(), 0);
                if let Some(last) = self.section.snaps.last_mut() {
                    *last += count;
                }
                self.section
                    .count_contacts(step.taut.len(), step.taut_after.len());
                if let Some(impacts) = &mut self.section.impacts {
                    impacts.take(&step, self.period);
                }
            }
            if let Some((tangent, directions)) = &mut self.linearised {
                let map = tangent.of_step(&simulation, &step);
                let magnified = directions.follow(&map, &step);
                self.section
                    .growth
                    .get_or_insert_default()
                    .follow(magnified);
            }
            let periods = (step.t_end - self.t_start) / self.period;
            Progress::new("following the motion", periods, last as f64).report(on_progress)?;
        }
        let section = &mut self.section;
        section.end = (simulation.state().components(), simulation.time());
        section.y_max = simulation.y_max();
        section.theta_max = simulation.theta_max();
        section.stop = simulation.stop().filter(|stop| *stop != Stop::EndTime);
        if section.stop.is_none() {
            section.points.push(section.end.0);
        }
        // A period that a stop cuts short does not count.
        section
            .snaps
            .resize(section.points.len().saturating_sub(1), 0);
        let taut_steps = self.taut_steps as f64 / section.snaps.len().max(1) as f64;
        if let Some((_, directions)) = &self.linearised {
            let growth = (&self.logs[..], directions.slow_logs());
            section.exponents = exponents(growth, section.first, self.period, taut_steps);
        }
        Ok(())
    }

    /// Keeps the sections before the end of a step; the last one is the end of the motion.
    fn sections_within(&mut self, step: &Step, last: u64) {
        while self.next < last {
            let t = self.t_start + self.period * self.next as f64;
            if t >= step.t_end {
                return;
            }
            let s = t - step.t_start;
            let state = self
                .prescribed
                .carried(step.taut, step.t_start, &step.start, s);
            self.section.points.push(state.components());
            if let Some((_, directions)) = &mut self.linearised {
                directions.close_from_now_on();
                self.logs.push(directions.logs());
            }
            self.next += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that alternate about (0.1, 0.2) at a distance that falls to a limit by a factor each
    /// period, with errors of the size of roundings of the time.
    fn alternating(limit: f64, beyond: f64, factor: f64, periods: u32) -> Section {
        let length = 1.6;
        let point = |k: u32| {
            let off = limit + beyond * factor.powf(f64::from(k));
            let sign = 1.0 - 2.0 * f64::from(k % 2);
            let t = length * f64::from(periods + k);
            let error = f64::EPSILON * t * (f64::from(k) * 2.4).sin();
            [
                0.1 + sign * off,
                0.2 - 0.5 * sign * off + error,
                0.0,
                0.3,
                0.4,
                0.0,
            ]
        };
        section_of((0..=1000).map(point).collect(), periods, length)
    }

    /// The section of a motion from its points, after a number of periods of this length.
    fn section_of(points: Vec<Point>, first: u32, length: f64) -> Section {
        Section {
            end: (
                points[points.len() - 1],
                length * (f64::from(first) + points.len() as f64 - 1.0),
            ),
            points,
            first: u64::from(first),
            clock: [0.0, length],
            snaps: Vec::new(),
            impacts: None,
            exponents: Vec::new(),
            contacts: Vec::new(),
            y_max: 0.0,
            theta_max: 0.0,
            stop: None,
            growth: None,
        }
    }

    /// Just before a period doubling a motion alternates for long about an orbit of one period, and
    /// just after it for ever.
    #[test]
    fn what_is_slowly_approached_is_told_from_what_repeats_itself() {
        for periods in [400, 9000, 39_000] {
            for factor in [0.999, 0.9996, 0.9999] {
                for beyond in [2e-8, 5e-8, 1e-7] {
                    let before = alternating(0.0, beyond, factor, periods);
                    assert_eq!(before.period(), Some(1), "{periods} {factor} {beyond}");
                    let after = alternating(1e-7, beyond, factor, periods);
                    assert_eq!(after.period(), Some(2), "{periods} {factor} {beyond}");
                }
            }
        }
    }

    /// A motion that jumps about as x -> 4 x (1 - x) does and then, from one moment to the next,
    /// goes round few points.
    #[test]
    fn what_comes_before_a_motion_settles_has_no_say_in_its_period() {
        for start in 1..200 {
            let (settles, period) = (start % 67, 2 + start % 5);
            let mut x = f64::from(start) / 200.0;
            let point = |k: u32| {
                x *= 4.0 * (1.0 - x);
                let angle = std::f64::consts::TAU * f64::from(k % period) / f64::from(period);
                let y = match k < settles {
                    true => x,
                    false => 0.5 + 0.01 * angle.cos(),
                };
                [0.0, y, 0.0, 0.0, 0.0, 0.0]
            };
            let points: Vec<Point> = (0..settles + 10 * period + start % 7).map(point).collect();
            let found = section_of(points, 0, 1.6).period();
            assert_eq!(found, Some(period as usize), "from {start}/200");
        }
    }
}
