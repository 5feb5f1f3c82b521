//! 6.5.2.1: the equations of rocking, against Newton's law with two multipliers.

use super::newton::{
    BOTH, Jet, Moment, Numbers, Sizes, derivatives, differences, identity, jet, length, over,
    sin_cos, tension_residual,
};
use super::numbers::{holds, max, min};
use super::runs::{FEW, near, past_settling, run, standard};
use super::verdict::{Checked, Checks, Claim, Finding, run_checks};
use crate::ReportError;
use crate::study::Study;
use snapload::{Playback, Real, TautSet, Trajectory, natural_inertia};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let (rocking, anywhere) = random_states();
    let material = Material {
        study,
        rocking,
        anywhere,
    };
    run_checks(&[CHECKS], &material)
}

/// Circles that rock, at random angles; and as many in any position, for comparing the gaps.
struct Material<'a> {
    study: &'a Study,
    rocking: Vec<Moment>,
    anywhere: Vec<Moment>,
}

const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5.2.1-01", |of| {
        identity(&of.anywhere, |state| {
            differences(
                eq_6_59_gaps(&state.sizes, state.place),
                BOTH.map(|side| state.gap(side)),
            )
        })
    }),
    ("6.5.2.1-02", |of| {
        identity(&of.rocking, |state| eq_6_59_gaps(&state.sizes, state.place))
    }),
    ("6.5.2.1-03", |of| {
        /// Gaps are dependent if the sine of the angle between their gradients is below this.
        const DEPENDENT: f64 = 1e-9;
        let least = min(of.rocking.iter().map(|state| {
            let [p, q] = BOTH.map(|side| state.gradient(side));
            length(cross(p, q)) / (length(p) * length(q))
        }));
        Ok(Finding::of(least > DEPENDENT)
            .value("states", of.rocking.len())
            .value("least", least))
    }),
    ("6.5.2.1-04", |of| {
        identity(&of.rocking, |state| {
            let ([_, _, theta], [_, _, rate]) = (state.place, state.velocity);
            let [_, _, newton] = state.with_both_taut().acceleration;
            let printed = eq_6_63_second(&state.sizes, theta, rate, state.force);
            [(printed - newton) / (1.0 + newton.abs())]
        })
    }),
    ("6.5.2.1-05", |of| {
        identity(&of.rocking, |state| {
            let printed = eq_6_66_factors(&state.sizes, state.place);
            BOTH.map(|side| differences(printed[side], state.gradient(side)))
                .concat()
        })
    }),
    ("6.5.2.1-06", |of| {
        let compression = over(&of.rocking, |state| {
            let lambda = state.with_both_taut().lambda;
            let factors = eq_6_66_factors(&state.sizes, state.place);
            // The residual relative to the size of the force, which is unbounded where the cables
            // are nearly in line.
            BOTH.map(|side| {
                let force = factors[side].map(|factor| factor * lambda[side]);
                let size = 2.0 * lambda[side].abs() * state.sizes.r;
                length(force.into_iter().take(2)) / size - 1.0
            })
        });
        let (tension, times) = tension_residual(&of.study.rocking.run, 2);
        let finding = Finding::of(holds(compression) && times > 0 && holds(tension));
        Ok(finding
            .value("residual", compression)
            .value("times", times)
            .value("tension", tension))
    }),
    ("6.5.2.1-07", loss),
    ("6.5.2.1-08", |_| rocking_square()),
];

/// 6.59, 6.60: the gaps of a circle.
fn eq_6_59_gaps(m: &Sizes, [x, y, theta]: [f64; 3]) -> [f64; 2] {
    let (s, c) = sin_cos(theta);
    let (a, h) = (m.a, m.h());
    let square = |z: f64| z * z;
    [
        square(1.0 - x - a * c) + square(h - y - a * s) - m.r * m.r,
        square(1.0 + x - a * c) + square(h - y + a * s) - m.r * m.r,
    ]
}

/// 6.61, 6.62: x and y of a rocking circle.
fn eq_6_61_place(m: &Sizes, theta: Jet) -> [Jet; 2] {
    let (s, c) = theta.sin_cos();
    let (a, h) = (m.a, m.h());
    let above = c * (2.0 * a) + (m.r * m.r - 1.0 - a * a);
    let below = c * (-2.0 * a) + (1.0 + a * a);
    let y = (c * a - 1.0) * above.sqrt() / below.sqrt() + h;
    let x = (y - h) * s * a / (c * -a + 1.0);
    [x, y]
}

