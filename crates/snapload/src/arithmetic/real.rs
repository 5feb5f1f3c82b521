//! The number type that the physics is written over, and its elementary functions.
//!
//! The whole motion is generic over [`Real`]: doubles for the ordinary run,
//! [`crate::arithmetic::dual::Dual`] numbers for its derivatives,
//! [`crate::arithmetic::precise::Precise`] ones for its proof. In a chaotic system a different last
//! bit is a different picture: no function of a double calls the platform's `libm` (sine and cosine
//! are those of [`crate::arithmetic::elementary`], plain arithmetic in a fixed order), and a
//! multiply is fused with an add where `mul_add` says so, on every machine, and nowhere else.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number in some arithmetic.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// Spacing of the numbers next to 1.
    const EPSILON: Self;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// How many steps of Newton's method take an error of 1e-9 below [`Real::EPSILON`].
    const NEWTON_STEPS: usize;
    /// Whether its products and sums are instructions of the processor, so that it is worth
    /// compiling a step for each kind of processor.
    const FUSES: bool = false;
    /// Whether it carries derivatives, which [`Real::detached`] leaves out.
    const CARRIES_SLOPES: bool = false;

    /// The number of this arithmetic that equals `value`.
    fn from_f64(value: f64) -> Self;
    /// The number that is written as `value` is: 0.1 is one tenth in every arithmetic, as far as
    /// that can hold it, and not the double next to a tenth.
    fn from_decimal(value: f64) -> Self;
    /// π/2.
    fn half_pi() -> Self;
    /// The nearest double.
    fn to_f64(self) -> f64;
    /// self · by + plus; where the arithmetic has it, rounded once.
    fn mul_add(self, by: Self, plus: Self) -> Self {
        self * by + plus
    }
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// ( (1 − cos z)/z², (z − sin z)/z² ), without cancellation at small z; (½, 0) at z = 0.
    ///
    /// They are the real and imaginary part of φ₂(iz) = (e^{iz} − 1 − iz)/(iz)², and both the drift
    /// under a sinusoidal force and the versine of a rotation are made of them.
    fn versines(self) -> (Self, Self);

    /// Absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
    /// The larger of two.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }
    /// The smaller of two.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// Square.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
    /// The same number without its derivatives: the instants at which a search evaluates the motion
    /// do not depend on the parameters.
    fn detached(self) -> Self {
        self
    }
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }
}
