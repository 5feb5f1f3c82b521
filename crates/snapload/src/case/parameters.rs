//! The values that make a case: a plain struct, its defaults, and the check at the border.
use crate::arithmetic::real::Real;
use crate::case::error::CaseError;
use crate::case::schema::{KEYS, LIGHTEST, check_entry};
use crate::case::value::Value;

/// What hangs on the cables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
pub enum BodyKind {
    /// A body with size and rotation.
    #[default]
    Rigid,
    /// A point mass: a = b = 0, no rotation.
    Point,
}

impl BodyKind {
    /// The names, in the order of the variants.
    pub const NAMES: &'static [&'static str] = &["rigid", "point"];

    /// The name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Point => "point",
        }
    }

    /// The body of a name.
    pub fn named(name: &str) -> Option<Self> {
        [Self::Rigid, Self::Point]
            .into_iter()
            .find(|kind| kind.name() == name)
    }
}

/// The values of all keys of a case, in nondimensional units (length L, mass m, force F, time T of
/// the model), with numbers of type `T`.
///
/// [`Parameters::from_entries`] fills in what is left out and checks the rest. One that is filled
/// in by hand is checked by [`Parameters::check`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<T = f64> {
    /// Length of the cables.
    pub r: T,
    /// Coefficient of restitution.
    pub e: T,
    /// Half-width of the body.
    pub a: T,
    /// Half-height of the body; 0 is the circle.
    pub b: T,
    /// Moment of inertia I; none for a point mass.
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
    /// Rigid body or point mass.
    pub body: BodyKind,
}

impl<T: Copy> Parameters<T> {
    /// The same case with its numbers in another arithmetic; `number` is told each one's key.
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
            body: self.body,
        }
    }
}

impl Default for Parameters {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl Parameters {
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
        body: BodyKind::Rigid,
    };

    /// A case from keys and values; keys left out take their defaults, and of a key given twice the
    /// last value counts (each is checked).
    ///
    /// ```
    /// use snapload::{Parameters, Value};
    /// let square = Parameters::from_entries([("a", Value::Number(0.2)), ("b", Value::Number(0.2))])?;
    /// assert_eq!(square.inertia, Some((0.2 * 0.2 + 0.2 * 0.2) / 3.0));
    /// assert_eq!(square.r, 1.5);
    /// # Ok::<(), snapload::CaseError>(())
    /// ```
    pub fn from_entries<K: AsRef<str>>(
        entries: impl IntoIterator<Item = (K, Value)>,
    ) -> Result<Self, CaseError> {
        let mut p = Self {
            inertia: None,
            ..Self::STANDARD
        };
        let mut given = Vec::new();
        for (name, value) in entries {
            let key = check_entry(name.as_ref(), &value)?;
            key.store(&mut p, &value)?;
            given.push(key.name);
        }
        match p.body {
            BodyKind::Point => {
                p.a = if given.contains(&"a") { p.a } else { 0.0 };
                p.b = if given.contains(&"b") { p.b } else { 0.0 };
            }
            BodyKind::Rigid if p.inertia.is_none() => p.inertia = natural_inertia(p.a, p.b),
            BodyKind::Rigid => {}
        }
        p.check()?;
        Ok(p)
    }

    /// Whether a small change of a key that holds a number changes the motion smoothly. A point mass has no
    /// size and no rotation, and a circle no half-height.
    pub fn moves_by(&self, name: &str) -> bool {
        match self.body {
            BodyKind::Point => !["a", "b", "inertia", "theta", "vtheta"].contains(&name),
            BodyKind::Rigid => name != "b" || self.b > 0.0,
        }
    }

    /// The value of a key; none for an unknown key, and for the inertia of a point mass.
    pub fn get(&self, name: &str) -> Option<Value> {
        KEYS.iter().find(|key| key.name == name)?.get(self)
    }

