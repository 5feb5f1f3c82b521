//! Balls against exact rationals.
use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::elementary::Elementary;
use dashu_int::IBig;
use proptest::prelude::*;

/// A rational number, exactly.
#[derive(Clone, Debug)]
struct Rational(IBig, IBig);

impl Rational {
    fn of(mid: &crate::arithmetic::number::Number) -> Self {
        let bytes: Vec<u8> = mid.limbs.iter().flat_map(|l| l.to_le_bytes()).collect();
        let magnitude = IBig::from(dashu_int::UBig::from_le_bytes(&bytes));
        let magnitude = if mid.negative { -magnitude } else { magnitude };
        Self(magnitude, IBig::ONE).times_power(mid.unit())
    }

    fn times_power(self, power: i64) -> Self {
        let two = IBig::ONE << power.unsigned_abs() as usize;
        if power >= 0 {
            Self(self.0 * two, self.1)
        } else {
            Self(self.0, self.1 * two)
        }
    }

    fn minus(&self, other: &Self) -> Self {
        Self(&self.0 * &other.1 - &other.0 * &self.1, &self.1 * &other.1)
    }
}

fn abs(x: IBig) -> IBig {
    if x < IBig::ZERO { -x } else { x }
}

/// |value − midpoint| ≤ radius, in integers.
fn holds(ball: &Ball, value: &Rational) -> bool {
    let off = Rational::of(ball.mid()).minus(value);
    let (mantissa, exponent) = ball.radius().parts();
    let radius = Rational(IBig::from(mantissa), IBig::ONE).times_power(exponent);
    abs(off.0) * abs(radius.1) <= abs(radius.0) * abs(off.1)
}

/// How wide a ball is in units of its last bit.
fn units(ball: &Ball) -> f64 {
    ball.radius().scaled(-ball.mid().unit()).to_f64()
}

#[derive(Clone, Debug)]
enum Expression {
    Leaf(i64, i32),
    Add(Box<Self>, Box<Self>),
    Sub(Box<Self>, Box<Self>),
    Mul(Box<Self>, Box<Self>),
    Div(Box<Self>, Box<Self>),
    Cut(Box<Self>),
}

fn expressions() -> impl Strategy<Value = Expression> {
    let leaf = (any::<i64>(), -200i32..200).prop_map(|(m, e)| Expression::Leaf(m, e));
    let small = (-9i64..10, -3i32..3).prop_map(|(m, e)| Expression::Leaf(m, e));
    prop_oneof![leaf, small].prop_recursive(6, 40, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            pair.clone()
                .prop_map(|(a, b)| Expression::Add(a.into(), b.into())),
            pair.clone()
                .prop_map(|(a, b)| Expression::Sub(a.into(), b.into())),
            pair.clone()
                .prop_map(|(a, b)| Expression::Mul(a.into(), b.into())),
            pair.prop_map(|(a, b)| Expression::Div(a.into(), b.into())),
            inner.prop_map(|a| Expression::Cut(a.into())),
        ]
    })
}

