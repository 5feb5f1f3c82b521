//! Sums, products, quotients by one limb and comparisons of significands of fixed size, rounded to
//! nearest.
//!
//! A significand is an array of `u64` limbs, the least significant one first. Its topmost bit is
//! set, and its lowest [`SPARE`] bits are zero; zero has limbs of zero. A number is ± significand ·
//! 2^exponent, and zero has the exponent 0.
//!
//! The functions take slices, so that each is compiled once, here and optimised, and not again for
//! every size in the crates that use it.

use std::cmp::Ordering;

/// The bits of the lowest limb that are always zero. The library's numbers, which have as many bits
/// as are kept here, fit with one more, and [`divide`] needs one.
pub(super) const SPARE: u32 = 2;
const _: () = assert!(SPARE >= 1);

/// The exponent of a number, and whether it is negative.
pub(super) type Scale = (i64, bool);

/// A number whose significand is borrowed.
#[derive(Clone, Copy)]
pub(super) struct Operand<'a> {
    pub(super) limbs: &'a [u64],
    pub(super) exponent: i64,
    pub(super) negative: bool,
}

impl Operand<'_> {
    fn is_zero(self) -> bool {
        self.limbs.last().is_none_or(|top| *top == 0)
    }

    /// The significand's only limb that is not zero, if this is the topmost one, as in a double.
    pub(super) fn single_limb(self) -> Option<u64> {
        let (top, rest) = self.limbs.split_last()?;
        (*top != 0 && rest.iter().all(|limb| *limb == 0)).then_some(*top)
    }

    /// Compares without the signs. Significands that are not zero have their topmost bits set, so
    /// that the exponents decide first, and the limbs if they are equal.
    fn compare_magnitude(self, other: Self) -> Ordering {
        let by_zero = (!self.is_zero()).cmp(&!other.is_zero());
        let by_limbs = || self.limbs.iter().rev().cmp(other.limbs.iter().rev());
        let by_exponent = || self.exponent.cmp(&other.exponent);
        by_zero.then_with(by_exponent).then_with(by_limbs)
    }

    /// Limb `k` of the significand · 2^−`shift`; limb −1 is the one below the lowest.
    fn limb_shifted(self, k: isize, shift: u64) -> u64 {
        let limb = |k: isize| usize::try_from(k).ok().and_then(|k| self.limbs.get(k));
        let from = k + (shift / 64) as isize;
        let low = limb(from).map_or(0, |limb| limb >> (shift % 64));
        // In two steps, as a shift by 64 is not defined.
        let high = limb(from + 1).map_or(0, |limb| (limb << 1) << (63 - shift % 64));
        low | high
    }

    /// Whether the significand · 2^−`shift` has a bit below limb −1.
    fn has_bits_below(self, shift: u64) -> bool {
        let Some(bits) = shift.checked_sub(64) else {
            return false;
        };
        let whole = (bits / 64) as usize;
        let part = self.limbs.get(whole);
        self.limbs.iter().take(whole).any(|limb| *limb != 0)
            || part.is_some_and(|limb| limb & ((1 << (bits % 64)) - 1) != 0)
    }
}

pub(super) fn compare(a: Operand, b: Operand) -> Ordering {
    let sign = |x: Operand| match (x.is_zero(), x.negative) {
        (true, _) => 0,
        (false, negative) => 1 - 2 * i8::from(negative),
    };
    let magnitudes = if a.negative {
        b.compare_magnitude(a)
    } else {
        a.compare_magnitude(b)
    };
    sign(a).cmp(&sign(b)).then(magnitudes)
}

