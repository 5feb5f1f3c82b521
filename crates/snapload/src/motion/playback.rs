//! The motion between the events of a finished run.

use crate::arithmetic::processor::{Kernel, dispatch};
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::active_set::tensions;
use crate::motion::contact::Contact;
use crate::motion::extremes::Extremes;
use crate::motion::flight::Flight;
use crate::motion::segments::Segment;
use crate::motion::simulation::within::{SegmentMotion, StateAt};
use crate::motion::taut_series::Series;
use crate::motion::trajectory::Trajectory;
use crate::motion::waves::Waves;
use std::borrow::Cow;

/// The motion at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// The time, held to the run's span \[T\].
    pub t: f64,
    /// The state; at an event's instant the one after it.
    pub state: State,
    /// The taut cables.
    pub taut: TautSet,
    /// Tensions by cable; 0 while slack \[F\].
    pub tensions: PerCable<f64>,
    /// Energy \[F L\].
    pub energy: f64,
    /// The force of the water's memory on a floating body \[F, F, F L\].
    pub memory_force: [f64; 3],
}

/// A part of the motion between two events.
pub(crate) struct Piece<'p, 'a> {
    playback: &'p Playback<'a>,
    /// The time from the beginning of its flight or expansion to its own beginning.
    begun: f64,
    /// Its duration.
    pub(crate) width: f64,
}

/// The time to come to, in the segment of an index, by the best instructions for it.
struct Reaching<'p, 'a>(&'p mut Playback<'a>, usize, f64);

impl Kernel for Reaching<'_, '_> {
    /// The time since the beginning of the flight or expansion, and the time up to which it may be
    /// used.
    type Output = (f64, f64);
    #[inline(always)]
    fn run(self) -> (f64, f64) {
        let Self(playback, index, t) = self;
        let segment = playback.expand_before(index, t);
        let free = playback.run.system().has_closed_form(segment.active.taut);
        let used = if free {
            f64::INFINITY
        } else {
            segment.t + playback.series.step()
        };
        (t - segment.t, used)
    }
}

impl Piece<'_, '_> {
    fn segment_motion(&self) -> SegmentMotion<'_, f64> {
        let Playback {
            run,
            reached,
            flight,
            series,
            ..
        } = self.playback;
        let taut = reached.as_ref().map(|(_, segment)| segment.active.taut);
        if taut.is_some_and(|taut| run.system().has_closed_form(taut)) {
            SegmentMotion::Closed(Cow::Borrowed(flight))
        } else {
            SegmentMotion::Expanded(series)
        }
    }

    /// The states at its start and at its end, before the event there.
    pub(crate) fn ends(&self) -> [State; 2] {
        let motion = self.segment_motion();
        [0.0, self.width].map(|s| dispatch(StateAt(&motion, self.begun + s)))
    }

    /// Bounds on |ÿ| and |θ̈| along it.
    pub(crate) fn acceleration_bounds(&self) -> [f64; 2] {
        let [_, y, theta] = self
            .segment_motion()
            .acceleration_bounds(self.playback.run.system());
        [y, theta]
    }

    /// Includes it in the extremes.
    pub(crate) fn cover(&self, extremes: &mut Extremes<f64>) {
        let motion = self.segment_motion();
        let within = |s: f64| dispatch(StateAt(&motion, self.begun + s));
        let [first, last] = self.ends();
        let acceleration_bounds = motion.acceleration_bounds(self.playback.run.system());
        extremes.cover(within, self.width, [&first, &last], acceleration_bounds);
    }
}

impl Trajectory {
    /// State, taut set, tensions and energy at time t, limited to the run's span; at an event's
    /// instant those after it. For many times use [`Playback`].
    pub fn at(&self, t: f64) -> Motion {
        Playback::new(self).at(t)
    }
}

/// Plays a run back: computes the motion at any time, most quickly for increasing times.
#[derive(Clone, Debug)]
pub struct Playback<'a> {
    run: &'a Trajectory,
    /// The index of the kept segment from which the motion was computed, and the segment of its
    /// chain that was reached.
    reached: Option<(usize, Segment)>,
    flight: Flight<f64>,
    series: Series<f64>,
    waves: Waves<f64>,
}

/// A motion to be computed, by the best instructions for it.
struct MotionAt<'p, 'a>(&'p mut Playback<'a>, f64);

