//! The library's operations, which are not generic, so that each is compiled once, here: a number
//! of so many words is compiled again in every crate that uses it, and calls these for all
//! expensive parts.
//!
//! A result is rounded to nearest, to a number of bits; there is none where it has no value.

use dashu_float::round::mode::HalfEven;
use dashu_float::{Context, FBig, FpError, Repr};
use dashu_int::{IBig, Sign, UBig};
use std::cmp::Ordering;

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

/// From a significand, an integer, least significant byte first.
pub(super) fn number(significand: &[u8], exponent: i64, negative: bool) -> Number {
    let sign = if negative {
        Sign::Negative
    } else {
        Sign::Positive
    };
    let magnitude = UBig::from_le_bytes(significand);
    Repr::new(IBig::from_parts(sign, magnitude), exponent as isize)
}

/// Writes the significand of a number, padded with zeros; returns its exponent and whether it is
/// negative. None if the significand does not fit.
pub(super) fn write(number: &Number, significand: &mut [u8]) -> Option<(i64, bool)> {
    let (sign, magnitude) = number.significand().clone().into_parts();
    let bytes = magnitude.to_le_bytes();
    if number.is_infinite() || bytes.len() > significand.len() {
        return None;
    }
    significand[..bytes.len()].copy_from_slice(&bytes);
    if bytes.is_empty() {
        return Some((0, false));
    }
    Some((number.exponent() as i64, sign == Sign::Negative))
}

pub(super) fn add(bits: usize, a: &Number, b: &Number) -> Option<Number> {
    known(context(bits).add(a, b).map(|sum| sum.value()))
}

pub(super) fn subtract(bits: usize, a: &Number, b: &Number) -> Option<Number> {
    known(context(bits).sub(a, b).map(|difference| difference.value()))
}

pub(super) fn multiply(bits: usize, a: &Number, b: &Number) -> Option<Number> {
    known(context(bits).mul(a, b).map(|product| product.value()))
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

pub(super) fn of_double(value: f64) -> Option<Number> {
    known(Rounded::try_from(value))
}

pub(super) fn to_double(bits: usize, x: Number) -> f64 {
    Rounded::from_repr(x, context(bits)).to_f64().value()
}

pub(super) fn compare(a: &Number, b: &Number) -> Ordering {
    a.cmp(b)
}
