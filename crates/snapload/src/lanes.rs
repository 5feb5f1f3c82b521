//! Many runs side by side, each to its end, without keeping them.
//!
//! Every lane of a vector carries a run of its own from bounce to bounce ([`crate::bounce`]). What is not
//! a bounce leaves the lanes: the run goes on in its [`Simulation`], taut modes included, until it flies
//! freely again; a run that has stopped gives its lane to the next. A lane has the bits of the same run by
//! itself, because both make the same operations: here only the bounces of several runs are made at once.

use crate::bounce::{Bounce, bounce};
use crate::fused::{Work, best};
use crate::lane::Lane;
use crate::mooring::{MOMENT, MOORING, Moment, Mooring};
use crate::simulate::{LastImpacts, Progress};
use crate::trajectory::RHO2_UNTIL;
use crate::vector::{Bits, Portable, Vector};
use crate::{Case, Outcome, Simulation, TautSet};

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
            if crate::fused::is_here() {
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
            if crate::fused::is_here() {
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
            Self::Avx2 if crate::fused::is_here() => x86::avx2(runs, tell),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if is_x86_feature_detected!("avx512f") => x86::avx512(runs, tell),
            Self::One => best(Fleet::<f64>::board(runs, tell)),
            Self::Four => best(Fleet::<Portable<4>>::board(runs, tell)),
            Self::Eight | Self::Avx2 | Self::Avx512 => {
                best(Fleet::<Portable<8>>::board(runs, tell))
            }
        }
    }
}

/// The functions that are compiled for a processor's instructions, and called where it has them.
#[cfg(target_arch = "x86_64")]
mod x86 {
    #![expect(unsafe_code, reason = "functions for one kind of processor; see below")]
    use super::{Fleet, Simulation, Tell, Usage};
    use crate::fused;
    use crate::vector::twice::Twice;
    use crate::vector::x86::{Avx2, Avx512};

    pub(super) fn avx2(runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        assert!(fused::is_here());
        fused::best(Fleet::<Twice<Avx2>>::board(runs, tell))
    }

    pub(super) fn avx512(runs: &mut dyn Iterator<Item = Simulation>, tell: Tell) -> Usage {
        #[target_feature(enable = "avx512f")]
        fn sail(fleet: Fleet<'_, Avx512>) -> Usage {
            fleet.sail()
        }
        assert!(is_x86_feature_detected!("avx512f"));
        let fleet = Fleet::board(runs, tell);
        // SAFETY: the processor has AVX-512, as was just asked.
        unsafe { sail(fleet) }
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
struct Rider {
    index: usize,
    simulation: Simulation,
    outcome: Outcome,
}

struct Fleet<'a, L> {
    runs: &'a mut dyn Iterator<Item = Simulation>,
    tell: Tell<'a>,
    boarded: usize,
    riders: Vec<Option<Box<Rider>>>,
    mooring: Mooring<L>,
    /// More impacts than this stop a run.
    most_impacts: L,
    moment: Moment<L>,
    tally: Tally<L>,
    usage: Usage,
}

impl<L: Vector> Work for Fleet<'_, L> {
    type Done = Usage;
    #[inline(always)]
    fn done(self) -> Usage {
        self.sail()
    }
}

impl<'a, L: Vector> Fleet<'a, L> {
    fn board(runs: &'a mut dyn Iterator<Item = Simulation>, tell: Tell<'a>) -> Self {
        let zero = L::ZERO;
        let mut fleet = Self {
            runs,
            tell,
            boarded: 0,
            riders: (0..L::WIDTH).map(|_| None).collect(),
            mooring: Mooring::from_numbers([zero; MOORING]),
            most_impacts: zero,
            moment: Moment::from_numbers([zero; MOMENT]),
            tally: Tally::from_numbers([zero; TALLY]),
            usage: Usage {
                width: L::WIDTH,
                ..Usage::default()
            },
        };
        for lane in 0..L::WIDTH {
            fleet.refill(lane);
        }
        fleet
    }

    /// Bounces until all runs have stopped.
    #[inline(always)]
    fn sail(mut self) -> Usage {
        let all = (1u32 << L::WIDTH) - 1;
        let mut empty = 0;
        loop {
            let bounce = bounce(&self.mooring, &self.moment);
            let plain = bounce.plain & self.tally.impacts.below(self.most_impacts);
            let (tally, bits) = (self.tally.with(&bounce), plain.bits());
            if bits == all {
                (self.moment, self.tally) = (bounce.next, tally);
            } else {
                self.moment = Moment::select(plain, &bounce.next, &self.moment);
                self.tally = Tally::select(plain, &tally, &self.tally);
            }
            let plain = bits & !empty;
            self.usage.rounds += 1;
            self.usage.bounces += u64::from(plain.count_ones());
            if plain != all {
                empty = self.attend(all & !plain);
                if empty == all {
                    return self.usage;
                }
            }
        }
    }

