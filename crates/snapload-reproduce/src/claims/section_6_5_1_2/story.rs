//! What happens in a run of the sliding example (eq. 6.57).

use crate::claims::engine::moment_of;
use crate::claims::newton::Side;
use snapload::{Impact, ModeInterval, Motion, Playback, TautSet, Trajectory};

/// Cable 2, the left one, of g2.
pub(super) const LEFT: usize = 1;

/// One run of the example, in the chapter's order of events.
pub(super) struct Story<'a> {
    pub(super) run: &'a Trajectory,
    /// The first slide.
    pub(super) first: ModeInterval,
    /// Where it starts.
    pub(super) start: Motion,
    /// Its motion at many times of all slides.
    pub(super) sliding: Vec<Motion>,
    /// The hits of cable 1 while it slides on cable 2.
    pub(super) hits: Vec<Impact>,
    /// The first rocking after a slide, and whether that came just before.
    pub(super) rocks: Option<(Motion, bool)>,
}

/// A slide shorter than this moves nothing that one could see; it is passed over.
pub(super) const SHORTEST: f64 = 5e-4;
/// Times of a slide at which it is looked at.
pub(super) const TIMES: usize = 200;

pub(super) fn slid(mode: &ModeInterval) -> bool {
    mode.taut.len() == 1
}

impl<'a> Story<'a> {
    pub(super) fn of(run: &'a Trajectory) -> Option<Self> {
        let mut playback = Playback::new(run);
        let modes = run.modes();
        let first = *modes.iter().find(|mode| slid(mode))?;
        let start = playback.at(first.t_start);
        let rocking = modes.windows(2).find_map(|pair| match pair {
            [before, mode] if mode.taut.len() > 1 => Some((mode.t_start, slid(before))),
            _ => None,
        });
        let end = rocking.map_or(run.end().t, |(t, _)| t);
        let slides = modes.iter().filter(|mode| {
            slid(mode) && mode.t_start < end && mode.t_end - mode.t_start > SHORTEST
        });
        let sliding = slides
            .flat_map(|mode| {
                (0..TIMES).map(|k| {
                    let part = (k as f64 + 0.5) / TIMES as f64;
                    mode.t_start + part * (mode.t_end - mode.t_start)
                })
            })
            .map(|t| playback.at(t))
            .collect();
        let within = |impact: &&Impact| {
            impact.cable != LEFT
                && modes.iter().any(|mode| {
                    mode.taut == TautSet::only(LEFT)
                        && mode.t_start < impact.t
                        && impact.t <= mode.t_end
                })
        };
        Some(Self {
            run,
            first,
            start,
            sliding,
            hits: run.impacts().iter().filter(within).copied().collect(),
            rocks: rocking.map(|(t, after)| (playback.at(t), after)),
        })
    }

    /// The taut set right after a time.
    pub(super) fn taut_after(&self, t: f64) -> Option<TautSet> {
        let modes = self.run.modes();
        modes.iter().find(|mode| mode.t_end > t).map(|m| m.taut)
    }

    /// Least speed of the taut cable's fairlead over that of the centre, while sliding.
    pub(super) fn least_turning(&self) -> f64 {
        let ratio = |motion: &Motion| {
            let moment = moment_of(self.run, motion);
            let cable = motion.taut.iter().next()?;
            let [px, py] = moment.fairlead_velocity(Side::of(cable));
            let [vx, vy, _] = moment.velocity;
            Some(((px * px + py * py) / (vx * vx + vy * vy)).sqrt())
        };
        self.sliding
            .iter()
            .filter_map(ratio)
            .fold(f64::INFINITY, f64::min)
    }

    pub(super) fn goes(&self, way: impl Fn(f64) -> bool) -> bool {
        self.sliding.iter().any(|motion| way(motion.state.vy))
    }

    /// Its impacts from the first slide to the first rocking.
    pub(super) fn impacts(&self) -> impl Iterator<Item = &Impact> + Clone {
        let from = self.first.t_start;
        let to = self.rocks.as_ref().map_or(from, |(motion, _)| motion.t);
        let between = move |impact: &&Impact| impact.t >= from && impact.t <= to;
        self.run.impacts().iter().filter(between)
    }
}
