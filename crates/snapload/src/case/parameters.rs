//! The values that make a case: a plain struct and its defaults.

use crate::arithmetic::real::Real;
use crate::case::value::Value;
use crate::model::rules::{Limit, LimitBounds, Rules};
use crate::model::system::anchor_height;

/// A run settles where, below this y, a cable sticks or two are taut (chapter 6.3.1).
pub const SETTLING_HEIGHT: f64 = 0.05;
/// The rotation limit π/2.
pub const ROTATION_LIMIT: f64 = std::f64::consts::FRAC_PI_2;

/// The kinds of body: one with size and rotation, or a point mass without.
pub(crate) const BODIES: [&str; 2] = ["rigid", "point"];

/// The values of all keys of a case, in nondimensional units (length L, mass m, force F, time T of
/// the model), with numbers of type `T`.
///
/// [`Parameters::from_entries`] fills in the values that are left out, and checks all. A struct
/// that is filled in by hand is checked by [`Parameters::check`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<T = f64> {
    /// Length of the cables.
    pub r: T,
    /// Coefficient of restitution.
    pub e: T,
    /// Half-width of the body.
    pub a: T,
    /// Half-height of the body; 0 for a circle.
    pub b: T,
    /// Moment of inertia I of a rigid body; without one the body is a point mass, a = b = 0.
    pub inertia: Option<T>,
    /// Force amplitude.
    pub f_o: T,
    /// Axis ratio ν of the forcing ellipse.
    pub nu: T,
    /// Frequency Ω of the forcing.
    pub omega: T,
    /// Start: horizontal position.
    pub x: T,
    /// Start: vertical position.
    pub y: T,
    /// Start: rotation θ.
    pub theta: T,
    /// Start: horizontal velocity.
    pub vx: T,
    /// Start: vertical velocity.
    pub vy: T,
    /// Start: angular velocity.
    pub vtheta: T,
    /// End of the run.
    pub t_end: T,
    /// Normal velocity below which a cable under tension sticks.
    pub v_stick: T,
    /// Whether a run stops where it settles.
    pub stop_when_settled: bool,
    /// Whether a run stops where it begins to slide.
    pub stop_when_sliding: bool,
    /// Most impacts of a run.
    pub max_impacts: u64,
}

impl<T: Copy> Parameters<T> {
    /// The same case with its numbers in another arithmetic; `number` converts each number and
    /// receives its key.
    pub fn map<U>(&self, mut number: impl FnMut(&'static str, T) -> U) -> Parameters<U> {
        Parameters {
            r: number("r", self.r),
            e: number("e", self.e),
            a: number("a", self.a),
            b: number("b", self.b),
            inertia: self.inertia.map(|inertia| number("inertia", inertia)),
            f_o: number("f_o", self.f_o),
            nu: number("nu", self.nu),
            omega: number("omega", self.omega),
            x: number("x", self.x),
            y: number("y", self.y),
            theta: number("theta", self.theta),
            vx: number("vx", self.vx),
            vy: number("vy", self.vy),
            vtheta: number("vtheta", self.vtheta),
            t_end: number("t_end", self.t_end),
            v_stick: number("v_stick", self.v_stick),
            stop_when_settled: self.stop_when_settled,
            stop_when_sliding: self.stop_when_sliding,
            max_impacts: self.max_impacts,
        }
    }

    /// Whether the body is a point mass.
    pub fn is_point(&self) -> bool {
        self.inertia.is_none()
    }
}

impl<T: Real> Parameters<T> {
    /// The rules that end its runs.
    pub fn rules(&self) -> Rules<T> {
        let settling_height = T::from_decimal(SETTLING_HEIGHT);
        Rules {
            limits: LimitBounds::none()
                .with(Limit::Rotation, (!self.is_point()).then(T::half_pi))
                .with(Limit::UpperBound, anchor_height(self.r, self.a) + self.b),
            settled_below: self.stop_when_settled.then_some(settling_height),
            sliding_above: self.stop_when_sliding.then_some(settling_height),
            t_end: self.t_end,
            max_impacts: self.max_impacts,
            v_stick: self.v_stick,
        }
    }
}

impl Default for Parameters {
    fn default() -> Self {
        Self::STANDARD
    }
}

/// How the value of a key is read from a case.
#[derive(Clone, Copy, Debug)]
pub enum Get {
    /// A number; none where the case has none, as for the inertia of a point mass or a limit that
    /// is off.
    Number(fn(&Parameters) -> Option<f64>),
    /// A whole number.
    Count(fn(&Parameters) -> u64),
    /// Yes or no.
    Flag(fn(&Parameters) -> bool),
    /// One of a few words.
    Word(fn(&Parameters) -> &'static str),
}

impl Get {
    /// The value; none for the inertia of a point mass.
    pub fn value(self, p: &Parameters) -> Option<Value> {
        Some(match self {
            Self::Number(of) => Value::Number(of(p)?),
            Self::Count(of) => Value::Integer(i64::try_from(of(p)).unwrap_or(i64::MAX)),
            Self::Flag(of) => Value::Bool(of(p)),
            Self::Word(of) => Value::Text(of(p).to_owned()),
        })
    }
}

/// How the value of a key is stored in its own field; none if it has no field.
#[derive(Clone, Copy)]
pub(crate) enum Store {
    Number(fn(&mut Parameters, f64)),
    Count(fn(&mut Parameters, u64)),
    Flag(fn(&mut Parameters, bool)),
    None,
}

/// The field in which a key is kept.
macro_rules! field {
    (Number $field:ident) => {
        (
            stringify!($field),
            Get::Number(|p| Some(p.$field)),
            Store::Number(|p, value| p.$field = value),
        )
    };
    ($kind:ident $field:ident) => {
        (
            stringify!($field),
            Get::$kind(|p| p.$field),
            Store::$kind(|p, value| p.$field = value),
        )
    };
}

/// The accessors of each key, in the order of the schema.
pub(crate) static FIELDS: &[(&str, Get, Store)] = &[
    field!(Number r),
    field!(Number e),
    field!(Number a),
    field!(Number b),
    (
        "inertia",
        Get::Number(|p| p.inertia),
        Store::Number(|p, value| p.inertia = p.inertia.and(Some(value))),
    ),
    field!(Number f_o),
    field!(Number nu),
    field!(Number omega),
    field!(Number x),
    field!(Number y),
    field!(Number theta),
    field!(Number vx),
    field!(Number vy),
    field!(Number vtheta),
    field!(Number t_end),
    field!(Number v_stick),
    field!(Flag stop_when_settled),
    field!(Flag stop_when_sliding),
    field!(Count max_impacts),
    (
        "body",
        Get::Word(|p| BODIES[usize::from(p.is_point())]),
        Store::None,
    ),
];

impl Parameters {
    /// Whether the inertia is the natural one of the size, and so follows it.
    pub fn inertia_follows(&self) -> bool {
        self.inertia.is_some() && self.inertia == natural_inertia(self.a, self.b)
    }