impl Kernel for MotionAt<'_, '_> {
    type Output = Motion;
    #[inline(always)]
    fn run(self) -> Motion {
        self.0.at_here(self.1)
    }
}

/// A motion to be expanded from the start of a segment, by the best instructions for it.
struct Expanding<'p, 'a>(&'p mut Playback<'a>, &'p Segment);

impl Kernel for Expanding<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Self(playback, segment) = self;
        segment.expand(
            playback.run.system(),
            &mut playback.waves,
            &mut playback.series,
        );
    }
}

impl<'a> Playback<'a> {
    /// Of a run.
    pub fn new(run: &'a Trajectory) -> Self {
        // No event can come, as those of the run are known.
        let rules = Rules::until(f64::INFINITY);
        Self {
            run,
            reached: None,
            flight: Flight::new(run.system(), &rules),
            series: Series::new(run.system(), &rules),
            waves: Waves::new(run.system()),
        }
    }

    /// State, taut set, tensions and energy at time t, held to the run's span.
    pub fn at(&mut self, t: f64) -> Motion {
        dispatch(MotionAt(self, t))
    }

    /// Passes every piece of the motion between two times within the run to `show`: a flight or an
    /// expansion, or the part of one that lies between them.
    pub(crate) fn each_piece(&mut self, [from, to]: [f64; 2], mut show: impl FnMut(&Piece)) {
        let mut t = from;
        while t < to {
            let index = self.segment_at(t);
            let next = self.run.segments().get(index + 1);
            let next = next.map_or(f64::INFINITY, |next| next.t);
            let (begun, expanded_to) = dispatch(Reaching(self, index, t));
            let end = to.min(next).min(expanded_to);
            let piece = Piece {
                playback: self,
                begun,
                width: end - t,
            };
            if piece.width > 0.0 {
                show(&piece);
            }
            // An expansion so short that the time does not change ends its chain.
            t = if end > t { end } else { next };
        }
    }

    /// The index of the segment in which a time lies. A run has at least the segment of its end;
    /// times before the start count as the start.
    fn segment_at(&self, t: f64) -> usize {
        let segments = self.run.segments();
        let after = segments.partition_point(|segment| segment.t <= t);
        after.saturating_sub(1)
    }

    #[inline(always)]
    fn at_here(&mut self, t: f64) -> Motion {
        let t = t.min(self.run.end().t);
        let segment = self.expand_before(self.segment_at(t), t);
        let s = (t - segment.t).max(0.0);
        let taut = segment.active.taut;
        let state = if s <= 0.0 {
            segment.start
        } else if self.run.system().has_closed_form(taut) {
            self.flight.state(s)
        } else {
            self.series.state(s)
        };
        let (system, t) = (self.run.system(), segment.t + s);
        self.waves.cover(t, t);
        let around = self.waves.at(system, t);
        let memory_force = if s > 0.0 {
            self.series.memory_force(s)
        } else {
            segment.memory_force(system)
        };
        Motion {
            t,
            state,
            taut,
            tensions: tensions(system, &around, &state, memory_force, taut),
            energy: system.energy(&state),
            memory_force,
        }
    }

    /// Expands the motion about the latest start of an expansion before time `t`, in the chain of a
    /// kept segment.
    #[inline(always)]
    fn expand_before(&mut self, index: usize, t: f64) -> Segment {
        let kept = self.run.segments();
        let system = self.run.system();
        let next = kept.get(index + 1).map_or(f64::INFINITY, |next| next.t);
        let mut segment = match self.reached.take() {
            Some((known, segment)) if known == index && segment.t <= t => segment,
            _ => {
                self.begin(&kept[index]);
                kept[index].clone()
            }
        };
        if !system.has_closed_form(segment.active.taut) {
            let mut later = segment.t + self.series.step();
            while segment.t < later && later <= t && later < next {
                segment = segment.following(system, &self.series);
                dispatch(Expanding(self, &segment));
                later = segment.t + self.series.step();
            }
        }
        self.reached = Some((index, segment.clone()));
        segment
    }

    #[inline(always)]
    fn begin(&mut self, segment: &Segment) {
        let (system, t, start) = (self.run.system(), segment.t, &segment.start);
        if system.has_closed_form(segment.active.taut) {
            // Gaps are not evaluated here, so that any contacts will do.
            let contacts = [Contact::RESTING; MAX_CABLES];
            self.flight.begin(system, t, start, start, &contacts);
        } else {
            dispatch(Expanding(self, segment));
        }
    }
}
