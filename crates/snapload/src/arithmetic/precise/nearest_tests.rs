//! Sums, products, quotients and comparisons against exact integers.

use super::nearest::*;
use dashu_int::{UBig, ops::BitTest};
use proptest::prelude::*;
use std::cmp::Ordering;

const BITS: usize = 64 * 3 - SPARE as usize;

/// A number as ± integer · 2^exponent.
#[derive(Clone, Debug)]
struct Exact {
    integer: UBig,
    exponent: i64,
    negative: bool,
}

impl Exact {
    fn limbs(&self) -> [u64; 3] {
        let bytes = self.integer.to_le_bytes();
        let mut limbs = [0; 3];
        for (k, byte) in bytes.iter().enumerate() {
            limbs[k / 8] |= u64::from(*byte) << (8 * (k % 8));
        }
        limbs
    }

    /// The integer over 2^`exponent`, which is not above its own.
    fn over(&self, exponent: i64) -> UBig {
        &self.integer << (self.exponent - exponent) as usize
    }

    fn sum(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let (a, b) = (self.over(exponent), other.over(exponent));
        let (integer, negative) = match (self.negative == other.negative, a >= b) {
            (true, _) => (a + b, self.negative),
            (false, true) => (a - b, self.negative),
            (false, false) => (b - a, other.negative),
        };
        Self {
            integer,
            exponent,
            negative,
        }
    }

    fn product(&self, other: &Self) -> Self {
        Self {
            integer: &self.integer * &other.integer,
            exponent: self.exponent + other.exponent,
            negative: self.negative != other.negative,
        }
    }

    /// Rounded to nearest by the definition: of the two neighbours with so many bits the one
    /// that is nearer, or the even one.
    fn rounded(self) -> Self {
        if self.integer == UBig::ZERO {
            return Self {
                exponent: 0,
                negative: false,
                ..self
            };
        }
        let length = self.integer.bit_len();
        let mut kept = self.integer.clone();
        let mut exponent = self.exponent;
        if let Some(surplus) = length.checked_sub(BITS + 1).map(|more| more + 1) {
            let below = &self.integer >> surplus;
            let rest = &self.integer - (&below << surplus);
            let half = UBig::ONE << (surplus - 1);
            let odd = &below % UBig::from(2u8) == UBig::ONE;
            kept = if rest > half || (rest == half && odd) {
                below + UBig::ONE
            } else {
                below
            };
            exponent += surplus as i64;
        }
        let room = 192 - kept.bit_len();
        Self {
            integer: kept << room,
            exponent: exponent - room as i64,
            negative: self.negative,
        }
    }
}

/// Numbers whose bits come in long runs of ones and zeros, so that halves, carries and
/// cancellations are common.
fn number() -> impl Strategy<Value = Exact> {
    let runs = prop::collection::vec((any::<bool>(), 1usize..80), 1..6);
    let zero = prop_oneof![9 => Just(false), 1 => Just(true)];
    (runs, -150i64..150, any::<bool>(), zero).prop_map(|(runs, exponent, negative, zero)| {
        let mut integer = UBig::ONE;
        for (ones, length) in runs {
            integer <<= length;
            if ones {
                integer += (UBig::ONE << length) - UBig::ONE;
            }
        }
        let integer = if zero { UBig::ZERO } else { integer };
        Exact {
            integer,
            exponent,
            negative,
        }
        .rounded()
    })
}

fn same(
    exact: Exact,
    operation: fn(Operand, Operand, &mut [u64]) -> Option<Scale>,
    [a, b]: [&Exact; 2],
) {
    let (p, q, mut out) = (a.limbs(), b.limbs(), [0; 3]);
    let operand = |limbs, exact: &Exact| Operand {
        limbs,
        exponent: exact.exponent,
        negative: exact.negative,
    };
    let scale = operation(operand(p.as_slice(), a), operand(q.as_slice(), b), &mut out);
    let exact = exact.rounded();
    assert_eq!(
        (out, scale),
        (exact.limbs(), Some((exact.exponent, exact.negative)))
    );
}

/// The quotient by a number of a single limb.
fn same_quotient(a: &Exact, divisor: &Exact) {
    // Many more bits than are kept, and one that tells whether there are any more.
    let scaled = &a.integer << 512usize;
    let quotient = &scaled / &divisor.integer;
    let inexact = &quotient * &divisor.integer != scaled;
    let exact = Exact {
        integer: (quotient << 1) + UBig::from(u8::from(inexact)),
        exponent: a.exponent - divisor.exponent - 513,
        negative: a.negative != divisor.negative,
    };
    let by_limb =
        |a: Operand, b: Operand, out: &mut [u64]| divide(a, b, b.single_limb().expect("one"), out);
    same(exact, by_limb, [a, divisor]);
}

