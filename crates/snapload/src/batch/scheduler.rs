//! The lanes and the runs in them: bounces are made in the lanes, all other steps by each run
//! alone, or with others that rock ([`crate::batch::rocking`]).

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::processor::Kernel;
use crate::batch::followers::{Follower, InTurn, LaneFollowers};
use crate::batch::rocking::Rocking;
use crate::batch::slot::Slot;
use crate::model::taut_set::TautSet;
use crate::motion::bounce::{Bounce, bounce};
use crate::motion::bounce_map::Bounced;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::{LastImpacts, Progress};
use crate::motion::trajectory::RHO2_UNTIL;
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};

/// Takes a run that has stopped, or whose follower has ended.
pub(super) type TakeResult<'a, C> = &'a mut dyn FnMut(Box<Slot<C>>);

/// The runs that are to be put into lanes.
pub(super) type Runs<'a, C> = &'a mut dyn Iterator<Item = Box<Slot<C>>>;

/// How well the lanes were used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Rounds, in each of which every lane makes a bounce.
    pub rounds: u64,
    /// Bounces made in lanes.
    pub bounces: u64,
    /// Steps that runs made by themselves, outside the lanes.
    pub steps_apart: u64,
    /// The number of lanes.
    pub width: usize,
}

impl Usage {
    /// Adds the usage of other runs.
    pub(super) fn add(&mut self, other: &Self) {
        self.rounds += other.rounds;
        self.bounces += other.bounces;
        self.steps_apart += other.steps_apart;
    }
}

/// The counters of a run.
#[derive(Clone, Copy, Default)]
struct Counts<L> {
    impacts: L,
    /// Impacts of the second cable among them.
    second: L,
    rho1: L,
    rho2: L,
    rho3: L,
    /// The latest instants of impact: the bits of the set of cables, v_n, and how many instants in
    /// a row were of the same cables.
    cables: L,
    v_n: L,
    repeats: L,
}

/// Whether a run is put into a lane for the first time, or back into the lane that has its system.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LaneEntry {
    First,
    Return,
}

pub(super) struct LaneScheduler<'a, L: Doubles, C: Follower> {
    runs: Runs<'a, C>,
    take_result: TakeResult<'a, C>,
    slots: Vec<Option<Box<Slot<C>>>>,
    two_cables: TwoCableSystem<L>,
    after_impact: AfterImpact<L>,
    tally: Counts<L>,
    followers: InTurn<C::LaneFollowers<L>>,
    rocking: Rocking<L::Register, C>,
    /// Runs that have rocked and now continue otherwise.
    returning: Vec<Box<Slot<C>>>,
    usage: Usage,
}

impl<L: Doubles, C: Follower> Kernel for LaneScheduler<'_, L, C> {
    type Output = Usage;
    #[inline(always)]
    fn run(self) -> Usage {
        self.run_all()
    }
}

