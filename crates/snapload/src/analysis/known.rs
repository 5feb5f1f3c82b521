//! How far the sums of a run are known: its norms, from the errors of its impacts.

use crate::analysis::trust::Trust;
use crate::model::rules::Stop;
use crate::model::state::State;
use crate::motion::impact::Impact;
use crate::motion::playback::Playback;
use crate::motion::trajectory::{RHO2_UNTIL, Trajectory};

/// Errors of the norms over the impacts, each two standard deviations or more \[L/T\]; none where
/// impacts past the horizon enter the norm, of which nothing is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormErrors {
    /// Of ρ1 = max v_n⁻.
    pub rho1: Option<f64>,
    /// Of ρ2 = Σ v_n⁻ over t ≤ 10.
    pub rho2: Option<f64>,
    /// Of ρ3 = Σ v_n⁻.
    pub rho3: Option<f64>,
    /// Of the highest y \[L\]; none where the run is not certain to its end, or reaches it after its
    /// last impact with a cable taut, as no error is told there.
    pub y_max: Option<f64>,
    /// Of the largest |θ| \[rad\], likewise.
    pub theta_max: Option<f64>,
}

impl NormErrors {
    /// Of a run, by what is known of its impacts.
    pub fn of(run: &Trajectory, trust: &Trust) -> Self {
        let horizon = trust.horizon.map(|horizon| horizon.t);
        let known = |t: f64| horizon.is_none_or(|horizon| t < horizon);
        let rows = run.impacts().iter().zip(&trust.errors);
        let rows = rows.filter(|(impact, _)| impact.v_n > 0.0 && known(impact.t));
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        let (mut early, mut all) = (0.0, 0.0);
        for (impact, &error) in rows {
            let off = error_of_v_n(run, impact, error);
            least = least.max(impact.v_n - off);
            most = most.max(impact.v_n + off);
            all += off;
            let late = impact.t - RHO2_UNTIL;
            if late.abs() <= error * impact.t.max(1.0) {
                // Whether it counts is open.
                early += off + impact.v_n;
            } else if late < 0.0 {
                early += off;
            }
        }
        let rho1 = run.norms().rho1;
        let whole = |error: f64| Some(error).filter(|_| horizon.is_none());
        Self {
            rho1: whole((most - rho1).max(rho1 - least)),
            rho2: Some(early).filter(|_| known(RHO2_UNTIL * (1.0 + LATER))),
            rho3: whole(all),
            y_max: extreme_error(run, trust, |state| [state.y, state.vy], run.norms().y_max),
            theta_max: match run.end().reason {
                // It is the limit, and no neighbour has another.
                Stop::RotationLimit => whole(0.0),
                _ => {
                    let turned = |state: &State| [state.theta.abs(), state.vtheta];
                    extreme_error(run, trust, turned, run.norms().theta_max)
                }
            },
        }
    }
}

/// Between two impacts a motion is looked at so many times.
const LOOKS: u32 = 64;
/// A top that is seen this much lower than the largest may be that: between two looks a motion rises
/// by less.
const UNSEEN: f64 = 1e-3;

/// The error of the largest value of a component of the state, given with its rate: the largest that
/// it may have in those stretches between impacts that may reach it. A deviation E of the states and
/// of the time at the impact before grows along a flight by no more than
///
/// ```text
/// E (max(1, |q|) + s max(1, |q̇|) + s²/2 max(1, t) |ḟ|)
/// ```
///
/// as the forces at a phase that is off by E t differ by that much. With a cable taut it is bounded by
/// what has become of it at the impact after.
fn extreme_error(
    run: &Trajectory,
    trust: &Trust,
    component: impl Fn(&State) -> [f64; 2],
    largest: f64,
) -> Option<f64> {
    if trust.horizon.is_some() {
        return None;
    }
    let [_, rate, _] = run.system().forcing.bounds();
    let mut playback = Playback::new(run);
    let mut most = 0.0_f64;
    let end = run.end().t;
    let rows = run.impacts().iter().zip(&trust.errors);
    let mut edges: Vec<(f64, Option<f64>)> = rows.map(|(i, error)| (i.t, Some(*error))).collect();
    edges.push((end, None));
    let (mut from, mut before) = (run.segments().first()?.t, None);
    for (to, after) in edges {
        let error = [before, after].into_iter().flatten().reduce(f64::max);
        let s = to - from;
        let (mut top, mut speed, mut taut) = (0.0_f64, 1.0_f64, false);
        for k in 0..=LOOKS {
            let motion = playback.at(from + s * f64::from(k) / f64::from(LOOKS));
            let [value, velocity] = component(&motion.state);
            (top, speed) = (top.max(value), speed.max(velocity.abs()));
            taut |= k < LOOKS && !motion.taut.is_empty();
        }
        let growth = largest.abs().max(1.0) + s * speed + 0.5 * s * s * to.max(1.0) * rate;
        let off = error.map(|error| error * growth);
        if top + UNSEEN + off.unwrap_or(0.0) >= largest {
            let known = after.is_some() || !taut;
            most = most.max(off.filter(|_| known)?);
        }
        (from, before) = (to, after.or(before));
    }
    Some(most)
}

