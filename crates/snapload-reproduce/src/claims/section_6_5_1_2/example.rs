//! The sliding example (eq. 6.57).

use crate::claims::motions::{CLEAR, attachment_speed, places};
use crate::claims::numbers::{max, min};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use crate::example_steps::slides;
use snapload::{Impact, ModeInterval, Motion, Playback, TautSet, Trajectory};

pub(super) const CHECKS: &Checks<fn(&Example) -> Checked> = &[
    ("6.5.1.2-05", |of| {
        let ways = |s: &RunEvents| [s.moves(1.0), s.moves(-1.0)];
        let count = |way: usize| of.sliding_runs.iter().filter(|s| ways(s)[way]).count();
        Ok(of
            .robust(|s| ways(s) == [true; 2])
            .values("members up down", [of.members, count(0), count(1)]))
    }),
    ("6.5.1.2-18", |of| {
        /// The largest ratio of the connection point's speed to the centre's at which the point
        /// counts as resting.
        const TURNS: f64 = 0.5;
        let least = || of.sliding_runs.iter().map(RunEvents::least_turning);
        Ok(of
            .robust(|s| s.least_turning() < TURNS)
            .list("least", least())
            .values("turns shortest", [TURNS, SHORTEST])
            .condition("never_turns", least().all(|least| least >= TURNS)))
    }),
    ("6.5.1.2-06", |of| {
        Ok(of
            .robust(on_the_left)
            .list("from", of.sliding_runs.iter().map(|s| s.start.t))
            .values("slide members", [of.sliding_runs.len(), of.members]))
    }),
    ("6.5.1.2-07", |of| {
        /// The height from which on a stuck cable means sliding.
        const SLIDING_ABOVE: f64 = 0.05;
        let heights = || of.sliding_runs.iter().map(|s| s.start.state.y);
        Ok(of
            .robust(|s| s.start.state.y >= SLIDING_ABOVE)
            .list("heights", heights())
            .condition("below", heights().all(|y| y < SLIDING_ABOVE)))
    }),
    ("6.5.1.2-08", |of| {
        let first = || of.sliding_runs.iter().filter_map(|s| s.hits.first());
        Ok(of
            .robust(|s| !s.hits.is_empty())
            .list("times", first().map(|hit| hit.t))
            .list("velocities", first().map(|hit| hit.v_n)))
    }),
    ("6.5.1.2-09", |of| {
        let slides_on = |s: &RunEvents| {
            let hit = s.hits.first();
            hit.and_then(|hit| s.taut_after(hit.t)) == Some(TautSet::only(LEFT))
        };
        let going_on = of.sliding_runs.iter().filter(|s| slides_on(s)).count();
        Ok(of
            .robust(slides_on)
            .values("going_on members", [going_on, of.members])
            .condition("never", going_on == 0))
    }),
    ("6.5.1.2-10", |of| {
        // The proved slides of the example itself, then those of its neighbours.
        let proved = slides(CASE)
            .into_iter()
            .filter_map(|(_, v_n)| v_n)
            .collect();
        let neighbours = of.sliding_runs.iter().skip(1);
        let hits = neighbours.map(|s| s.hits.iter().map(|hit| hit.v_n).collect());
        let members: Vec<Vec<f64>> = std::iter::once(proved).chain(hits).collect();
        let clear = |hits: &Vec<f64>| hits.iter().filter(|v_n| **v_n > CLEAR).count();
        Ok(Finding::robust(&members, |hits| is_many(clear(hits)))
            .values(
                "proved proved_clear",
                [members[0].len(), clear(&members[0])],
            )
            .list("hits", members.iter().map(|hits| hits.len() as f64))
            .list("clear", members.iter().map(|hits| clear(hits) as f64))
            .value("above", CLEAR)
            .value("many", MANY_HITS)
            .condition("small_ones", members.iter().all(|hits| is_many(hits.len()))))
    }),
    ("6.5.1.2-11", |of| {
        let turning = |s: &RunEvents| s.visible_slides().filter(|slide| turns_back(slide)).count();
        let moves: Vec<[f64; 2]> = of
            .sliding_runs
            .iter()
            .filter_map(RunEvents::rise_and_fall)
            .collect();
        let none = of.sliding_runs.iter().all(|s| turning(s) == 0);
        Ok(of
            .robust(|s| turning(s) > 0)
            .list("turning", of.sliding_runs.iter().map(|s| turning(s) as f64))
            .list(
                "slides",
                of.sliding_runs
                    .iter()
                    .map(|s| s.visible_slides().count() as f64),
            )
            .value(
                "proved",
                slides(CASE)
                    .iter()
                    .filter(|(lasts, _)| *lasts > SHORTEST)
                    .count(),
            )
            .list("up", moves.iter().map(|m| m[0]))
            .list("down", moves.iter().map(|m| m[1]))
            .value("shortest", SHORTEST)
            .condition("in_flight", none && !moves.is_empty()))
    }),
    ("6.5.1.2-17", |of| {
        let rise = |s: &RunEvents| {
            let end = s.run.at(s.first.t_end.next_down()).state.y;
            end - s.start.state.y
        };
        let lasts = |s: &RunEvents| s.first.t_end - s.first.t_start;
        Ok(of
            .robust(|s| rise(s) < 0.0)
            .list("rise", of.sliding_runs.iter().map(rise))
            .list("lasts", of.sliding_runs.iter().map(lasts)))
    }),
    ("6.5.1.2-19", |of| {
        let at_its_end = |s: &RunEvents| s.hits.first().is_some_and(|hit| hit.t == s.first.t_end);
        Ok(of
            .robust(at_its_end)
            .list("ends", of.sliding_runs.iter().map(|s| s.first.t_end)))
    }),
    ("6.5.1.2-12", |of| {
        let places = || of.sliding_runs.iter().map(|s| s.start.state.x);
        let sliding = of.sliding_runs.iter().flat_map(RunEvents::sliding);
        let on_left = of.robust(on_the_left).verdict == Verdict::Reproduced;
        Ok(of
            .robust(|s| s.start.state.x < 0.0 && s.sliding().any(|m| m.state.x > 0.0))
            .list("start", places())
            .list("all", sliding.map(|now| now.state.x))
            .value("shortest", SHORTEST)
            .list("theta", of.sliding_runs.iter().map(|s| s.start.state.theta))
            .condition("on_the_right", on_left && places().all(|x| x > 0.0)))
    }),
    ("6.5.1.2-13", |of| {
        let common = of
            .sliding_runs
            .iter()
            .filter_map(RunEvents::overlap)
            .flatten();
        Ok(of.robust(|s| s.overlap().is_some()).list("common", common))
    }),
    ("6.5.1.2-14", |of| {
        let rocks = of.sliding_runs.iter().filter_map(|s| s.rocks);
        let ends = of.robust(|s| s.rocks_after_slide());
        Ok(ends.list("times", rocks.map(|(now, _)| now.t)))
    }),
    ("6.5.1.2-15", |of| {
        /// The least kinetic energy that does not count as rest.
        const MOVING: f64 = 1e-3;
        let kinetic = |s: &RunEvents| s.rocks.map(|(now, _)| now.energy - now.state.y);
        let moves = |s: &RunEvents| s.rocks_after_slide() && kinetic(s) > Some(MOVING);
        let energies = of.sliding_runs.iter().filter_map(kinetic);
        Ok(of
            .robust(moves)
            .list("kinetic", energies)
            .value("moving", MOVING))
    }),
];