    /// The standard case of the chapter (1910001000-359), which also holds the defaults.
    pub const STANDARD: Self = Self {
        r: 1.5,
        e: 0.9,
        a: 0.1,
        b: 0.0,
        inertia: Some(0.1 * 0.1),
        f_o: 0.3,
        nu: 0.5,
        omega: 0.9,
        x: 0.0,
        y: 0.1,
        theta: 0.0,
        vx: 0.0,
        vy: 0.0,
        vtheta: 0.0,
        t_end: 100.0,
        v_stick: 1e-6,
        stop_when_settled: true,
        stop_when_sliding: false,
        max_impacts: 1_000_000,
    };

    /// Whether a small change of a key that holds a number changes the motion smoothly. A point
    /// mass has no size and no rotation, and a circle no half-height.
    pub fn moves_by(&self, name: &str) -> bool {
        if self.is_point() {
            !["a", "b", "inertia", "theta", "vtheta"].contains(&name)
        } else {
            name != "b" || self.b > 0.0
        }
    }

    /// Stores the checked value of a key.
    pub(crate) fn store(&mut self, name: &str, value: &Value) {
        let field = FIELDS.iter().find(|(key, ..)| *key == name);
        match (field.map_or(Store::None, |(_, _, put)| *put), value) {
            (Store::Number(put), value) => _ = value.number().map(|number| put(self, number)),
            (Store::Count(put), value) => _ = value.count().map(|count| put(self, count)),
            (Store::Flag(put), Value::Bool(flag)) => put(self, *flag),
            _ => {}
        }
    }

    /// The value of a key; none for an unknown key, and for the inertia of a point mass.
    pub fn get(&self, name: &str) -> Option<Value> {
        let (_, get, _) = FIELDS.iter().find(|(key, ..)| *key == name)?;
        get.value(self)
    }
}

/// The moment of inertia that follows from the size: a thin ring if b = 0, else a solid rectangle.
/// None if it would be zero: without size, or with one so small that its square underflows.
pub fn natural_inertia<T: Real>(a: T, b: T) -> Option<T> {
    let inertia = if b == T::ZERO {
        a * a
    } else {
        (a * a + b * b) / 3.0
    };
    (inertia > T::ZERO).then_some(inertia)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::keys::KEYS;

    #[test]
    fn fields_stand_in_the_order_of_the_schema() {
        let kept = FIELDS.iter().map(|(name, ..)| *name);
        assert!(kept.eq(KEYS.iter().map(|key| key.name)));
    }
}