/// A horizon counts as later than a time if it is by this part of it, which is more than times
/// before a horizon are off by.
const LATER: f64 = 0.01;

/// The error of v_n = n·(ẋ, ẏ) + s θ̇ at an impact where time and each component of the state are
/// off by `error`, relative to their value where that is above 1: the sum of what each of them
/// contributes, as it is not known here how they go together.
fn error_of_v_n(run: &Trajectory, impact: &Impact, error: f64) -> f64 {
    let state = &impact.before;
    let (normal, slopes) = run.system().cables[impact.cable].normal_and_slopes(state);
    let [x, y, theta, vx, vy, vtheta] = state.components();
    let by_place = |k: usize| slopes[0][k] * vx + slopes[1][k] * vy + slopes[2][k] * vtheta;
    let by_component = [
        (by_place(0), x),
        (by_place(1), y),
        (by_place(2), theta),
        (normal.n.x, vx),
        (normal.n.y, vy),
        (normal.arm, vtheta),
    ];
    let parts = by_component.map(|(slope, value)| slope.abs() * value.abs().max(1.0));
    error * parts.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::progress::{Unfinished, unwatched};
    use crate::analysis::trust::{Uncertainty, trusted_run};
    use crate::case::Case;
    use crate::case::parameters::Parameters;

    /// Neighbours as far off as may be have norms that differ by less than is told, and by more
    /// than a thousandth of it.
    #[test]
    fn neighbours_have_norms_within_the_errors() -> Result<(), Unfinished> {
        let certain = Parameters {
            f_o: 0.31,
            ..Parameters::STANDARD
        };
        let doubt = 1e-9;
        let case = Case::new(certain)?;
        let (run, trust) = trusted_run(&case, &Uncertainty::of_start(doubt), &unwatched)?;
        assert!(trust.decides_the_end());
        let told = NormErrors::of(&run, &trust);
        let told = [told.rho1, told.rho2, told.rho3, told.y_max, told.theta_max];
        let told = told.map(|error| error.unwrap_or(f64::NAN));
        let mut largest = [0.0_f64; 5];
        for (name, value) in [("x", certain.x), ("y", certain.y), ("vx", certain.vx)] {
            for side in [-doubt, doubt] {
                let moved = certain.map(|key, old| if key == name { value + side } else { old });
                let other = Case::new(moved)?.run();
                let (ours, theirs) = (run.norms(), other.norms());
                let off = [
                    ours.rho1 - theirs.rho1,
                    ours.rho2 - theirs.rho2,
                    ours.rho3 - theirs.rho3,
                    ours.y_max - theirs.y_max,
                    ours.theta_max - theirs.theta_max,
                ];
                largest = std::array::from_fn(|k| largest[k].max(off[k].abs()));
            }
        }
        for (largest, told) in largest.into_iter().zip(told) {
            assert!(
                largest <= told && told <= 1e3 * largest,
                "{largest:e} {told:e}"
            );
        }
        Ok(())
    }

    /// Past the horizon nothing is known, but of the sum up to t = 10 where the horizon is later.
    #[test]
    fn what_counts_impacts_past_the_horizon_is_not_known() -> Result<(), Unfinished> {
        let errors = |parameters: Parameters| -> Result<_, Unfinished> {
            let case = Case::new(parameters)?;
            let (run, trust) = trusted_run(&case, &Uncertainty::default(), &unwatched)?;
            let NormErrors {
                rho1,
                rho2,
                rho3,
                y_max,
                theta_max,
            } = NormErrors::of(&run, &trust);
            Ok([rho1, rho2, rho3, y_max, theta_max].map(|error| error.is_some()))
        };
        assert_eq!(errors(Parameters::STANDARD)?, [false; 5]);
        // A long cable turns the body slowly: trust lasts far past t = 10, but not to the end.
        let slow = Parameters {
            f_o: 0.0,
            theta: 0.2,
            r: 100.0,
            e: 1.0,
            t_end: 1000.0,
            ..Parameters::STANDARD
        };
        assert_eq!(errors(slow)?, [false, true, false, false, false]);
        Ok(())
    }
}
