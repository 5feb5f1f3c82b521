//! Many runs side by side, each to its end, without keeping them.
//!
//! Every lane of a vector carries a run of its own from bounce to bounce
//! ([`crate::motion::bounce`]). A step that is no bounce is made outside of the lanes: the run goes
//! on in its [`Simulation`], taut modes included, until it flies freely again. When a run has
//! stopped, the next takes its lane. A run in a lane has the bits of the same run by itself,
//! because both make the same operations.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::batch::vector::Several;
use crate::case::Case;
use crate::model::taut_set::TautSet;
use crate::motion::bounce::{Bounce, bounce};
use crate::motion::outcome::Outcome;
use crate::motion::simulation::{LastImpacts, Progress, Simulation};
use crate::motion::trajectory::RHO2_UNTIL;
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};

/// Takes the outcome of a run that has stopped, with its place in the order in which they came.
type Tell<'a> = &'a mut dyn FnMut(usize, Outcome);

/// How many runs go side by side. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// Four, in plain Rust: what the registers have to agree with, on every processor. It is not made
    /// to be fast.
    Plain,
    /// Eight, in pairs of the registers of a processor with AVX2 and FMA.
    Avx2,
    /// Eight, in the registers of a processor with AVX-512.
    Avx512,
}

impl Lanes {
    /// All kinds that this processor has.
    pub fn available() -> Vec<Self> {
        #[cfg_attr(
            not(target_arch = "x86_64"),
            expect(unused_mut, reason = "other processors have no more")
        )]
        let mut all = vec![Self::One, Self::Plain];
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

    /// The fastest that this processor has.
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
        self.outcomes_of(cases.iter().map(Case::simulation))
    }

    /// The same of motions that have just begun.
    pub fn outcomes_of(
        self,
        mut runs: impl ExactSizeIterator<Item = Simulation>,
    ) -> (Vec<Outcome>, Usage) {
        let count = runs.len();
        let mut outcomes = vec![None; count];
        let usage = self.run(&mut runs, &mut |index, outcome| {
            outcomes[index] = Some(outcome);
        });
        let told: Vec<Outcome> = outcomes.into_iter().flatten().collect();
        assert_eq!(told.len(), count, "every run is told of once");
        (told, usage)
    }

    /// Runs all of `runs` to their ends and hands each outcome on as the run stops. In place of
    /// lanes that this processor lacks, plain Rust is used.
    fn run(self, runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if crate::arithmetic::processor::has_fma() => x86::avx2(runs, tell),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if is_x86_feature_detected!("avx512f") => x86::avx512(runs, tell),
            Self::One => dispatch(LaneScheduler::<f64>::new(runs, tell)),
            Self::Plain | Self::Avx2 | Self::Avx512 => {
                LaneScheduler::<Several<f64, 4>>::new(runs, tell).run_all()
            }
        }
    }
}

/// The functions that are compiled for the instructions of one kind of processor.
#[cfg(target_arch = "x86_64")]
mod x86 {
    #![expect(unsafe_code, reason = "functions for one kind of processor; see below")]
    use super::{LaneScheduler, Simulation, Tell, Usage};
    use crate::arithmetic::processor;
    use crate::batch::vector::Several;
    use crate::batch::vector::x86::{Avx2, Avx512};

    pub(super) fn avx2(runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        #[target_feature(enable = "avx2,fma")]
        fn run_all(scheduler: LaneScheduler<'_, Several<Avx2, 2>>) -> Usage {
            scheduler.run_all()
        }
        assert!(processor::has_fma());
        let scheduler = LaneScheduler::new(runs, tell);
        // SAFETY: the processor has AVX2 and FMA, as was just asked.
        unsafe { run_all(scheduler) }
    }

    pub(super) fn avx512(runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        #[target_feature(enable = "avx512f")]
        fn run_all(scheduler: LaneScheduler<'_, Avx512>) -> Usage {
            scheduler.run_all()
        }
        assert!(is_x86_feature_detected!("avx512f"));
        let scheduler = LaneScheduler::new(runs, tell);
        // SAFETY: the processor has AVX-512, as was just asked.
        unsafe { run_all(scheduler) }
    }
}

/// How well the lanes were used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Rounds of bounces, each of all lanes.
    pub rounds: u64,
    /// Bounces made in lanes.
    pub bounces: u64,
    /// Steps that runs made by themselves, out of the lanes.
    pub steps_apart: u64,
    /// Lanes of a round.
    pub width: usize,
}

