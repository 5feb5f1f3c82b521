//! The library's operations, which are not generic, so that each is compiled once, here: a number
//! of so many words is compiled again in every crate that uses it, and calls these for all
//! expensive parts.
//!
//! A result is rounded to nearest, to a number of bits; there is none where it has no value.

use super::nearest::{self, Operand, SPARE, Scale};
use dashu_float::round::mode::HalfEven;
use dashu_float::{Context, FBig, FpError, Repr};
use dashu_int::ops::BitTest;
use dashu_int::{IBig, Sign, UBig};

/// A number in the library's representation.
pub(super) type Number = Repr<2>;

/// An operation on one number or on two.
pub(super) type Unary = fn(usize, &Number) -> Option<Number>;
pub(super) type Binary = fn(usize, &Number, &Number) -> Option<Number>;

type Rounded = FBig<HalfEven, 2>;

fn context(bits: usize) -> Context<HalfEven> {
    Context::new(bits)
}

fn known<E>(result: Result<Rounded, E>) -> Option<Number> {
    result.ok().map(Rounded::into_repr)
}

pub(super) fn number(operand: Operand) -> Number {
    let mut bytes = Vec::with_capacity(8 * operand.limbs.len());
    for limb in operand.limbs {
        bytes.extend(limb.to_le_bytes());
    }
    let sign = if operand.negative {
        Sign::Negative
    } else {
        Sign::Positive
    };
    let magnitude = UBig::from_le_bytes(&bytes);
    Repr::new(IBig::from_parts(sign, magnitude), operand.exponent as isize)
}

/// A whole number of any length, in decimal digits after an optional sign; none if it is not one.
pub(super) fn integer(bits: usize, digits: &str) -> Option<Number> {
    let integer: IBig = digits.parse().ok()?;
    known(Ok::<_, FpError>(context(bits).convert_int(integer).value()))
}

/// Writes the significand of a number, which the library has rounded to as many bits as are kept.
/// None if the number has no value.
pub(super) fn write(number: &Number, limbs: &mut [u64]) -> Option<Scale> {
    let (sign, magnitude) = number.significand().clone().into_parts();
    let bytes = magnitude.to_le_bytes();
    debug_assert!(magnitude.bit_len() <= 64 * limbs.len() - SPARE as usize);
    if number.is_infinite() || bytes.len() > 8 * limbs.len() {
        return None;
    }
    for (limb, bytes) in limbs.iter_mut().zip(bytes.chunks(8)) {
        let mut whole = [0; 8];
        whole[..bytes.len()].copy_from_slice(bytes);
        *limb = u64::from_le_bytes(whole);
    }
    nearest::normalise(limbs, 0, number.exponent() as i64, sign == Sign::Negative)
}

pub(super) fn divide(bits: usize, a: &Number, b: &Number) -> Option<Number> {
    known(context(bits).div(a, b).map(|quotient| quotient.value()))
}

pub(super) fn root(bits: usize, x: &Number) -> Option<Number> {
    known(context(bits).sqrt(x).map(|root| root.value()))
}

pub(super) fn sine_and_cosine(bits: usize, x: &Number) -> [Option<Number>; 2] {
    let (sine, cosine) = context(bits).sin_cos(x, None);
    [
        known(sine.map(|sine| sine.value())),
        known(cosine.map(|cosine| cosine.value())),
    ]
}

pub(super) fn pi(bits: usize) -> Number {
    context(bits).pi::<2>(None).value().into_repr()
}

/// 10^`power`.
pub(super) fn power_of_ten(bits: usize, power: u32) -> Option<Number> {
    let power = IBig::from(UBig::from(10u8).pow(power as usize));
    known(Ok::<_, FpError>(context(bits).convert_int(power).value()))
}

pub(super) fn to_double(bits: usize, x: Number) -> f64 {
    Rounded::from_repr(x, context(bits)).to_f64().value()
}
