//! What is known of each cable's gap at the start of a stretch of motion.

use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::MAX_CABLES;

/// A gap as it is known at an event. Evaluated afresh from the state it has a rounding of its own,
/// which would swamp the last bounces of an accumulation (heights of v_n² / 2α); carried forward
/// from the moment when the cable was struck, it has far less.
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
    /// Closed, and moving along the normal as the state says.
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

    /// The more precise of a gap carried forward and the one evaluated.
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