    /// The names of all keys with their values, in the order of the schema.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, Option<Value>)> + '_ {
        KEYS.iter().map(|key| (key.name, key.get(self)))
    }

    /// The shortest list of keys and values that makes this case: those that are neither the default nor follow
    /// from the others, as the inertia does from the size.
    ///
    /// ```
    /// use snapload::{Parameters, Value};
    /// let square = [("a", Value::Number(0.2)), ("b", Value::Number(0.2))];
    /// let case = Parameters::from_entries(square.clone())?;
    /// assert_eq!(case.differing(), square);
    /// # Ok::<(), snapload::CaseError>(())
    /// ```
    pub fn differing(&self) -> Vec<(&'static str, Value)> {
        let natural = natural_inertia(self.a, self.b);
        let default = match self.body {
            BodyKind::Rigid => Self {
                inertia: natural,
                ..Self::STANDARD
            },
            BodyKind::Point => Self {
                a: 0.0,
                b: 0.0,
                inertia: None,
                ..Self::STANDARD
            },
        };
        self.entries()
            .filter(|(key, value)| *value != default.get(key))
            .filter_map(|(key, value)| Some((key, value?)))
            .collect()
    }

    /// Checks every range, and what the keys ask of each other. The start's place among the cables
    /// is not looked at here: that is geometry, and the business of the engine.
    pub fn check(&self) -> Result<(), CaseError> {
        KEYS.iter().try_for_each(|key| key.check(self))?;
        match self.body {
            BodyKind::Point => self.check_point()?,
            BodyKind::Rigid => self.check_rigid()?,
        }
        let needed = (1.0 - self.a).abs();
        if self.r > needed {
            return Ok(());
        }
        let (a, needed) = (Value::Number(self.a), Value::Number(needed));
        let allowed = format!("r > |1 - a| = {needed} (a = {a})");
        let hint = format!(
            "the cables are too short to reach from the anchors to the body; choose r above {needed}"
        );
        Err(CaseError::value("r", Value::Number(self.r), allowed).with_hint(hint))
    }

    fn check_point(&self) -> Result<(), CaseError> {
        let zero = [
            ("a", self.a),
            ("b", self.b),
            ("theta", self.theta),
            ("vtheta", self.vtheta),
        ];
        for (name, value) in zero {
            if value != 0.0 {
                let what = if name.len() == 1 {
                    "no size"
                } else {
                    "no rotation"
                };
                let allowed = format!("0, as a point mass (body = \"point\") has {what}");
                let hint = format!("set {name} = 0, or choose body = \"rigid\"");
                return Err(CaseError::value(name, Value::Number(value), allowed).with_hint(hint));
            }
        }
        match self.inertia {
            None => Ok(()),
            Some(inertia) => {
                let allowed = "no inertia at all for a point mass (body = \"point\")";
                let error = CaseError::value("inertia", Value::Number(inertia), allowed);
                Err(error.with_hint("leave inertia out, or choose body = \"rigid\""))
            }
        }
    }

    fn check_rigid(&self) -> Result<(), CaseError> {
        let (a, b) = (Value::Number(self.a), Value::Number(self.b));
        let Some(inertia) = self.inertia else {
            let allowed = format!(
                "a number, 1e-12 <= inertia <= 1e6, as a = {a} and b = {b} give a rigid body none"
            );
            let error = CaseError::value("inertia", "(left out)", allowed);
            return Err(
                error.with_hint("give inertia, or a size a or b, or choose body = \"point\"")
            );
        };
        let least = LIGHTEST * (self.a * self.a + self.b * self.b);
        if inertia >= least {
            return Ok(());
        }
        let allowed = format!("inertia >= 1e-6 (a^2 + b^2) = {least:e} (a = {a}, b = {b})");
        Err(CaseError::value("inertia", Value::Number(inertia), allowed))
    }
}

/// The moment of inertia that follows from the size: a thin ring where b = 0, else a solid
/// rectangle. None where that is nothing: without size, or one so small that its square vanishes.
pub fn natural_inertia<T: Real>(a: T, b: T) -> Option<T> {
    let inertia = if b == T::ZERO {
        a * a
    } else {
        (a * a + b * b) / 3.0
    };
    (inertia > T::ZERO).then_some(inertia)
}