/// 6.63 with 6.65: θ̈ of a rocking circle.
fn eq_6_63_second(m: &Sizes, theta: f64, rate: f64, force: [f64; 2]) -> f64 {
    let [[_, dx, ddx], [_, dy, ddy]] = eq_6_61_place(m, jet([theta, 1.0, 0.0])).map(derivatives);
    let generalized = force[0] * dx + force[1] * dy;
    let velocity_term = rate * rate * (dx * ddx + dy * ddy);
    (generalized - dy - velocity_term) / (m.i + dx * dx + dy * dy)
}

/// The factors of λ1 and λ2 in 6.66, 6.67, 6.68.
fn eq_6_66_factors(m: &Sizes, [x, y, theta]: [f64; 3]) -> [[f64; 3]; 2] {
    let (s, c) = sin_cos(theta);
    let (a, h) = (m.a, m.h());
    [
        [
            2.0 * (-1.0 + x + a * c),
            2.0 * (y - h + a * s),
            2.0 * a * ((1.0 - x) * s - (h - y) * c),
        ],
        [
            2.0 * (1.0 + x - a * c),
            2.0 * (y - h - a * s),
            2.0 * a * ((1.0 + x) * s + (h - y) * c),
        ],
    ]
}

/// The number of random states.
const STATES: usize = 600;
/// Their seed.
const SEED: u64 = 6_521;

fn random_states() -> (Vec<Moment>, Vec<Moment>) {
    let mut numbers = Numbers::new(SEED);
    let state = |_| {
        let a = numbers.between(0.05, 0.6);
        let (r, b, i) = (numbers.between(1.2, 3.0), 0.0, a * a);
        let sizes = Sizes { a, b, r, i };
        let (theta, rate) = (numbers.between(-1.5, 1.5), numbers.normal(1.5));
        let force = [0.4, 0.4].map(|deviation| numbers.normal(deviation));
        let [x, y] = eq_6_61_place(&sizes, jet([theta, rate, 0.0])).map(derivatives);
        let rocking = Moment {
            sizes,
            place: [x[0], y[0], theta],
            velocity: [x[1], y[1], rate],
            force,
        };
        let place = [numbers.normal(0.5), numbers.normal(0.5), theta];
        (rocking, Moment { place, ..rocking })
    };
    (0..STATES).map(state).unzip()
}

fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

/// The cables that stay taut by the signs of λ1 and λ2.
fn by_signs(state: &Moment) -> TautSet {
    let lambda = state.with_both_taut().lambda;
    BOTH.into_iter()
        .filter(|side| lambda[*side] < 0.0)
        .collect()
}

/// The cables that stay taut: no cable pushes, no gap becomes positive, and each cable pulls or
/// goes slack. Of the four possible sets the one with the least violation.
fn complementary(state: &Moment) -> TautSet {
    let w = |p, q| state.coupling(p, q);
    let opening = BOTH.map(|side| state.opening(side));
    let failure = |taut: TautSet| {
        let lambda = state.with_taut(taut).lambda;
        let fails = BOTH.map(|side| {
            if taut.contains(side) {
                lambda[side] * w(side, side)
            } else {
                opening[side] + w(side, 1 - side) * lambda[1 - side]
            }
        });
        fails[0].max(fails[1])
    };
    let all: TautSet = BOTH.into_iter().collect();
    let best = all
        .subsets()
        .min_by(|p, q| failure(*p).total_cmp(&failure(*q)));
    best.unwrap_or(TautSet::SLACK)
}

/// The same state under the wave force for which the tension of one cable is just below zero.
fn at_loss(state: &Moment, side: usize) -> Option<Moment> {
    /// λ of a cable that has just lost its tension.
    const LAMBDA_AT_LOSS: f64 = 1e-6;
    let [_, fy] = state.force;
    let with = |fx| Moment {
        force: [fx, fy],
        ..*state
    };
    let of = |moment: &Moment| moment.with_both_taut().lambda;
    let start = of(&with(0.0))[side];
    let slope = of(&with(1.0))[side] - start;
    let lost = with((LAMBDA_AT_LOSS - start) / slope);
    // The other one must pull by more than rounding.
    (slope.abs() > 1e-3 && of(&lost)[1 - side] < -1e-3).then_some(lost)
}