/// What a run counts on its way.
#[derive(Clone, Copy, Default)]
struct Tally<L> {
    impacts: L,
    /// Impacts of the second cable among them.
    second: L,
    rho1: L,
    rho2: L,
    rho3: L,
    /// The latest instants of impact: the bits of the set of cables, v_n, and how many in a row
    /// were of the same cables.
    cables: L,
    v_n: L,
    repeats: L,
}

/// A run that has a lane.
struct Slot {
    index: usize,
    simulation: Simulation,
    outcome: Outcome,
}

struct LaneScheduler<'a, L> {
    runs: &'a mut dyn Iterator<Item = Simulation>,
    tell: Tell<'a>,
    started: usize,
    slots: Vec<Option<Box<Slot>>>,
    two_cables: TwoCableSystem<L>,
    after_impact: AfterImpact<L>,
    tally: Tally<L>,
    usage: Usage,
}

impl<L: Doubles> Kernel for LaneScheduler<'_, L> {
    type Output = Usage;
    #[inline(always)]
    fn run(self) -> Usage {
        self.run_all()
    }
}

impl<'a, L: Doubles> LaneScheduler<'a, L> {
    fn new(runs: &'a mut dyn Iterator<Item = Simulation>, tell: Tell<'a>) -> Self {
        let zero = |_: f64, _: f64| L::ZERO;
        let (system, motion, tally) = Default::default();
        let mut scheduler = Self {
            runs,
            tell,
            started: 0,
            slots: (0..L::WIDTH).map(|_| None).collect(),
            two_cables: TwoCableSystem::zip_with(&system, &system, zero),
            after_impact: AfterImpact::zip_with(&motion, &motion, zero),
            tally: Tally::zip_with(&tally, &tally, zero),
            usage: Usage {
                width: L::WIDTH,
                ..Usage::default()
            },
        };
        for lane in 0..L::WIDTH {
            scheduler.refill(lane);
        }
        scheduler
    }

    /// Bounces until all runs have stopped.
    #[inline(always)]
    fn run_all(mut self) -> Usage {
        let all = (1u32 << L::WIDTH) - 1;
        let mut empty = 0;
        loop {
            let bounce = bounce(&self.two_cables, &self.after_impact);
            let plain = bounce.plain & self.tally.impacts.below(self.two_cables.max_impacts);
            let (tally, bits) = (self.tally.with(&bounce), plain.bits());
            if bits == all {
                (self.after_impact, self.tally) = (bounce.next, tally);
            } else {
                let chosen = |next, present| L::select(plain, next, present);
                self.after_impact = bounce.next.zip_with(&self.after_impact, chosen);
                self.tally = tally.zip_with(&self.tally, chosen);
            }
            let plain = bits & !empty;
            self.usage.rounds += 1;
            self.usage.bounces += u64::from(plain.count_ones());
            if plain != all {
                empty = self.serve(all & !plain);
                if empty == all {
                    return self.usage;
                }
            }
        }
    }

    /// Lets the runs of these lanes go on by themselves until they fly freely, and gives lanes that
    /// have become free to other runs. Returns the lanes that are empty.
    #[inline(never)]
    fn serve(&mut self, lanes: u32) -> u32 {
        let mut empty = 0;
        for lane in 0..L::WIDTH {
            if lanes & 1 << lane == 0 {
                continue;
            }
            if let Some(mut slot) = self.slots[lane].take() {
                self.leave(lane, &mut slot);
                slot.step();
                self.usage.steps_apart += 1;
                if !self.fill(lane, slot) {
                    self.refill(lane);
                }
            }
            if self.slots[lane].is_none() {
                empty |= 1 << lane;
            }
        }
        empty
    }

    /// Gives a lane to the next run that comes to fly freely; those before it stop without a lane.
    fn refill(&mut self, lane: usize) {
        while let Some(simulation) = self.runs.next() {
            let slot = Box::new(Slot {
                index: self.started,
                outcome: Outcome::begun(&simulation),
                simulation,
            });
            self.started += 1;
            if self.fill(lane, slot) {
                return;
            }
        }
    }

