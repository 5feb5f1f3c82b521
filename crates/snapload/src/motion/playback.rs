//! The motion between the events of a finished run.

use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::active_set::{ActiveSet, tensions};
use crate::motion::contact::Contact;
use crate::motion::flight::Flight;
use crate::motion::taut_series::Series;
use crate::motion::trajectory::Trajectory;

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
}

impl Trajectory {
    /// State, taut set, tensions and energy at time t, held to the run's span; at an event's
    /// instant those after it. For many times ask [`Playback`].
    pub fn at(&self, t: f64) -> Motion {
        Playback::new(self).at(t)
    }
}

/// Plays a run back: computes the motion at any time, quickest for times that follow each other.
#[derive(Clone, Debug)]
pub struct Playback<'a> {
    run: &'a Trajectory,
    segment: Option<usize>,
    flight: Flight<f64>,
    series: Series<f64>,
}

impl<'a> Playback<'a> {
    /// Of a run.
    pub fn new(run: &'a Trajectory) -> Self {
        // Events lie behind.
        let rules = Rules::until(f64::INFINITY);
        Self {
            run,
            segment: None,
            flight: Flight::new(run.system(), &rules),
            series: Series::new(run.system(), &rules),
        }
    }

    /// State, taut set, tensions and energy at time t, held to the run's span.
    pub fn at(&mut self, t: f64) -> Motion {
        let segments = self.run.segments();
        let after = segments.partition_point(|segment| segment.t <= t);
        // A run has at least the segment of its end; before the start it is the start that counts.
        let index = after.saturating_sub(1);
        let segment = &segments[index];
        let s = (t - segment.t).clamp(0.0, (self.run.end().t - segment.t).max(0.0));
        if self.segment != Some(index) {
            self.begin(index);
        }
        let state = if s <= 0.0 {
            segment.start
        } else if self.run.system().flies_freely(segment.taut) {
            self.flight.state(s)
        } else {
            self.series.state(s)
        };
        let (system, t) = (self.run.system(), segment.t + s);
        Motion {
            t,
            state,
            taut: segment.taut,
            tensions: tensions(system, t, &state, segment.taut),
            energy: system.energy(&state),
        }
    }

    fn begin(&mut self, index: usize) {
        let segment = &self.run.segments()[index];
        let (system, t, start) = (self.run.system(), segment.t, &segment.start);
        // Gaps are not looked at here, so nothing need be known of them.
        let contacts = [Contact::RESTING; MAX_CABLES];
        if system.flies_freely(segment.taut) {
            self.flight.begin(system, t, start, start, &contacts);
        } else {
            let active = ActiveSet {
                taut: segment.taut,
                carrying: segment.carrying,
            };
            self.series.begin(system, t, start, &contacts, active);
        }
        self.segment = Some(index);
    }
}
