//! Many runs side by side, each to its end, of which only the outcomes are kept.
//!
//! Every lane of a vector carries a run of its own from bounce to bounce
//! ([`crate::motion::bounce`]). A step that is no bounce is made outside the lanes: the run
//! continues in its [`Simulation`], taut modes included, until it flies freely again. When a run
//! has stopped, the next takes its lane. A run in a lane has the same bits as the run by itself,
//! because both perform the same operations.

use crate::arithmetic::processor::dispatch;
use crate::batch::followers::{Follower, NoFollower};
pub use crate::batch::scheduler::Usage;
use crate::batch::scheduler::{LaneScheduler, Runs, TakeResult};
use crate::batch::slot::Slot;
use crate::case::Case;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::Simulation;
use std::vec::IntoIter;

/// The outcomes of runs and the verdicts of their followers, in their order. They are options,
/// although each place is filled, so that the allocation can be reused for the results made from
/// them.
pub(crate) type LaneResults<C> = IntoIter<Option<(Outcome, <C as Follower>::Verdict)>>;

/// Memory for this many outcomes is allocated at once at most; for more it grows.
const MOST_AT_ONCE: usize = 1 << 16;

/// The number of runs side by side. All variants give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// Four, in plain Rust, on every processor: a reference for the registers, used in tests only
    /// and not made to be fast.
    #[cfg(feature = "comparisons")]
    Plain,
    /// Eight, in pairs of the registers of a processor with AVX2 and FMA.
    Avx2,
    /// Eight, in the registers of a processor with AVX-512.
    Avx512,
}

impl Lanes {
    /// All variants that this processor supports.
    pub fn available() -> Vec<Self> {
        #[cfg_attr(
            not(target_arch = "x86_64"),
            expect(unused_mut, reason = "other processors have no more")
        )]
        let mut all = vec![
            Self::One,
            #[cfg(feature = "comparisons")]
            Self::Plain,
        ];
        #[cfg(target_arch = "x86_64")]
        {
            if crate::arithmetic::processor::has_fma() {
                all.push(Self::Avx2);
            }
            if is_x86_feature_detected!("avx512f") {
                all.push(Self::Avx512);
            }
        }
        all
    }

    /// The fastest variant that this processor supports.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") {
                return Self::Avx512;
            }
            if crate::arithmetic::processor::has_fma() {
                return Self::Avx2;
            }
        }
        Self::One
    }

    /// The outcomes of many cases, in their order, on one thread, and how well the lanes were used.
    pub fn outcomes(self, cases: &[Case]) -> (Vec<Outcome>, Usage) {
        let runs = cases
            .iter()
            .map(|case| (Box::new(case.simulation()), NoFollower));
        let (results, usage) = self.outcomes_with_followers(runs);
        let outcomes: Vec<Outcome> = results.filter_map(|result| Some(result?.0)).collect();
        assert_eq!(outcomes.len(), cases.len(), "every run has one result");
        (outcomes, usage)
    }

    /// The same for motions that have just begun, each with its follower. A run whose follower has
    /// ended continues without it.
    pub(crate) fn outcomes_with_followers<C: Follower>(
        self,
        runs: impl Iterator<Item = (Box<Simulation>, C)>,
    ) -> (LaneResults<C>, Usage) {
        let many = runs.size_hint().1.unwrap_or(0).min(MOST_AT_ONCE);
        let mut results: Vec<Option<(Outcome, C::Verdict)>> = Vec::with_capacity(many);
        let mut left = Vec::new();
        let mut begun = runs
            .enumerate()
            .map(|(index, (simulation, follower))| Slot::new(index, simulation, follower));
        let mut usage = self.run(&mut begun, &mut |slot| {
            let Slot {
                index,
                simulation,
                outcome,
                follower,
            } = *slot;
            if results.len() <= index {
                results.resize_with(index + 1, || None);
            }
            results[index] = Some((outcome.ended(&simulation), follower.verdict()));
            if simulation.stop().is_none() {
                left.push(Box::new(Slot {
                    index,
                    simulation,
                    outcome,
                    follower: NoFollower,
                }));
            }
        });
        let alone = self.run(&mut left.into_iter(), &mut |slot| {
            if let Some((outcome, _)) = &mut results[slot.index] {
                *outcome = slot.outcome.ended(&slot.simulation);
            }
        });
        usage.add(&alone);
        (results.into_iter(), usage)
    }

    /// Runs all of `runs` to their ends, or as far as their followers go, and passes them to
    /// `take_result`. If this processor lacks the registers, one lane is used.
    fn run<C: Follower>(self, runs: Runs<C>, take_result: TakeResult<C>) -> Usage {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if crate::arithmetic::processor::has_fma() => x86::avx2(runs, take_result),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if is_x86_feature_detected!("avx512f") => x86::avx512(runs, take_result),
            #[cfg(feature = "comparisons")]
            Self::Plain => LaneScheduler::<
                crate::batch::vector::Pair<crate::batch::vector::Pair<f64>>,
                C,
            >::new(runs, take_result)
            .run_all(),
            Self::One | Self::Avx2 | Self::Avx512 => {
                dispatch(LaneScheduler::<f64, C>::new(runs, take_result))
            }
        }
    }
}

#[cfg(feature = "comparisons")]
impl Lanes {
    /// Runs a case many times over. How many runs were on their way at a time, and how many places
    /// there are: in the lanes, waiting for a step together, and one on its way between them.
    pub fn most_at_a_time(self, case: &Case, count: usize) -> [usize; 2] {
        let [begun, ended, most] = [0_usize; 3].map(std::cell::Cell::new);
        let mut runs = (0..count).map(|index| {
            begun.set(begun.get() + 1);
            most.set(most.get().max(begun.get() - ended.get()));
            Slot::new(index, Box::new(case.simulation()), NoFollower)
        });
        let usage = self.run(&mut runs, &mut |slot| {
            assert!(slot.simulation.stop().is_some(), "it has ended");
            ended.set(ended.get() + 1);
        });
        assert_eq!((begun.get(), ended.get()), (count, count), "{self:?}");
        [most.get(), 2 * usage.width + 1]
    }
}

/// The functions that are compiled for the instructions of one kind of processor.
#[cfg(target_arch = "x86_64")]
mod x86 {
    #![expect(unsafe_code, reason = "functions for one kind of processor; see below")]
    use super::{Follower, LaneScheduler, Runs, TakeResult, Usage};
    use crate::arithmetic::processor;
    use crate::batch::vector::Pair;
    use crate::batch::vector::x86::{Avx2, Avx512};

    pub(super) fn avx2<C: Follower>(runs: Runs<C>, take_result: TakeResult<C>) -> Usage {
        #[target_feature(enable = "avx2,fma")]
        fn run_all<C: Follower>(scheduler: LaneScheduler<'_, Pair<Avx2>, C>) -> Usage {
            scheduler.run_all()
        }
        assert!(processor::has_fma());
        let scheduler = LaneScheduler::new(runs, take_result);
        // SAFETY: the processor has AVX2 and FMA, as was just asked.
        unsafe { run_all(scheduler) }
    }

    pub(super) fn avx512<C: Follower>(runs: Runs<C>, take_result: TakeResult<C>) -> Usage {
        #[target_feature(enable = "avx512f")]
        fn run_all<C: Follower>(scheduler: LaneScheduler<'_, Avx512, C>) -> Usage {
            scheduler.run_all()
        }
        assert!(is_x86_feature_detected!("avx512f"));
        let scheduler = LaneScheduler::new(runs, take_result);
        // SAFETY: the processor has AVX-512, as was just asked.
        unsafe { run_all(scheduler) }
    }
}
