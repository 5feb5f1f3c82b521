//! How far the sums of a run are known: its norms, from the errors of its impacts.

use crate::analysis::trust::Trust;
use crate::model::rules::Stop;
use crate::motion::extremes::Extremes;
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
    /// Of the highest y \[L\]; none where the run is not certain to its end.
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
        let [y_max, theta_max] = extreme_errors(run, trust);
        Self {
            rho1: whole((most - rho1).max(rho1 - least)),
            rho2: Some(early).filter(|_| known(RHO2_UNTIL * (1.0 + LATER))),
            rho3: whole(all),
            y_max,
            theta_max: match run.end().reason {
                // It is the limit, and no neighbour has another.
                Stop::RotationLimit => whole(0.0),
                _ => theta_max,
            },
        }
    }
}

/// Errors of the highest y and of the largest |θ|: the largest that either may have in those
/// stretches between impacts that may reach it. A deviation E of the states and of the time at the
/// impact before grows along a flight to no more than
///
/// ```text
/// E (max(1, |q|) + s max(1, |q̇|) + s²/2 max(1, t) |ḟ|)
/// ```
///
/// as the forces at a phase that is off by E t differ by that much. With a cable taut what has
/// become of it at the impact after, or at the end, counts where it is more. The end may come
/// sooner or later by its own error.
fn extreme_errors(run: &Trajectory, trust: &Trust) -> [Option<f64>; 2] {
    if trust.horizon.is_some() {
        return [None; 2];
    }
    let norms = run.norms();
    let largest = [norms.y_max, norms.theta_max];
    let mut playback = Playback::new(run);
    let mut worst = [0.0_f64; 2];
    let start = run.segments().first().map_or(0.0, |first| first.t);
    let ([first, last], end) = (trust.edge_errors, run.end().t);
    let rows = run.impacts().iter().zip(&trust.errors);
    let rows = rows.map(|(impact, error)| (impact.t, *error, 0.0));
    let mut rows: Vec<_> = [(start, first, 0.0)]
        .into_iter()
        .chain(rows)
        .chain([(end, last, trust.end_error)])
        .collect();
    // What happens at one instant, such as an impact and the impulses that it passes on, or the
    // impact that ends the run, has no stretch between.
    rows.dedup_by(|next, row| {
        let at_once = next.0 <= row.0;
        if at_once {
            *row = (row.0, row.1.max(next.1), row.2.max(next.2));
        }
        at_once
    });
    let (mut from, mut before, _) = rows[0];
    for &(to, after, late) in &rows[1..] {
        let (span, told) = ([from, to], after.max(before));
        let along = Along::of(&mut playback, span);
        let off = |k: usize| along.growth(run, k, span) * told + along.speeds[k] * late;
        let offs = [off(0), off(1)];
        let floor = |k: usize| largest[k] - offs[k] - PLAYED_BACK * largest[k].abs().max(1.0);
        let floors = [floor(0), floor(1)];
        let tops = along.tops(&mut playback, span, floors);
        for k in 0..2 {
            if tops[k] >= floors[k] {
                worst[k] = worst[k].max(offs[k]);
            }
        }
        (from, before) = (to, after);
    }
    match rows.len() {
        // It ends where it starts.
        1 => largest.map(|value| Some(before * value.abs().max(1.0))),
        _ => worst.map(Some),
    }
}

/// A motion that is played back is that of the run to this.
const PLAYED_BACK: f64 = 1e-14;

/// A stretch between two impacts, by its y and its |θ|.
struct Along {
    /// The largest of each at an end of a piece of it, and a bound on it within.
    reached: [f64; 2],
    bound: [f64; 2],
    /// Bounds on the ways that they go, ∫ |q̇| dt, and their speeds at the end.
    ways: [f64; 2],
    speeds: [f64; 2],
}

impl Along {
    fn of(playback: &mut Playback, span: [f64; 2]) -> Self {
        let mut along = Self {
            reached: [f64::NEG_INFINITY; 2],
            bound: [f64::NEG_INFINITY; 2],
            ways: [0.0; 2],
            speeds: [0.0; 2],
        };
        playback.each_piece(span, |piece| {
            let (ends, bends, width) = (piece.ends(), piece.bends(), piece.width);
            let values = ends.map(|state| [state.y, state.theta.abs()]);
            let speeds = ends.map(|state| [state.vy.abs(), state.vtheta.abs()]);
            along.speeds = speeds[1];
            for k in 0..2 {
                let top = values[0][k].max(values[1][k]);
                let speed = speeds[0][k].max(speeds[1][k]) + bends[k] * width * 0.5;
                along.reached[k] = along.reached[k].max(top);
                along.bound[k] = along.bound[k].max(top + bends[k] * width * width * 0.125);
                along.ways[k] += speed * width;
            }
        });
        along
    }

    /// By how much a deviation of its start may grow in y or in θ.
    fn growth(&self, run: &Trajectory, k: usize, [from, to]: [f64; 2]) -> f64 {
        let ([_, rate, _], s) = (run.system().forcing.bounds(), to - from);
        self.bound[k].abs().max(1.0) + self.ways[k].max(s) + 0.5 * s * s * to.max(1.0) * rate
    }

