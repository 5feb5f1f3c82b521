//! The numbers that are coefficients of power series.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::elementary::Elementary;

/// The operations on enclosures of a true number.
pub(crate) trait Scalar: Clone {
    /// A number that does not depend on the state.
    type Constant: Clone;

    fn zero() -> Self;
    fn constant(constant: &Self::Constant) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, by: &Self::Constant) -> Self;
    fn times_small(&self, factor: u32) -> Self;
    /// Divided by an integer above zero.
    fn over_small(&self, divisor: u32) -> Self;
    /// None if the divisor contains zero.
    fn reciprocal(&self) -> Option<Self>;
    /// None unless the enclosure is positive.
    fn sqrt(&self) -> Option<Self>;
    fn sin_cos(&self, functions: &Elementary) -> Option<(Self, Self)>;
    /// Whether the enclosure contains zero and no other number.
    fn is_exact_zero(&self) -> bool;
}

impl Scalar for Ball {
    type Constant = Self;

    fn zero() -> Self {
        Self::zero()
    }
    fn constant(constant: &Self) -> Self {
        constant.clone()
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn scaled(&self, by: &Self) -> Self {
        self * by
    }
    fn times_small(&self, factor: u32) -> Self {
        self * &Self::integer(i64::from(factor))
    }
    fn over_small(&self, divisor: u32) -> Self {
        Self::over_small(self, u64::from(divisor))
    }
    fn reciprocal(&self) -> Option<Self> {
        Self::reciprocal(self)
    }
    fn sqrt(&self) -> Option<Self> {
        Self::sqrt(self)
    }
    fn sin_cos(&self, functions: &Elementary) -> Option<(Self, Self)> {
        Some(functions.sin_cos(self))
    }
    fn is_exact_zero(&self) -> bool {
        self.is_zero()
    }
}

/// A number with its derivatives with respect to the N coordinates at the beginning.
#[derive(Clone, Debug)]
pub(crate) struct Jet<S, const N: usize> {
    pub(crate) value: S,
    pub(crate) slopes: [S; N],
}

impl<S: Scalar, const N: usize> Jet<S, N> {
    /// The coordinate number `which` at the beginning, whose derivative with respect to itself is
    /// 1.
    pub(crate) fn coordinate(value: S, which: usize, one: &S) -> Self {
        let slope = |i: usize| if i == which { one.clone() } else { S::zero() };
        Self::with(value, slope)
    }

    fn with(value: S, slope: impl Fn(usize) -> S) -> Self {
        let slopes = std::array::from_fn(slope);
        Self { value, slopes }
    }
}

impl<S: Scalar, const N: usize> Scalar for Jet<S, N> {
    type Constant = S::Constant;

    fn zero() -> Self {
        Self::with(S::zero(), |_| S::zero())
    }
    fn constant(constant: &S::Constant) -> Self {
        Self::with(S::constant(constant), |_| S::zero())
    }
    fn plus(&self, other: &Self) -> Self {
        let slope = |i: usize| self.slopes[i].plus(&other.slopes[i]);
        Self::with(self.value.plus(&other.value), slope)
    }
    fn minus(&self, other: &Self) -> Self {
        let slope = |i: usize| self.slopes[i].minus(&other.slopes[i]);
        Self::with(self.value.minus(&other.value), slope)
    }
    fn times(&self, other: &Self) -> Self {
        Self::with(self.value.times(&other.value), |i| {
            let first = self.slopes[i].times(&other.value);
            first.plus(&self.value.times(&other.slopes[i]))
        })
    }
    fn scaled(&self, by: &S::Constant) -> Self {
        Self::with(self.value.scaled(by), |i| self.slopes[i].scaled(by))
    }
    fn times_small(&self, factor: u32) -> Self {
        let slope = |i: usize| self.slopes[i].times_small(factor);
        Self::with(self.value.times_small(factor), slope)
    }
    fn over_small(&self, divisor: u32) -> Self {
        let slope = |i: usize| self.slopes[i].over_small(divisor);
        Self::with(self.value.over_small(divisor), slope)
    }
    fn reciprocal(&self) -> Option<Self> {
        let inverse = self.value.reciprocal()?;
        let slope = S::zero().minus(&inverse.times(&inverse));
        Some(Self::with(inverse, |i| slope.times(&self.slopes[i])))
    }
    fn sqrt(&self) -> Option<Self> {
        let root = self.value.sqrt()?;
        let slope = root.reciprocal()?.over_small(2);
        Some(Self::with(root, |i| slope.times(&self.slopes[i])))
    }
    fn sin_cos(&self, functions: &Elementary) -> Option<(Self, Self)> {
        let (sine, cosine) = self.value.sin_cos(functions)?;
        let first = Self::with(sine.clone(), |i| cosine.times(&self.slopes[i]));
        let minus = S::zero().minus(&sine);
        let second = Self::with(cosine, |i| minus.times(&self.slopes[i]));
        Some((first, second))
    }
    fn is_exact_zero(&self) -> bool {
        self.value.is_exact_zero() && self.slopes.iter().all(S::is_exact_zero)
    }
}
