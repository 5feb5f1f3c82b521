//! Vectors in the registers of x86 processors: four doubles with AVX2, eight with AVX-512.
//!
//! `unsafe` here says only that the processor has the instructions. The proof is one for all of it: a value of these
//! types exists only in a scheduler of [`crate::batch::lanes`], and the two functions there that make such fleets ask the
//! processor first: for [`Avx2`] whether it has AVX2 and FMA, for [`Avx512`] whether it has AVX-512F. (That most of it is compiled with the instructions enabled is for speed.)
#![expect(unsafe_code, reason = "the instructions of a processor; see above")]

use crate::arithmetic::elementary;
use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use crate::batch::vector::{Bits, Vector};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Four doubles.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256d);

/// Four answers: all bits of a lane, or none.
#[derive(Clone, Copy)]
pub(crate) struct Avx2Mask(__m256d);

/// Eight doubles.
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m512d);

/// Eight answers.
#[derive(Clone, Copy)]
pub(crate) struct Avx512Mask(__mmask8);

impl Mask for Avx2Mask {
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

impl Bits for Avx2Mask {
    const WIDTH: usize = 4;
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { _mm256_movemask_pd(self.0) as u32 }
    }
}

impl BitAnd for Avx2Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_and_pd(self.0, other.0)) }
    }
}

impl BitOr for Avx2Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_or_pd(self.0, other.0)) }
    }
}

impl Not for Avx2Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: the processor has AVX2, as the head of this file says.
        unsafe {
            let all = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
            Self(_mm256_xor_pd(self.0, all))
        }
    }
}

impl Mask for Avx512Mask {
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
}

impl Bits for Avx512Mask {
    const WIDTH: usize = 8;
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
}

impl BitAnd for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

/// One operator.
macro_rules! operator {
    ($type:ident, $trait:ident, $method:ident, $instruction:ident) => {
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the processor has the instruction, as the head of this file says.
                unsafe { Self($instruction(self.0, other.0)) }
            }
        }
    };
}
operator!(Avx2, Add, add, _mm256_add_pd);
operator!(Avx2, Sub, sub, _mm256_sub_pd);
operator!(Avx2, Mul, mul, _mm256_mul_pd);
operator!(Avx2, Div, div, _mm256_div_pd);
operator!(Avx512, Add, add, _mm512_add_pd);
operator!(Avx512, Sub, sub, _mm512_sub_pd);
operator!(Avx512, Mul, mul, _mm512_mul_pd);
operator!(Avx512, Div, div, _mm512_div_pd);
with_doubles!([] Avx2);
with_doubles!([] Avx512);

impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_xor_pd(self.0, Self::from_f64(-0.0).0)) }
    }
}

impl Neg for Avx512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe {
            let bits = _mm512_castpd_si512(self.0);
            let sign = _mm512_castpd_si512(Self::from_f64(-0.0).0);
            Self(_mm512_castsi512_pd(_mm512_xor_si512(bits, sign)))
        }
    }
}

/// What the two vectors do alike.
macro_rules! vector {
    ($type:ident, $register:ident, $width:literal) => {
        impl $type {
            const fn of(value: f64) -> Self {
                // SAFETY: a register is as many doubles, and any bits are legal in both.
                Self(unsafe { std::mem::transmute::<[f64; $width], $register>([value; $width]) })
            }

            fn to_array(self) -> [f64; $width] {
                // SAFETY: a register is as many doubles, and any bits are legal in both.
                unsafe { std::mem::transmute::<$register, [f64; $width]>(self.0) }
            }

            fn from_array(array: [f64; $width]) -> Self {
                // SAFETY: a register is as many doubles, and any bits are legal in both.
                Self(unsafe { std::mem::transmute::<[f64; $width], $register>(array) })
            }
        }

        impl Doubles for $type {
            fn each(self, f: fn(f64) -> (f64, f64)) -> (Self, Self) {
                let both = self.to_array().map(f);
                (
                    Self::from_array(both.map(|b| b.0)),
                    Self::from_array(both.map(|b| b.1)),
                )
            }
        }

        impl Vector for $type {
            fn get(&self, lane: usize) -> f64 {
                self.to_array()[lane]
            }
            fn set(&mut self, lane: usize, value: f64) {
                let register: *mut [f64; $width] = (&raw mut self.0).cast();
                // SAFETY: a register is as many doubles, and any bits are legal in both. In place, because a register that
                // is read right after a part of it was written to memory waits for the store.
                unsafe { (*register)[lane] = value };
            }
        }
    };
}
vector!(Avx2, __m256d, 4);
vector!(Avx512, __m512d, 8);

impl Lane for Avx2 {
    type Mask = Avx2Mask;
    const EPSILON: Self = Self::of(f64::EPSILON);
    const ZERO: Self = Self::of(0.0);
    const ONE: Self = Self::of(1.0);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        // SAFETY: the processor has FMA, as the head of this file says.
        unsafe { Self(_mm256_fmadd_pd(self.0, by.0, plus.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_andnot_pd(Self::from_f64(-0.0).0, self.0)) }
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
    fn below(self, other: Self) -> Avx2Mask {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Avx2Mask(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Avx2Mask {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Avx2Mask(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn select(mask: Avx2Mask, yes: Self, no: Self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_blendv_pd(no.0, yes.0, mask.0)) }
    }
    // The instructions give the second of two that are equal, or of which one is not a number.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_max_pd(other.0, self.0)) }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: the processor has AVX, as the head of this file says.
        unsafe { Self(_mm256_min_pd(other.0, self.0)) }
    }
}

impl Lane for Avx512 {
    type Mask = Avx512Mask;
    const EPSILON: Self = Self::of(f64::EPSILON);
    const ZERO: Self = Self::of(0.0);
    const ONE: Self = Self::of(1.0);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_set1_pd(value)) }
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_fmadd_pd(self.0, by.0, plus.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_abs_pd(self.0)) }
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
    fn below(self, other: Self) -> Avx512Mask {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Avx512Mask(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Avx512Mask {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Avx512Mask(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn select(mask: Avx512Mask, yes: Self, no: Self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_mask_blend_pd(mask.0, no.0, yes.0)) }
    }
    // The instructions give the second of two that are equal, or of which one is not a number.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_max_pd(other.0, self.0)) }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512, as the head of this file says.
        unsafe { Self(_mm512_min_pd(other.0, self.0)) }
    }
}
