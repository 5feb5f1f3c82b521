//! Several doubles side by side: portable, and in the registers of x86 processors.
//!
//! Every operation is the one that IEEE 754 defines, lane by lane, so all of these give the same bits.
//! `mul_add` always fuses; a multiply and an add apart never do.

use crate::arithmetic::elementary;
use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Doubles that can be looked at and set one by one.
pub(crate) trait Vector: Doubles<Mask: Bits> {
    /// How many.
    const WIDTH: usize = <Self::Mask as Bits>::WIDTH;
    fn get(&self, lane: usize) -> f64;
    fn set(&mut self, lane: usize, value: f64);
}

/// A mask as bits, that of the first lane lowest.
pub(crate) trait Bits: Mask {
    /// How many lanes.
    const WIDTH: usize;
    fn bits(self) -> u32;
}

impl Bits for bool {
    const WIDTH: usize = 1;
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

impl Vector for f64 {
    fn get(&self, _: usize) -> f64 {
        *self
    }
    fn set(&mut self, _: usize, value: f64) {
        *self = value;
    }
}

/// `N` doubles in plain Rust.
#[derive(Clone, Copy)]
pub(crate) struct Portable<const N: usize>([f64; N]);

/// `N` answers.
#[derive(Clone, Copy)]
pub(crate) struct PortableMask<const N: usize>([bool; N]);

impl<const N: usize> Mask for PortableMask<N> {
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

impl<const N: usize> Bits for PortableMask<N> {
    const WIDTH: usize = N;
    #[inline(always)]
    fn bits(self) -> u32 {
        (0..N).fold(0, |bits, k| bits | u32::from(self.0[k]) << k)
    }
}

/// One operator, of two masks or of two vectors, lane by lane.
macro_rules! lane_by_lane {
    ($type:ident, $trait:ident, $method:ident, $operator:tt) => {
        impl<const N: usize> $trait for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for k in 0..N {
                    self.0[k] $operator other.0[k];
                }
                self
            }
        }
    };
}
lane_by_lane!(PortableMask, BitAnd, bitand, &=);
lane_by_lane!(PortableMask, BitOr, bitor, |=);
lane_by_lane!(Portable, Add, add, +=);
lane_by_lane!(Portable, Sub, sub, -=);
lane_by_lane!(Portable, Mul, mul, *=);
lane_by_lane!(Portable, Div, div, /=);

impl<const N: usize> Not for PortableMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|answer| !answer))
    }
}

impl<const N: usize> Neg for Portable<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<const N: usize> Lane for Portable<N> {
    type Mask = PortableMask<N>;
    const EPSILON: Self = Self([f64::EPSILON; N]);
    const ZERO: Self = Self([0.0; N]);
    const ONE: Self = Self([1.0; N]);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        Self(std::array::from_fn(|k| {
            self.0[k].mul_add(by.0[k], plus.0[k])
        }))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }
    #[inline(always)]
    fn versines(self) -> (Self, Self) {
        elementary::versines(self)
    }
    #[inline(always)]
    fn below(self, other: Self) -> Self::Mask {
        PortableMask(std::array::from_fn(|k| self.0[k] < other.0[k]))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        PortableMask(std::array::from_fn(|k| self.0[k] <= other.0[k]))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        let one = |k: usize| if mask.0[k] { yes.0[k] } else { no.0[k] };
        Self(std::array::from_fn(one))
    }
}

impl<const N: usize> Doubles for Portable<N> {
    fn each(self, f: fn(f64) -> (f64, f64)) -> (Self, Self) {
        let both = self.0.map(f);
        (Self(both.map(|b| b.0)), Self(both.map(|b| b.1)))
    }
}

impl<const N: usize> Vector for Portable<N> {
    fn get(&self, lane: usize) -> f64 {
        self.0[lane]
    }
    fn set(&mut self, lane: usize, value: f64) {
        self.0[lane] = value;
    }
}

/// The operators with a double on the right.
macro_rules! with_doubles {
    ([$($generic:tt)*] $type:ty) => {
        with_doubles!(@ [$($generic)*] $type, Add, add, +);
        with_doubles!(@ [$($generic)*] $type, Sub, sub, -);
        with_doubles!(@ [$($generic)*] $type, Mul, mul, *);
    };
    (@ [$($generic:tt)*] $type:ty, $trait:ident, $method:ident, $operator:tt) => {
        impl<$($generic)*> $trait<f64> for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self $operator Self::from_f64(other)
            }
        }
    };
}
with_doubles!([const N: usize] Portable<N>);

#[cfg(target_arch = "x86_64")]
pub(crate) mod twice;

#[cfg(target_arch = "x86_64")]
pub(crate) mod x86;
