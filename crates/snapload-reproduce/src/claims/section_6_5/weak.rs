//! Weak rocking: the example of eq. 6.69.

use super::Material;
use super::example::{LOW, Rocking};
use crate::ReportError;
use crate::claims::motions::CLEAR;
use crate::claims::numbers::{max, mean, min, spearman};
use crate::claims::runs::case;
use crate::claims::verdict::{Checked, Checks, Finding};
use snapload::{Impact, Motion, State, System};

pub(super) const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5.2.2-05", |of| {
        let low = |of: &Rocking| of.motion.iter().all(|now| now.state.y < LOW);
        let widest = |of: &Rocking| {
            [
                largest(of, |now| now.state.y),
                largest(of, |now| now.state.theta.abs()),
            ]
        };
        Ok(
            Finding::robust(&of.weak, |of| of.keeps_rocking() && low(of))
                .list("from", of.weak.iter().map(|of| of.start))
                .by_start("widest", of.weak.iter().map(widest))
                .value("low", LOW),
        )
    }),
    ("6.5.2.2-06", |of| {
        let on = of.weak.iter().filter(|of| of.keeps_rocking()).count();
        let held = |of: &Rocking| of.keeps_rocking() && of.least_tension() > 0.0;
        Ok(Finding::robust(&of.weak, held)
            .values("on starts", [on, of.weak.len()])
            .list("tension", of.weak.iter().map(Rocking::least_tension)))
    }),
    ("6.5.2.2-07", |of| {
        /// The longest waiting time that counts as none.
        const AT_ONCE: f64 = 0.01;
        let waits: Vec<f64> = of.weak.iter().map(|of| of.start - sticks(of)).collect();
        Ok(Finding::robust(&waits, |wait| *wait < AT_ONCE)
            .list("sticks", of.weak.iter().map(sticks))
            .values(
                "least most at_once",
                [
                    min(waits.iter().copied()),
                    max(waits.iter().copied()),
                    AT_ONCE,
                ],
            ))
    }),
    ("6.5.2.2-08", |of| {
        let forces: Vec<Forces> = of.weak.iter().map(Forces::of).collect();
        Ok(Finding::robust(&forces, |of| of.wave_is_horizontal())
            .list("ratio", forces.iter().map(|of| of.vertical / of.horizontal))
            .value("little", NEGLIGIBLE_RATIO))
    }),
    ("6.5.2.2-15", |of| {
        let forces: Vec<Forces> = of.weak.iter().map(Forces::of).collect();
        let ratio = |of: &Forces| of.weight / of.horizontal;
        Ok(Finding::robust(&forces, |of| of.horizontal_controls())
            .list("ratio", forces.iter().map(ratio))
            .condition("weight_counts", forces.iter().all(|of| ratio(of) >= 1.0)))
    }),
    ("6.5.2.2-09", |of| {
        let members = bouncing(of)?;
        let lowest = |of: &[Above]| min(of.iter().map(|impact| impact.height));
        let lowest_clear = |of: &Vec<Above>| lowest(&clear(of));
        let above = |of: &Vec<Above>| lowest(of) >= -ROUNDING && lowest_clear(of) > 0.0;
        let below = max(members.iter().map(|of| -lowest(of)));
        Ok(Finding::robust(&members, above)
            .list("impacts", members.iter().map(|of| of.len() as f64))
            .list("clear", members.iter().map(|of| clear(of).len() as f64))
            .list("lowest_clear", members.iter().map(lowest_clear))
            .values("below plain", [below.max(0.0), CLEAR]))
    }),
    ("6.5.2.2-10", |of| {
        /// The least rank correlation that counts as a relation.
        const GOES_WITH: f64 = 0.5;
        let rho = bouncing(of)?
            .into_iter()
            .map(|of| rotation_against_height(&clear(&of)));
        let finding = Finding::measured("rho", rho, |rho| rho > GOES_WITH);
        Ok(finding.values("goes_with plain", [GOES_WITH, CLEAR]))
    }),
    ("6.5.2.2-11", |of| {
        /// The largest distance from a circle, as a part of its radius, that counts as circular.
        const ROUND: f64 = 0.01;
        let system = of.weak[0].run.system();
        let (widest, wide) = (largest(&of.weak[0], |now| now.state.theta.abs()), 1.4);
        let ((radius, miss), (_, miss_wide)) =
            (fit_circle(system, widest), fit_circle(system, wide));
        Ok(Finding::of(miss < ROUND)
            .values("widest radius wide", [widest, radius, wide])
            .values(
                "miss miss_wide round",
                [miss, miss_wide, ROUND].map(|part| 100.0 * part),
            ))
    }),
];

