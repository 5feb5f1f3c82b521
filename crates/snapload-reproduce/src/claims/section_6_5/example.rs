//! The two examples that rock, and what is said of the stronger one, f_o = 0.27.

use super::kind;
use crate::claims::numbers::{range, span};
use crate::claims::runs::{MANY, near};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use rayon::prelude::*;
use snapload::{CaseError, ModeInterval, Motion, Playback, Stop, Trajectory, named_case};

/// Times between the samples of a rocking motion.
const SAMPLE: f64 = 0.02;

/// A run that comes to rock.
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
    first.and_then(|k| modes.get(k..)).unwrap_or_default()
}

/// Whether a run rocks from its first rocking to the end of its time.
pub(super) fn rocks_on(run: &Trajectory) -> bool {
    from_rocking(run).len() == 1 && run.end().reason == Stop::EndTime
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

    pub(super) fn goes_on(&self) -> bool {
        rocks_on(&self.run)
    }

    /// The smallest tension while both cables are taut.
    pub(super) fn least_tension(&self) -> f64 {
        let rocking = self.motion.iter().filter(|now| now.taut.len() == 2);
        let cables = self.run.system().cables.len();
        range(rocking.flat_map(|now| now.tensions.into_iter().take(cables))).0
    }

    /// The largest of a figure in 20 T of its motion.
    fn largest(&self, from: f64, figure: impl Fn(&Motion) -> f64) -> f64 {
        let part = self
            .motion
            .iter()
            .filter(|now| (from..from + 20.0).contains(&now.t));
        range(part.map(figure)).1
    }

    /// The same of the last 20 T.
    fn largest_late(&self, figure: impl Fn(&Motion) -> f64) -> f64 {
        self.largest(self.run.end().t - 20.0, figure)
    }

    /// The largest |θ| of the last 20 T over that of the first.
    fn remaining(&self) -> f64 {
        let turned = |now: &Motion| now.state.theta.abs();
        self.largest_late(turned) / self.largest(self.start, turned)
    }
}

/// An example and its neighbours.
pub(super) fn example(code: &str) -> Result<Vec<Rocking>, CaseError> {
    let runs = near(&named_case(code)?.parameters, MANY)?;
    Ok(runs.into_par_iter().map(Rocking::new).collect())
}

/// Checks the claims on the stronger example, and on how rocking ends in both.
pub(super) fn claims(strong: &[Rocking], weak: &[Rocking]) -> Vec<Claim> {
    vec![
        claim(
            "6.5.2.2-03",
            "At f_o = 0.27 the rocking soon ends as one cable loses its tension and a second \
             sliding begins.",
            short_rocking(strong),
        ),
        claim(
            "6.5.2.2-04",
            "That example then comes to rest at the bottom.",
            rests(strong),
        ),
        claim(
            "6.5.2.2-14",
            "In the end rocking stops as the body comes to rest in equilibrium.",
            dies_out(weak, strong),
        ),
    ]
}

fn short_rocking(members: &[Rocking]) -> Finding {
    let slides = |of: &Rocking| {
        let modes = from_rocking(&of.run);
        modes.iter().any(|mode| kind(mode) == "sliding")
    };
    let on = members.iter().filter(|of| of.goes_on()).count();
    let least = span(members.iter().map(Rocking::least_tension), 3);
    Finding::new(
        Verdict::robust(members.iter().map(slides)),
        format!(
            "rocks from t = {}, smallest tension {least}; unbroken to t = 100 from {on} of {} \
             starts",
            span(members.iter().map(|of| of.start), 3),
            members.len()
        ),
    )
    .because(
        Verdict::NotReproduced,
        on == members.len(),
        format!(
            "Here both cables go on pulling, with {least} at the least. How near that comes to 0 \
             depends on the state in which the rocking begins, so another law for an impact that \
             meets a taut cable may end it."
        ),
    )
}

fn rests(members: &[Rocking]) -> Finding {
    let heights = members.iter().map(|of| of.largest_late(|now| now.state.y));
    let heights: Vec<f64> = heights.collect();
    Finding::new(
        Verdict::robust(heights.iter().map(|y| *y < 0.05)),
        format!(
            "highest y of the last 20 T: {} by start",
            span(heights.iter().copied(), 3)
        ),
    )
    .because(
        Verdict::NotReproduced,
        members.iter().all(Rocking::goes_on),
        "It rocks on under the force. With both cables taut there are no impacts, and nothing \
         else in the model takes energy.",
    )
}

fn dies_out(weak: &[Rocking], strong: &[Rocking]) -> Finding {
    /// What is left of a motion that dies out.
    const DYING: f64 = 0.1;
    let [weak, strong] = [weak, strong].map(|members| {
        let left: Vec<f64> = members.iter().map(Rocking::remaining).collect();
        left
    });
    let all = weak.iter().chain(&strong);
    Finding::new(
        Verdict::robust(all.clone().map(|left| *left < DYING)),
        format!(
            "widest rotation of the last 20 T over that of the first: {} at f_o = 0.1, {} at f_o \
             = 0.27",
            span(weak.iter().copied(), 2),
            span(strong.iter().copied(), 2)
        ),
    )
    .because(
        Verdict::NotReproduced,
        all.clone().all(|left| *left > 0.5),
        "Rocking loses no energy in this model, and the force goes on: it does not die out.",
    )
}
