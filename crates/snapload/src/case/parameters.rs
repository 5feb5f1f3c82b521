//! The values that make a case: its keys, a struct of their values, and their defaults.

use crate::arithmetic::real::Real;
use crate::case::fields::{case_keys, field};
use crate::case::key::{DefaultValue, Key, Kind};
use crate::case::value::Value;
use crate::model::rules::{Limit, LimitBounds, Rules};
use crate::model::system::anchor_height;

/// A run settles where, below this y, a cable sticks or two are taut (chapter 6.3.1).
pub const SETTLING_HEIGHT: f64 = 0.05;
/// The rotation limit π/2.
pub const ROTATION_LIMIT: f64 = std::f64::consts::FRAC_PI_2;

/// The kinds of body: one with size and rotation, or a point mass without.
pub(crate) const BODIES: [&str; 2] = ["rigid", "point"];

/// Largest magnitude of a number in a case; all relevant quantities are of order 1 in its units.
pub(crate) const LARGEST: f64 = 1e3;
const ANY: Kind = Kind::number(-LARGEST, LARGEST);
const SIZE: Kind = Kind::number(0.0, LARGEST);
const POSITIVE: Kind = Kind::positive(LARGEST);
/// The upper bound is a^2 at the largest a, so that each derived value may also be given.
const INERTIA: Kind = Kind::number(1e-12, 1e6);

case_keys! {
    /// The values of all keys of a case, in nondimensional units (length L, mass m, force F, time T
    /// of the model), with numbers of type `T`.
    ///
    /// [`Parameters::from_entries`] fills in the values that are left out, and checks all. A struct
    /// that is filled in by hand is checked by [`Parameters::check`].
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Parameters;

    "cables" r: T = 1.5, "L", POSITIVE, "length of the cables"
        .also("and r > |1 - a|").usual(0.95, 3.0);
    "cables" e: T = 0.9, "1", Kind::number(0.0, 1.0),
        "coefficient of restitution of a snap: v_n after = -e v_n before".usual(0.0, 1.0);
    "body" a: T = 0.1, "L", SIZE, "half-width of the body"
        .default_in_words("0.1; 0 for a point mass").usual(0.02, 0.5);
    "body" b: T = 0.0, "L", SIZE, "half-height of the body; 0 is the circle"
        .default_in_words("0").usual(0.0, 0.5);
    /// None for a point mass, which has no size either: a = b = 0.
    "body" inertia: Option<T> = Some(0.1 * 0.1), "m L^2", INERTIA, "moment of inertia"
        .default_in_words("a^2 if b = 0 (ring), (a^2 + b^2)/3 if b > 0 (rectangle)")
        .symbol("I").also("at least 1e-6 (a^2 + b^2); never given for a point mass")
        .usual(1e-3, 0.2);
    "forcing" f_o: T = 0.3, "F", ANY, "force amplitude: f_x = f_o cos(omega t)"
        .usual(0.0, 1.0);
    "forcing" nu: T = 0.5, "1", ANY,
        "axis ratio of the forcing ellipse: f_y = nu f_o sin(omega t)".symbol("ν").usual(-1.0, 1.0);
    "forcing" omega: T = 0.9, "rad/T", ANY, "frequency of the forcing"
        .symbol("Ω").usual(0.1, 3.0);
    "start" x: T = 0.0, "L", ANY, "start: horizontal position of the centre".usual(-0.5, 0.5);
    "start" y: T = 0.1, "L", ANY,
        "start: vertical position, towards the anchors; 0 with both cables taut".usual(0.0, 1.0);
    "start" theta: T = 0.0, "rad", ANY, "start: rotation"
        .symbol("θ").also("and |theta| <= pi/2; 0 for a point mass").usual(-1.5, 1.5);
    "start" vx: T = 0.0, "L/T", ANY, "start: horizontal velocity".symbol("ẋ").usual(-1.0, 1.0);
    "start" vy: T = 0.0, "L/T", ANY, "start: vertical velocity".symbol("ẏ").usual(-1.0, 1.0);
    "start" vtheta: T = 0.0, "rad/T", ANY, "start: angular velocity"
        .symbol("θ̇").also("0 for a point mass").usual(-3.0, 3.0);
    "stops" t_end: T = 100.0, "T", Kind::positive(1e6), "the run ends here at the latest"
        .usual(5.0, 200.0);
    "cables" v_stick: T = 1e-6, "L/T", Kind::number(1e-9, 1e-2),
        "a slower snap makes the cable stay taut if its tension would be positive";
    "stops" stop_when_settled: bool = true, "", Kind::Flag,
        "stop where a cable sticks, or both are taut, below y = 0.05";
    "stops" stop_when_sliding: bool = false, "", Kind::Flag,
        "stop where a cable sticks at y = 0.05 or above";
    "stops" max_impacts: u64 = 1_000_000, "", Kind::Count(1, 10_000_000),
        "the run ends at more impacts than this";

    without a field: BODY, Get::Word(|p| BODIES[usize::from(p.is_point())]);
}

const BODY: Key = Key::new(
    "body",
    "",
    Kind::Choice(&BODIES),
    DefaultValue::Word(BODIES[0]),
    "kind of body: a rigid one that turns, or a point mass (a = b = 0) that does not",
)
.in_group("body");

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
    /// The value; none where the case has none.
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

impl<T: Copy> Parameters<T> {
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

impl Parameters {
    /// Whether the inertia is the natural one of the size, and so follows it.
    pub fn inertia_follows(&self) -> bool {
        self.inertia.is_some() && self.inertia == natural_inertia(self.a, self.b)
    }

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
        let store = Self::field(name).map_or(Store::None, |(_, store)| *store);
        match (store, value) {
            (Store::Number(put), value) => _ = value.number().map(|number| put(self, number)),
            (Store::Count(put), value) => _ = value.count().map(|count| put(self, count)),
            (Store::Flag(put), Value::Bool(flag)) => put(self, *flag),
            _ => {}
        }
    }

    /// The value of a key; none for an unknown key, and where the case has none.
    pub fn get(&self, name: &str) -> Option<Value> {
        let (get, _) = Self::field(name)?;
        get.value(self)
    }

    fn field(name: &str) -> Option<&'static (Get, Store)> {
        FIELDS.get(KEYS.iter().position(|key| key.name == name)?)
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
