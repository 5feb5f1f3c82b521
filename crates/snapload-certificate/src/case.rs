//! The case that a theorem is about: its values are decimals, each an exact rational number.

use crate::arithmetic::decimal::Decimal;
use snapload::{Limit, Parameters, Value};

/// The keys that hold a number, in the order in which a certificate has them.
pub const NUMBERS: [&str; 15] = [
    "r", "e", "a", "b", "f_o", "nu", "omega", "x", "y", "theta", "vx", "vy", "vtheta", "t_end",
    "v_stick",
];

/// The limits of the motion that a proof can deal with.
const PROVABLE: [Limit; 2] = [Limit::Rotation, Limit::UpperBound];

/// A case whose values are decimals.
#[derive(Clone, Debug)]
pub struct ExactCase {
    numbers: [Decimal; NUMBERS.len()],
    /// The inertia if it is given; otherwise it follows from the size.
    pub(crate) inertia: Option<Decimal>,
    /// Whether the body is a point mass.
    pub(crate) is_point: bool,
    pub(crate) stop_when_settled: bool,
    pub(crate) stop_when_sliding: bool,
    pub(crate) max_impacts: u64,
}

impl ExactCase {
    /// A case from its decimals, in the order of [`NUMBERS`].
    ///
    /// # Errors
    /// What a case or the model does not allow, in words.
    pub fn new(
        numbers: [Decimal; NUMBERS.len()],
        inertia: Option<Decimal>,
        is_point: bool,
        stops: [bool; 2],
        max_impacts: u64,
    ) -> Result<Self, String> {
        let case = Self {
            numbers,
            inertia,
            is_point,
            stop_when_settled: stops[0],
            stop_when_sliding: stops[1],
            max_impacts,
        };
        case.check()?;
        Ok(case)
    }

    /// The case of parameters that are doubles: for each the decimal that `typed` says was written
    /// for it, or else the shortest decimal that is read back as the same double.
    ///
    /// # Errors
    /// What the model does not allow or a proof can not deal with, in words.
    pub fn of(
        parameters: &Parameters,
        mut typed: impl FnMut(&str) -> Option<Decimal>,
    ) -> Result<Self, String> {
        let unknown = |(limit, _): &(Limit, f64)| !PROVABLE.contains(limit);
        if let Some((limit, _)) = parameters.rules().limits.iter().find(unknown) {
            let (words, key) = (limit.stop().label(), limit.stop().name());
            let why = format!("proofs do not cover the {words}; leave {key} out");
            return Err(why);
        }
        let mut decimal = |key: &str, value: f64| {
            typed(key)
                .or_else(|| Decimal::shortest(value))
                .ok_or_else(|| format!("{key} = {value} is not a decimal"))
        };
        let mut numbers = Vec::new();
        for key in NUMBERS {
            let value = parameters.get(key).and_then(|value| value.number());
            numbers.push(decimal(key, value.unwrap_or(0.0))?);
        }
        let natural = snapload::natural_inertia(parameters.a, parameters.b);
        // An inertia that was typed counts as given even if it rounds to the same double as the
        // inertia of the size.
        let inertia = match (parameters.inertia, typed("inertia")) {
            (Some(_), Some(written)) => Some(written),
            (Some(inertia), None) if Some(inertia) != natural => {
                let shortest = Decimal::shortest(inertia);
                Some(shortest.ok_or_else(|| format!("inertia = {inertia} is not a decimal"))?)
            }
            _ => None,
        };
        let numbers = numbers.try_into().map_err(|_| "a key is missing")?;
        Self::new(
            numbers,
            inertia,
            parameters.is_point(),
            [parameters.stop_when_settled, parameters.stop_when_sliding],
            parameters.max_impacts,
        )
    }

    /// The decimal of a key; zero for an unknown key.
    pub fn number(&self, key: &str) -> Decimal {
        let at = NUMBERS.iter().position(|name| *name == key);
        at.map_or_else(|| Decimal::integer(0), |k| self.numbers[k].clone())
    }

    /// The same case without the rules that end a run for another reason than a limit, so that the
    /// motion is that of the model alone.
    pub(crate) fn without_end(&self) -> Self {
        Self {
            stop_when_settled: false,
            stop_when_sliding: false,
            max_impacts: u64::MAX,
            ..self.clone()
        }
    }

