//! Functions for tests only: the same step with other instructions, and facts about a bounce to
//! compare with those of a general step.

use crate::arithmetic::processor::plain;
use crate::motion::bounce_map::{BounceMap, Rows};
use crate::motion::simulation::kernels::NextStep;
use crate::motion::simulation::{Simulation, Step};

/// The effect of a bounce on deviations (w, τ), one column for each deviation, after each of its
/// stages.
#[derive(Clone, Copy, Debug)]
pub struct BounceStages {
    /// Along the flight.
    pub along: [[f64; 7]; 7],
    /// Then to the impact's own time.
    pub met: [[f64; 7]; 7],
    /// Then through the law of impact.
    pub after: [[f64; 7]; 7],
    /// The whole bounce, for deviations at one common time.
    pub at_one_time: [[f64; 7]; 7],
    /// The square of the largest factor by which a deviation can grow because the impact comes at
    /// another time.
    pub magnification_squared: f64,
}

impl Simulation {
    /// [`Simulation::step`] with only the instructions that every processor of the family has.
    pub fn step_plain(&mut self) -> Option<Step> {
        plain(NextStep(self))
    }

    /// Counts a step of no length without a snap, as [`Simulation::step`] does.
    pub fn idle(&mut self) {
        self.check_progress(self.t, self.impacts);
    }

    /// The effect of the latest step on deviations, if it was a bounce.
    pub fn bounce_stages(&self, step: &Step) -> Option<BounceStages> {
        let map = BounceMap::of(&self.bounced(step)?);
        let mut rows: Rows<f64, 7> = [[0.0; 7]; 7];
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        let mut at_one_time = rows;
        map.at_one_time(&mut at_one_time);
        map.along(&mut rows);
        let along = rows;
        map.meet(&mut rows);
        let met = rows;
        map.through(&mut rows);
        Some(BounceStages {
            along,
            met,
            after: rows,
            at_one_time,
            magnification_squared: map.magnification_squared(),
        })
    }
}
