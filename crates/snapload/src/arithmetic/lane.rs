//! One number, or several processed side by side.
//!
//! What happens in nearly every step of nearly every run, a flight that ends with one cable
//! snapping taut, is written over [`Lane`]: for [`Real`] numbers it is the ordinary motion, for the
//! vectors in [`crate::batch::lanes`] it is that of several cases at once. A vector does in each of
//! its lanes exactly the operations that a single number would undergo, so each lane has that
//! number's bits. Where numbers would take different branches, both are computed and one is
//! selected.
//!
//! All functions involved are `#[inline(always)]`: the vectors' instructions exist only in the
//! functions that were compiled for a processor which has them. Large functions are `apart!` over
//! numbers that have no instructions of their own.

use crate::arithmetic::real::Real;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The answer of a comparison, lane by lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// How many lanes.
    const WIDTH: usize;
    /// The answers as bits, that of the first lane lowest.
    fn bits(self) -> u32;
    /// Whether it is true in any lane.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

impl Mask for bool {
    const WIDTH: usize = 1;
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

/// The arithmetic that the motion of one number and that of several have in common.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The result of a comparison.
    type Mask: Mask;
    /// Spacing of the numbers next to 1.
    const EPSILON: Self;
    /// See [`Real::FUSES`].
    const FUSES: bool = true;
    /// See [`Real::CARRIES_SLOPES`].
    const CARRIES_SLOPES: bool = false;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;

    /// The same number in every lane.
    fn from_f64(value: f64) -> Self;
    /// self · by + plus; see [`Real::mul_add`].
    fn mul_add(self, by: Self, plus: Self) -> Self;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// ( (1 − cos z)/z², (z − sin z)/z² ); see [`Real::versines`].
    fn versines(self) -> (Self, Self);
    /// Where it is below `other`; false where one of them is NaN.
    fn below(self, other: Self) -> Self::Mask;
    /// Where it is below `other` or equal.
    fn at_most(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The same number without its derivatives; see [`Real::detached`].
    #[inline(always)]
    fn detached(self) -> Self {
        self
    }
    /// 1/6, rounded to these numbers.
    #[inline(always)]
    fn sixth() -> Self {
        Self::ONE / Self::from_f64(6.0)
    }
    /// The larger of two; the first if they are equal or one is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::select(self.below(other), other, self)
    }
    /// The smaller of two, likewise.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::select(other.below(self), other, self)
    }
    /// The number itself where it is positive, else 0.
    #[inline(always)]
    fn positive(self) -> Self {
        self.larger(Self::ZERO)
    }
}

/// A function of each pair of two lists.
#[inline(always)]
pub(crate) fn zip<A: Copy, B: Copy, C, const N: usize>(
    a: [A; N],
    b: [B; N],
    f: impl Fn(A, B) -> C,
) -> [C; N] {
    std::array::from_fn(|k| f(a[k], b[k]))
}

/// One of two lists, lane by lane.
#[inline(always)]
pub(crate) fn select_each<L: Lane, const N: usize>(
    mask: L::Mask,
    yes: [L; N],
    no: [L; N],
) -> [L; N] {
    let mut chosen = no;
    for k in 0..N {
        chosen[k] = L::select(mask, yes[k], no[k]);
    }
    chosen
}

impl<T: Real> Lane for T {
    type Mask = bool;
    const EPSILON: Self = <T as Real>::EPSILON;
    const FUSES: bool = <T as Real>::FUSES;
    const CARRIES_SLOPES: bool = <T as Real>::CARRIES_SLOPES;
    const ZERO: Self = <T as Real>::ZERO;
    const ONE: Self = <T as Real>::ONE;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Real::from_f64(value)
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        Real::mul_add(self, by, plus)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Real::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Real::abs(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        Real::sin_cos(self)
    }
    #[inline(always)]
    fn versines(self) -> (Self, Self) {
        Real::versines(self)
    }
    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn detached(self) -> Self {
        Real::detached(self)
    }
}
