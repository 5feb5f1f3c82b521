//! The extremes of a lap between its events, which show whether it is admissible.
//!
//! A point that closes the composed map need not be a motion: a gap may be positive between events,
//! a tension negative, a snap may open instead of close. These quantities are sampled along the
//! lap, and their extremes then refined.

use crate::hybrid::{DURATION, Family, Hybrid, Jet, Limits, Point, constant};
use crate::lap::{Lap, Leg};
use crate::roots::{golden, root};
use crate::sequence::Event;
use snapload::{Limit, TautSet};

/// Samples of a leg for each period of the forcing, without and with held surfaces, and the least
/// number of samples of a leg.
const SAMPLES: f64 = 160.0;
const TAUT_SAMPLES: f64 = 64.0;
const FEWEST_SAMPLES: f64 = 6.0;
/// A limit that is never closer than this needs no refinement.
const FAR_FROM_LIMIT: f64 = 0.05;

/// An extreme value along a lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The surface to which it belongs.
    pub surface: usize,
    /// The leg, or the event at its end.
    pub leg: usize,
    /// When.
    pub t: f64,
}

/// The extremes along a lap.
#[derive(Clone, Debug)]
pub struct Survey {
    /// The largest gap of a surface at a closest approach between events, as a length.
    pub largest_gap: Option<Extreme>,
    /// The largest gap of a surface at an instant when another one is struck.
    pub corner_gap: Option<Extreme>,
    /// The same within accumulations: however slow their snaps are, one surface is all but touched
    /// there at the snaps of another.
    pub accumulated_gap: Option<Extreme>,
    /// The least tension of held surfaces. At the end of a leg where a surface is released its
    /// tension is zero whatever the lap is, so that this does not count.
    pub least_tension: Option<Extreme>,
    /// The slowest fall of the tension of a surface that is released; negative if it rises there
    /// instead, so that the surface would have to push before.
    pub slowest_release: Option<Extreme>,
    /// The least closing velocity of the surfaces struck.
    pub least_speed: Option<Extreme>,
    /// The shortest time from one event to the next of another surface.
    pub shortest: Option<Extreme>,
    /// The highest y, and the largest |θ|.
    pub y_max: f64,
    /// The largest |θ|.
    pub theta_max: f64,
    /// The limits at their closest, and the times.
    pub limits: Limits,
}

/// A gap, a tension or a velocity of the wrong sign counts as zero below this.
const ROUNDING: f64 = 1e-9;

impl Survey {
    /// Of no leg at all.
    const EMPTY: Self = Self {
        largest_gap: None,
        corner_gap: None,
        accumulated_gap: None,
        least_tension: None,
        slowest_release: None,
        least_speed: None,
        shortest: None,
        y_max: f64::NEG_INFINITY,
        theta_max: 0.0,
        limits: [f64::NEG_INFINITY; Limit::ALL.len()],
    };

    /// The least tension, or the slowest fall to a release if that is less: where it changes its
    /// sign a surface no longer holds as the lap has it.
    pub(crate) fn slackest(&self) -> Option<Extreme> {
        let both = [self.least_tension, self.slowest_release];
        let less = |a: &Extreme, b: &Extreme| a.value.total_cmp(&b.value);
        both.into_iter().flatten().min_by(less)
    }

    /// The largest gaps between events and at them.
    pub(crate) fn gaps(&self) -> impl Iterator<Item = Extreme> {
        let gaps = [self.largest_gap, self.corner_gap, self.accumulated_gap];
        gaps.into_iter().flatten()
    }

    /// Whether no surface is passed while snaps accumulate.
    pub(crate) fn accumulates_in_order(&self) -> bool {
        self.accumulated_gap.is_none_or(|gap| gap.value <= ROUNDING)
    }

    /// Why no body can have the lap, whose events follow each other by these durations.
    pub fn why_not(&self, durations: &[f64]) -> Vec<String> {
        let mut why = Vec::new();
        let cable = |surface: usize| surface + 1;
        if let Some(snap) = self.least_speed.filter(|snap| snap.value < -ROUNDING) {
            why.push(format!(
                "the snap of cable {} at t = {:.6} would have a negative velocity, v_n = {:.3e}",
                cable(snap.surface),
                snap.t,
                snap.value
            ));
        }
        for gap in self.gaps() {
            if gap.value > ROUNDING {
                why.push(format!(
                    "cable {} would have to be {:.3e} longer at t = {:.6}",
                    cable(gap.surface),
                    gap.value,
                    gap.t
                ));
            }
        }
        if let Some(tension) = self.least_tension.filter(|least| least.value < -ROUNDING) {
            why.push(format!(
                "the tension of cable {} is negative, {:.6} at t = {:.6}: it would have to push",
                cable(tension.surface),
                tension.value,
                tension.t
            ));
        }
        if durations.iter().any(|s| *s < -ROUNDING) {
            why.push("two events would have to come in the other order".to_owned());
        }
        for (beyond, limit) in self.limits.iter().zip(Limit::ALL) {
            if *beyond > ROUNDING {
                let name = limit.stop().label();
                why.push(format!("the {name} is exceeded by {beyond:.3e}"));
            }
        }
        why
    }
}