/// The largest value of a quantity while rocking.
fn largest(of: &Rocking, figure: impl Fn(&Motion) -> f64) -> f64 {
    max(of.motion.iter().map(figure))
}

/// When the first cable sticks.
fn sticks(of: &Rocking) -> f64 {
    let first = of.run.modes().iter().find(|mode| !mode.taut.is_empty());
    first.map_or(f64::NAN, |mode| mode.t_start)
}

/// An impact relative to the arc on which the body rocks.
#[derive(Clone, Copy)]
struct Above {
    clear: bool,
    /// Height of the centre above the arc at the same x.
    height: f64,
    /// Rotation relative to that on the arc at the same x.
    turned: f64,
}

/// Heights below this have a sign that depends on rounding.
const ROUNDING: f64 = 1e-9;

/// The impacts of the bouncing, until the first cable sticks: those of the motion in many digits,
/// then of its neighbours.
fn bouncing(of: &Material) -> Result<Vec<Vec<Above>>, ReportError> {
    let own = &case(of.study, "1910001000-159")?.exact;
    let mut members = vec![above_arc(own.system(), own.impacts().iter())];
    for neighbour in &of.weak[1..] {
        let until = sticks(neighbour);
        let hits = neighbour.run.impacts().iter().filter(|hit| hit.t < until);
        members.push(above_arc(neighbour.run.system(), hits));
    }
    Ok(members)
}

fn above_arc<'a>(system: &System, hits: impl Iterator<Item = &'a Impact>) -> Vec<Above> {
    let above = hits.map(|hit| {
        let arc = on_arc(system, 0, hit.before.x);
        Above {
            clear: hit.v_n > CLEAR,
            height: hit.before.y - arc.y,
            turned: (hit.before.theta - arc.theta).abs(),
        }
    });
    above.collect()
}

/// The impacts that are visible in a plot.
fn clear(impacts: &[Above]) -> Vec<Above> {
    impacts
        .iter()
        .filter(|impact| impact.clear)
        .copied()
        .collect()
}

/// Rank correlation of the height above the arc and the rotation relative to that on it.
fn rotation_against_height(impacts: &[Above]) -> f64 {
    let points = impacts.iter().map(|hit| (hit.height, hit.turned));
    spearman(&points.collect::<Vec<_>>())
}

/// The position at which both cables are straight, for a given x (0) or θ (2): Newton's iteration
/// in the two other coordinates, followed from the lowest position.
fn on_arc(system: &System, given: usize, value: f64) -> State {
    let steps = 8;
    let [p, q] = if given == 0 { [1, 2] } else { [0, 1] };
    let at = |[x, y, theta]: [f64; 3]| State::from_components([x, y, theta, 0.0, 0.0, 0.0]);
    let mut place = [0.0; 3];
    for k in 1..=steps {
        place[given] = value * f64::from(k) / f64::from(steps);
        for _ in 0..12 {
            let state = at(place);
            let (sine, cosine) = state.theta.sin_cos();
            // Half of each gap and of its gradient.
            let [(a, gap_a), (b, gap_b)] = [0, 1].map(|k| {
                let cable = &system.cables[k];
                let ([x, y], lever) = (
                    cable.span(&state).components(),
                    cable.lever(sine, cosine).components(),
                );
                ([x, y, y * lever[0] - x * lever[1]], 0.5 * cable.gap(&state))
            });
            let determinant = a[p] * b[q] - a[q] * b[p];
            place[p] += (a[q] * gap_b - b[q] * gap_a) / determinant;
            place[q] += (b[p] * gap_a - a[p] * gap_b) / determinant;
        }
    }
    at(place)
}