/// The losses of tension of a run that rocks: their number, and after how many the motion continues
/// with the cable that still pulls.
fn losses_of(run: &Trajectory) -> (usize, usize) {
    let mut playback = Playback::new(run);
    let pairs = run.modes().windows(2).filter(|pair| pair[0].taut.len() > 1);
    let agree = pairs.map(|pair| {
        let mode = pair[0];
        let near = mode.t_end - 1e-6 * (mode.t_end - mode.t_start);
        let tensions = playback.at(near).tensions;
        let harder = |i: &usize, j: &usize| tensions[*i].total_cmp(&tensions[*j]);
        mode.taut.iter().max_by(harder).map(TautSet::only) == Some(pair[1].taut)
    });
    let agree: Vec<bool> = agree.collect();
    (agree.len(), agree.iter().filter(|agree| **agree).count())
}

/// How long a run rocks, and the largest gap of a cable during that.
fn rocked(run: &Trajectory) -> [f64; 2] {
    /// The number of times at which a rocking is evaluated.
    const TIMES: i32 = 200;
    let mut playback = Playback::new(run);
    let rocking = run.modes().iter().filter(|mode| mode.taut.len() > 1);
    let (mut time, mut widest) = (0.0, 0.0_f64);
    for mode in rocking {
        let lasts = mode.t_end - mode.t_start;
        time += lasts;
        for k in 0..TIMES {
            let t = mode.t_start + lasts * f64::from(k) / f64::from(TIMES);
            let state = playback.at(t).state;
            let cables = run.system().cables.iter();
            widest = cables.fold(widest, |widest, cable| widest.max(cable.gap(&state).abs()));
        }
    }
    [time, widest]
}

/// Whether a rocking was computed: it lasts, and no gap opens.
fn is_solved([time, widest]: [f64; 2]) -> bool {
    time > 0.0 && holds(widest)
}

/// Whether the rocking of a body with a height can not be computed.
fn rocking_square() -> Checked {
    let case = past_settling(standard(|p| {
        (p.a, p.b, p.f_o, p.t_end) = (0.2, 0.2, 0.1, 30.0);
        p.inertia = natural_inertia(p.a, p.b);
    }));
    let members = near(&case, FEW, |case| Ok(rocked(&run(case)?)))?;
    let solved = members.iter().all(|found| is_solved(*found));
    Ok(Finding::robust(&members, |found| !is_solved(*found))
        .values("size until", [case.a, case.t_end])
        .list("time", members.iter().map(|found| found[0]))
        .value("gap", max(members.iter().map(|found| found[1])))
        .condition("solved", solved))
}

fn loss(of: &Material) -> Checked {
    let rocking = past_settling(standard(|p| p.f_o = 0.4));
    let losses = near(&rocking, FEW, |case| Ok(losses_of(&run(case)?)))?;
    let at_losses = |state: &Moment| BOTH.map(|side| at_loss(state, side));
    let lost: Vec<Moment> = of.rocking.iter().flat_map(at_losses).flatten().collect();
    let same = |states: &[Moment]| {
        let agree = |state: &&Moment| by_signs(state) == complementary(state);
        states.iter().filter(agree).count()
    };
    let (at_loss, anywhere) = (same(&lost), same(&of.rocking));
    let of_states = !lost.is_empty() && at_loss == lost.len();
    let words = losses
        .iter()
        .map(|(seen, slid)| format!("{slid} of {seen}"));
    Ok(
        Finding::robust(&losses, |(seen, slid)| of_states && seen == slid)
            .values("at_loss lost", [at_loss, lost.len()])
            .value("by_start", words.collect::<Vec<_>>().join(", "))
            .values("anywhere states", [anywhere, of.rocking.len()]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_that_opens_and_a_rocking_that_is_none_are_not_solved() {
        assert!(is_solved([20.0, 1e-15]));
        assert!(!is_solved([20.0, 1e-3]) && !is_solved([0.0, 0.0]));
    }
}
