//! Quantities of a run: its end, its swings, its clear impacts, and the forces on the body.

use snapload::{End, Impact, State, Stop, System};
use snapload_verify::RoundedRun;

/// Whether a run exceeded the limits: rotation limit or upper bound.
pub(super) fn exceeds(run: &RoundedRun) -> bool {
    run.end().reason.exceeds()
}

/// Time and θ of the turning points of the rotation.
pub(super) fn turns(run: &RoundedRun) -> Vec<(f64, f64)> {
    let turns =
        |hit: &&Impact| hit.before.vtheta == 0.0 || hit.before.vtheta * hit.after.vtheta < 0.0;
    let turning = run.impacts().iter().filter(turns);
    turning.map(|hit| (hit.t, hit.before.theta)).collect()
}

/// A swing of the rotation from one turning point to the next: time and θ of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Swing {
    pub(super) from: (f64, f64),
    pub(super) to: (f64, f64),
}

/// A large swing goes from beyond this angle on one side to beyond it on the other \[rad\]; the
/// chapter's swings go from near π/2 to near −π/2.
pub(super) const LARGE: f64 = std::f64::consts::FRAC_PI_4;

impl Swing {
    pub(super) fn size(self) -> f64 {
        (self.to.1 - self.from.1).abs()
    }

    pub(super) fn is_large(self) -> bool {
        let [from, to] = [self.from.1, self.to.1];
        from * to < 0.0 && from.abs().min(to.abs()) > LARGE
    }
}

/// The swings of θ between its turns.
pub(super) fn swings(run: &RoundedRun) -> Vec<Swing> {
    let turns = turns(run);
    let pairs = turns.windows(2);
    pairs
        .map(|pair| Swing {
            from: pair[0],
            to: pair[1],
        })
        .collect()
}

/// The largest rotation of a run.
pub(super) fn rotation(run: &RoundedRun) -> f64 {
    run.norms().theta_max
}

/// The positions at times `step` apart between two times, from the function `at`.
pub(super) fn places(
    at: impl FnMut(f64) -> State,
    (from, to): (f64, f64),
    step: f64,
) -> Vec<[f64; 2]> {
    let count = ((to - from) / step).floor().max(0.0) as usize;
    let times = (0..=count).map(|k| from + k as f64 * step).chain([to]);
    let states = times.map(at);
    states.map(|state| [state.x, state.y]).collect()
}

/// The smallest snap velocity that is visible in a printed plot.
pub(super) const CLEAR: f64 = 1e-2;

/// The impacts that are visible in a printed plot.
pub(super) fn clear(run: &RoundedRun) -> impl Iterator<Item = &Impact> + Clone {
    run.impacts().iter().filter(|hit| hit.v_n > CLEAR)
}

/// The component of the wave's force on a body in some state, away from the anchor of a cable.
pub(super) fn push(system: &System, cable: usize, t: f64, state: &State) -> f64 {
    let [nx, ny] = system.cables[cable].normal(state).n.components();
    let [fx, fy] = system.forcing.at(t).components();
    nx * fx + ny * (fy - system.forcing.constant.y)
}

/// The component of the weight, away from the anchor of a cable.
pub(super) fn weight_push(system: &System, cable: usize, state: &State) -> f64 {
    let [_, ny] = system.cables[cable].normal(state).n.components();
    ny * system.forcing.constant.y
}

/// The speed of the point of the body to which a cable is attached.
pub(super) fn attachment_speed(system: &System, cable: usize, state: &State) -> f64 {
    let (s, c) = state.theta.sin_cos();
    let [x, y] = system.cables[cable].lever(s, c).components();
    (state.vx - state.vtheta * y).hypot(state.vy + state.vtheta * x)
}

/// How a run ended and when, in words.
pub(super) fn ending(end: &End) -> String {
    format!("{} at {:.3}", how(end.reason), end.t)
}

fn how(reason: Stop) -> &'static str {
    match reason {
        Stop::Settled => "settles",
        Stop::SlidingStart => "slides",
        Stop::EndTime => "goes on",
        other => other.label(),
    }
}

/// The ends of the runs in many digits, which are the first of the members; and for each, the
/// number of other starts that end differently, if there are any.
pub(super) fn endings<const N: usize>(members: &[[&RoundedRun; N]]) -> String {
    let words = (0..N).map(|k| {
        let own = members[0][k].end();
        let others = members
            .iter()
            .filter(|runs| runs[k].end().reason != own.reason);
        match others.count() {
            0 => ending(own),
            count => format!(
                "{} ({count} of {} starts otherwise)",
                ending(own),
                members.len()
            ),
        }
    });
    words.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_swing_goes_far_to_both_sides() {
        let swing = |from, to| Swing {
            from: (0.0, from),
            to: (1.0, to),
        };
        assert!(swing(1.5, -1.5).is_large() && swing(-0.8, 0.9).is_large());
        // As wide as a quarter turn, but not from side to side.
        assert!(!swing(1.5, -0.1).is_large() && !swing(0.3, -0.3).is_large());
        assert!((swing(1.5, -0.1).size() - 1.6).abs() < 1e-12);
    }
}
