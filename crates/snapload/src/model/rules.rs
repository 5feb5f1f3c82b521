//! When a run stops, and why it did.

use crate::arithmetic::real::Real;

/// Two cables that snap in turn come to rest together after so many snaps in a row that are slower
/// than `v_stick` (docs/model.md section 6).
pub const SLOW_SNAPS: u32 = 5;
/// Such snaps belong to one row if the flight between them takes no longer than this many times
/// `v_stick` over the largest constant force and waves' force together: they follow each other in
/// 2 v/α, and α may be a 50th of it.
pub const SLOW_FLIGHT: f64 = 100.0;
/// The largest velocity of an end of a cable, in multiples of `v_stick`, that is taken away where
/// they come to rest. For two cables at a right angle it is √2.
pub const MOST_HALTED: f64 = 16.0;

/// The rules that end a run, each on or off (docs/model.md section 7), and the speed below which a
/// cable sticks.
///
/// Code that has to consider all of them destructures this without `..`, so that it does not
/// compile when a rule is added that it does not consider. The limits are one field: code that has
/// to consider all of them iterates over [`Limit::ALL`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules<T = f64> {
    /// Stop where a limit of the motion is reached.
    pub limits: LimitBounds<T>,
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
    /// Every rule off but the end of time; no cable sticks unless its normal velocity is zero.
    ///
    /// With `v_stick` zero a body that comes to rest by ever smaller bounces, as under e < 1 it
    /// does wherever its weight pulls straight along a cable, bounces on until its time can no
    /// longer increase, and the run ends there as [`Stop::Standstill`]. Set `v_stick`, for example
    /// to 1e-6, wherever a body may come to rest on a cable and is to go on from there.
    pub fn until(t_end: T) -> Self {
        Self {
            limits: LimitBounds::none(),
            settled_below: None,
            sliding_above: None,
            t_end,
            max_impacts: u64::MAX,
            v_stick: T::ZERO,
        }
    }
}

