//! When a run stops, and why it did.

use crate::arithmetic::real::Real;

/// What ends a run, each rule on or off (docs/model.md section 7), and what counts as being at
/// rest.
///
/// Whatever has to know all of them takes this apart without `..`, so that a rule which is added is
/// known everywhere or does not compile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules<T = f64> {
    /// Stop when |θ| reaches this angle \[rad\].
    pub rotation_limit: Option<T>,
    /// Stop when the highest point of the body reaches this level \[L\].
    pub upper_bound: Option<T>,
    /// Stop when a cable sticks, or two are taut, while y is below this height \[L\].
    pub settled_below: Option<T>,
    /// Stop when a cable sticks at or above this height \[L\].
    pub sliding_above: Option<T>,
    /// Stop at this time \[T\].
    pub t_end: T,
    /// Stop after more impacts than this.
    pub max_impacts: u64,
    /// An impact slower than this lets its cable stick, if the cable would then carry tension
    /// \[L/T\].
    pub v_stick: T,
}

impl<T: Real> Rules<T> {
    /// Every rule off but the end of time; nothing sticks that does not come to rest.
    pub fn until(t_end: T) -> Self {
        Self {
            rotation_limit: None,
            upper_bound: None,
            settled_below: None,
            sliding_above: None,
            t_end,
            max_impacts: u64::MAX,
            v_stick: T::ZERO,
        }
    }
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stop {
    /// A cable stuck, or two are taut, below the settling height.
    Settled,
    /// |θ| reached the rotation limit.
    RotationLimit,
    /// The highest point of the body reached the upper bound.
    UpperBound,
    /// A cable stuck at or above the settling height.
    SlidingStart,
    /// The end of the time asked for.
    EndTime,
    /// More impacts than allowed.
    ImpactLimit,
}

impl Stop {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Settled,
        Self::RotationLimit,
        Self::UpperBound,
        Self::SlidingStart,
        Self::EndTime,
        Self::ImpactLimit,
    ];

    /// Its name in files and in programs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Settled => "settled",
            Self::RotationLimit => "rotation_limit",
            Self::UpperBound => "upper_bound",
            Self::SlidingStart => "sliding_start",
            Self::EndTime => "end_time",
            Self::ImpactLimit => "impact_limit",
        }
    }

    /// The same for people to read.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Settled => "settled",
            Self::RotationLimit => "rotation limit",
            Self::UpperBound => "upper bound",
            Self::SlidingStart => "sliding start",
            Self::EndTime => "end time",
            Self::ImpactLimit => "impact limit",
        }
    }

    /// What ended the run, as a sentence's end: "the run stopped because ...".
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Settled => "a cable stuck, or two were taut, below the settling height",
            Self::RotationLimit => "the rotation reached its limit",
            Self::UpperBound => "the highest point of the body reached the upper bound",
            Self::SlidingStart => "a cable stuck at or above the settling height",
            Self::EndTime => "the time asked for was over",
            Self::ImpactLimit => "there were more impacts than allowed",
        }
    }

    /// Whether the run left the range in which the mooring is taken to hold: it stopped at the
    /// rotation limit or the upper bound (chapter 6.4.2).
    pub fn exceeds(self) -> bool {
        match self {
            Self::RotationLimit | Self::UpperBound => true,
            Self::Settled | Self::SlidingStart | Self::EndTime | Self::ImpactLimit => false,
        }
    }
}

/// Event functions that all limits together have at most: one for either side of the rotation, one
/// for each corner below the upper bound.
pub(crate) const LIMIT_FUNCTIONS: usize = 6;

/// A limit of the motion, those first that count where several are reached at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Limit {
    /// |θ| stays below the rotation limit.
    Rotation,
    /// The highest point of the body stays below the upper bound.
    UpperBound,
}

impl Limit {
    /// All of them.
    pub(crate) const ALL: [Self; 2] = [Self::Rotation, Self::UpperBound];

    /// Why a run stops that reaches it.
    pub(crate) fn stop(self) -> Stop {
        match self {
            Self::Rotation => Stop::RotationLimit,
            Self::UpperBound => Stop::UpperBound,
        }
    }

    /// Its bound by the rules of a run; none where they do not ask for it.
    pub(crate) fn bound<T: Real>(self, rules: &Rules<T>) -> Option<T> {
        let Rules {
            rotation_limit,
            upper_bound,
            settled_below: _,
            sliding_above: _,
            t_end: _,
            max_impacts: _,
            v_stick: _,
        } = rules;
        match self {
            Self::Rotation => *rotation_limit,
            Self::UpperBound => *upper_bound,
        }
    }
}

/// A set of limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LimitSet([bool; Limit::ALL.len()]);

impl LimitSet {
    /// Whether the limit is in it.
    pub(crate) fn contains(self, limit: Limit) -> bool {
        self.0[limit as usize]
    }

    /// Adds a limit.
    pub(crate) fn insert(&mut self, limit: Limit) {
        self.0[limit as usize] = true;
    }

    /// Its members.
    pub(crate) fn iter(self) -> impl Iterator<Item = Limit> {
        Limit::ALL
            .into_iter()
            .filter(move |limit| self.contains(*limit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A variant that is added does not compile here before it has a place, and fails without one.
    #[test]
    fn the_lists_are_complete() {
        let stop = |stop| match stop {
            Stop::Settled => 0,
            Stop::RotationLimit => 1,
            Stop::UpperBound => 2,
            Stop::SlidingStart => 3,
            Stop::EndTime => 4,
            Stop::ImpactLimit => 5,
        };
        assert!(Stop::ALL.into_iter().map(stop).eq(0..6));
        let limit = |limit| match limit {
            Limit::Rotation => 0,
            Limit::UpperBound => 1,
        };
        assert!(Limit::ALL.into_iter().map(limit).eq(0..2));
    }
}
