//! Vectors in the registers of x86 processors: four doubles with AVX2, eight with AVX-512.
//!
//! `unsafe` here relies only on the processor having the instructions, and one proof holds for all
//! of it: a value of these types exists only in a scheduler of [`crate::batch::lanes`], and the two
//! functions there that make such schedulers first check the processor, for [`Avx2`] for AVX2 and
//! FMA, for [`Avx512`] for AVX-512F. Most of it is compiled with the instructions enabled, for
//! speed.
//!
//! Libraries considered: a draft over `pulp` 0.22, whose speed was not measured, was a quarter
//! shorter than this. It needs `unsafe` as well, for its tokens and for the constants of a vector,
//! and adds five crates, 24,000 lines in `pulp` alone. `wide` chooses its instructions when it is
//! compiled, not by the processor at hand.
#![expect(unsafe_code, reason = "the instructions of a processor; see above")]
#![expect(
    unused_unsafe,
    reason = "the masks of AVX-512 are integers, whose operators are safe"
)]

use crate::arithmetic::elementary;
use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// An operator of a register.
macro_rules! operator {
    ($type:ident, $trait:ident, $method:ident, |$a:ident $(, $b:ident)?| $result:expr) => {
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self $(, $b: Self)?) -> Self {
                let $a = self.0;
                $(let $b = $b.0;)?
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $result })
            }
        }
    };
}

/// A vector and its mask, by the instruction of each operation on a, b and c.
macro_rules! vector {
    (
        $vector:ident($register:ident, $width:literal), $mask:ident($answers:ident),
        |$a:ident, $b:ident, $c:ident|
        bits: $bits:expr, and: $and:expr, or: $or:expr, not: $not:expr,
        add: $add:expr, sub: $sub:expr, mul: $mul:expr, div: $div:expr, neg: $neg:expr,
        splat: $splat:expr, mul_add: $mul_add:expr, sqrt: $sqrt:expr, abs: $abs:expr,
        below: $below:expr, at_most: $at_most:expr, select: $select:expr,
        larger: $larger:expr, smaller: $smaller:expr,
    ) => {
        #[doc = concat!("Vector of ", $width, " doubles.")]
        #[derive(Clone, Copy)]
        pub(crate) struct $vector($register);

        /// What comparing two such vectors gives.
        #[derive(Clone, Copy)]
        pub(crate) struct $mask($answers);

        operator!($mask, BitAnd, bitand, |$a, $b| $and);
        operator!($mask, BitOr, bitor, |$a, $b| $or);
        operator!($mask, Not, not, |$a| $not);
        operator!($vector, Add, add, |$a, $b| $add);
        operator!($vector, Sub, sub, |$a, $b| $sub);
        operator!($vector, Mul, mul, |$a, $b| $mul);
        operator!($vector, Div, div, |$a, $b| $div);
        operator!($vector, Neg, neg, |$a| $neg);
        with_doubles!([] $vector);

        impl Mask for $mask {
            const WIDTH: usize = $width;
            #[inline(always)]
            fn bits(self) -> u32 {
                let $a = self.0;
                // SAFETY: the processor has the instruction, as the head of this file says.
                unsafe { $bits as u32 }
            }
        }

        impl $vector {
            const fn of(value: f64) -> Self {
                // SAFETY: a register is as many doubles, and any bits are legal in both.
                Self(unsafe { transmute::<[f64; $width], $register>([value; $width]) })
            }
        }

        impl Doubles for $vector {
            type Register = Self;

            #[inline(always)]
            fn get(&self, lane: usize) -> f64 {
                let register: *const [f64; $width] = (&raw const self.0).cast();
                // SAFETY: a register is as many doubles, and any bits are legal in both. In place,
                // so that no more than one double is read.
                unsafe { (*register)[lane] }
            }
            #[inline(always)]
            fn set(&mut self, lane: usize, value: f64) {
                let register: *mut [f64; $width] = (&raw mut self.0).cast();
                // SAFETY: a register is as many doubles, and any bits are legal in both. In place,
                // because a register that is read right after a part of it was written to memory
                // waits for the store.
                unsafe { (*register)[lane] = value };
            }
        }

        impl Lane for $vector {
            type Mask = $mask;
            const EPSILON: Self = Self::of(f64::EPSILON);
            const ZERO: Self = Self::of(0.0);
            const ONE: Self = Self::of(1.0);

            #[inline(always)]
            fn from_f64($a: f64) -> Self {
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $splat })
            }
            #[inline(always)]
            fn mul_add(self, by: Self, plus: Self) -> Self {
                let ($a, $b, $c) = (self.0, by.0, plus.0);
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $mul_add })
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                let $a = self.0;
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $sqrt })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                let $a = self.0;
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $abs })
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
            fn below(self, other: Self) -> $mask {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: the processor has the instruction, as the head of this file says.
                $mask(unsafe { $below })
            }
            #[inline(always)]
            fn at_most(self, other: Self) -> $mask {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: the processor has the instruction, as the head of this file says.
                $mask(unsafe { $at_most })
            }
            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                let ($a, $b, $c) = (mask.0, yes.0, no.0);
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $select })
            }
            // The instructions give the second of two that are equal, or of which one is not a
            // number.
            #[inline(always)]
            fn larger(self, other: Self) -> Self {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $larger })
            }
            #[inline(always)]
            fn smaller(self, other: Self) -> Self {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: the processor has the instruction, as the head of this file says.
                Self(unsafe { $smaller })
            }
        }
    };
}

vector! {
    Avx2(__m256d, 4), Avx2Mask(__m256d), |a, b, c|
    bits: _mm256_movemask_pd(a),
    and: _mm256_and_pd(a, b),
    or: _mm256_or_pd(a, b),
    not: _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))),
    add: _mm256_add_pd(a, b),
    sub: _mm256_sub_pd(a, b),
    mul: _mm256_mul_pd(a, b),
    div: _mm256_div_pd(a, b),
    neg: _mm256_xor_pd(a, _mm256_set1_pd(-0.0)),
    splat: _mm256_set1_pd(a),
    mul_add: _mm256_fmadd_pd(a, b, c),
    sqrt: _mm256_sqrt_pd(a),
    abs: _mm256_andnot_pd(_mm256_set1_pd(-0.0), a),
    below: _mm256_cmp_pd::<_CMP_LT_OQ>(a, b),
    at_most: _mm256_cmp_pd::<_CMP_LE_OQ>(a, b),
    select: _mm256_blendv_pd(c, b, a),
    larger: _mm256_max_pd(b, a),
    smaller: _mm256_min_pd(b, a),
}

vector! {
    Avx512(__m512d, 8), Avx512Mask(__mmask8), |a, b, c|
    bits: a,
    and: a & b,
    or: a | b,
    not: !a,
    add: _mm512_add_pd(a, b),
    sub: _mm512_sub_pd(a, b),
    mul: _mm512_mul_pd(a, b),
    div: _mm512_div_pd(a, b),
    neg: _mm512_castsi512_pd(_mm512_xor_si512(
        _mm512_castpd_si512(a),
        _mm512_castpd_si512(_mm512_set1_pd(-0.0)),
    )),
    splat: _mm512_set1_pd(a),
    mul_add: _mm512_fmadd_pd(a, b, c),
    sqrt: _mm512_sqrt_pd(a),
    abs: _mm512_abs_pd(a),
    below: _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b),
    at_most: _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a, b),
    select: _mm512_mask_blend_pd(a, c, b),
    larger: _mm512_max_pd(b, a),
    smaller: _mm512_min_pd(b, a),
}
