//! Many runs side by side, each to its end, without keeping them.
//!
//! Every lane of a vector carries a run of its own from bounce to bounce ([`crate::motion::bounce`]). What is not
//! a bounce leaves the lanes: the run goes on in its [`Simulation`], taut modes included, until it flies
//! freely again; a run that has stopped gives its lane to the next. A lane has the bits of the same run by
//! itself, because both make the same operations: here only the bounces of several runs are made at once.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::batch::vector::{Bits, Portable, Vector};
use crate::case::Case;
use crate::model::taut_set::TautSet;
use crate::motion::bounce::{Bounce, bounce};
use crate::motion::outcome::Outcome;
use crate::motion::simulation::{LastImpacts, Progress, Simulation};
use crate::motion::trajectory::RHO2_UNTIL;
use crate::motion::two_cables::{AfterImpact, STATE_NUMBERS, SYSTEM_NUMBERS, TwoCableSystem};

/// What is told of a run that has stopped: which it was, in the order in which they came, and its outcome.
type Tell<'a> = &'a mut dyn FnMut(usize, Outcome);

/// How many runs go side by side. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// Four, in plain Rust.
    Four,
    /// Eight, in plain Rust.
    Eight,
    /// Eight, in pairs of the registers of a processor with AVX2 and FMA.
    Avx2,
    /// Eight, in the registers of a processor with AVX-512.
    Avx512,
}

impl Lanes {
    /// All that this processor can do.
    pub fn available() -> Vec<Self> {
        #[cfg_attr(
            not(target_arch = "x86_64"),
            expect(unused_mut, reason = "no more are known")
        )]
        let mut all = vec![Self::One, Self::Four, Self::Eight];
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

    /// The fastest that this processor can do.
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

    /// Runs all of `runs` to their ends and tells each as it stops. Lanes that this processor lacks are
    /// done in plain Rust.
    fn run(self, runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if crate::arithmetic::processor::has_fma() => x86::avx2(runs, tell),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if is_x86_feature_detected!("avx512f") => x86::avx512(runs, tell),
            Self::One => dispatch(LaneScheduler::<f64>::new(runs, tell)),
            Self::Four => dispatch(LaneScheduler::<Portable<4>>::new(runs, tell)),
            Self::Eight | Self::Avx2 | Self::Avx512 => {
                dispatch(LaneScheduler::<Portable<8>>::new(runs, tell))
            }
        }
    }
}

/// The functions that are compiled for a processor's instructions, and called where it has them.
#[cfg(target_arch = "x86_64")]
mod x86 {
    #![expect(unsafe_code, reason = "functions for one kind of processor; see below")]
    use super::{LaneScheduler, Simulation, Tell, Usage};
    use crate::arithmetic::processor;
    use crate::batch::vector::twice::Twice;
    use crate::batch::vector::x86::{Avx2, Avx512};

    pub(super) fn avx2(runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        assert!(processor::has_fma());
        processor::dispatch(LaneScheduler::<Twice<Avx2>>::new(runs, tell))
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
#[derive(Clone, Copy)]
struct Tally<L> {
    impacts: L,
    /// Impacts of the second cable among them.
    second: L,
    rho1: L,
    rho2: L,
    rho3: L,
    /// The latest instants of impact: cables as the number of their set, v_n, and how many alike.
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
    /// More impacts than this stop a run.
    most_impacts: L,
    after_impact: AfterImpact<L>,
    tally: Tally<L>,
    usage: Usage,
}

impl<L: Vector> Kernel for LaneScheduler<'_, L> {
    type Output = Usage;
    #[inline(always)]
    fn run(self) -> Usage {
        self.run_all()
    }
}

impl<'a, L: Vector> LaneScheduler<'a, L> {
    fn new(runs: &'a mut dyn Iterator<Item = Simulation>, tell: Tell<'a>) -> Self {
        let zero = L::ZERO;
        let mut scheduler = Self {
            runs,
            tell,
            started: 0,
            slots: (0..L::WIDTH).map(|_| None).collect(),
            two_cables: TwoCableSystem::from_numbers([zero; SYSTEM_NUMBERS]),
            most_impacts: zero,
            after_impact: AfterImpact::from_numbers([zero; STATE_NUMBERS]),
            tally: Tally::from_numbers([zero; TALLY]),
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
            let plain = bounce.plain & self.tally.impacts.below(self.most_impacts);
            let (tally, bits) = (self.tally.with(&bounce), plain.bits());
            if bits == all {
                (self.after_impact, self.tally) = (bounce.next, tally);
            } else {
                self.after_impact = AfterImpact::select(plain, &bounce.next, &self.after_impact);
                self.tally = Tally::select(plain, &tally, &self.tally);
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

    /// Lets the runs of these lanes go on by themselves until they fly freely, and gives lanes that have become free
    /// to other runs. Returns the lanes that are empty.
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

    /// Gives a lane to the next run that flies freely at some time; those before it stop without.
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

    /// Puts a run into a lane once it flies freely. If it stops before, says so and leaves the lane free.
    fn fill(&mut self, lane: usize, mut slot: Box<Slot>) -> bool {
        loop {
            if slot.simulation.stop().is_some() {
                (self.tell)(slot.index, slot.outcome.ended(&slot.simulation));
                return false;
            }
            // The first impact is kept as such, so it is not made in a lane.
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
        let most = slot.simulation.rules().max_impacts as f64;
        self.most_impacts.set(lane, most);
        self.two_cables = TwoCableSystem::from_numbers(put(
            lane,
            self.two_cables.numbers(),
            two_cables.numbers(),
        ));
        self.after_impact = AfterImpact::from_numbers(put(
            lane,
            self.after_impact.numbers(),
            after_impact.numbers(),
        ));
        self.tally = Tally::from_numbers(put(lane, self.tally.numbers(), tally.numbers()));
    }

    /// Tells a run's simulation what it did in its lane.
    fn leave(&self, lane: usize, slot: &mut Slot) {
        let after_impact =
            AfterImpact::from_numbers(self.after_impact.numbers().map(|number| number.get(lane)));
        let tally = Tally::from_numbers(self.tally.numbers().map(|number| number.get(lane)));
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

fn put<L: Vector, const N: usize>(lane: usize, mut all: [L; N], one: [f64; N]) -> [L; N] {
    for (all, one) in all.iter_mut().zip(one) {
        all.set(lane, one);
    }
    all
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

    /// One of two, lane by lane.
    #[inline(always)]
    fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        let (mut numbers, others) = (no.numbers(), yes.numbers());
        for k in 0..TALLY {
            numbers[k] = L::select(mask, others[k], numbers[k]);
        }
        Self::from_numbers(numbers)
    }
}

/// How many numbers a [`Tally`] is.
const TALLY: usize = 8;

impl<L: Copy> Tally<L> {
    fn numbers(&self) -> [L; TALLY] {
        let Self {
            impacts,
            second,
            rho1,
            rho2,
            rho3,
            cables,
            v_n,
            repeats,
        } = *self;
        [impacts, second, rho1, rho2, rho3, cables, v_n, repeats]
    }

    fn from_numbers([impacts, second, rho1, rho2, rho3, cables, v_n, repeats]: [L; TALLY]) -> Self {
        Self {
            impacts,
            second,
            rho1,
            rho2,
            rho3,
            cables,
            v_n,
            repeats,
        }
    }
}
