//! What makes a body slide, and what ends it.

use super::kind;
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use snapload::{Impact, ModeInterval, Motion, Playback, Trajectory};

/// The slides of a run that a plot shows, but for one that ends with the run.
fn slides(run: &Trajectory) -> impl Iterator<Item = &ModeInterval> {
    /// A slide shorter than this is none to the eye.
    const SHORTEST: f64 = 0.05;
    let seen = |mode: &&ModeInterval| {
        kind(mode) == "sliding" && mode.t_end - mode.t_start > SHORTEST && mode.t_end < run.end().t
    };
    run.modes().iter().filter(seen)
}

/// The push of the wave along the taut cable, away from its anchor.
fn push(run: &Trajectory, now: &Motion) -> f64 {
    let system = run.system();
    let cable = now.taut.iter().next().and_then(|k| system.cables.get(k));
    let [nx, ny] = cable
        .map(|cable| cable.normal(&now.state).n.components())
        .unwrap_or_default();
    let [fx, fy] = system.forcing.at(now.t).components();
    nx * fx + ny * (fy - system.forcing.constant.y)
}

/// What becomes of the slides of many runs.
#[derive(Default)]
struct Slides {
    all: usize,
    /// So many begin while the wave pushes into the boundary.
    pushed: usize,
    /// So many end once it does not.
    turned: usize,
    /// So many end as the other cable is hit.
    hit: usize,
}

impl Slides {
    fn take(&mut self, run: &Trajectory) {
        let mut playback = Playback::new(run);
        for mode in slides(run) {
            let inside = 0.01 * (mode.t_end - mode.t_start);
            let [begin, end] = [mode.t_start + inside, mode.t_end - inside].map(|t| playback.at(t));
            let hits = |hit: &Impact| (hit.t - mode.t_end).abs() < 1e-12;
            self.all += 1;
            self.pushed += usize::from(push(run, &begin) > 0.0);
            self.turned += usize::from(push(run, &end) <= 0.0);
            self.hit += usize::from(run.impacts().iter().any(hits));
        }
    }
}

/// Checks the claims on slides in many runs.
pub(super) fn claims(sweep: &[Trajectory]) -> [Claim; 2] {
    /// Nearly all: what one would tell as how it goes.
    const NEARLY_ALL: f64 = 0.8;
    let mut found = Slides::default();
    for run in sweep {
        found.take(run);
    }
    let Slides {
        all,
        pushed,
        turned,
        hit,
    } = found;
    let nearly = |part: usize| Verdict::of(part as f64 > NEARLY_ALL * all as f64);
    let runs = sweep.len();
    [
        claim(
            "6.5.1-01",
            "It is the wave that pushes a sliding body into its boundary.",
            Finding::new(
                nearly(pushed),
                format!(
                    "the wave pushes into the boundary as {pushed} of {all} slides begin, in \
                     {runs} runs"
                ),
            ),
        ),
        claim(
            "6.5.1-02",
            "A body slides until the wave reverses and stops pushing it.",
            Finding::new(
                nearly(turned),
                format!("the wave has turned as {turned} of {all} slides end, in {runs} runs"),
            )
            .because(
                Verdict::NotReproduced,
                2 * hit > all,
                format!(
                    "Another end comes first: {hit} slides end as the body hits the boundary of \
                     its other cable."
                ),
            ),
        ),
    ]
}