/// Generalised forces on the rotation while the body rocks, as root mean squares: of the horizontal
/// and of the vertical component of the wave, and of the weight.
#[derive(Clone, Copy)]
struct Forces {
    horizontal: f64,
    vertical: f64,
    weight: f64,
}

impl Forces {
    fn of(rocking: &Rocking) -> Self {
        let forcing = &rocking.run.system().forcing;
        let turning = |now: &&Motion| now.state.vtheta.abs() > 1e-3;
        let squares = |force: &dyn Fn(&Motion) -> f64| {
            let moving = rocking.motion.iter().filter(turning);
            mean(moving.map(|now| (force(now) / now.state.vtheta).powi(2))).sqrt()
        };
        let weight = forcing.constant.y;
        Self {
            horizontal: squares(&|now| forcing.at(now.t).x * now.state.vx),
            vertical: squares(&|now| (forcing.at(now.t).y - weight) * now.state.vy),
            weight: squares(&|now| weight * now.state.vy),
        }
    }

    /// Whether the horizontal component of the wave dominates the vertical one.
    fn wave_is_horizontal(self) -> bool {
        self.vertical < NEGLIGIBLE_RATIO * self.horizontal
    }

    /// Whether the horizontal force also dominates the weight.
    fn horizontal_controls(self) -> bool {
        self.wave_is_horizontal() && self.weight < self.horizontal
    }
}

/// The largest ratio at which a force is negligible.
const NEGLIGIBLE_RATIO: f64 = 0.2;

/// Radius of the circle x² + y² = 2my + c nearest to the arc, and its largest distance from the arc
/// as a part of the radius. The arc is symmetric, so the centre has x = 0.
fn fit_circle(system: &System, widest: f64) -> (f64, f64) {
    let theta = |k: i32| widest * f64::from(k) / 20.0;
    let points: Vec<State> = (-20..=20).map(|k| on_arc(system, 2, theta(k))).collect();
    let square = |p: &State| p.x * p.x + p.y * p.y;
    let mean = |figure: &dyn Fn(&State) -> f64| mean(points.iter().map(figure));
    let (y, s) = (mean(&|p| p.y), mean(&square));
    let slope = mean(&|p| (p.y - y) * (square(p) - s)) / mean(&|p| (p.y - y).powi(2));
    let centre = 0.5 * slope;
    let radius = (s - slope * y + centre * centre).sqrt();
    let miss = |p: &State| (p.x.hypot(p.y - centre) - radius).abs() / radius;
    (radius, max(points.iter().map(miss)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_the_weight_outdoes_does_not_control() {
        let with = |vertical, weight| Forces {
            horizontal: 1.0,
            vertical,
            weight,
        };
        assert!(with(0.1, 0.5).horizontal_controls());
        assert!(with(0.1, 2.1).wave_is_horizontal() && !with(0.1, 2.1).horizontal_controls());
        assert!(!with(0.3, 0.5).wave_is_horizontal());
    }

    #[test]
    fn what_turns_less_the_higher_it_is_does_not_turn_away() {
        let with = |turned: [f64; 3]| {
            let impact = |k: usize| Above {
                clear: true,
                height: k as f64,
                turned: turned[k],
            };
            rotation_against_height(&[0, 1, 2].map(impact))
        };
        assert!(with([0.1, 0.2, 0.3]) > 0.5 && with([0.3, 0.2, 0.1]) < 0.0);
    }
}
