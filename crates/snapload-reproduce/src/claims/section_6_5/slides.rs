//! Why a body begins to slide, and what ends a slide.

use super::{Material, kind};
use crate::claims::motions::{push, weight_push};
use crate::claims::verdict::{Checked, Checks, Finding};
use snapload::{Impact, ModeInterval, Motion, Playback, Trajectory};

pub(super) const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5.1-01", |of| {
        let by_wave = nearly_all(of, |slides| slides.more);
        let weight = of
            .slides
            .iter()
            .all(|slides| slides.are_nearly_all(slides.all - slides.more));
        let pushed = of.slides.iter().map(|slides| slides.pushed as f64);
        Ok(by_wave.list("pushed", pushed).condition("weight", weight))
    }),
    ("6.5.1-02", |of| {
        let turned = nearly_all(of, |slides| slides.turned);
        let first = of.slides.iter().all(|slides| 2 * slides.hit > slides.all);
        let hit = of.slides.iter().map(|slides| slides.hit as f64);
        Ok(turned.list("hit", hit).condition("hit_first", first))
    }),
];

/// The least part that counts as nearly all.
const NEARLY_ALL: f64 = 0.8;

/// The finding on a statement that should hold for nearly all slides.
fn nearly_all(of: &Material, part: fn(&Slides) -> usize) -> Finding {
    let holds = Finding::robust(&of.slides, |slides| slides.are_nearly_all(part(slides)));
    of.with_counts(holds)
        .list("part", of.slides.iter().map(|slides| part(slides) as f64))
        .list("all", of.slides.iter().map(|slides| slides.all as f64))
        .values("shortest nearly", [SHORTEST, 100.0 * NEARLY_ALL])
}

/// The counts of the slides of many runs.
#[derive(Clone, Copy, Default)]
pub(super) struct Slides {
    all: usize,
    /// The number that begin while the wave pushes the body into the boundary.
    pushed: usize,
    /// The number that begin while it pushes harder than the weight does.
    more: usize,
    /// The number that end when it no longer pushes.
    turned: usize,
    /// The number that end with a snap of the other cable.
    hit: usize,
}

impl Slides {
    /// The counts of all slides that are visible in a plot, without one that ends with its run.
    pub(super) fn of(runs: &[Trajectory]) -> Self {
        let mut found = Self::default();
        for run in runs {
            let mut playback = Playback::new(run);
            let long = |mode: &ModeInterval| mode.t_end - mode.t_start > SHORTEST;
            let seen = |mode: &&ModeInterval| long(mode) && mode.t_end < run.end().t;
            let slides = run.modes().iter().filter(|mode| kind(mode) == "sliding");
            for mode in slides.filter(seen) {
                let inside = 0.01 * (mode.t_end - mode.t_start);
                // The components of the wave's force and of the weight into the boundary.
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

    /// Whether a number of them is nearly all.
    fn are_nearly_all(&self, part: usize) -> bool {
        part as f64 > NEARLY_ALL * self.all as f64
    }
}

/// A shorter slide is not visible.
const SHORTEST: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_push_that_the_weight_outdoes_is_not_the_cause() {
        let slides = Slides {
            all: 10,
            pushed: 10,
            more: 0,
            ..Slides::default()
        };
        assert!(slides.are_nearly_all(slides.pushed));
        assert!(!slides.are_nearly_all(slides.more));
    }
}