/// Finds the extremes along the legs of a lap.
pub fn survey<F: Family>(lap: &Lap<F>, system: &F::Plain, legs: &[Leg]) -> Survey {
    let mut found = Survey::EMPTY;
    let period = lap.family.forcing_period(lap.at).value;
    let sampler = Sampler {
        family: lap.family,
        system,
        at: lap.at,
        period,
    };
    let mut before = lap.sequence.last();
    let between = between_events(system, legs);
    let accumulating = lap.timed(system, legs).accumulating();
    for (k, leg) in legs.iter().enumerate() {
        if between[k].s > 0.0 {
            // The last leg ends at the section, or at the first event if that comes before it.
            let ends_last = || lap.sequence.events.first().filter(|_| legs[0].s < 0.0);
            let event = lap.sequence.events.get(k).or_else(ends_last);
            let released = event.map_or(TautSet::SLACK, Event::released);
            sampler.leg(k, &between[k], [before, released], &mut found);
        }
        let Some(event) = lap.sequence.events.get(k) else {
            continue;
        };
        let t = leg.t + leg.s;
        let at = |value, surface| Extreme {
            value,
            surface,
            leg: k,
            t,
        };
        for surface in event.struck().iter() {
            let speed = system.speed(surface, &leg.end);
            least(&mut found.least_speed, at(speed, surface));
        }
        let busy = event.struck().union(leg.taut).union(event.after);
        for surface in system.surfaces().iter().filter(|&s| !busy.contains(s)) {
            if !event.struck().is_empty() {
                let kept = match accumulating[k] {
                    true => &mut found.accumulated_gap,
                    false => &mut found.corner_gap,
                };
                most(kept, at(system.gap(surface, &leg.end), surface));
            }
        }
        if k > 0 && lap.sequence.events[k - 1].surface() != event.surface() {
            least(&mut found.shortest, at(leg.s, event.surface()));
        }
        before = leg.taut;
    }
    found
}

/// The legs, of which the last one ends at the first event where that has passed the section, and
/// the first one begins at the last event where that has passed the next section.
fn between_events<H: Hybrid<f64>>(system: &H, legs: &[Leg]) -> Vec<Leg> {
    let mut between = legs.to_vec();
    let last = between.len() - 1;
    let [early, late] = [0, last].map(|k| legs[k].s.min(0.0));
    between[last].s += early;
    if late < 0.0 {
        let first = &mut between[0];
        first.start = system.flow(first.taut, first.t, &first.start, -late);
        first.t -= late;
        first.s += late;
    }
    between
}

fn least(kept: &mut Option<Extreme>, other: Extreme) {
    if kept.is_none_or(|kept| other.value < kept.value) {
        *kept = Some(other);
    }
}

fn most(kept: &mut Option<Extreme>, other: Extreme) {
    if kept.is_none_or(|kept| other.value > kept.value) {
        *kept = Some(other);
    }
}

/// Finds extremes along legs.
struct Sampler<'a, F: Family> {
    family: &'a F,
    system: &'a F::Plain,
    at: [f64; 2],
    period: f64,
}