impl<'a, L: Doubles, C: Follower> LaneScheduler<'a, L, C> {
    pub(super) fn new(runs: Runs<'a, C>, take_result: TakeResult<'a, C>) -> Self {
        let zero = |_: f64, _: f64| L::ZERO;
        let (system, motion, tally) = Default::default();
        let mut scheduler = Self {
            runs,
            take_result,
            slots: (0..L::WIDTH).map(|_| None).collect(),
            two_cables: TwoCableSystem::zip_with(&system, &system, zero),
            after_impact: AfterImpact::zip_with(&motion, &motion, zero),
            tally: Counts::zip_with(&tally, &tally, zero),
            followers: InTurn::new(C::LaneFollowers::empty()),
            rocking: Rocking::new(),
            returning: Vec::new(),
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

    /// Makes bounces until all runs have stopped.
    #[inline(always)]
    pub(super) fn run_all(mut self) -> Usage {
        let all = (1u32 << L::WIDTH) - 1;
        let mut empty = 0;
        loop {
            let bounce = bounce(&self.two_cables, &self.after_impact);
            let plain = bounce.plain & self.tally.impacts.below(self.two_cables.max_impacts);
            let bounced = Bounced::of(&self.two_cables, &self.after_impact, &bounce);
            let (now, next) = self.followers.now_and_next();
            let plain = now.bounce(next, plain, &bounced);
            self.followers.turn();
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
                empty = self.resume_alone(all & !plain);
                while self.rocking.is_full() || empty == all && !self.rocking.is_empty() {
                    self.rock();
                    empty = self.fill_empty();
                }
                if empty == all {
                    return self.usage;
                }
            }
        }
    }

    /// Lets the runs of these lanes continue by themselves until they fly freely, and gives free
    /// lanes to other runs. Returns the lanes that are empty.
    #[inline(never)]
    fn resume_alone(&mut self, lanes: u32) -> u32 {
        let mut empty = 0;
        for lane in 0..L::WIDTH {
            if lanes & 1 << lane == 0 {
                continue;
            }
            if let Some(mut slot) = self.slots[lane].take() {
                self.leave(lane, &mut slot);
                slot.step();
                self.usage.steps_apart += 1;
                if !self.fill(lane, slot, LaneEntry::Return) {
                    self.refill(lane);
                }
            }
            if self.slots[lane].is_none() {
                empty |= 1 << lane;
            }
        }
        empty
    }

    /// Lets the runs that rock make a step.
    #[inline(always)]
    fn rock(&mut self) {
        let (mut others, made) = self.rocking.step();
        self.usage.steps_apart += made as u64;
        self.returning.append(&mut others);
    }

    /// Gives empty lanes to runs again; returns those that remain empty.
    fn fill_empty(&mut self) -> u32 {
        let mut empty = 0;
        for lane in 0..L::WIDTH {
            if self.slots[lane].is_none() {
                self.refill(lane);
            }
            if self.slots[lane].is_none() {
                empty |= 1 << lane;
            }
        }
        empty
    }

    /// Gives a lane to the next run that flies freely at some time; runs before it that never do
    /// end without a lane. Those that rock wait, and once as many wait as step together, no other
    /// run begins before they have made room: few runs are in progress at any time.
    fn refill(&mut self, lane: usize) {
        while !self.rocking.is_full()
            && let Some(slot) = self.returning.pop().or_else(|| self.runs.next())
        {
            if self.fill(lane, slot, LaneEntry::First) {
                return;
            }
        }
    }

    /// Puts a run into a lane once it flies freely, or passes it on if it ends before that. Returns
    /// whether the lane is taken.
    fn fill(&mut self, lane: usize, mut slot: Box<Slot<C>>, entry: LaneEntry) -> bool {
        loop {
            if slot.simulation.stop().is_some() || !slot.follower.is_active() {
                (self.take_result)(slot);
                return false;
            }
            // The first impact is part of the outcome, and lanes do not record it.
            let begun = slot.outcome.first.is_some() && slot.follower.fits_a_lane();
            if let (true, Some((two_cables, after_impact))) = (begun, slot.simulation.lane_start())
            {
                if entry == LaneEntry::First {
                    self.two_cables = self.two_cables.zip_with(two_cables, put(lane));
                }
                self.enter(lane, &slot, &after_impact);
                self.slots[lane] = Some(slot);
                return true;
            }
            if self.rocking.takes(&slot) {
                self.rocking.push(slot);
                return false;
            }
            slot.step();
            self.usage.steps_apart += 1;
        }
    }

    fn enter(&mut self, lane: usize, slot: &Slot<C>, after_impact: &AfterImpact<f64>) {
        let progress = slot.simulation.progress();
        let tally = Counts {
            impacts: progress.impacts as f64,
            second: slot.outcome.impacts[1] as f64,
            rho1: slot.outcome.norms.rho1,
            rho2: slot.outcome.norms.rho2,
            rho3: slot.outcome.norms.rho3,
            cables: f64::from(progress.last.cables.bits()),
            v_n: progress.last.v_n,
            repeats: f64::from(progress.last.repeats),
        };
        self.after_impact = self.after_impact.zip_with(after_impact, put(lane));
        self.tally = self.tally.zip_with(&tally, put(lane));
        self.followers.now().put(lane, &slot.follower);
    }

    /// Updates a run with the result of its lane, which has not made the latest bounce.
    fn leave(&mut self, lane: usize, slot: &mut Slot<C>) {
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
        let made = progress.impacts - before;
        let followers = self.followers.before();
        followers.get(lane, &mut slot.follower, made);
    }
}

/// Puts a double into a lane.
#[inline(always)]
fn put<L: Doubles>(lane: usize) -> impl Fn(L, f64) -> L + Copy {
    move |mut all, one| {
        all.set(lane, one);
        all
    }
}

impl<L: Lane> Counts<L> {
    /// The counts with an impact added in every lane, as [`Outcome::take`] and
    /// [`crate::motion::simulation::Simulation`] count them.
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

impl<L: Copy> Counts<L> {
    /// A function of each number and the other counts'.
    #[inline(always)]
    fn zip_with<M: Copy, U>(&self, other: &Counts<M>, number: impl Fn(L, M) -> U) -> Counts<U> {
        Counts {
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