/// The built-in case.
const CASE: &str = "sliding-example";
/// Cable 2, the left one, of g2.
const LEFT: usize = 1;
/// A shorter slide moves the body by nothing visible, and is skipped.
const SHORTEST: f64 = 5e-4;
/// The least number of hits that counts as many.
const MANY_HITS: usize = 3;

fn is_many(hits: usize) -> bool {
    hits >= MANY_HITS
}

/// Whether a motion switches from going up to going down.
fn turns_back(motion: &[Motion]) -> bool {
    let pairs = motion.windows(2);
    let mut turns = pairs.map(|pair| pair[0].state.vy > 0.0 && pair[1].state.vy <= 0.0);
    turns.any(|turns| turns)
}

/// The example and its neighbours: those that slide, and the number of all.
pub(super) struct Example<'a> {
    sliding_runs: Vec<RunEvents<'a>>,
    members: usize,
}

impl<'a> Example<'a> {
    pub(super) fn of(runs: &'a [Trajectory]) -> Self {
        Self {
            sliding_runs: runs.iter().filter_map(RunEvents::of).collect(),
            members: runs.len(),
        }
    }

    /// The finding on a statement about all members; it does not hold for one without a slide.
    fn robust(&self, holds: impl Fn(&RunEvents) -> bool) -> Finding {
        let absent = std::iter::repeat_n(false, self.members - self.sliding_runs.len());
        let members = self.sliding_runs.iter().map(holds).chain(absent);
        Finding::new(Verdict::robust(members))
    }
}

/// A slide: its duration, and its motion at many times.
struct Slide {
    lasts: f64,
    motion: Vec<Motion>,
}

/// The events of one run, in the chapter's order.
struct RunEvents<'a> {
    run: &'a Trajectory,
    /// The first slide.
    first: ModeInterval,
    /// The motion at its start.
    start: Motion,
    /// Its slides.
    slides: Vec<Slide>,
    /// The hits of cable 1 while it slides on cable 2.
    hits: Vec<Impact>,
    /// The first rocking after a slide, and whether it followed immediately.
    rocks: Option<(Motion, bool)>,
}

