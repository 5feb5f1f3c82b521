//! What a run comes to, without keeping the run.

use crate::lanes::Finished;
use crate::{Case, End, Lanes, Norms, Simulation, Usage};
use rayon::prelude::*;

/// How many of `count` cases go to a thread at a time: enough for lanes to be full, and few enough to share.
pub(crate) fn share(count: usize) -> usize {
    const MOST: usize = 256;
    count.div_ceil(rayon::current_num_threads()).clamp(1, MOST)
}

/// The end and the norms of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub end: End,
    /// The norms.
    pub norms: Norms,
    /// How many impacts, impulses passed into taut cables not among them.
    pub impacts: u64,
}

impl Outcome {
    /// Of a case.
    pub fn of(case: &Case) -> Self {
        Self::after(case.simulation())
    }

    /// Of many cases, in their order: side by side in the lanes of the processor, on all threads that there
    /// are. Each has the bits that it has by itself.
    pub fn of_many(cases: &[Case]) -> Vec<Self> {
        let chunks = cases.par_chunks(share(cases.len()));
        chunks
            .flat_map_iter(|chunk| Self::side_by_side(chunk, Lanes::best()).0)
            .collect()
    }

    /// Of many cases, in their order, on one thread and in the lanes that are asked for.
    pub fn side_by_side(cases: &[Case], lanes: Lanes) -> (Vec<Self>, Usage) {
        let mut outcomes = vec![None; cases.len()];
        let mut runs = cases.iter().map(Case::simulation);
        let usage = lanes.run(&mut runs, &mut |run| {
            outcomes[run.index] = Some(Self::finished(&run));
        });
        (outcomes.into_iter().flatten().collect(), usage)
    }

    fn finished(run: &Finished) -> Self {
        Self {
            end: End::of(&run.simulation),
            norms: run.norms,
            impacts: run.impacts,
        }
    }

    /// Of a simulation that is run to its end.
    pub fn after(mut simulation: Simulation) -> Self {
        let mut norms = Norms::default();
        let mut impacts = 0;
        while let Some(step) = simulation.step() {
            for impact in step.impacts() {
                norms.take(&impact);
                impacts += u64::from(impact.v_n > 0.0);
            }
        }
        norms.y_max = simulation.y_max();
        norms.theta_max = simulation.theta_max();
        Self {
            end: End::of(&simulation),
            norms,
            impacts,
        }
    }

    /// Whether it stopped at the rotation limit or the upper bound.
    pub fn exceeds(&self) -> bool {
        self.end.reason.exceeds()
    }
}
