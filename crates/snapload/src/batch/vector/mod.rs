//! Several doubles side by side: in plain Rust, and in the registers of x86 processors.
//!
//! Every operation is the one that IEEE 754 defines, lane by lane, so that all of these give the
//! same bits. `mul_add` always fuses; a separate multiply and add never do.

use crate::arithmetic::elementary;
use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

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

#[cfg(target_arch = "x86_64")]
pub(crate) mod x86;

/// Two vectors as one, or the answers of comparing them.
///
/// Two registers are faster than one: the arithmetic of a bounce is a chain in which each result
/// waits for the one before, and with two chains the processor is busy during the wait. Pairs of
/// pairs of doubles are the vector for every processor. There are no loops and no closures here: a
/// closure that is not inlined is compiled without the processor's own instructions, and hundreds
/// of loops over two elements in one function took a quarter of the time to compile the engine.
#[derive(Clone, Copy)]
pub(crate) struct Pair<V>(V, V);

/// An operator of two vectors or of two masks.
macro_rules! operator {
    ($bound:ident, $trait:ident, $method:ident) => {
        impl<V: $bound> $trait for Pair<V> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    };
}
operator!(Mask, BitAnd, bitand);
operator!(Mask, BitOr, bitor);
operator!(Doubles, Add, add);
operator!(Doubles, Sub, sub);
operator!(Doubles, Mul, mul);
operator!(Doubles, Div, div);
with_doubles!([V: Doubles] Pair<V>);

impl<M: Mask> Not for Pair<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<V: Doubles> Neg for Pair<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<M: Mask> Mask for Pair<M> {
    const WIDTH: usize = 2 * M::WIDTH;
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | self.1.bits() << M::WIDTH
    }
}

impl<V: Doubles> Lane for Pair<V> {
    type Mask = Pair<V::Mask>;
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
        Pair(self.0.below(other.0), self.1.below(other.1))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        Pair(self.0.at_most(other.0), self.1.at_most(other.1))
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

impl<V: Doubles> Doubles for Pair<V> {
    type Register = V;

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
