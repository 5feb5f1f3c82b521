//! Two vectors as one of twice the width: while one waits for a result, the processor goes on with the other.

use crate::elementary::{self, Doubles};
use crate::lane::{Lane, Mask};
use crate::vector::{Bits, Vector};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Both, the lower lanes first.
#[derive(Clone, Copy)]
pub(crate) struct Pair<V>(V, V);

/// The answers of both.
#[derive(Clone, Copy)]
pub(crate) struct PairMask<M>(M, M);

impl<M: Mask> Mask for PairMask<M> {
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
}

impl<M: Mask> Not for PairMask<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<V: Lane> Neg for Pair<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

/// One operator, done to either.
macro_rules! to_either {
    ($type:ident, $bound:ident, $trait:ident, $method:ident) => {
        impl<T: $bound> $trait for $type<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    };
    ($trait:ident, $method:ident) => {
        to_either!(Pair, Lane, $trait, $method);
        impl<V: Lane> $trait<f64> for Pair<V> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(self.0.$method(other), self.1.$method(other))
            }
        }
    };
}
to_either!(PairMask, Mask, BitAnd, bitand);
to_either!(PairMask, Mask, BitOr, bitor);
to_either!(Pair, Lane, Div, div);
to_either!(Add, add);
to_either!(Sub, sub);
to_either!(Mul, mul);

impl<V: Vector> Lane for Pair<V> {
    type Mask = PairMask<V::Mask>;
    const EPSILON: Self = Self(V::EPSILON, V::EPSILON);
    const ZERO: Self = Self(V::ZERO, V::ZERO);
    const ONE: Self = Self(V::ONE, V::ONE);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(V::from_f64(value), V::from_f64(value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
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
        PairMask(self.0.below(other.0), self.1.below(other.1))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        PairMask(self.0.at_most(other.0), self.1.at_most(other.1))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(
            V::select(mask.0, yes.0, no.0),
            V::select(mask.1, yes.1, no.1),
        )
    }
}

impl<V: Vector> Doubles for Pair<V> {
    fn each(self, f: fn(f64) -> (f64, f64)) -> (Self, Self) {
        let (low, high) = (self.0.each(f), self.1.each(f));
        (Self(low.0, high.0), Self(low.1, high.1))
    }
}

impl<V: Vector> Vector for Pair<V> {
    fn get(&self, lane: usize) -> f64 {
        match lane.checked_sub(V::WIDTH) {
            None => self.0.get(lane),
            Some(lane) => self.1.get(lane),
        }
    }
    fn set(&mut self, lane: usize, value: f64) {
        match lane.checked_sub(V::WIDTH) {
            None => self.0.set(lane, value),
            Some(lane) => self.1.set(lane, value),
        }
    }
}

impl<M: Bits> Bits for PairMask<M> {
    const WIDTH: usize = 2 * M::WIDTH;
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | self.1.bits() << M::WIDTH
    }
}
