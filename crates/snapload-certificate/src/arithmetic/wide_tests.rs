//! Wide balls, extreme exponents and limbs that carry, against exact rationals.
use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::{Decimal, fixed, significant};
use crate::arithmetic::elementary::Elementary;
use crate::arithmetic::radius::Radius;
use dashu_int::{IBig, UBig};
use proptest::prelude::*;
use std::cmp::Ordering;

/// `.0` · 2^`.1` / `.2`, exactly.
#[derive(Clone, Debug)]
struct Exact(IBig, i64, IBig);

impl Exact {
    fn integer(integer: i64) -> Self {
        Self(IBig::from(integer), 0, IBig::ONE)
    }

    fn of_radius(radius: Radius) -> Self {
        let (mantissa, exponent) = radius.parts();
        Self(IBig::from(mantissa), exponent, IBig::ONE)
    }

    fn middle(ball: &Ball) -> Self {
        let number = ball.mid();
        let bytes: Vec<u8> = number.limbs.iter().flat_map(|l| l.to_le_bytes()).collect();
        let magnitude = IBig::from(UBig::from_le_bytes(&bytes));
        let signed = if number.negative {
            -magnitude
        } else {
            magnitude
        };
        Self(signed, number.unit(), IBig::ONE)
    }

    fn plus(&self, other: &Self) -> Self {
        let low = self.1.min(other.1);
        let at = |x: &Self| &x.0 << (x.1 - low) as usize;
        Self(
            at(self) * &other.2 + at(other) * &self.2,
            low,
            &self.2 * &other.2,
        )
    }

    fn times(&self, other: &Self) -> Self {
        Self(&self.0 * &other.0, self.1 + other.1, &self.2 * &other.2)
    }

    fn inverse(&self) -> Self {
        let sign = if self.0 < IBig::ZERO {
            -IBig::ONE
        } else {
            IBig::ONE
        };
        Self(&self.2 * &sign, -self.1, &self.0 * sign)
    }

    fn negated(&self) -> Self {
        Self(-&self.0, self.1, self.2.clone())
    }

    fn size(&self) -> Self {
        if self.0 < IBig::ZERO {
            self.negated()
        } else {
            self.clone()
        }
    }