/// The ball and the exact value; none where something is divided by zero, or may be.
fn evaluate(expression: &Expression, limbs: usize) -> Option<(Ball, Rational)> {
    let pair = |a, b| Some((evaluate(a, limbs)?, evaluate(b, limbs)?));
    Some(match expression {
        Expression::Leaf(m, e) => {
            let ball = Ball::from_limbs(*m < 0, &[m.unsigned_abs()], i64::from(*e), limbs);
            let exact = Rational(IBig::from(*m), IBig::ONE).times_power(i64::from(*e));
            (ball, exact)
        }
        Expression::Add(a, b) => {
            let ((x, p), (y, q)) = pair(a, b)?;
            (x + y, Rational(&p.0 * &q.1 + &q.0 * &p.1, p.1 * q.1))
        }
        Expression::Sub(a, b) => {
            let ((x, p), (y, q)) = pair(a, b)?;
            (x - y, p.minus(&q))
        }
        Expression::Mul(a, b) => {
            let ((x, p), (y, q)) = pair(a, b)?;
            (x * y, Rational(p.0 * q.0, p.1 * q.1))
        }
        Expression::Div(a, b) => {
            let ((x, p), (y, q)) = pair(a, b)?;
            (x.over(&y)?, Rational(p.0 * q.1, p.1 * q.0))
        }
        Expression::Cut(a) => {
            let (x, p) = evaluate(a, limbs)?;
            (x.with_limbs(1), p)
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn balls_hold_the_exact_value(expression in expressions(), limbs in 1usize..8) {
        if let Some((ball, exact)) = evaluate(&expression, limbs) {
            prop_assert!(holds(&ball, &exact), "{ball:?}");
        }
    }

    /// Zero is the only reciprocal that does not exist, and one operation costs few units.
    #[test]
    fn reciprocals_are_sharp(m in 1i64.., e in -300i64..300, limbs in 1usize..20) {
        let x = Ball::from_limbs(false, &[m as u64], e, limbs);
        let y = x.reciprocal().expect("not zero");
        let exact = Rational(IBig::ONE, IBig::from(m)).times_power(-e);
        prop_assert!(holds(&y, &exact) && units(&y) < 64.0, "{y:?}");
    }

    /// (s − ρ)² ≤ x ≤ (s + ρ)².
    #[test]
    fn roots_hold_the_root(m in 1i64.., e in -300i64..300, limbs in 1usize..20) {
        let x = Ball::from_limbs(false, &[m as u64], e, limbs);
        let root = x.sqrt().expect("positive");
        let exact = Rational(IBig::from(m), IBig::ONE).times_power(e);
        let (mantissa, exponent) = root.radius().parts();
        let radius = Rational(IBig::from(mantissa), IBig::ONE).times_power(exponent);
        let mid = Rational::of(root.mid());
        let square = |a: &Rational| Rational(&a.0 * &a.0, &a.1 * &a.1);
        let low = mid.minus(&radius);
        let high = mid.minus(&Rational(-radius.0, radius.1));
        prop_assert!(square(&low).minus(&exact).0 <= IBig::ZERO);
        prop_assert!(square(&high).minus(&exact).0 >= IBig::ZERO);
        prop_assert!(units(&root) < 64.0, "{root:?}");
    }

    /// Addition theorem, sin² + cos² = 1, and the double next to it.
    #[test]
    fn sines_obey_their_laws(a in -30.0f64..30.0, b in -2.0f64..2.0, limbs in 1usize..12) {
        let functions = Elementary::new(limbs);
        let (x, y) = (Ball::double(a).with_limbs(limbs), Ball::double(b).with_limbs(limbs));
        let ((s, c), (u, v)) = (functions.sin_cos(&x), functions.sin_cos(&y));
        let (sum, _) = functions.sin_cos(&(&x + &y));
        let rest = &s * &v + &c * &u - sum;
        prop_assert!(!rest.is_positive() && !rest.is_negative());
        prop_assert!(rest.radius().to_f64() < 2f64.powi(20 - 64 * limbs as i32));
        let one = s.squared() + c.squared() - Ball::integer(1);
        prop_assert!(!one.is_positive() && !one.is_negative());
        prop_assert!((s.to_f64() - a.sin()).abs() < 1e-15 && (c.to_f64() - a.cos()).abs() < 1e-15);
    }
}

/// Decimals in other spellings are read as the same number.
#[test]
fn decimals_are_read_as_people_write_them() {
    for (typed, plain) in [
        ("+0.3000000000000000000001", "0.3000000000000000000001"),
        ("3.000000000000000000001E-1", "3.000000000000000000001e-1"),
        (".5", "0.5"),
        ("-.5e+2", "-0.5e2"),
        ("1_000", "1000"),
        ("7.", "7"),
        ("7.e1", "7e1"),
    ] {
        let decimal = Decimal::typed(typed).map(|decimal| decimal.text().to_owned());
        assert_eq!(decimal.as_deref(), Some(plain), "{typed}");
    }
    for text in ["nan", "inf", "1e999", "", "+", "0x10"] {
        assert!(Decimal::typed(text).is_none(), "{text}");
    }
}

#[test]
fn the_longest_decimal_has_400_characters() {
    let ones = |count: usize| Decimal::parse(&"1".repeat(count));
    assert!(ones(400).is_some() && ones(401).is_none());
}
