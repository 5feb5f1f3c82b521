//! Binary numbers of many digits: integers of 64-bit limbs with a sign and a power of two. Sums and
//! products are truncated, and report whether anything was cut off.

use smallvec::SmallVec;

/// Limbs of 64 bits, the least significant one first; up to six of them need no allocation.
pub(crate) type Limbs = SmallVec<[u64; 6]>;

/// ± L · 2^(`exponent` − 64 n), with the integer L of n limbs, the topmost bit of which is set: so
/// 2^(`exponent` − 1) ≤ |number| < 2^`exponent`. Zero has limbs of zero.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    pub(crate) negative: bool,
    pub(crate) exponent: i64,
    pub(crate) limbs: Limbs,
}

/// A result, and whether it differs from the exact one; the difference is less than 2 ·
/// 2^[`Number::unit`].
pub(crate) type Rounded = (Number, bool);

impl Number {
    pub(crate) fn zero() -> Self {
        Self {
            negative: false,
            exponent: 0,
            limbs: SmallVec::from_slice(&[0]),
        }
    }

    /// An integer, exactly.
    pub(crate) fn from_integer(integer: i64) -> Self {
        let magnitude = integer.unsigned_abs();
        let zeros = magnitude.leading_zeros();
        if magnitude == 0 {
            return Self::zero();
        }
        Self {
            negative: integer < 0,
            exponent: i64::from(64 - zeros),
            limbs: SmallVec::from_slice(&[magnitude << zeros]),
        }
    }

    /// A double, exactly; none if it is infinite or NaN.
    pub(crate) fn from_f64(value: f64) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        let bits = value.to_bits();
        let (field, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        // IEEE 754: fraction · 2^-1074 below the normal numbers, else (2^52 + fraction) · 2^(field
        // − 1075).
        let (integer, power) = if field == 0 {
            (fraction, -1074)
        } else {
            (fraction | (1 << 52), field as i64 - 1075)
        };
        let mut number = Self::from_integer(integer as i64);
        number.negative = value.is_sign_negative() && integer != 0;
        number.exponent += if integer == 0 { 0 } else { power };
        Some(number)
    }

    /// ± the integer of these limbs · 2^power, with at most `most` limbs.
    pub(crate) fn from_limbs(negative: bool, limbs: &[u64], power: i64, most: usize) -> Rounded {
        let mut limbs = Limbs::from_slice(limbs);
        let exponent = power + 64 * limbs.len() as i64;
        Self::normalised(negative, exponent, &mut limbs, most)
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.limbs.last().is_none_or(|top| *top == 0)
    }

    /// The exponent k of the unit 2^k of the last bit.
    pub(crate) fn unit(&self) -> i64 {
        self.exponent - 64 * self.limbs.len() as i64
    }

    /// The number with `limbs` limbs: surplus low limbs are cut off, missing ones are filled with
    /// zeros.
    pub(crate) fn with_limbs(&self, limbs: usize) -> Rounded {
        let n = self.limbs.len();
        let mut number = self.clone();
        let inexact = if n > limbs {
            number.limbs.drain(..n - limbs).any(|limb| limb != 0)
        } else {
            number
                .limbs
                .insert_many(0, std::iter::repeat_n(0, limbs - n));
            false
        };
        (number, inexact)
    }

    /// ± `limbs` · 2^(exponent − 64 n), shifted so that the topmost bit is set, and truncated or
    /// padded with zeros to `most` limbs, so that the precision of a result does not depend on its
    /// value.
    fn normalised(negative: bool, mut exponent: i64, limbs: &mut Limbs, most: usize) -> Rounded {
        while limbs.len() > 1 && limbs.last() == Some(&0) {
            limbs.pop();
            exponent -= 64;
        }
        let popped = limbs.len();
        let top = limbs.last().copied().unwrap_or(0);
        if top == 0 {
            return (Self::zero(), false);
        }
        let zeros = top.leading_zeros();
        if zeros > 0 {
            let mut low = 0;
            for limb in limbs.iter_mut() {
                let next = *limb >> (64 - zeros);
                *limb = (*limb << zeros) | low;
                low = next;
            }
        }
        let mut inexact = false;
        if popped > most {
            // `drain` removes all these limbs even if `any` stops early.
            inexact = limbs.drain(..popped - most).any(|limb| limb != 0);
        } else if popped < most {
            limbs.insert_many(0, std::iter::repeat_n(0, most - popped));
        }
        let number = Self {
            negative,
            exponent: exponent - i64::from(zeros),
            limbs: std::mem::take(limbs),
        };
        (number, inexact)
    }

