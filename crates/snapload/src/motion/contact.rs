//! The gap of each cable at the start of a segment of motion, with its error.

use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::MAX_CABLES;

/// A gap at an event. If it is evaluated from the state its rounding error would exceed the heights
/// v_n² / 2α of the last bounces of an accumulation; carried forward from the time when the cable
/// was struck, its error is far smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact<T> {
    /// g ≤ 0; exactly 0 for a cable that is struck, taut or just released.
    pub(crate) gap: T,
    /// Bound on the error of `gap`.
    pub(crate) error: T,
    /// Whether ġ = 0 is known, too.
    pub(crate) resting: bool,
}

impl<T: Real> Contact<T> {
    /// Closed, with the normal velocity of the state.
    pub(crate) const CLOSED: Self = Self {
        gap: T::ZERO,
        error: T::ZERO,
        resting: false,
    };
    /// Closed, with no normal velocity.
    pub(crate) const RESTING: Self = Self {
        gap: T::ZERO,
        error: T::ZERO,
        resting: true,
    };

    /// Evaluated from the state.
    #[inline(always)]
    pub(crate) fn evaluated(system: &System<T>, cable: usize, state: &State<T>) -> Self {
        let (gap, error) = system.cables[cable].gap_and_error(state);
        Self {
            gap,
            error,
            resting: false,
        }
    }

    /// The same with a gap of exactly zero where that is zero up to rounding.
    #[inline(always)]
    pub(crate) fn without_rounding(self) -> Self {
        Self {
            gap: if self.gap < -self.error {
                self.gap
            } else {
                T::ZERO
            },
            ..self
        }
    }

    /// The more precise of a gap carried forward and the one evaluated from the state.
    #[inline(always)]
    pub(crate) fn carried(self, system: &System<T>, cable: usize, state: &State<T>) -> Self {
        let evaluated = Self::evaluated(system, cable, state);
        if self.error < evaluated.error {
            self
        } else {
            evaluated
        }
    }
}

/// Contacts by cable.
pub(crate) type Contacts<T> = [Contact<T>; MAX_CABLES];
