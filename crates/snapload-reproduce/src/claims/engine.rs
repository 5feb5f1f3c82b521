//! Runs of the engine in the terms of Newton's law.

use super::newton::{Moment, Mooring, Side, largest};
use snapload::{Motion, Playback, Trajectory};

/// How many intervals of a run are looked at, and at how many times each.
const INTERVALS: usize = 40;
const TIMES: usize = 20;

/// The tensions that a run has while so many cables are taut, 1 or 2, against −2 λ r at the same states;
/// and at how many times that was looked at.
pub(super) fn tension_residual(run: &Trajectory, taut: usize) -> (f64, usize) {
    let mut playback = Playback::new(run);
    let mut residuals = Vec::new();
    let intervals = run.modes().iter().filter(|mode| mode.taut.len() == taut);
    for mode in intervals.take(INTERVALS) {
        for k in 0..TIMES {
            let part = (k as f64 + 0.5) / TIMES as f64;
            let motion = playback.at(mode.t_start + part * (mode.t_end - mode.t_start));
            let moment = moment_of(run, &motion);
            for cable in motion.taut.iter() {
                let lambda = match taut {
                    1 => moment.held(Side::of(cable)).lambda[0],
                    _ => moment.held_by_both().lambda[cable],
                };
                residuals.push(motion.tensions[cable] + 2.0 * lambda * moment.mooring.r);
            }
        }
    }
    let times = residuals.len() / taut.max(1);
    (largest(residuals), times)
}

/// A run's moment in the terms of Newton's law.
pub(super) fn moment_of(run: &Trajectory, motion: &Motion) -> Moment {
    let system = run.system();
    let [a, b, r] = system.cables.first().map_or([0.0; 3], |cable| {
        let [a, b] = cable.fairlead().components();
        [a, b, cable.length()]
    });
    let [fx, fy] = system.forcing.at(motion.t).components();
    let state = &motion.state;
    Moment {
        mooring: Mooring {
            a,
            b,
            r,
            inertia: system.body.inertia(),
        },
        place: [state.x, state.y, state.theta],
        velocity: [state.vx, state.vy, state.vtheta],
        force: [fx, fy + 1.0], // the weight is told apart
    }
}
