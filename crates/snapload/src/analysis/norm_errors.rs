//! The errors of the norms of a run, from the errors of its impacts.

use crate::analysis::trust::Trust;
use crate::model::rules::Stop;
use crate::motion::extremes::Extremes;
use crate::motion::impact::Impact;
use crate::motion::playback::Playback;
use crate::motion::trajectory::{RHO2_UNTIL, Trajectory};

/// Errors of the norms over the impacts, each two standard deviations or more \[L/T\]; none where
/// the norm includes impacts past the horizon, whose errors are unknown.
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

impl Trust {
    /// Whether a time is before the horizon.
    fn is_before_horizon(&self, t: f64) -> bool {
        self.horizon.is_none_or(|horizon| t < horizon.t)
    }

    /// The error of the normal velocity v_n⁻ at each impact of a run, two standard deviations or
    /// more \[L/T\]; none past the horizon, and where an impulse is passed on with v_n = 0.
    pub fn errors_of_v_n<'a>(
        &'a self,
        run: &'a Trajectory,
    ) -> impl Iterator<Item = Option<f64>> + 'a {
        let rows = run.impacts().iter().zip(&self.errors);
        rows.map(move |(impact, error)| {
            let known = impact.v_n > 0.0 && self.is_before_horizon(impact.t);
            known.then(|| error_of_v_n(run, impact, *error))
        })
    }
}

impl NormErrors {
    /// The errors of a run's norms, from the trust in its impacts.
    pub fn of(run: &Trajectory, trust: &Trust) -> Self {
        let rows = run.impacts().iter().zip(&trust.errors);
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        let (mut early, mut all) = (0.0, 0.0);
        for ((impact, &error), off) in rows.zip(trust.errors_of_v_n(run)) {
            let Some(off) = off else { continue };
            least = least.max(impact.v_n - off);
            most = most.max(impact.v_n + off);
            all += off;
            let late = impact.t - RHO2_UNTIL;
            if late.abs() <= error * impact.t.max(1.0) {
                // The impact is so close to the end of the sum that neighbours may not include it.
                early += off + impact.v_n;
            } else if late < 0.0 {
                early += off;
            }
        }
        let rho1 = run.norms().rho1;
        let whole = |error: f64| Some(error).filter(|_| trust.horizon.is_none());
        let [y_max, theta_max] = extreme_errors(run, trust);
        Self {
            rho1: whole((most - rho1).max(rho1 - least)),
            rho2: Some(early).filter(|_| trust.is_before_horizon(RHO2_UNTIL * (1.0 + LATER))),
            rho3: whole(all),
            y_max,
            theta_max: match run.end().reason {
                // θ is at the limit there, for all neighbours.
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
/// as the forces at a phase that is off by E t differ by that much. With a cable taut, the error at
/// the next impact, or at the end, is used if it is larger. The end may come sooner or later by its
/// own error.
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
    // Events at one instant, such as an impact and the impulses that it passes on, or the impact
    // that ends the run, have no stretch between them.
    rows.dedup_by(|next, row| {
        let at_once = next.0 <= row.0;
        if at_once {
            *row = (row.0, row.1.max(next.1), row.2.max(next.2));
        }
        at_once
    });
    let (mut from, mut before, _) = rows[0];
    for &(to, after, late) in &rows[1..] {
        let (span, error) = ([from, to], after.max(before));
        let along = Along::of(&mut playback, span);
        let off = |k: usize| along.growth(run, k, span) * error + along.speeds[k] * late;
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
        // The run ends where it starts.
        1 => largest.map(|value| Some(before * value.abs().max(1.0))),
        _ => worst.map(Some),
    }
}

/// The accuracy with which a motion that is played back agrees with that of the run.
const PLAYED_BACK: f64 = 1e-14;

/// The y and the |θ| along a stretch between two impacts.
struct Along {
    /// The largest of each at the ends of the stretch's pieces, and a bound on it between them.
    reached: [f64; 2],
    bound: [f64; 2],
    /// Bounds on the path lengths ∫ |q̇| dt, and the speeds at the end.
    path_lengths: [f64; 2],
    speeds: [f64; 2],
}

impl Along {
    fn of(playback: &mut Playback, span: [f64; 2]) -> Self {
        let mut along = Self {
            reached: [f64::NEG_INFINITY; 2],
            bound: [f64::NEG_INFINITY; 2],
            path_lengths: [0.0; 2],
            speeds: [0.0; 2],
        };
        playback.each_piece(span, |piece| {
            let (ends, accelerations, width) =
                (piece.ends(), piece.acceleration_bounds(), piece.width);
            let values = ends.map(|state| [state.y, state.theta.abs()]);
            let speeds = ends.map(|state| [state.vy.abs(), state.vtheta.abs()]);
            along.speeds = speeds[1];
            for k in 0..2 {
                let top = values[0][k].max(values[1][k]);
                let speed = speeds[0][k].max(speeds[1][k]) + accelerations[k] * width * 0.5;
                along.reached[k] = along.reached[k].max(top);
                along.bound[k] = along.bound[k].max(top + accelerations[k] * width * width * 0.125);
                along.path_lengths[k] += speed * width;
            }
        });
        along
    }

    /// The factor by which a deviation at the start may grow in y or in θ.
    fn growth(&self, run: &Trajectory, k: usize, [from, to]: [f64; 2]) -> f64 {
        let ([_, rate, _], s) = (run.system().forcing.bounds(), to - from);
        self.bound[k].abs().max(1.0)
            + self.path_lengths[k].max(s)
            + 0.5 * s * s * to.max(1.0) * rate
    }

    /// The largest of each within the stretch; if that is below its floor, some value below the
    /// floor.
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

/// A horizon counts as later than a time only if it is later by this part of the time, which is
/// more than the errors of times before a horizon.
const LATER: f64 = 0.01;

/// The error of v_n = n·(ẋ, ẏ) + s θ̇ at an impact where time and each component of the state are
/// off by `error`, relative to their value where that is above 1: the sum of the contributions of
/// all components, as their correlation is not known here.
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
