//! Several doubles side by side: in plain Rust, and in the registers of x86 processors.
//!
//! Every operation is the one that IEEE 754 defines, lane by lane, so all of these give the same
//! bits. `mul_add` always fuses; a multiply and an add apart never do.

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

/// `N` vectors as one, or the answers of comparing them.
///
/// Of plain doubles it is the vector for every processor. Of two registers it is faster than one:
/// the arithmetic of a bounce is a chain in which each result waits for the one before, and with
/// two chains a processor has something to do meanwhile. Loops stand where closures would: a
/// closure that is not inlined is compiled without the processor's own instructions.
#[derive(Clone, Copy)]
pub(crate) struct Several<V, const N: usize>([V; N]);

/// An operator of two vectors or of two masks.
macro_rules! operator {
    ($bound:ident, $trait:ident, $method:ident) => {
        impl<V: $bound, const N: usize> $trait for Several<V, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for k in 0..N {
                    self.0[k] = self.0[k].$method(other.0[k]);
                }
                self
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
with_doubles!([V: Doubles, const N: usize] Several<V, N>);

impl<M: Mask, const N: usize> Not for Several<M, N> {
    type Output = Self;
    #[inline(always)]
    fn not(mut self) -> Self {
        for k in 0..N {
            self.0[k] = !self.0[k];
        }
        self
    }
}

impl<V: Doubles, const N: usize> Neg for Several<V, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for k in 0..N {
            self.0[k] = -self.0[k];
        }
        self
    }
}

impl<M: Mask, const N: usize> Mask for Several<M, N> {
    const WIDTH: usize = N * M::WIDTH;
    #[inline(always)]
    fn bits(self) -> u32 {
        (0..N).fold(0, |bits, k| bits | self.0[k].bits() << (k * M::WIDTH))
    }
}

impl<V: Doubles, const N: usize> Lane for Several<V, N> {
    type Mask = Several<V::Mask, N>;
    const EPSILON: Self = Self([V::EPSILON; N]);
    const ZERO: Self = Self([V::ZERO; N]);
    const ONE: Self = Self([V::ONE; N]);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self([V::from_f64(value); N])
    }
    #[inline(always)]
    fn mul_add(mut self, by: Self, plus: Self) -> Self {
        for k in 0..N {
            self.0[k] = self.0[k].mul_add(by.0[k], plus.0[k]);
        }
        self
    }
    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for k in 0..N {
            self.0[k] = self.0[k].sqrt();
        }
        self
    }
    #[inline(always)]
    fn abs(mut self) -> Self {
        for k in 0..N {
            self.0[k] = self.0[k].abs();
        }
        self
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
        let mut answers = Several([self.0[0].below(other.0[0]); N]);
        for k in 0..N {
            answers.0[k] = self.0[k].below(other.0[k]);
        }
        answers
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        let mut answers = Several([self.0[0].at_most(other.0[0]); N]);
        for k in 0..N {
            answers.0[k] = self.0[k].at_most(other.0[k]);
        }
        answers
    }
    #[inline(always)]
    fn select(mask: Self::Mask, mut yes: Self, no: Self) -> Self {
        for k in 0..N {
            yes.0[k] = V::select(mask.0[k], yes.0[k], no.0[k]);
        }
        yes
    }
    #[inline(always)]
    fn larger(mut self, other: Self) -> Self {
        for k in 0..N {
            self.0[k] = self.0[k].larger(other.0[k]);
        }
        self
    }
    #[inline(always)]
    fn smaller(mut self, other: Self) -> Self {
        for k in 0..N {
            self.0[k] = self.0[k].smaller(other.0[k]);
        }
        self
    }
}

impl<V: Doubles, const N: usize> Doubles for Several<V, N> {
    fn get(&self, lane: usize) -> f64 {
        self.0[lane / V::WIDTH].get(lane % V::WIDTH)
    }
    fn set(&mut self, lane: usize, value: f64) {
        self.0[lane / V::WIDTH].set(lane % V::WIDTH, value);
    }
}