    /// The start x, y, θ and its velocities.
    pub(crate) fn start(&self) -> &[Decimal] {
        &self.numbers[7..13]
    }

    /// The kind of body, as the key `body` names it.
    pub(crate) fn body(&self) -> &'static str {
        if self.is_point { "point" } else { "rigid" }
    }

    /// That the doubles next to the decimals are a legal case, as a run has them.
    fn check_as_doubles(&self) -> Result<(), String> {
        let nearest = |decimal: &Decimal| Value::Number(decimal.text().parse().unwrap_or(f64::NAN));
        let numbers = NUMBERS.into_iter().zip(self.numbers.iter().map(nearest));
        let count = i64::try_from(self.max_impacts).unwrap_or(i64::MAX);
        let others = [
            ("max_impacts", Value::Integer(count)),
            ("body", Value::Text(self.body().to_owned())),
        ];
        let inertia = self.inertia.as_ref().map(nearest);
        let inertia = inertia.map(|inertia| ("inertia", inertia));
        let entries = numbers.chain(others).chain(inertia);
        let legal = Parameters::from_entries(entries);
        legal.map(drop).map_err(|error| error.to_string())
    }

    /// That the case is legal, and its decimals within what the model allows, also by less than a
    /// rounding.
    fn check(&self) -> Result<(), String> {
        self.check_as_doubles()?;
        let number = |key| self.number(key);
        let one = Decimal::integer(1);
        let not_negative = |d: &Decimal| d.is_positive() || d.is_zero();
        let allowed = [
            (
                not_negative(&number("e")) && not_negative(&one.minus(&number("e"))),
                "0 <= e <= 1",
            ),
            (
                not_negative(&number("a")) && not_negative(&number("b")),
                "a, b >= 0",
            ),
            (
                number("r")
                    .minus(&one.minus(&number("a")).abs())
                    .is_positive(),
                "r > |1 - a|",
            ),
        ];
        for (holds, what) in allowed {
            if !holds {
                return Err(format!("the case violates {what}"));
            }
        }
        let still = ["a", "b", "theta", "vtheta"];
        if self.is_point && !still.iter().all(|key| number(key).is_zero()) {
            return Err("a point mass has no size and no rotation".to_owned());
        }
        Ok(())
    }

    /// Whether a cable's gap is exactly zero at the start, which is decided for θ = 0 alone.
    ///
    /// There D = (d, y − h) with d = x ∓ (1 − a), h > 0 and h² = r² − (1 − a)², so that the gap is
    /// q − 2 y h with q = d² + y² − (1 − a)². It is zero where q has the sign of y and q² is
    /// 4 y² h², all of which are decimals.
    pub(crate) fn starts_closed(&self, cable: usize) -> bool {
        let [x, y, theta, r, a] = ["x", "y", "theta", "r", "a"].map(|key| self.number(key));
        let square = |d: &Decimal| d.times(d);
        let width = Decimal::integer(1).minus(&a);
        let d = if cable == 0 {
            x.minus(&width)
        } else {
            x.plus(&width)
        };
        let q = square(&d).plus(&square(&y)).minus(&square(&width));
        let h_squared = square(&r).minus(&square(&width));
        let rise = Decimal::integer(4).times(&square(&y)).times(&h_squared);
        let one_sign = q.is_zero() || q.times(&y).is_positive();
        theta.is_zero() && one_sign && square(&q) == rise
    }

    /// The moment of inertia times three, exactly; none for a point mass. A circle is a thin ring,
    /// I = a², a rectangle is solid, I = (a² + b²)/3.
    pub(crate) fn inertia_times_three(&self) -> Option<Decimal> {
        let (a, b) = (self.number("a"), self.number("b"));
        let three = Decimal::integer(3);
        match &self.inertia {
            _ if self.is_point => None,
            Some(inertia) => Some(inertia.times(&three)),
            None if b.is_zero() => Some(a.times(&a).times(&three)),
            None => Some(a.times(&a).plus(&b.times(&b))),
        }
    }
}
