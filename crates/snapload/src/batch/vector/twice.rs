//! Two vectors as one of twice the width.
//!
//! The arithmetic of a bounce is a chain in which each result waits for the one before. With two chains side by side a
//! processor has something to do meanwhile.

use crate::arithmetic::elementary;
use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use crate::batch::vector::{Bits, Vector};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Two vectors.
#[derive(Clone, Copy)]
pub(crate) struct Twice<V>(V, V);

/// Two masks.
#[derive(Clone, Copy)]
pub(crate) struct TwiceMask<M>(M, M);

impl<M: Mask> Mask for TwiceMask<M> {
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
}

impl<M: Bits> Bits for TwiceMask<M> {
    const WIDTH: usize = 2 * M::WIDTH;
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | self.1.bits() << M::WIDTH
    }
}

/// One operator, of two masks or of two vectors.
macro_rules! twice {
    ($type:ident, $bound:ident, $trait:ident, $method:ident) => {
        impl<V: $bound> $trait for $type<V> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    };
}
twice!(TwiceMask, Mask, BitAnd, bitand);
twice!(TwiceMask, Mask, BitOr, bitor);
twice!(Twice, Vector, Add, add);
twice!(Twice, Vector, Sub, sub);
twice!(Twice, Vector, Mul, mul);
twice!(Twice, Vector, Div, div);

with_doubles!([V: Vector] Twice<V>);

impl<M: Mask> Not for TwiceMask<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<V: Vector> Neg for Twice<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<V: Vector> Lane for Twice<V> {
    type Mask = TwiceMask<V::Mask>;
    const EPSILON: Self = Self(V::EPSILON, V::EPSILON);
    const ZERO: Self = Self(V::ZERO, V::ZERO);
    const ONE: Self = Self(V::ONE, V::ONE);
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(V::from_f64(value), V::from_f64(value))
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        Self(self.0.mul_add(by.0, plus.0), self.1.mul_add(by.1, plus.1))
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
        TwiceMask(self.0.below(other.0), self.1.below(other.1))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        TwiceMask(self.0.at_most(other.0), self.1.at_most(other.1))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(
            V::select(mask.0, yes.0, no.0),
            V::select(mask.1, yes.1, no.1),
        )
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.larger(other.0), self.1.larger(other.1))
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self(self.0.smaller(other.0), self.1.smaller(other.1))
    }
}

impl<V: Vector> Doubles for Twice<V> {
    fn each(self, f: fn(f64) -> (f64, f64)) -> (Self, Self) {
        let (a, b) = self.0.each(f);
        let (c, d) = self.1.each(f);
        (Self(a, c), Self(b, d))
    }
}

impl<V: Vector> Vector for Twice<V> {
    fn get(&self, lane: usize) -> f64 {
        if lane < V::WIDTH {
            self.0.get(lane)
        } else {
            self.1.get(lane - V::WIDTH)
        }
    }
    fn set(&mut self, lane: usize, value: f64) {
        if lane < V::WIDTH {
            self.0.set(lane, value)
        } else {
            self.1.set(lane - V::WIDTH, value)
        }
    }
}