impl<F: Family> Sampler<'_, F> {
    /// The extremes of a leg, of the surfaces held before it and of those released at its end.
    fn leg(&self, k: usize, leg: &Leg, [before, released]: [TautSet; 2], found: &mut Survey) {
        let density = if leg.taut.is_empty() {
            SAMPLES
        } else {
            TAUT_SAMPLES
        };
        let count = (density * leg.s / self.period).ceil().max(FEWEST_SAMPLES) as usize;
        let path = self.system.path(leg.taut, leg.t, &leg.start, leg.s);
        let sampled = Sampled {
            width: leg.s / count as f64,
            samples: (0..=count)
                .map(|i| path(leg.s * i as f64 / count as f64))
                .collect(),
            path: &path,
        };
        self.gaps(k, leg, before, &sampled, found);
        self.tensions(k, leg, released, &sampled, found);
        let height = sampled.highest(&|_, z| z[1]).0;
        let turned = match self.family.variables().contains(&2) {
            true => sampled.highest(&|_, z| z[2].abs()).0,
            false => 0.0,
        };
        found.y_max = found.y_max.max(height);
        found.theta_max = found.theta_max.max(turned);
        for limit in 0..Limit::ALL.len() {
            let beyond = |_: f64, z: &Point| self.family.limits(self.system, z)[limit];
            if beyond(0.0, &leg.start).is_finite() {
                let rough = sampled
                    .samples
                    .iter()
                    .map(|z| beyond(0.0, z))
                    .fold(f64::MIN, f64::max);
                let value = if rough > -FAR_FROM_LIMIT {
                    sampled.highest(&beyond).0
                } else {
                    rough
                };
                found.limits[limit] = found.limits[limit].max(value);
            }
        }
    }

    /// The least tensions, and how they fall where surfaces are released.
    fn tensions(
        &self,
        k: usize,
        leg: &Leg,
        released: TautSet,
        sampled: &Sampled,
        found: &mut Survey,
    ) {
        let at = |value, surface, s| Extreme {
            value,
            surface,
            leg: k,
            t: leg.t + s,
        };
        for surface in leg.taut.iter() {
            let push = |s: f64, z: &Point| -self.system.tension(surface, leg.taut, leg.t + s, z);
            if !released.contains(surface) {
                let (push, s) = sampled.highest(&push);
                least(&mut found.least_tension, at(-push, surface, s));
                continue;
            }
            let fall = -self.tension_rate(leg, surface);
            least(&mut found.slowest_release, at(fall, surface, leg.s));
            let (push, s) = sampled.highest_before_end(&push, fall < 0.0);
            least(&mut found.least_tension, at(-push, surface, s));
        }
    }

    /// The rate of a surface's tension at the end of a leg.
    fn tension_rate(&self, leg: &Leg, surface: usize) -> f64 {
        let jets = self.family.jets(self.at);
        let start: Point<Jet> = leg.start.map(constant);
        let [t, s] = [constant(leg.t), Jet::variable(leg.s, DURATION)];
        let end = jets.flow(leg.taut, t, &start, s);
        jets.tension(surface, leg.taut, t + s, &end).slope[DURATION]
    }

    /// The times of closest approach of slack surfaces, where v_n goes from positive to negative.
    fn gaps(
        &self,
        k: usize,
        leg: &Leg,
        before: TautSet,
        Sampled {
            samples,
            width,
            path,
        }: &Sampled,
        found: &mut Survey,
    ) {
        for surface in self
            .system
            .surfaces()
            .iter()
            .filter(|&s| !leg.taut.contains(s))
        {
            // A surface that has just been released opens as the cube of time, so that its v_n is
            // only rounding at first.
            let first = usize::from(before.contains(surface));
            let speeds: Vec<f64> = samples
                .iter()
                .map(|z| self.system.speed(surface, z))
                .collect();
            for i in first..samples.len() - 1 {
                if !(speeds[i] > 0.0 && speeds[i + 1] <= 0.0) {
                    continue;
                }
                let speed = |s: f64| self.system.speed(surface, &path(s));
                let [from, to] = [i, i + 1].map(|i| width * i as f64);
                let s = root(&speed, (from, speeds[i]), (to, speeds[i + 1]));
                let extreme = Extreme {
                    value: self.system.gap(surface, &path(s)),
                    surface,
                    leg: k,
                    t: leg.t + s,
                };
                most(&mut found.largest_gap, extreme);
            }
        }
    }
}

/// A leg, and its states at evenly spaced times.
struct Sampled<'a> {
    samples: Vec<Point>,
    width: f64,
    path: &'a dyn Fn(f64) -> Point,
}

impl Sampled<'_> {
    fn values(&self, of: &dyn Fn(f64, &Point) -> f64) -> Vec<f64> {
        let samples = self.samples.iter().enumerate();
        let values = samples.map(|(i, z)| of(self.width * i as f64, z));
        values.collect()
    }

    /// The largest value of a function along the leg, and when.
    fn highest(&self, of: &dyn Fn(f64, &Point) -> f64) -> (f64, f64) {
        let values = self.values(of).into_iter().enumerate();
        let largest = values.fold((0, f64::NEG_INFINITY), |best, (i, value)| {
            if value > best.1 { (i, value) } else { best }
        });
        self.refined(of, largest)
    }

    /// The same without the leg's end, towards which the function may rise: the largest of its
    /// values at the start and at its peaks; `falls` says whether it falls towards the end, from a
    /// peak that may lie between the last two samples.
    fn highest_before_end(&self, of: &dyn Fn(f64, &Point) -> f64, falls: bool) -> (f64, f64) {
        let values = self.values(of);
        let last = values.len() - 1;
        let is_peak = |i: &usize| {
            let follows = *i == 0 || values[*i] >= values[*i - 1];
            follows && (*i == last || values[*i] >= values[*i + 1])
        };
        let peaks = (0..last + usize::from(falls)).filter(is_peak);
        let peaks = peaks.map(|i| self.refined(of, (i, values[i])));
        peaks.fold(
            (values[0], 0.0),
            |best, peak| {
                if peak.0 > best.0 { peak } else { best }
            },
        )
    }

    /// The largest value of a function near the sample at which it is largest, and when.
    fn refined(&self, of: &dyn Fn(f64, &Point) -> f64, (place, best): (usize, f64)) -> (f64, f64) {
        let last = self.samples.len() - 1;
        let (low, high) = (place.saturating_sub(1), (place + 1).min(last));
        let begin = self.width * low as f64;
        let at = |s: f64| of(begin + s, &(self.path)(begin + s));
        let (s, value) = golden(&at, self.width * (high - low) as f64);
        match value > best {
            true => (value, begin + s),
            false => (best, self.width * place as f64),
        }
    }
}