    /// The largest of each within; where that is below its floor, something below it.
    fn tops(&self, playback: &mut Playback, span: [f64; 2], floors: [f64; 2]) -> [f64; 2] {
        if (0..2).all(|k| self.bound[k] < floors[k] || floors[k] <= self.reached[k]) {
            return self.reached;
        }
        let [y_max, theta_max] = self.reached;
        let mut extremes = Extremes { y_max, theta_max };
        playback.each_piece(span, |piece| piece.cover(&mut extremes));
        [extremes.y_max, extremes.theta_max]
    }
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
    use crate::arithmetic::precise::Precise;
    use crate::arithmetic::real::Real;
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

    /// Of random runs that are certain, the highest y and the largest |θ| with 76 digits are within
    /// the errors: by start, body, forcing and restitution, so that they are reached at the start,
    /// within flights, at impacts and at the limits.
    #[test]
    fn extremes_with_many_digits_are_within_the_errors() -> Result<(), Unfinished> {
        let (mut compared, mut sharp) = (0, 0);
        for k in 0..600 {
            // Places of a point in seven dimensions that no two numbers share.
            let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
            let parameters = Parameters {
                r: 1.2 + 2.0 * at(2.0),
                e: 0.3 + 0.65 * at(3.0),
                f_o: 0.8 * at(5.0),
                omega: 0.3 + 3.0 * at(7.0),
                y: 0.05 + 0.3 * at(11.0),
                vy: 0.8 * at(13.0) - 0.3,
                vtheta: 0.8 * at(17.0) - 0.4,
                inertia: Some(0.01 + 0.03 * at(19.0)),
                t_end: 3.0,
                ..Parameters::STANDARD
            };
            let Ok(case) = Case::new(parameters) else {
                continue;
            };
            let (run, trust) = trusted_run(&case, &Uncertainty::default(), &unwatched)?;
            let slack = run.modes().iter().all(|mode| mode.taut.is_empty());
            let exact = case.simulation_over(|_, number| Precise::<4>::from_decimal(number));
            let (true, true, Ok(mut exact)) = (trust.decides_the_end(), slack, exact) else {
                continue;
            };
            while exact.step().is_some() {}
            let told = NormErrors::of(&run, &trust);
            let norms = run.norms();
            for (ours, exact, told) in [
                (norms.y_max, exact.y_max(), told.y_max),
                (norms.theta_max, exact.theta_max(), told.theta_max),
            ] {
                let told = told.unwrap_or(f64::NAN);
                assert!(told.is_finite(), "{parameters:?}");
                // What is a limit, or the start, is known to its rounding.
                let off = (exact - Precise::from_f64(ours)).to_f64().abs();
                assert!(
                    off <= told + 2.0 * f64::EPSILON,
                    "{parameters:?}: {off:e} {told:e}"
                );
                compared += 1;
                sharp += usize::from(told < 1e-12 + 1e4 * off);
            }
        }
        assert!(compared > 200 && sharp * 2 > compared, "{compared} {sharp}");
        Ok(())
    }

    /// Impacts of one instant, and one that ends the run, take nothing from what is known: the
    /// standard case settles at an impact, and goes on to rock after impulses that were passed on.
    #[test]
    fn extremes_are_known_where_impacts_come_at_once() -> Result<(), Unfinished> {
        for stop_when_settled in [true, false] {
            let case = Case::new(Parameters {
                e: 0.3,
                t_end: 5.0,
                stop_when_settled,
                ..Parameters::STANDARD
            })?;
            let (run, trust) = trusted_run(&case, &Uncertainty::default(), &unwatched)?;
            let told = NormErrors::of(&run, &trust);
            for told in [told.y_max, told.theta_max] {
                assert!(told.is_some_and(|error| error < 1e-10), "{told:?}");
            }
        }
        Ok(())
    }

    /// With cables taut no digits are at hand: neighbours of a body that rocks on both cables from
    /// its start keep within.
    #[test]
    fn neighbours_of_taut_motion_are_within_the_errors() -> Result<(), Unfinished> {
        let rocking = Parameters {
            y: 0.0,
            f_o: 0.1,
            stop_when_settled: false,
            ..Parameters::STANDARD
        };
        for t_end in [3.0, 9.0, 30.0] {
            let certain = Parameters { t_end, ..rocking };
            let case = Case::new(certain)?;
            let doubt = 1e-9;
            let mut uncertainty = Uncertainty::default();
            uncertainty.set("f_o", doubt)?;
            let (run, trust) = trusted_run(&case, &uncertainty, &unwatched)?;
            let told = NormErrors::of(&run, &trust);
            let told = [told.y_max, told.theta_max].map(|error| error.unwrap_or(f64::NAN));
            for side in [-doubt, doubt] {
                let f_o = certain.f_o + side;
                let other = Case::new(Parameters { f_o, ..certain })?.run();
                let (ours, theirs) = (run.norms(), other.norms());
                let off = [
                    (ours.y_max - theirs.y_max).abs(),
                    (ours.theta_max - theirs.theta_max).abs(),
                ];
                for (off, told) in off.into_iter().zip(told) {
                    assert!(off <= told && told < 1e-5, "{t_end}: {off:e} {told:e}");
                }
            }
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
