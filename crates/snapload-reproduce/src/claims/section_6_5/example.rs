//! The two examples that rock, and the claims on the stronger one, f_o = 0.27.

use super::{Material, kind};
use crate::claims::numbers::{max, min};
use crate::claims::runs::{MANY, near, run};
use crate::claims::verdict::{Checked, Checks, Finding};
use snapload::{CaseError, ModeInterval, Motion, Playback, Stop, Trajectory, named_case};

pub(super) const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5.2.2-03", |of| {
        let members = &of.strong;
        let slides = |of: &Rocking| from_rocking(&of.run).iter().any(|m| kind(m) == "sliding");
        let on = members.iter().filter(|of| of.keeps_rocking()).count();
        Ok(Finding::robust(members, slides)
            .list("from", members.iter().map(|of| of.start))
            .list("tension", members.iter().map(Rocking::least_tension))
            .values("on starts", [on, members.len()])
            .condition("all_go_on", on == members.len()))
    }),
    ("6.5.2.2-04", |of| {
        let height = |of: &Rocking| of.largest_late(|now| now.state.y);
        let heights = of.strong.iter().map(height);
        Ok(Finding::measured("heights", heights, |y| y < LOW)
            .value("low", LOW)
            .condition("all_go_on", of.strong.iter().all(Rocking::keeps_rocking)))
    }),
    ("6.5.2.2-14", |of| {
        /// A motion dies out if its remaining part is below the first number, and does not above
        /// the second.
        const DYING: f64 = 0.1;
        const LASTING: f64 = 0.5;
        let [weak, strong] = [&of.weak, &of.strong]
            .map(|members| members.iter().map(Rocking::remaining).collect::<Vec<_>>());
        let all = [&weak[..], &strong].concat();
        Ok(Finding::robust(&all, |left| *left < DYING)
            .list("weak", weak)
            .list("strong", strong)
            .value("dying", DYING)
            .condition("lasting", all.iter().all(|left| *left > LASTING)))
    }),
];

/// Times between the samples of a rocking motion.
const SAMPLE: f64 = 0.02;
/// Below this height the body is at the bottom of the region.
pub(super) const LOW: f64 = 0.05;

/// A run that begins to rock.
pub(super) struct Rocking {
    pub(super) run: Trajectory,
    /// When the first rocking begins; the end of a run that does not rock.
    pub(super) start: f64,
    /// Its motion from there on, sampled.
    pub(super) motion: Vec<Motion>,
}

/// The first interval of rocking and those after it.
fn from_rocking(run: &Trajectory) -> &[ModeInterval] {
    let modes = run.modes();
    let first = modes.iter().position(|mode| kind(mode) == "rocking");
    &modes[first.unwrap_or(modes.len())..]
}

/// Whether a run rocks from its first rocking to its end.
pub(super) fn rocks_on(run: &Trajectory) -> bool {
    from_rocking(run).len() == 1 && run.end().reason == Stop::EndTime
}

/// Whether a run leaves its first rocking.
pub(super) fn leaves_rocking(run: &Trajectory) -> bool {
    from_rocking(run).len() > 1
}

impl Rocking {
    fn new(run: Trajectory) -> Self {
        let first = from_rocking(&run).first();
        let start = first.map_or(run.end().t, |mode| mode.t_start);
        let mut playback = Playback::new(&run);
        let steps = ((run.end().t - start) / SAMPLE).max(0.0) as usize;
        let motion = (1..=steps)
            .map(|k| playback.at(start + SAMPLE * k as f64))
            .collect();
        Self { run, start, motion }
    }

    pub(super) fn keeps_rocking(&self) -> bool {
        rocks_on(&self.run)
    }

    /// The smallest tension while both cables are taut.
    pub(super) fn least_tension(&self) -> f64 {
        let rocking = self.motion.iter().filter(|now| now.taut.len() == 2);
        let cables = self.run.system().cables.len();
        min(rocking.flat_map(|now| now.tensions.into_iter().take(cables)))
    }

    /// The largest value of a quantity in 20 T of its motion.
    fn largest(&self, from: f64, figure: impl Fn(&Motion) -> f64) -> f64 {
        let motion = self.motion.iter();
        max(motion
            .filter(|now| (from..from + 20.0).contains(&now.t))
            .map(figure))
    }

    /// The same in the last 20 T.
    fn largest_late(&self, figure: impl Fn(&Motion) -> f64) -> f64 {
        self.largest(self.run.end().t - 20.0, figure)
    }

    /// The ratio of the largest |θ| in the last 20 T to that in the first.
    fn remaining(&self) -> f64 {
        let turned = |now: &Motion| now.state.theta.abs();
        self.largest_late(turned) / self.largest(self.start, turned)
    }
}

/// An example and its neighbours.
pub(super) fn example(code: &str) -> Result<Vec<Rocking>, CaseError> {
    near(&named_case(code)?.parameters, MANY, |case| {
        Ok(Rocking::new(run(case)?))
    })
}