    fn sign(&self) -> Ordering {
        self.0.cmp(&IBig::ZERO)
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    fn is_at_most(&self, other: &Self) -> bool {
        self.minus(other).sign() != Ordering::Greater
    }
}

fn holds(ball: &Ball, value: &Exact) -> bool {
    let off = Exact::middle(ball).minus(value).size();
    off.is_at_most(&Exact::of_radius(ball.radius()))
}

/// A limb whose bits are likely to cause carries.
fn limb() -> impl Strategy<Value = u64> {
    prop_oneof![
        Just(0),
        Just(1),
        Just(u64::MAX),
        Just(1 << 63),
        Just(u64::MAX << 32),
        any::<u64>()
    ]
}

/// A ball, and a number within it: the middle, either end, or between.
fn member() -> impl Strategy<Value = (Ball, Exact)> {
    let limbs = prop::collection::vec(limb(), 1..6);
    let places = (any::<bool>(), -3000i64..3000, 1usize..7);
    let size = (any::<u64>(), -400i64..40, -64i64..=64);
    (limbs, places, size).prop_map(|(limbs, (negative, power, most), (m, below, share))| {
        let power = power - 64 * limbs.len() as i64;
        let ball = Ball::from_limbs(negative, &limbs, power, most);
        // Relative to the middle, from far below its last bit to far above itself.
        let radius = match m % 5 {
            0 => Radius::ZERO,
            _ => Radius::above(m, ball.mid().exponent + below - 64),
        };
        let share = Exact(IBig::from(share), -6, IBig::ONE);
        let value = Exact::middle(&ball).plus(&share.times(&Exact::of_radius(radius)));
        (ball.widened(radius), value)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn operations_on_wide_balls_hold_every_member(
        (x, p) in member(), (y, q) in member(), near in -3i64..4, divisor in 1u64..,
    ) {
        prop_assert!(holds(&x, &p) && holds(&y, &q));
        // Next to x, so that a difference cancels.
        let close = x.centre() + y.scaled(x.mid().exponent - y.mid().exponent - 200);
        let shift = x.mid().exponent - y.mid().exponent - 200;
        let beside = Exact::middle(&x).plus(&Exact(q.0.clone(), q.1 + shift, q.2.clone()));
        prop_assert!(holds(&(&x - &close), &p.minus(&beside)));
        prop_assert!(holds(&(&x + &y), &p.plus(&q)) && holds(&(&x - &y), &p.minus(&q)));
        prop_assert!(holds(&(&x * &y), &p.times(&q)) && holds(&x.squared(), &p.times(&p)));
        prop_assert!(holds(&-&x, &p.negated()) && holds(&x.abs(), &p.size()));
        let halved = Exact(p.0.clone(), p.1 + near, p.2.clone());
        prop_assert!(holds(&x.scaled(near), &halved));
        let part = p.times(&Exact(IBig::ONE, 0, IBig::from(divisor)));
        prop_assert!(holds(&x.over_small(divisor), &part));
        let both = x.hull(&y);
        prop_assert!(holds(&both, &p) && holds(&both, &q));
        prop_assert!(holds(&x.with_limbs(1), &p) && holds(&x.with_limbs(9), &p));
        if let Some(inverse) = y.reciprocal() {
            prop_assert!(holds(&inverse, &q.inverse()));
            let quotient = x.over(&y).expect("as the reciprocal");
            prop_assert!(holds(&quotient, &p.times(&q.inverse())));
        }
        if let Some(root) = x.sqrt() {
            let (middle, radius) = (Exact::middle(&root), Exact::of_radius(root.radius()));
            let (low, high) = (middle.minus(&radius), middle.plus(&radius));
            prop_assert!(low.sign() == Ordering::Less || low.times(&low).is_at_most(&p));
            prop_assert!(p.is_at_most(&high.times(&high)));
        }
    }

    #[test]
    fn what_is_claimed_of_a_ball_holds_of_every_member((x, p) in member(), (y, q) in member()) {
        prop_assert!(Exact::of_radius(x.lower()).is_at_most(&p.size()));
        prop_assert!(p.size().is_at_most(&Exact::of_radius(x.upper())));
        prop_assert!(!x.is_positive() || p.sign() == Ordering::Greater);
        prop_assert!(!x.is_negative() || p.sign() == Ordering::Less);
        prop_assert!(!x.is_zero() || p.sign() == Ordering::Equal);
        prop_assert!(!x.is_below(&y) || p.minus(&q).sign() == Ordering::Less);
        // Midpoints are ordered correctly, however close they are.
        let (a, b) = (x.centre(), y.centre());
        let order = Exact::middle(&a).minus(&Exact::middle(&b)).sign();
        prop_assert_eq!(a.is_below(&b), order == Ordering::Less);
    }

    #[test]
    fn bounds_round_to_their_side(
        m in any::<u64>(), n in 1u64.., e in -5000i64..5000, f in -70i64..70,
    ) {
        let (a, b) = (Radius::above(m, e), Radius::above(n, e + f));
        let (x, y) = (Exact::of_radius(a), Exact::of_radius(b));
        let given = Exact(IBig::from(m), e, IBig::ONE);
        prop_assert!(given.is_at_most(&x));
        prop_assert!(Exact::of_radius(Radius::below(m, e)).is_at_most(&given));
        prop_assert!(x.plus(&y).is_at_most(&Exact::of_radius(a.plus(b))));
        prop_assert!(x.times(&y).is_at_most(&Exact::of_radius(a.times(b))));
        prop_assert!(x.times(&y.inverse()).is_at_most(&Exact::of_radius(a.over(b))));
        let less = Exact::of_radius(a.minus(b));
        prop_assert!(a.minus(b).is_zero() || less.is_at_most(&x.minus(&y)));
        prop_assert_eq!(a.cmp(&b), x.minus(&y).sign());
    }

    /// sin x = Σ ± x^k/k!, in integer multiples of 2^-600, with a bound on the rounding of the
    /// divisions and on the remainder.
    #[test]
    fn sines_of_wide_balls_hold_those_of_members(
        m in -(1i64 << 44)..1 << 44, e in -44i64..-34, limbs in 2usize..7, below in -300i64..4, share in -8i64..=8,
    ) {
        const BITS: usize = 600;
        let radius = Radius::power_of_two(below);
        let x = Ball::from_limbs(m < 0, &[m.unsigned_abs()], e, limbs).widened(radius);
        let at = Exact(IBig::from(m), e, IBig::ONE)
            .plus(&Exact(IBig::from(share), below - 3, IBig::ONE));
        let unit = IBig::ONE << (-at.1) as usize;
        let mut sums = [IBig::ZERO, IBig::ZERO];
        let mut term = IBig::ONE << BITS;
        let mut k = 0;
        while term != IBig::ZERO && k < 20_000 {
            let signed = if k / 2 % 2 == 0 { term.clone() } else { -term.clone() };
            sums[k % 2] += signed;
            k += 1;
            term = term * &at.0 / (IBig::from(k as u64) * &unit);
        }
        // The rounding of each term is below one unit, and is magnified by the later factors to at
        // most e^1100 · k units.
        let slack = Exact(IBig::from(k as u64) << 60, -(BITS as i64), IBig::ONE);
        let (sine, cosine) = Elementary::new(limbs).sin_cos(&x);
        let [c, s] = sums.map(|sum| Exact(sum, -(BITS as i64), IBig::ONE));
        if at.size().is_at_most(&Exact::integer(40)) {
            for (ball, value) in [(sine, s), (cosine, c)] {
                let off = Exact::middle(&ball).minus(&value).size();
                prop_assert!(off.is_at_most(&Exact::of_radius(ball.radius()).plus(&slack)));
            }
        }
    }

    /// At large arguments, against the results of doubling a small part of the argument.
    #[test]
    fn sines_far_out_are_those_of_doubled_angles(m in -(1i64 << 52)..1 << 52, limbs in 2usize..6) {
        let x = Ball::from_limbs(m < 0, &[m.unsigned_abs()], 0, limbs);
        let (sine, cosine) = Elementary::new(limbs).sin_cos(&x);
        let high = limbs + 4;
        let (mut s, mut c) = Elementary::new(high).sin_cos(&x.with_limbs(high).scaled(-53));
        for _ in 0..53 {
            (s, c) = ((&s * &c).twice(), c.squared() - s.squared());
        }
        for off in [s - sine, c - cosine] {
            prop_assert!(!off.is_positive() && !off.is_negative());
        }
    }

    /// A printed number is within half a unit of its last place of every member of the ball.
    #[test]
    fn printed_digits_are_those_of_every_member(
        (x, p) in member(), power in prop_oneof![-60i64..60, -1200i64..1200],
    ) {
        let shift = power - x.mid().exponent;
        let x = x.scaled(shift);
        let p = Exact(p.0, p.1 + shift, p.2);
        for text in [fixed(&x, 25), significant(&x, 17)].into_iter().flatten() {
            let printed = Decimal::parse(&text).expect("a decimal");
            let (digits, e) = text.split_once('e').unwrap_or((&text, "0"));
            let places = digits.split_once('.').map_or(0, |(_, f)| f.len()) as i64;
            let places = places - e.parse::<i64>().expect("a power");
            let ten = IBig::from(10).pow(places.unsigned_abs() as usize);
            let unit = match places >= 0 {
                true => Exact(IBig::ONE, 0, ten),
                false => Exact(ten, 0, IBig::ONE),
            };
            let integer: IBig = digits.replace('.', "").parse().expect("digits");
            let value = unit.times(&Exact(integer, 0, IBig::ONE));
            let off = value.minus(&p).size();
            let half = Exact(unit.0.clone(), unit.1 - 1, unit.2.clone());
            prop_assert!(off.is_at_most(&half), "{text}");
            prop_assert!(holds(&printed.ball(4), &value) && holds(&printed.half_unit().ball(3), &half));
        }
    }
}
