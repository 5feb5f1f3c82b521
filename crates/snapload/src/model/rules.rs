//! When a run stops, and why it did.

use crate::arithmetic::real::Real;

/// The stop rules, each on or off (docs/model.md section 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopRules<T = f64> {
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
}

impl<T: Real> StopRules<T> {
    /// Every rule off but the end of time.
    pub fn until(t_end: T) -> Self {
        Self {
            rotation_limit: None,
            upper_bound: None,
            settled_below: None,
            sliding_above: None,
            t_end,
            max_impacts: u64::MAX,
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
        matches!(self, Self::RotationLimit | Self::UpperBound)
    }
}