/// Numbers whose bits are nearly all zeros or nearly all ones: a power of two, or the number below
/// it, with some bits flipped at either end.
fn extreme_numbers() -> Vec<Exact> {
    let top = UBig::ONE << (BITS - 1);
    let flips = [0, 1, BITS - 3, BITS - 2];
    let mut numbers = Vec::new();
    for chosen in 0..1u32 << flips.len() {
        let chosen = flips
            .iter()
            .enumerate()
            .filter(|(i, _)| chosen >> i & 1 == 1);
        let flipped = chosen.fold(UBig::ZERO, |sum, (_, bit)| sum + (UBig::ONE << *bit));
        let ones = (&top << 1) - UBig::ONE;
        for integer in [&top + &flipped, ones - flipped] {
            numbers.push(Exact {
                integer: integer << SPARE as usize,
                exponent: 0,
                negative: false,
            });
        }
    }
    numbers
}

/// Results that are halfway between two numbers, or off it by the last of all bits: the smaller
/// operand has its bits about the lowest ones of the larger one, and far below them.
#[test]
fn halfway_cases_are_decided_by_the_last_bit() {
    let numbers = extreme_numbers();
    for a in &numbers {
        for b in &numbers {
            same(a.product(b), multiply, [a, b]);
            for shift in 0..=260 {
                for negative in [false, true] {
                    let b = Exact {
                        exponent: -shift,
                        negative,
                        ..b.clone()
                    };
                    same(a.sum(&b), add, [a, &b]);
                }
            }
        }
    }
}

/// Quotients next to a halfway point, by a part of 2^-64 above it or below it: a · 2^k = q d ± 1
/// with a q of one bit more than is kept. It is odd, as the left side is even. The dividend's first
/// limb is at least the divisor, or below it.
#[test]
fn halfway_quotients_are_decided_by_the_remainder() {
    let (bits, quarter) = (SPARE as usize, UBig::ONE << (BITS - 66));
    for (k, quarters) in [(64, 4u8), (65, 3)] {
        for seed in 0..200u64 {
            // Odd, with the two topmost bits set, and otherwise arbitrary.
            let d = UBig::from(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 3 << 62 | 1);
            // The inverse of 2^k modulo d, by halving.
            let mut inverse = UBig::ONE;
            for _ in 0..k {
                if &inverse % UBig::from(2u8) != UBig::ZERO {
                    inverse += &d;
                }
                inverse >>= 1;
            }
            for (residue, above) in [(inverse.clone(), true), (&d - &inverse, false)] {
                // The same modulo d, with as many bits as are kept.
                let a = residue + &d * &quarter * UBig::from(quarters);
                let nearest = (&a << k) + if above { UBig::ZERO } else { UBig::ONE };
                assert_eq!((a.bit_len(), (nearest / &d).bit_len()), (BITS, BITS + 1));
                let of = |integer| Exact {
                    integer,
                    exponent: 0,
                    negative: false,
                };
                same_quotient(&of(a << bits), &of(&d << 128));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn sums_and_products_are_the_exact_ones_rounded_once(a in number(), b in number()) {
        same(a.sum(&b), add, [&a, &b]);
        same(a.product(&b), multiply, [&a, &b]);
        let nearly = Exact { negative: !a.negative, ..a.sum(&b).rounded() };
        let nearly = if nearly.integer == UBig::ZERO { a.clone() } else { nearly };
        same(a.sum(&nearly), add, [&a, &nearly]);
    }

    #[test]
    fn quotients_by_doubles_are_the_exact_ones_rounded_once(
        a in number(),
        b in prop_oneof![any::<f64>(), (1i32..1000).prop_map(f64::from)],
    ) {
        prop_assume!(b.is_finite() && b != 0.0);
        let mut limbs = [0; 3];
        let (exponent, negative) = of_double(b, &mut limbs).expect("finite");
        let top = UBig::from(limbs[2]) << 128;
        let divisor = Exact { integer: top, exponent, negative };
        same_quotient(&a, &divisor);
    }

    #[test]
    fn doubles_are_exact(value in any::<f64>()) {
        prop_assume!(value.is_finite());
        let mut limbs = [0; 3];
        let (exponent, negative) = of_double(value, &mut limbs).expect("finite");
        prop_assert_eq!(&limbs[..2], [0, 0]);
        // A power of two is exact, and in two factors it does not overflow.
        let power = exponent as i32 + 128 + 11;
        let scaled = (limbs[2] >> 11) as f64 * 2f64.powi(power / 2) * 2f64.powi(power - power / 2);
        prop_assert_eq!(if negative { -scaled } else { scaled }, value);
    }

    #[test]
    fn order_is_the_sign_of_the_difference(a in number(), b in number()) {
        let difference = a.sum(&Exact { negative: !b.negative, ..b.clone() });
        let expected = match (difference.integer == UBig::ZERO, difference.negative) {
            (true, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        };
        let (p, q) = (a.limbs(), b.limbs());
        let of = |limbs, exact: &Exact| Operand {
            limbs,
            exponent: exact.exponent,
            negative: exact.negative,
        };
        prop_assert_eq!(compare(of(p.as_slice(), &a), of(q.as_slice(), &b)), expected);
    }
}