    /// Puts a run into a lane once it flies freely, or hands on its outcome if it stops before
    /// that. Returns whether the lane is taken.
    fn fill(&mut self, lane: usize, mut slot: Box<Slot>) -> bool {
        loop {
            if slot.simulation.stop().is_some() {
                (self.tell)(slot.index, slot.outcome.ended(&slot.simulation));
                return false;
            }
            // The first impact is part of the outcome, so it is not made in a lane.
            let begun = slot.outcome.first.is_some();
            if let (true, Some((two_cables, after_impact))) = (begun, slot.simulation.lane_start())
            {
                self.enter(lane, &slot, &two_cables, &after_impact);
                self.slots[lane] = Some(slot);
                return true;
            }
            slot.step();
            self.usage.steps_apart += 1;
        }
    }

    fn enter(
        &mut self,
        lane: usize,
        slot: &Slot,
        two_cables: &TwoCableSystem<f64>,
        after_impact: &AfterImpact<f64>,
    ) {
        let progress = slot.simulation.progress();
        let tally = Tally {
            impacts: progress.impacts as f64,
            second: slot.outcome.impacts[1] as f64,
            rho1: slot.outcome.norms.rho1,
            rho2: slot.outcome.norms.rho2,
            rho3: slot.outcome.norms.rho3,
            cables: f64::from(progress.last.cables.bits()),
            v_n: progress.last.v_n,
            repeats: f64::from(progress.last.repeats),
        };
        let put = |mut all: L, one| {
            all.set(lane, one);
            all
        };
        self.two_cables = self.two_cables.zip_with(two_cables, put);
        self.after_impact = self.after_impact.zip_with(after_impact, put);
        self.tally = self.tally.zip_with(&tally, put);
    }

    /// Brings a run's simulation up to what the run did in its lane.
    fn leave(&self, lane: usize, slot: &mut Slot) {
        let get = |all: L, _| all.get(lane);
        let after_impact = self.after_impact.zip_with(&self.after_impact, get);
        let tally = self.tally.zip_with(&self.tally, get);
        let before = slot.simulation.progress().impacts;
        let progress = Progress {
            impacts: tally.impacts as u64,
            last: LastImpacts {
                cables: TautSet::from_bits(tally.cables as u16),
                v_n: tally.v_n,
                repeats: tally.repeats as u32,
            },
        };
        let Outcome { impacts, norms, .. } = &mut slot.outcome;
        let second = tally.second as u64;
        impacts[0] = impacts[0] + (progress.impacts - before) - (second - impacts[1]);
        impacts[1] = second;
        (norms.rho1, norms.rho2, norms.rho3) = (tally.rho1, tally.rho2, tally.rho3);
        slot.simulation.resume(&after_impact, progress);
    }
}

impl Slot {
    fn step(&mut self) {
        if let Some(step) = self.simulation.step() {
            self.outcome.take(&step);
        }
    }
}

impl<L: Lane> Tally<L> {
    /// With an impact counted in every lane, as [`Outcome::take`] and [`Simulation`] do.
    #[inline(always)]
    fn with(
        &self,
        Bounce {
            second, v_n, next, ..
        }: &Bounce<L>,
    ) -> Self {
        let cables = L::select(*second, L::from_f64(2.0), L::ONE);
        let same = cables.at_most(self.cables) & self.cables.at_most(cables);
        let early = next.t.at_most(L::from_f64(RHO2_UNTIL));
        Self {
            impacts: self.impacts + 1.0,
            second: self.second + (cables - 1.0),
            rho1: self.rho1.larger(*v_n),
            rho2: L::select(early, self.rho2 + *v_n, self.rho2),
            rho3: self.rho3 + *v_n,
            cables,
            v_n: *v_n,
            repeats: L::select(same, self.repeats + 1.0, L::ONE),
        }
    }
}

impl<L: Copy> Tally<L> {
    /// What `number` makes of each number and the other tally's.
    #[inline(always)]
    fn zip_with<M: Copy, U>(&self, other: &Tally<M>, number: impl Fn(L, M) -> U) -> Tally<U> {
        Tally {
            impacts: number(self.impacts, other.impacts),
            second: number(self.second, other.second),
            rho1: number(self.rho1, other.rho1),
            rho2: number(self.rho2, other.rho2),
            rho3: number(self.rho3, other.rho3),
            cables: number(self.cables, other.cables),
            v_n: number(self.v_n, other.v_n),
            repeats: number(self.repeats, other.repeats),
        }
    }
}
