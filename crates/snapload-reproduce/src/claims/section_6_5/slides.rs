//! What makes a body slide, and what ends it.

use super::{Material, kind};
use crate::claims::motions::{push, weight_push};
use crate::claims::verdict::{Finding, Judged, Judges};
use snapload::{Impact, ModeInterval, Motion, Playback, Trajectory};

pub(super) const JUDGES: &Judges<fn(&Material) -> Judged> = &[
    ("6.5.1-01", |of| {
        let Slides { pushed, more, .. } = of.slides;
        let by_wave = of.slides.nearly_all(more);
        Ok(by_wave.value("pushed", pushed).found("never", more == 0))
    }),
    ("6.5.1-02", |of| {
        let Slides { all, hit, .. } = of.slides;
        let turned = of.slides.nearly_all(of.slides.turned);
        Ok(turned.value("hit", hit).found("hit_first", 2 * hit > all))
    }),
];

/// What becomes of the slides of many runs.
#[derive(Clone, Copy, Default)]
pub(super) struct Slides {
    runs: usize,
    all: usize,
    /// So many begin while the wave pushes into the boundary.
    pushed: usize,
    /// So many begin while it pushes more than the weight does.
    more: usize,
    /// So many end once it does not.
    turned: usize,
    /// So many end as the other cable is hit.
    hit: usize,
}

impl Slides {
    /// Of all slides that a plot shows, but for one that ends with its run.
    pub(super) fn of(runs: &[Trajectory]) -> Self {
        let mut found = Self {
            runs: runs.len(),
            ..Self::default()
        };
        for run in runs {
            let mut playback = Playback::new(run);
            let long = |mode: &ModeInterval| mode.t_end - mode.t_start > SHORTEST;
            let seen = |mode: &&ModeInterval| long(mode) && mode.t_end < run.end().t;
            let slides = run.modes().iter().filter(|mode| kind(mode) == "sliding");
            for mode in slides.filter(seen) {
                let inside = 0.01 * (mode.t_end - mode.t_start);
                // Of the wave and of the weight, into the boundary.
                let pushes = |now: Motion| {
                    let cable = now.taut.iter().next().unwrap_or(0);
                    let wave = push(run.system(), cable, now.t, &now.state);
                    [wave, weight_push(run.system(), cable, &now.state)]
                };
                let hits = |hit: &Impact| (hit.t - mode.t_end).abs() < 1e-12;
                found.all += 1;
                let [wave, weight] = pushes(playback.at(mode.t_start + inside));
                found.pushed += usize::from(wave > 0.0);
                found.more += usize::from(wave > weight);
                found.turned += usize::from(pushes(playback.at(mode.t_end - inside))[0] <= 0.0);
                found.hit += usize::from(run.impacts().iter().any(hits));
            }
        }
        found
    }

    /// Of a statement that should hold of nearly all slides: what one would tell as how it goes.
    fn nearly_all(&self, part: usize) -> Finding {
        const NEARLY_ALL: f64 = 0.8;
        let holds = part as f64 > NEARLY_ALL * self.all as f64;
        Finding::of(holds)
            .values("part all runs", [part, self.all, self.runs])
            .values("shortest nearly", [SHORTEST, 100.0 * NEARLY_ALL])
    }
}

/// A slide shorter than this is none to the eye.
const SHORTEST: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::Verdict;

    #[test]
    fn a_push_that_the_weight_outdoes_is_not_the_cause() {
        let slides = Slides {
            runs: 9,
            all: 10,
            pushed: 10,
            more: 0,
            ..Slides::default()
        };
        assert_eq!(
            slides.nearly_all(slides.pushed).verdict,
            Verdict::Reproduced
        );
        assert_eq!(
            slides.nearly_all(slides.more).verdict,
            Verdict::NotReproduced
        );
    }
}