    /// Lets the runs of these lanes go on by themselves until they fly freely, and gives lanes that have become free
    /// to other runs. Returns the lanes that are empty.
    #[inline(never)]
    fn attend(&mut self, lanes: u32) -> u32 {
        let mut empty = 0;
        for lane in 0..L::WIDTH {
            if lanes & 1 << lane == 0 {
                continue;
            }
            if let Some(mut rider) = self.riders[lane].take() {
                self.leave(lane, &mut rider);
                rider.step();
                self.usage.steps_apart += 1;
                if !self.boards(lane, rider) {
                    self.refill(lane);
                }
            }
            if self.riders[lane].is_none() {
                empty |= 1 << lane;
            }
        }
        empty
    }

    /// Gives a lane to the next run that flies freely at some time; those before it stop without.
    fn refill(&mut self, lane: usize) {
        while let Some(simulation) = self.runs.next() {
            let rider = Box::new(Rider {
                index: self.boarded,
                outcome: Outcome::begun(&simulation),
                simulation,
            });
            self.boarded += 1;
            if self.boards(lane, rider) {
                return;
            }
        }
    }

    /// Puts a run into a lane once it flies freely. If it stops before, says so and leaves the lane free.
    fn boards(&mut self, lane: usize, mut rider: Box<Rider>) -> bool {
        loop {
            if rider.simulation.stop().is_some() {
                (self.tell)(rider.index, rider.outcome.ended(&rider.simulation));
                return false;
            }
            // The first impact is kept as such, so it is not made in a lane.
            let begun = rider.outcome.first.is_some();
            if let (true, Some((mooring, moment))) = (begun, rider.simulation.aboard()) {
                self.enter(lane, &rider, &mooring, &moment);
                self.riders[lane] = Some(rider);
                return true;
            }
            rider.step();
            self.usage.steps_apart += 1;
        }
    }

    fn enter(&mut self, lane: usize, rider: &Rider, mooring: &Mooring<f64>, moment: &Moment<f64>) {
        let progress = rider.simulation.progress();
        let tally = Tally {
            impacts: progress.impacts as f64,
            second: rider.outcome.impacts[1] as f64,
            rho1: rider.outcome.norms.rho1,
            rho2: rider.outcome.norms.rho2,
            rho3: rider.outcome.norms.rho3,
            cables: f64::from(progress.last.cables.bits()),
            v_n: progress.last.v_n,
            repeats: f64::from(progress.last.repeats),
        };
        let most = rider.simulation.rules().max_impacts as f64;
        self.most_impacts.set(lane, most);
        self.mooring = Mooring::from_numbers(put(lane, self.mooring.numbers(), mooring.numbers()));
        self.moment = Moment::from_numbers(put(lane, self.moment.numbers(), moment.numbers()));
        self.tally = Tally::from_numbers(put(lane, self.tally.numbers(), tally.numbers()));
    }

    /// Tells a run's simulation what it did in its lane.
    fn leave(&self, lane: usize, rider: &mut Rider) {
        let moment = Moment::from_numbers(self.moment.numbers().map(|number| number.get(lane)));
        let tally = Tally::from_numbers(self.tally.numbers().map(|number| number.get(lane)));
        let before = rider.simulation.progress().impacts;
        let progress = Progress {
            impacts: tally.impacts as u64,
            last: LastImpacts {
                cables: TautSet::from_bits(tally.cables as u16),
                v_n: tally.v_n,
                repeats: tally.repeats as u32,
            },
        };
        let Outcome { impacts, norms, .. } = &mut rider.outcome;
        let second = tally.second as u64;
        *impacts = [
            impacts[0] + (progress.impacts - before) - (second - impacts[1]),
            second,
        ];
        (norms.rho1, norms.rho2, norms.rho3) = (tally.rho1, tally.rho2, tally.rho3);
        rider.simulation.resume(&moment, progress);
    }
}

fn put<L: Vector, const N: usize>(lane: usize, mut all: [L; N], one: [f64; N]) -> [L; N] {
    for (all, one) in all.iter_mut().zip(one) {
        all.set(lane, one);
    }
    all
}

impl Rider {
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
