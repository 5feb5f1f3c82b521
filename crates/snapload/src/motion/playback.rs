//! The motion between the events of a finished run.

use crate::arithmetic::processor::{Kernel, dispatch};
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::active_set::tensions;
use crate::motion::contact::Contact;
use crate::motion::flight::Flight;
use crate::motion::segments::Segment;
use crate::motion::taut_series::Series;
use crate::motion::trajectory::Trajectory;
use crate::motion::waves::Waves;

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
    /// The force with which the water's memory holds a floating body back \[F, F, F L\].
    pub memory_force: [f64; 3],
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
    /// The kept segment that the motion was computed from, by index, and the one of its chain that
    /// it has come to.
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

impl<'a> Playback<'a> {
    /// Of a run.
    pub fn new(run: &'a Trajectory) -> Self {
        // Events lie behind.
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

    #[inline(always)]
    fn at_here(&mut self, t: f64) -> Motion {
        let t = t.min(self.run.end().t);
        let segments = self.run.segments();
        let after = segments.partition_point(|segment| segment.t <= t);
        // A run has at least the segment of its end; before the start it is the start that counts.
        let index = after.saturating_sub(1);
        let segment = self.come_to(index, t);
        let s = (t - segment.t).max(0.0);
        let taut = segment.active.taut;
        let state = if s <= 0.0 {
            segment.start
        } else if self.run.system().flies_freely(taut) {
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

    /// Expands the motion about the latest start of an expansion up to time `t`, in the chain of a
    /// kept segment.
    #[inline(always)]
    fn come_to(&mut self, index: usize, t: f64) -> Segment {
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
        if !system.flies_freely(segment.active.taut) {
            let mut later = segment.t + self.series.step();
            while segment.t < later && later <= t && later < next {
                segment = segment.following(system, &self.series);
                segment.expand(system, &mut self.waves, &mut self.series);
                later = segment.t + self.series.step();
            }
        }
        self.reached = Some((index, segment.clone()));
        segment
    }

    #[inline(always)]
    fn begin(&mut self, segment: &Segment) {
        let (system, t, start) = (self.run.system(), segment.t, &segment.start);
        if system.flies_freely(segment.active.taut) {
            // Gaps are not looked at here, so nothing need be known of them.
            let contacts = [Contact::RESTING; MAX_CABLES];
            self.flight.begin(system, t, start, start, &contacts);
        } else {
            segment.expand(system, &mut self.waves, &mut self.series);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::case::error::CaseError;
    use crate::case::named::named_case;
    use crate::case::parameters::Parameters;

    /// Expansions that were not kept are computed again to the bit, whatever is asked for first.
    #[test]
    fn a_motion_is_the_same_however_little_of_it_is_kept() -> Result<(), CaseError> {
        let long = Parameters {
            stop_when_settled: false,
            omega: 30.0,
            t_end: 40.0,
            ..Parameters::STANDARD
        };
        let cases = ["sliding-example", "rocking-example"].map(named_case);
        let [sliding, rocking] = cases;
        for parameters in [sliding?.parameters, rocking?.parameters, long] {
            let run = Case::new(parameters)?.run();
            let all = run.segments().len();
            for most in [0, 1, 7] {
                let mut thin = run.clone();
                thin.keep_links(most);
                let kept = thin.segments().len();
                assert!(kept + 20 < all, "{kept} of {all}");
                let (mut whole, mut playback) = (Playback::new(&run), Playback::new(&thin));
                let starts = run.segments().iter().map(|segment| segment.t);
                let mut times: Vec<f64> = starts.step_by(5).collect();
                times.extend((0..50).map(|k| run.end().t * f64::from(k * 37 % 50) / 49.0));
                times.extend([-1.0, f64::INFINITY]);
                for t in times {
                    assert_eq!(playback.at(t), whole.at(t), "{t} with {most}");
                }
            }
        }
        Ok(())
    }
}