/// a + b, with the significand in `out`; none if the exponent is out of range, or close to it.
///
/// Let a be the larger one in magnitude. Below its significand one more limb is computed, and what
/// b has below that limb only sets the lowest bit. A difference with b shifted by two bits or more
/// loses at most one leading bit, and one with b shifted by less fits into the limb, so that this
/// bit is never near those that are kept, and the result is rounded correctly.
pub(super) fn add(a: Operand, b: Operand, out: &mut [u64]) -> Option<Scale> {
    let (a, b) = match a.compare_magnitude(b) {
        Ordering::Less => (b, a),
        _ => (a, b),
    };
    out.copy_from_slice(a.limbs);
    if b.is_zero() {
        return Some((a.exponent, a.negative && !a.is_zero()));
    }
    // Beyond the whole significand and two limbs the shift makes no difference.
    let farthest = 64 * (a.limbs.len() as u64 + 2);
    let shift = a.exponent.abs_diff(b.exponent).min(farthest);
    let below = b.limb_shifted(-1, shift) | u64::from(b.has_bits_below(shift));
    let shifted = |k: usize| b.limb_shifted(k as isize, shift);
    if a.negative == b.negative {
        let mut carry = false;
        for (k, limb) in out.iter_mut().enumerate() {
            let (sum, first) = limb.overflowing_add(shifted(k));
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            (*limb, carry) = (sum, first || second);
        }
        let (mut exponent, mut below) = (a.exponent, below);
        if carry {
            below = (below >> 1) | (below & 1) | (out[0] << 63);
            shift_down_by_one(out);
            exponent = exponent.checked_add(1)?;
        }
        round(out, below, exponent, a.negative)
    } else {
        let (below, mut borrow) = 0u64.overflowing_sub(below);
        for (k, limb) in out.iter_mut().enumerate() {
            let (difference, first) = limb.overflowing_sub(shifted(k));
            let (difference, second) = difference.overflowing_sub(u64::from(borrow));
            (*limb, borrow) = (difference, first || second);
        }
        normalise(out, below, a.exponent, a.negative)
    }
}

/// a · b, with the significand in `out`; none if the exponent is out of range, or close to it.
///
/// The product is computed column by column from the lowest one. Of the columns below the upper
/// half, the highest is kept for rounding; of the others it only matters whether a bit is set.
pub(super) fn multiply(a: Operand, b: Operand, out: &mut [u64]) -> Option<Scale> {
    if a.is_zero() || b.is_zero() {
        out.fill(0);
        return Some((0, false));
    }
    let n = out.len();
    let (mut below, mut lost) = (0, 0);
    // The sum of a column and what the columns before it carry, in three limbs.
    let (mut sum, mut over) = (0u128, 0u64);
    for column in 0..2 * n - 1 {
        let first = (column + 1).saturating_sub(n);
        for i in first..=column.min(n - 1) {
            let product = u128::from(a.limbs[i]) * u128::from(b.limbs[column - i]);
            let (total, carried) = sum.overflowing_add(product);
            (sum, over) = (total, over + u64::from(carried));
        }
        let limb = sum as u64;
        if column >= n {
            out[column - n] = limb;
        } else {
            lost |= below;
            below = limb;
        }
        (sum, over) = ((sum >> 64) | (u128::from(over) << 64), 0);
    }
    out[n - 1] = sum as u64;
    let below = below | u64::from(lost != 0);
    let exponent = a.exponent.checked_add(b.exponent)?;
    let exponent = exponent.checked_add(64 * n as i64)?;
    normalise(out, below, exponent, a.negative != b.negative)
}

