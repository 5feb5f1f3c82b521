//! Runs that rock on two taut cables, which make their steps together.

use crate::arithmetic::elementary::Doubles;
use crate::batch::followers::Follower;
use crate::batch::slot::Slot;
use crate::motion::taut_series::RockingSeries;

/// Runs that wait to make a step together.
pub(super) struct Rocking<L: Doubles, C> {
    waiting: Vec<Box<Slot<C>>>,
    series: Box<RockingSeries<L>>,
}

impl<L: Doubles, C: Follower> Rocking<L, C> {
    pub(super) fn new() -> Self {
        Self {
            waiting: Vec::new(),
            series: Box::new(RockingSeries::empty()),
        }
    }

    /// Whether a run is to wait here: it rocks, and a register has places for more than one.
    pub(super) fn takes(&self, slot: &Slot<C>) -> bool {
        L::WIDTH > 1 && slot.simulation.rocks()
    }

    /// Lets a run wait.
    pub(super) fn push(&mut self, slot: Box<Slot<C>>) {
        self.waiting.push(slot);
    }

    /// Whether there are as many runs as can step at once.
    pub(super) fn is_full(&self) -> bool {
        self.waiting.len() >= L::WIDTH
    }

    /// Whether no run waits.
    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Lets all runs here make a step, as many at once as there are lanes. Returns those that do
    /// not rock on, and how many steps were made.
    #[inline(always)]
    pub(super) fn step(&mut self) -> (Vec<Box<Slot<C>>>, usize) {
        let mut others = Vec::new();
        let made = self.waiting.len();
        let mut waiting = std::mem::take(&mut self.waiting);
        for group in waiting.chunks_mut(L::WIDTH) {
            self.series.clear();
            let mut fitting = 0_u32;
            for (lane, slot) in group.iter_mut().enumerate() {
                let fits = slot.simulation.begin_rocking(&mut self.series, lane);
                fitting |= u32::from(fits) << lane;
            }
            self.series.extend();
            for (lane, slot) in group.iter_mut().enumerate() {
                if fitting & 1 << lane != 0 {
                    slot.simulation.take_rocking(&self.series, lane);
                }
                slot.step();
            }
        }
        for slot in waiting {
            let goes_on = slot.simulation.stop().is_none() && slot.follower.is_active();
            if goes_on && slot.simulation.rocks() {
                self.waiting.push(slot);
            } else {
                others.push(slot);
            }
        }
        (others, made)
    }
}