impl<'a> RunEvents<'a> {
    fn of(run: &'a Trajectory) -> Option<Self> {
        /// The number of times at which a slide is evaluated.
        const TIMES: usize = 200;
        let mut playback = Playback::new(run);
        let slid = |mode: &ModeInterval| mode.taut.len() == 1;
        let modes = run.modes();
        let first = *modes.iter().find(|mode| slid(mode))?;
        let mut pairs = modes.windows(2);
        let rocking = pairs.find(|pair| pair[1].taut.len() > 1);
        let rocking = rocking.map(|pair| (pair[1].t_start, slid(&pair[0])));
        let end = rocking.map_or(run.end().t, |(t, _)| t);
        let slides = modes.iter().filter(|mode| slid(mode) && mode.t_start < end);
        let slides = slides.map(|mode| {
            let lasts = mode.t_end - mode.t_start;
            let part = |k: usize| (k as f64 + 0.5) / TIMES as f64;
            let times = (0..TIMES).map(|k| mode.t_start + part(k) * lasts);
            let motion = times.map(|t| playback.at(t)).collect();
            Slide { lasts, motion }
        });
        let slides: Vec<Slide> = slides.collect();
        let on_left = |t: f64| {
            let mut on_left = modes.iter().filter(|mode| mode.taut == TautSet::only(LEFT));
            on_left.any(|mode| mode.t_start < t && t <= mode.t_end)
        };
        let impacts = run.impacts().iter();
        let hits = impacts.filter(|hit| hit.cable != LEFT && on_left(hit.t));
        Some(Self {
            run,
            first,
            start: playback.at(first.t_start),
            slides,
            hits: hits.copied().collect(),
            rocks: rocking.map(|(t, after)| (playback.at(t), after)),
        })
    }

    /// The taut set right after a time.
    fn taut_after(&self, t: f64) -> Option<TautSet> {
        let modes = self.run.modes();
        modes.iter().find(|mode| mode.t_end > t).map(|m| m.taut)
    }

    /// Least ratio of the speed of the taut cable's fairlead to that of the centre, while sliding.
    fn least_turning(&self) -> f64 {
        let ratio = |now: &Motion| {
            let speed = attachment_speed(self.run.system(), now.taut.iter().next()?, &now.state);
            Some(speed / now.state.vx.hypot(now.state.vy))
        };
        min(self.sliding().filter_map(ratio))
    }

    /// Its visible slides.
    fn visible_slides(&self) -> impl Iterator<Item = &[Motion]> {
        let long = self.slides.iter().filter(|slide| slide.lasts > SHORTEST);
        long.map(|slide| slide.motion.as_slice())
    }

    /// All times of these.
    fn sliding(&self) -> impl Iterator<Item = &Motion> {
        self.visible_slides().flatten()
    }

    /// Whether it goes up (1) or down (-1) in a slide, however short.
    fn moves(&self, sign: f64) -> bool {
        let mut motion = self.slides.iter().flat_map(|slide| &slide.motion);
        motion.any(|now| sign * now.state.vy > 0.0)
    }

    fn rocks_after_slide(&self) -> bool {
        self.rocks.is_some_and(|(_, after_slide)| after_slide)
    }

    /// Its impacts from the first slide to the first rocking.
    fn impacts(&self) -> impl Iterator<Item = &Impact> + Clone {
        let from = self.first.t_start;
        let to = self.rocks.as_ref().map_or(from, |(motion, _)| motion.t);
        let impacts = self.run.impacts().iter();
        impacts.filter(move |impact| impact.t >= from && impact.t <= to)
    }

    /// The rise of y from the first slide on, and its fall from there to the first rocking.
    fn rise_and_fall(&self) -> Option<[f64; 2]> {
        let (rocking, _) = self.rocks?;
        let (from, to) = (self.start.t, rocking.t);
        let mut playback = Playback::new(self.run);
        let path = places(|t| playback.at(t).state, (from, to), (to - from) / 1000.0);
        let top = max(path.iter().map(|p| p[1]));
        Some([top - self.start.state.y, top - rocking.state.y])
    }

    /// The range of x in which both cables are hit.
    fn overlap(&self) -> Option<[f64; 2]> {
        let places = |cable: usize| {
            let own = self.impacts().filter(move |i| i.cable == cable);
            own.map(|i| i.before.x)
        };
        let from = min(places(0)).max(min(places(LEFT)));
        let to = max(places(0)).min(max(places(LEFT)));
        (from < to).then_some([from, to])
    }
}

fn on_the_left(run_events: &RunEvents) -> bool {
    run_events.first.taut == TautSet::only(LEFT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload::{Case, CaseError, named_case};

    #[test]
    fn what_only_goes_down_does_not_turn_back() -> Result<(), CaseError> {
        let run = Case::new(named_case("sliding-example")?.parameters)?.run();
        let with = |vy: f64| {
            let mut motion = run.at(0.0);
            motion.state.vy = vy;
            motion
        };
        let turns = |velocities: [f64; 3]| turns_back(&velocities.map(with));
        assert!(turns([0.2, 0.1, -0.1]));
        assert!(!turns([-0.1, -0.2, -0.3]) && !turns([-0.1, 0.1, 0.2]));
        assert!(is_many(3) && !is_many(1));
        Ok(())
    }
}