/// a / b with a divisor of a single limb `divisor`, the significand in `out`; none if the exponent
/// is out of range, or close to it.
///
/// Long division from the topmost limb, by one limb more than is kept. The first digit is 0 or 1,
/// as both topmost bits are set. If it is 0, the topmost bit of the next one is set.
///
/// What is left after the last digit needs no bit of its own. With the limbs as integers, in units
/// of the last digit, the quotient is A 2^128 / d, and a halfway point h is a multiple of 2^(63 +
/// SPARE), at least of 2^64. So their difference is a multiple of 2^64 / d, and as d < 2^64 it is
/// zero or more than one unit.
pub(super) fn divide(a: Operand, b: Operand, divisor: u64, out: &mut [u64]) -> Option<Scale> {
    if a.is_zero() {
        out.fill(0);
        return Some((0, false));
    }
    let n = out.len();
    let divisor = u128::from(divisor);
    let mut remainder = 0;
    let mut next_digit = |limb: u64| {
        let dividend = (remainder << 64) | u128::from(limb);
        remainder = dividend % divisor;
        (dividend / divisor) as u64
    };
    let first = next_digit(a.limbs[n - 1]);
    for k in (0..n).rev() {
        out[k] = next_digit(k.checked_sub(1).map_or(0, |k| a.limbs[k]));
    }
    let mut below = next_digit(0);
    let exponent = a.exponent.checked_sub(b.exponent)?;
    // The divisor is its topmost limb times 2^(64 (n − 1)), and the dividend was extended by one.
    let mut exponent = exponent.checked_sub(64 * n as i64)?;
    if first == 1 {
        below = (below >> 1) | (below & 1) | (out[0] << 63);
        shift_down_by_one(out);
        exponent = exponent.checked_add(1)?;
    }
    round(out, below, exponent, a.negative != b.negative)
}

/// A double, exactly; none if it is infinite or NaN.
pub(super) fn of_double(value: f64, out: &mut [u64]) -> Option<Scale> {
    if !value.is_finite() {
        return None;
    }
    let bits = value.to_bits();
    let (field, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    // IEEE 754: fraction · 2^−1074 below the normal numbers, else (2^52 + fraction) · 2^(field −
    // 1075).
    let (integer, power) = match field {
        0 => (fraction, -1074),
        _ => (fraction | (1 << 52), field as i64 - 1075),
    };
    let top = out.len() - 1;
    out.fill(0);
    out[top] = integer;
    normalise(out, 0, power - 64 * top as i64, value.is_sign_negative())
}

fn shift_down_by_one(limbs: &mut [u64]) {
    let mut high = 0;
    for limb in limbs.iter_mut().rev() {
        let low = *limb << 63;
        *limb = (*limb >> 1) | high;
        high = low;
    }
    if let Some(top) = limbs.last_mut() {
        *top |= 1 << 63;
    }
}

/// Shifts the significand and the limb below it so that the topmost bit is set, and rounds.
pub(super) fn normalise(
    limbs: &mut [u64],
    mut below: u64,
    exponent: i64,
    negative: bool,
) -> Option<Scale> {
    let n = limbs.len();
    let empty = limbs.iter().rev().take_while(|limb| **limb == 0).count();
    if empty == n && below == 0 {
        return Some((0, false));
    }
    if empty > 0 {
        limbs.copy_within(..n - empty, empty);
        limbs[..empty].fill(0);
        (limbs[empty - 1], below) = (below, 0);
    }
    let bits = limbs[n - 1].leading_zeros();
    if bits > 0 && bits < 64 {
        for k in (1..n).rev() {
            limbs[k] = (limbs[k] << bits) | (limbs[k - 1] >> (64 - bits));
        }
        limbs[0] = (limbs[0] << bits) | (below >> (64 - bits));
        below <<= bits;
    }
    let shifted = 64 * empty as i64 + i64::from(bits);
    round(limbs, below, exponent.checked_sub(shifted)?, negative)
}

/// Rounds a significand whose topmost bit is set, and the limb below it, to nearest; halfway to
/// even.
fn round(limbs: &mut [u64], below: u64, exponent: i64, negative: bool) -> Option<Scale> {
    const UNIT: u64 = 1 << SPARE;
    let low = limbs[0];
    let rest = (low % UNIT, below);
    let half = (UNIT / 2, 0);
    let up = rest > half || (rest == half && low & UNIT != 0);
    limbs[0] = low - low % UNIT;
    let mut carry = if up { UNIT } else { 0 };
    for limb in limbs.iter_mut() {
        let (sum, carried) = limb.overflowing_add(carry);
        (*limb, carry) = (sum, u64::from(carried));
    }
    if carry == 0 {
        return Some((exponent, negative));
    }
    // All bits were set: the next power of two.
    shift_down_by_one(limbs);
    Some((exponent.checked_add(1)?, negative))
}
