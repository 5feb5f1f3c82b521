//! One number, or several side by side.
//!
//! What happens in nearly every step of nearly every run, a flight that ends with one cable snapping
//! taut, is written over [`Lane`]: for [`Real`] numbers it is the ordinary motion, for the vectors in
//! [`crate::batch::lanes`] it is that of several cases at once. A vector does in each of its lanes exactly the
//! operations that one number would see, so each lane has that number's bits. Where numbers would take
//! different turns, both are computed and one is selected.
//!
//! Everything on the way is `#[inline(always)]`: the vectors' instructions exist only in the functions
//! that were compiled for a processor which has them.

use crate::arithmetic::real::Real;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The answer of a comparison, lane by lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether it is true in any lane.
    fn any(self) -> bool;
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
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
    /// What comparing gives.
    type Mask: Mask;
    /// Spacing of the numbers next to 1.
    const EPSILON: Self;
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
    /// Where it is below `other`; nowhere where one of them is not a number.
    fn below(self, other: Self) -> Self::Mask;
    /// Where it is below `other` or equal.
    fn at_most(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The same number as one that depends on nothing; see [`Real::detached`].
    #[inline(always)]
    fn detached(self) -> Self {
        self
    }
    /// 1/6 as near as these numbers come to it.
    #[inline(always)]
    fn sixth() -> Self {
        Self::ONE / Self::from_f64(6.0)
    }
    /// The larger of two; the first if they are equal or one is not a number.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::select(self.below(other), other, self)
    }
    /// The smaller of two, likewise.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::select(other.below(self), other, self)
    }
    /// It where it is positive, else 0.
    #[inline(always)]
    fn positive(self) -> Self {
        self.larger(Self::ZERO)
    }
    /// Square.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
}

impl<T: Real> Lane for T {
    type Mask = bool;
    const EPSILON: Self = <T as Real>::EPSILON;
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

/// x u + y v of two plane vectors.
#[inline(always)]
pub(crate) fn dot<L: Lane>(a: [L; 2], b: [L; 2]) -> L {
    a[0].mul_add(b[0], a[1] * b[1])
}

/// x v − y u of two plane vectors.
#[inline(always)]
pub(crate) fn cross<L: Lane>(a: [L; 2], b: [L; 2]) -> L {
    a[0].mul_add(b[1], -(a[1] * b[0]))
}

/// Length of a plane vector.
#[inline(always)]
pub(crate) fn length<L: Lane>(a: [L; 2]) -> L {
    dot(a, a).sqrt()
}

/// A bound on the length of a plane vector, at most an eighth above it: the larger component and half of the smaller, as
/// (x + y/2)² ≥ x² + y² for 0 ≤ y ≤ x.
#[inline(always)]
pub(crate) fn length_bound<L: Lane>(a: [L; 2]) -> L {
    let (x, y) = (a[0].abs(), a[1].abs());
    x.smaller(y).mul_add(L::from_f64(0.5), x.larger(y))
}

/// A plane vector turned by a quarter, counter-clockwise: the velocity of a point at `a` on a body
/// that turns at unit rate.
#[inline(always)]
pub(crate) fn quarter_turn<L: Lane>(a: [L; 2]) -> [L; 2] {
    [-a[1], a[0]]
}

/// a + b.
#[inline(always)]
pub(crate) fn sum<L: Lane>(a: [L; 2], b: [L; 2]) -> [L; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// a − b.
#[inline(always)]
pub(crate) fn difference<L: Lane>(a: [L; 2], b: [L; 2]) -> [L; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// a + k b.
#[inline(always)]
pub(crate) fn added<L: Lane>(a: [L; 2], b: [L; 2], k: L) -> [L; 2] {
    [b[0].mul_add(k, a[0]), b[1].mul_add(k, a[1])]
}

/// k a.
#[inline(always)]
pub(crate) fn scaled<L: Lane>(a: [L; 2], k: L) -> [L; 2] {
    [a[0] * k, a[1] * k]
}

/// p u + q v.
#[inline(always)]
pub(crate) fn combined<L: Lane>(p: L, u: [L; 2], q: L, v: [L; 2]) -> [L; 2] {
    added(scaled(v, q), u, p)
}

/// One of two plane vectors, lane by lane.
#[inline(always)]
pub(crate) fn select2<L: Lane>(mask: L::Mask, yes: [L; 2], no: [L; 2]) -> [L; 2] {
    [
        L::select(mask, yes[0], no[0]),
        L::select(mask, yes[1], no[1]),
    ]
}

/// A rotation by an angle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<L> {
    pub(crate) sine: L,
    pub(crate) cosine: L,
    /// 1 − cos, without cancellation.
    pub(crate) versine: L,
    /// The angle less its sine, without cancellation.
    pub(crate) sine_deficit: L,
}

impl<L: Lane> Turn<L> {
    #[inline(always)]
    pub(crate) fn by(angle: L) -> Self {
        let (even, odd) = angle.versines();
        let square = angle * angle;
        let (versine, sine_deficit) = (square * even, square * odd);
        Self {
            sine: angle - sine_deficit,
            cosine: L::ONE - versine,
            versine,
            sine_deficit,
        }
    }
}
