//! Bounds: non-negative numbers with a mantissa of 32 bits, rounded up or down as each operation
//! says.

use std::cmp::Ordering;

/// `mantissa` · 2^`exponent` with 2³¹ ≤ `mantissa` < 2³², or zero with `mantissa` = 0.
///
/// Integers of 64 bits hold the exact result of every operation below before it is rounded, so that
/// no rounding mode of the processor matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Radius {
    mantissa: u64,
    exponent: i64,
}

impl Radius {
    pub(crate) const ZERO: Self = Self {
        mantissa: 0,
        exponent: 0,
    };

    /// 2^exponent.
    pub(crate) const fn power_of_two(exponent: i64) -> Self {
        Self {
            mantissa: 1 << 31,
            exponent: exponent - 31,
        }
    }

    /// The smallest value that is not below `integer` · 2^`exponent`.
    ///
    /// An integer of 64 bits has at most 32 bits too many. If any bit cut off is set, one is added,
    /// which is more than was cut off; if that makes the mantissa 2³² it is even, and halved
    /// exactly.
    pub(crate) fn above(integer: u64, exponent: i64) -> Self {
        if integer == 0 {
            return Self::ZERO;
        }
        let zeros = i64::from(integer.leading_zeros());
        if zeros >= 32 {
            let shift = zeros - 32;
            return Self {
                mantissa: integer << shift,
                exponent: exponent - shift,
            };
        }
        let shift = 32 - zeros;
        let cut = integer >> shift;
        let mantissa = cut + u64::from(cut << shift != integer);
        if mantissa >> 32 == 0 {
            Self {
                mantissa,
                exponent: exponent + shift,
            }
        } else {
            Self {
                mantissa: mantissa >> 1,
                exponent: exponent + shift + 1,
            }
        }
    }

    /// The largest value that is not above `integer` · 2^`exponent`: surplus bits are cut off.
    pub(crate) fn below(integer: u64, exponent: i64) -> Self {
        if integer == 0 {
            return Self::ZERO;
        }
        let shift = 32 - i64::from(integer.leading_zeros());
        let mantissa = if shift > 0 {
            integer >> shift
        } else {
            integer << -shift
        };
        Self {
            mantissa,
            exponent: exponent + shift,
        }
    }

    pub(crate) fn is_zero(self) -> bool {
        self.mantissa == 0
    }

    /// An upper bound on the sum.
    ///
    /// The smaller one is brought to the larger one's exponent by cutting bits off; one unit is
    /// more than what was cut off.
    pub(crate) fn plus(self, other: Self) -> Self {
        let (large, small) = self.ordered(other);
        if small.is_zero() {
            return large;
        }
        let shift = large.exponent - small.exponent;
        let cut = if shift < 32 {
            let cut = small.mantissa >> shift;
            cut + u64::from(cut << shift != small.mantissa)
        } else {
            1
        };
        Self::above(large.mantissa + cut, large.exponent)
    }

    /// A lower bound on the difference; zero where that is negative.
    pub(crate) fn minus(self, other: Self) -> Self {
        if self <= other {
            return Self::ZERO;
        }
        if other.is_zero() {
            return self;
        }
        // As self > other, its exponent is not smaller. As in a sum, other is rounded up.
        let shift = self.exponent - other.exponent;
        let cut = if shift < 32 {
            let cut = other.mantissa >> shift;
            cut + u64::from(cut << shift != other.mantissa)
        } else {
            1
        };
        Self::below(self.mantissa.saturating_sub(cut), self.exponent)
    }

    /// An upper bound on the product; the exact product of two 32-bit integers has 64 bits.
    pub(crate) fn times(self, other: Self) -> Self {
        Self::above(
            self.mantissa * other.mantissa,
            self.exponent.saturating_add(other.exponent),
        )
    }

    /// An upper bound on the quotient; the divisor is not zero.
    ///
    /// The integer quotient of mantissa · 2³² cuts off less than one unit, which is added.
    pub(crate) fn over(self, divisor: Self) -> Self {
        let quotient = (self.mantissa << 32) / divisor.mantissa.max(1);
        let integer = if self.is_zero() { 0 } else { quotient + 1 };
        Self::above(integer, self.exponent.saturating_sub(divisor.exponent) - 32)
    }

    /// Times 2^power, exactly.
    pub(crate) fn scaled(self, power: i64) -> Self {
        Self {
            mantissa: self.mantissa,
            exponent: if self.is_zero() {
                0
            } else {
                self.exponent.saturating_add(power)
            },
        }
    }

    /// The integer and the power of two that make it up.
    pub(crate) fn parts(self) -> (u64, i64) {
        (self.mantissa, self.exponent)
    }

    /// The double nearest to it: it is exact except beyond the range of doubles, where it is 0, a
    /// subnormal or infinite. Proofs use the doubles next to it as bounds.
    pub(crate) fn to_f64(self) -> f64 {
        let exponent = i32::try_from(self.exponent).unwrap_or(if self.exponent > 0 {
            i32::MAX
        } else {
            i32::MIN
        });
        // In two steps, because 2^exponent alone may overflow where the product does not.
        let half = exponent / 2;
        self.mantissa as f64 * 2f64.powi(half) * 2f64.powi(exponent - half)
    }

    fn ordered(self, other: Self) -> (Self, Self) {
        if self < other {
            (other, self)
        } else {
            (self, other)
        }
    }
}

impl PartialOrd for Radius {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Radius {
    /// Nonzero mantissas differ by less than a factor of two, so that the exponent is compared
    /// first.
    fn cmp(&self, other: &Self) -> Ordering {
        match (self.is_zero(), other.is_zero()) {
            (true, true) => Ordering::Equal,
            (true, false) => Ordering::Less,
            (false, true) => Ordering::Greater,
            (false, false) => self
                .exponent
                .cmp(&other.exponent)
                .then(self.mantissa.cmp(&other.mantissa)),
        }
    }
}