/// An enum, with the list of its variants and the texts of each.
macro_rules! listed {
    (
        $(#[$of_enum:meta])*
        pub enum $Enum:ident: $Texts:ty {
            $($(#[$of_variant:meta])* $Variant:ident = $texts:expr;)*
        }
    ) => {
        $(#[$of_enum])*
        pub enum $Enum { $($(#[$of_variant])* $Variant,)* }

        impl $Enum {
            /// All variants.
            pub const ALL: [Self; [$(stringify!($Variant)),*].len()] = [$(Self::$Variant),*];

            const fn texts(self) -> $Texts {
                match self { $(Self::$Variant => $texts,)* }
            }
        }
    };
}

listed! {
    /// Why a run stopped. In tables of numbers each is stored as its index in [`Stop::ALL`], so
    /// that a new one has to come last. Its texts are its name in files and in programs, the same
    /// for people, and the end of a sentence about it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Stop: [&'static str; 3] {
        /// A cable stuck, or two are taut, below the settling height.
        Settled = [
            "settled", "settled", "a cable stuck, or two were taut, below the settling height",
        ];
        /// |θ| reached the rotation limit.
        RotationLimit = ["rotation_limit", "rotation limit", "the rotation reached its limit"];
        /// The highest point of the body reached the upper bound.
        UpperBound = [
            "upper_bound", "upper bound", "the highest point of the body reached the upper bound",
        ];
        /// A cable stuck at or above the settling height.
        SlidingStart = [
            "sliding_start", "sliding start", "a cable stuck at or above the settling height",
        ];
        /// The end of the requested time.
        EndTime = ["end_time", "end time", "the requested time was over"];
        /// More impacts than allowed.
        ImpactLimit = ["impact_limit", "impact limit", "there were more impacts than allowed"];
        /// The time no longer increases, in very many steps, or a number is no longer finite: the
        /// computation can not go on.
        Standstill = [
            "standstill", "standstill",
            "the computation could not go on: its time no longer increased, or a number overflowed",
        ];
    }
}

impl Stop {
    /// Its name in files and in programs.
    pub const fn name(self) -> &'static str {
        self.texts()[0]
    }

    /// The same for people to read.
    pub const fn label(self) -> &'static str {
        self.texts()[1]
    }

    /// What ended the run, as a sentence's end: "the run stopped because ...".
    pub const fn reason_text(self) -> &'static str {
        self.texts()[2]
    }

    /// The limit that was reached, if it was one.
    pub fn limit(self) -> Option<Limit> {
        Limit::ALL.into_iter().find(|limit| limit.stop() == self)
    }

    /// Whether the run left the range in which the mooring is taken to hold: it stopped at a limit
    /// (chapter 6.4.2: the rotation limit or the upper bound).
    pub fn exceeds(self) -> bool {
        self.limit().is_some()
    }

    /// Whether the run ended before the motion did, so that it leaves open whether a limit
    /// would have been reached later.
    pub fn cuts_short(self) -> bool {
        matches!(self, Self::ImpactLimit | Self::Standstill)
    }
}

/// The largest number of event functions of all limits together.
pub(crate) const LIMIT_FUNCTIONS: usize = {
    let (mut sum, mut k) = (0, 0);
    while k < Limit::ALL.len() {
        sum += Limit::ALL[k].functions();
        k += 1;
    }
    sum
};

listed! {
    /// A limit of the motion: a run ends where the quantity that it bounds reaches its bound. If
    /// several are reached at one instant, the first in the order of [`Limit::ALL`] counts.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Limit: LimitTexts {
        /// |θ| stays below the rotation limit \[rad\].
        Rotation = LimitTexts {
            stop: Stop::RotationLimit,
            bounded: "rotation",
            bound: "the rotation reaches this angle in either direction [rad]",
            functions: 2,
        };
        /// The highest point of the body stays below the upper bound \[L\].
        UpperBound = LimitTexts {
            stop: Stop::UpperBound,
            bounded: "highest point",
            bound: "the highest point of the body reaches this height",
            functions: 4,
        };
    }
}

/// What describes a limit.
struct LimitTexts {
    /// The reason for which a run stops that reaches it; its name is also the limit's.
    stop: Stop,
    /// The quantity that it bounds.
    bounded: &'static str,
    /// The end of a sentence about its bound: "the run ends where ...".
    bound: &'static str,
    /// The largest number of its event functions: one for either direction of the rotation, one for
    /// each corner below the upper bound.
    functions: usize,
}

impl Limit {
    /// The reason for which a run stops that reaches it; its name is also the limit's.
    pub const fn stop(self) -> Stop {
        self.texts().stop
    }

    /// The largest number of its event functions.
    const fn functions(self) -> usize {
        self.texts().functions
    }

    /// The quantity that it bounds, in words.
    pub const fn bounded(self) -> &'static str {
        self.texts().bounded
    }

    /// The end of a sentence about its bound: "the run ends where ...".
    pub const fn bound_text(self) -> &'static str {
        self.texts().bound
    }
}

/// The bound of each limit; none for a limit that is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitBounds<T = f64>([Option<T>; Limit::ALL.len()]);

impl<T: Copy> LimitBounds<T> {
    /// All limits off.
    pub const fn none() -> Self {
        Self([None; Limit::ALL.len()])
    }

    /// The same with this bound of a limit.
    #[must_use]
    pub fn with(mut self, limit: Limit, bound: impl Into<Option<T>>) -> Self {
        self.0[limit as usize] = bound.into();
        self
    }

    /// The bound of a limit.
    pub fn of(&self, limit: Limit) -> Option<T> {
        self.0[limit as usize]
    }

    /// The limits that are on, with their bounds.
    pub fn iter(&self) -> impl Iterator<Item = (Limit, T)> {
        let bounds = Limit::ALL.into_iter().zip(self.0);
        bounds.filter_map(|(limit, bound)| Some((limit, bound?)))
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

    /// Where only the name is known, as in files, people read it with blanks for underscores.
    #[test]
    fn labels_are_names_with_blanks() {
        for stop in Stop::ALL {
            assert_eq!(stop.label(), stop.name().replace('_', " "));
        }
    }
}
