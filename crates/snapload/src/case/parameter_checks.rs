//! From keys and values to a case, and back. Conditions between keys are checked here, once.

use crate::case::error::CaseError;
use crate::case::key::Key;
use crate::case::keys::check_entry;
use crate::case::parameters::{BODIES, FIELDS, Get, KEYS, Parameters, natural_inertia};
use crate::case::value::Value;

/// The least moment of inertia that may be given, as a part of a^2 + b^2: a lighter body would turn
/// a thousand times faster than it moves.
const LEAST_INERTIA_RATIO: f64 = 1e-6;

impl Parameters {
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
        let mut p = Self::STANDARD;
        let (mut is_point, mut inertia, mut sizes) = (false, None, [None; 2]);
        for (name, value) in entries {
            let key = check_entry(name.as_ref(), &value)?;
            match (key.name, &value) {
                ("body", Value::Text(word)) => is_point = word == BODIES[1],
                ("inertia", value) => inertia = value.number(),
                ("a", value) => sizes[0] = value.number(),
                ("b", value) => sizes[1] = value.number(),
                (name, value) => p.store(name, value),
            }
        }
        let missing = if is_point { [0.0; 2] } else { [p.a, p.b] };
        [p.a, p.b] = std::array::from_fn(|k| sizes[k].unwrap_or(missing[k]));
        if is_point {
            p.inertia = None;
            if let Some(inertia) = inertia {
                let allowed = "no inertia for a point mass (body = \"point\")";
                let error = CaseError::value("inertia", Value::Number(inertia), allowed);
                return Err(error.with_hint("leave inertia out, or choose body = \"rigid\""));
            }
        } else {
            p.inertia = Some(
                inertia
                    .or(natural_inertia(p.a, p.b))
                    .ok_or_else(|| p.no_inertia())?,
            );
        }
        p.check()?;
        Ok(p)
    }

    /// All keys, in the order of the schema, with how the value of each is read.
    pub fn keys() -> impl Iterator<Item = (&'static Key, Get)> {
        KEYS.iter().zip(FIELDS.iter().map(|(get, _)| *get))
    }

    /// The names of all keys with their values, in the order of the schema.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, Option<Value>)> + '_ {
        Self::keys().map(|(key, get)| (key.name, get.value(self)))
    }

    /// The shortest list of keys and values that makes this case: those that are neither the
    /// default nor follow from the others, as the inertia does from the size.
    ///
    /// ```
    /// use snapload::{Parameters, Value};
    /// let square = [("a", Value::Number(0.2)), ("b", Value::Number(0.2))];
    /// let case = Parameters::from_entries(square.clone())?;
    /// assert_eq!(case.differing(), square);
    /// # Ok::<(), snapload::CaseError>(())
    /// ```
    pub fn differing(&self) -> Vec<(&'static str, Value)> {
        let mut default = Self {
            inertia: natural_inertia(self.a, self.b),
            ..Self::STANDARD
        };
        if self.is_point() {
            (default.a, default.b) = (0.0, 0.0);
        }
        let differs = |key: &str, value: &Value| match key {
            "body" => self.is_point(),
            key => default.get(key).as_ref() != Some(value),
        };
        self.entries()
            .filter_map(|(key, value)| Some((key, value?)))
            .filter(|(key, value)| differs(key, value))
            .collect()
    }

    /// Checks every range, and the conditions between keys. Whether the start is possible with the
    /// cables is not checked here: that is geometry, and the engine checks it.
    pub fn check(&self) -> Result<(), CaseError> {
        // Words were checked when they were read.
        let numbers = Self::keys().filter(|(_, get)| !matches!(get, Get::Word(_)));
        for (key, get) in numbers {
            get.value(self)
                .map_or(Ok(()), |value| key.check(key.name, &value))?;
        }
        self.check_body()?;
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

    fn check_body(&self) -> Result<(), CaseError> {
        let Some(inertia) = self.inertia else {
            return self.check_point();
        };
        let least = LEAST_INERTIA_RATIO * (self.a * self.a + self.b * self.b);
        if inertia >= least {
            return Ok(());
        }
        let (a, b) = (Value::Number(self.a), Value::Number(self.b));
        let allowed = format!("inertia >= 1e-6 (a^2 + b^2) = {least:e} (a = {a}, b = {b})");
        Err(CaseError::value("inertia", Value::Number(inertia), allowed))
    }

    fn check_point(&self) -> Result<(), CaseError> {
        for (name, value, what) in [
            ("a", self.a, "no size"),
            ("b", self.b, "no size"),
            ("theta", self.theta, "no rotation"),
            ("vtheta", self.vtheta, "no rotation"),
        ] {
            if value != 0.0 {
                let allowed = format!("0, as a point mass (body = \"point\") has {what}");
                let hint = format!("set {name} = 0, or choose body = \"rigid\"");
                return Err(CaseError::value(name, Value::Number(value), allowed).with_hint(hint));
            }
        }
        Ok(())
    }

    fn no_inertia(&self) -> CaseError {
        let (a, b) = (Value::Number(self.a), Value::Number(self.b));
        let allowed = format!(
            "a number, 1e-12 <= inertia <= 1e6, as a = {a} and b = {b} determine no inertia"
        );
        CaseError::value("inertia", "(left out)", allowed)
            .with_hint("give inertia, or a size a or b, or choose body = \"point\"")
    }
}