    /// The sum, with as many limbs as the longer of the two.
    ///
    /// Let a be the one with the larger exponent, b the other, n the limbs of the result. Both are
    /// aligned to n + 1 limbs below a's exponent, so that the unit is u = 2^(a.exponent − 64 n −
    /// 64). There a is exact; of b less than u is cut off, and only where its exponent is smaller
    /// than a's by more than 64. Then |b| < |a| 2^-63, the sum is above 2^(a.exponent − 2), and u
    /// is less than 2^-62 units of the result. Truncating the sum to n limbs takes away less than
    /// one unit, so that the total error is less than two units.
    pub(crate) fn add(&self, other: &Self) -> Rounded {
        if self.is_zero() {
            return (other.clone(), false);
        }
        if other.is_zero() {
            return (self.clone(), false);
        }
        let (a, b) = if self.exponent < other.exponent {
            (other, self)
        } else {
            (self, other)
        };
        let n = a.limbs.len().max(b.limbs.len());
        let mut sum: Limbs = SmallVec::from_elem(0, n + 1);
        sum[n + 1 - a.limbs.len()..].copy_from_slice(&a.limbs);
        let (shifted, lost) = b.shifted(n + 1, (a.exponent - b.exponent) as u64);
        let mut exponent = a.exponent;
        let mut negative = a.negative;
        if a.negative == b.negative {
            if add_into(&mut sum, &shifted) {
                sum.push(1);
                exponent += 64;
            }
        } else if subtract_from(&mut sum, &shifted) {
            negative = !negative;
            negate(&mut sum);
        }
        let (number, inexact) = Self::normalised(negative, exponent, &mut sum, n);
        (number, inexact || lost)
    }

    /// The limbs shifted down by `bits` bits, in `length` limbs, and whether any set bit was lost.
    fn shifted(&self, length: usize, bits: u64) -> (Limbs, bool) {
        let mut out: Limbs = SmallVec::from_elem(0, length);
        let whole = usize::try_from(bits / 64).unwrap_or(usize::MAX);
        let part = (bits % 64) as u32;
        if whole >= length {
            return (out, true);
        }
        let mut lost = false;
        // The top of self moves to `whole` limbs and `part` bits below the top of out.
        let offset = (length - whole) as i64 - self.limbs.len() as i64;
        for (k, &limb) in self.limbs.iter().enumerate() {
            let at = k as i64 + offset;
            let high = limb >> part;
            let low = if part == 0 { 0 } else { limb << (64 - part) };
            if at >= 0 {
                out[at as usize] |= high;
            } else {
                lost |= high != 0;
            }
            if at >= 1 {
                out[at as usize - 1] |= low;
            } else {
                lost |= low != 0;
            }
        }
        (out, lost)
    }

    /// The product, truncated to as many limbs as the longer factor has.
    pub(crate) fn mul(&self, other: &Self) -> Rounded {
        if self.is_zero() || other.is_zero() {
            return (Self::zero(), false);
        }
        let (n, m) = (self.limbs.len(), other.limbs.len());
        let mut product: Limbs = SmallVec::from_elem(0, n + m);
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0u128;
            for (place, &b) in product[i..].iter_mut().zip(&other.limbs) {
                let sum = u128::from(a) * u128::from(b) + u128::from(*place) + carry;
                *place = sum as u64;
                carry = sum >> 64;
            }
            product[i + m] = carry as u64;
        }
        let exponent = self.exponent + other.exponent;
        // Both topmost bits are set, so that at most the product's topmost bit is zero.
        Self::normalised(
            self.negative != other.negative,
            exponent,
            &mut product,
            n.max(m),
        )
    }

    /// The quotient by a small positive integer, truncated to as many limbs.
    pub(crate) fn over_small(&self, divisor: u64) -> Rounded {
        if self.is_zero() {
            return (Self::zero(), false);
        }
        let n = self.limbs.len();
        let mut quotient: Limbs = SmallVec::from_elem(0, n + 2);
        let mut rest = 0u128;
        for k in (0..n + 2).rev() {
            let limb = if k >= 2 { self.limbs[k - 2] } else { 0 };
            let dividend = (rest << 64) | u128::from(limb);
            quotient[k] = (dividend / u128::from(divisor)) as u64;
            rest = dividend % u128::from(divisor);
        }
        let (number, inexact) = Self::normalised(self.negative, self.exponent, &mut quotient, n);
        (number, inexact || rest != 0)
    }

    pub(crate) fn negated(mut self) -> Self {
        self.negative = !self.negative && !self.is_zero();
        self
    }

    /// A double next to it.
    pub(crate) fn to_f64(&self) -> f64 {
        let top = self.limbs.last().copied().unwrap_or(0) as f64;
        let power = (self.exponent - 64).clamp(-2000, 2000) as i32;
        let size = top * 2f64.powi(power / 2) * 2f64.powi(power - power / 2);
        if self.negative { -size } else { size }
    }
}

/// a += b; whether it carries.
fn add_into(a: &mut [u64], b: &[u64]) -> bool {
    let mut carry = false;
    for (x, &y) in a.iter_mut().zip(b) {
        let (sum, first) = x.overflowing_add(y);
        let (sum, second) = sum.overflowing_add(u64::from(carry));
        *x = sum;
        carry = first || second;
    }
    carry
}

/// a −= b, modulo 2^(64 n); whether it was negative.
fn subtract_from(a: &mut [u64], b: &[u64]) -> bool {
    let mut borrow = false;
    for (x, &y) in a.iter_mut().zip(b) {
        let (difference, first) = x.overflowing_sub(y);
        let (difference, second) = difference.overflowing_sub(u64::from(borrow));
        *x = difference;
        borrow = first || second;
    }
    borrow
}

/// a = 2^(64 n) − a.
fn negate(a: &mut [u64]) {
    let mut carry = true;
    for x in a {
        let (sum, over) = (!*x).overflowing_add(u64::from(carry));
        *x = sum;
        carry = over;
    }
}
