//! The one description of the keys of a case: names, types, ranges, defaults and help texts. The
//! case file, `--set`, the JSON echo, the error texts and `snapload keys` derive from it.
use crate::case::error::CaseError;
use crate::case::parameters::{BodyKind, Parameters};
use crate::case::value::Value;

/// Largest magnitude of a number in a case, in units in which all that matters is near 1.
const LARGEST: f64 = 1e3;
/// Latest end of a run.
const LONGEST: f64 = 1e6;
/// Largest moment of inertia: a^2 at the largest a, so that each derived value may be given too.
const LARGEST_INERTIA: f64 = 1e6;
/// Smallest moment of inertia; see also [`LIGHTEST`].
const LEAST_INERTIA: f64 = 1e-12;
/// A moment of inertia may be this part of a^2 + b^2 and no less: a lighter body would turn a thousand
/// times faster than it moves.
pub(crate) const LIGHTEST: f64 = 1e-6;

/// Below this y a cable that sticks, or two that are taut, settle the run (chapter 6.3.1).
pub const SETTLING_HEIGHT: f64 = 0.05;
/// The rotation limit π/2.
pub const ROTATION_LIMIT: f64 = std::f64::consts::FRAC_PI_2;

/// The type of a key and the range of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A finite number between two bounds.
    Number {
        /// Lower bound.
        low: f64,
        /// Whether the lower bound itself is allowed.
        low_included: bool,
        /// Upper bound, allowed.
        high: f64,
    },
    /// A whole number between two bounds, both allowed.
    Count {
        /// Lower bound.
        low: u64,
        /// Upper bound.
        high: u64,
    },
    /// `true` or `false`.
    Flag,
    /// One of some words.
    Choice(&'static [&'static str]),
}

/// What a key is about; the keys of a group stand together wherever they are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// The body: its shape and inertia.
    Body,
    /// The cables and their snaps.
    Cables,
    /// The force of the waves.
    Forcing,
    /// Where and how the motion begins.
    Start,
    /// What ends a run.
    Stops,
}

impl Group {
    /// Its name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::Cables => "cables",
            Self::Forcing => "forcing",
            Self::Start => "start",
            Self::Stops => "stops",
        }
    }
}

/// Where a key's value is kept.
enum Slot {
    Number(fn(&mut Parameters) -> &mut f64),
    MaybeNumber(fn(&mut Parameters) -> &mut Option<f64>),
    Count(fn(&mut Parameters) -> &mut u64),
    Flag(fn(&mut Parameters) -> &mut bool),
    Body(fn(&mut Parameters) -> &mut BodyKind),
}

/// One key of a case.
pub struct Key {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// Its symbol in the text of the model; the name where there is none.
    pub symbol: &'static str,
    /// Its unit, from the length L, mass m, force F and time T of the model; `1` where it has none.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// What it is about.
    pub group: Group,
    /// Its type and range.
    pub kind: Kind,
    /// Where one looks first, from and to: what a slider spans. None where sliding tells nothing.
    pub usual: Option<[f64; 2]>,
    /// A condition beside the range; empty where there is none.
    also: &'static str,
    /// The default in words where it depends on other keys; empty where it is a plain value.
    derived_default: &'static str,
    slot: Slot,
}

const ANY: Kind = Kind::Number {
    low: -LARGEST,
    low_included: true,
    high: LARGEST,
};
const SIZE: Kind = Kind::Number {
    low: 0.0,
    low_included: true,
    high: LARGEST,
};
const POSITIVE: Kind = Kind::Number {
    low: 0.0,
    low_included: false,
    high: LARGEST,
};
const DURATION: Kind = Kind::Number {
    low: 0.0,
    low_included: false,
    high: LONGEST,
};
const INERTIA: Kind = Kind::Number {
    low: LEAST_INERTIA,
    low_included: true,
    high: LARGEST_INERTIA,
};
const FRACTION: Kind = Kind::Number {
    low: 0.0,
    low_included: true,
    high: 1.0,
};
const STICKING: Kind = Kind::Number {
    low: 1e-9,
    low_included: true,
    high: 1e-2,
};
const IMPACTS: Kind = Kind::Count {
    low: 1,
    high: 10_000_000,
};

/// Short form of a row whose symbol, conditions and default need no words.
const fn key(
    group: Group,
    name: &'static str,
    unit: &'static str,
    kind: Kind,
    slot: Slot,
    meaning: &'static str,
) -> Key {
    Key {
        name,
        symbol: name,
        unit,
        meaning,
        group,
        kind,
        usual: None,
        also: "",
        derived_default: "",
        slot,
    }
}

impl Key {
    const fn usual(mut self, low: f64, high: f64) -> Self {
        self.usual = Some([low, high]);
        self
    }

    const fn symbol(mut self, symbol: &'static str) -> Self {
        self.symbol = symbol;
        self
    }

    const fn also(mut self, also: &'static str) -> Self {
        self.also = also;
        self
    }

    const fn default_in_words(mut self, words: &'static str) -> Self {
        self.derived_default = words;
        self
    }
}

/// Every key of a case, in the order in which they are echoed.
#[rustfmt::skip] // one row a key
pub static KEYS: &[Key] = &[
    key(Group::Cables, "r", "L", POSITIVE, Slot::Number(|p| &mut p.r), "length of the cables")
        .also("and r > |1 - a|").usual(0.95, 3.0),
    key(Group::Cables, "e", "1", FRACTION, Slot::Number(|p| &mut p.e),
        "coefficient of restitution of a snap: v_n after = -e v_n before").usual(0.0, 1.0),
    key(Group::Body, "a", "L", SIZE, Slot::Number(|p| &mut p.a), "half-width of the body")
        .default_in_words("0.1; 0 for a point mass").usual(0.02, 0.5),
    key(Group::Body, "b", "L", SIZE, Slot::Number(|p| &mut p.b),
        "half-height of the body; 0 is the circle")
        .default_in_words("0").usual(0.0, 0.5),
    key(Group::Body, "inertia", "m L^2", INERTIA, Slot::MaybeNumber(|p| &mut p.inertia),
        "moment of inertia")
        .symbol("I").also("at least 1e-6 (a^2 + b^2); never given for a point mass")
        .default_in_words("a^2 if b = 0 (ring), (a^2 + b^2)/3 if b > 0 (rectangle)").usual(1e-3, 0.2),
    key(Group::Forcing, "f_o", "F", ANY, Slot::Number(|p| &mut p.f_o),
        "force amplitude: f_x = f_o cos(omega t)").usual(0.0, 1.0),
    key(Group::Forcing, "nu", "1", ANY, Slot::Number(|p| &mut p.nu),
        "axis ratio of the forcing ellipse: f_y = nu f_o sin(omega t)").symbol("ν").usual(-1.0, 1.0),
    key(Group::Forcing, "omega", "rad/T", ANY, Slot::Number(|p| &mut p.omega),
        "frequency of the forcing").symbol("Ω").usual(0.1, 3.0),
    key(Group::Start, "x", "L", ANY, Slot::Number(|p| &mut p.x),
        "start: horizontal position of the centre").usual(-0.5, 0.5),
    key(Group::Start, "y", "L", ANY, Slot::Number(|p| &mut p.y),
        "start: vertical position, towards the anchors; 0 with both cables taut").usual(0.0, 1.0),
    key(Group::Start, "theta", "rad", ANY, Slot::Number(|p| &mut p.theta), "start: rotation")
        .symbol("θ").also("0 for a point mass").usual(-1.5, 1.5),
    key(Group::Start, "vx", "L/T", ANY, Slot::Number(|p| &mut p.vx), "start: horizontal velocity")
        .symbol("ẋ").usual(-1.0, 1.0),
    key(Group::Start, "vy", "L/T", ANY, Slot::Number(|p| &mut p.vy), "start: vertical velocity")
        .symbol("ẏ").usual(-1.0, 1.0),
    key(Group::Start, "vtheta", "rad/T", ANY, Slot::Number(|p| &mut p.vtheta),
        "start: angular velocity").symbol("θ̇").also("0 for a point mass").usual(-3.0, 3.0),
    key(Group::Stops, "t_end", "T", DURATION, Slot::Number(|p| &mut p.t_end),
        "the run ends here at the latest").usual(5.0, 200.0),
    key(Group::Cables, "v_stick", "L/T", STICKING, Slot::Number(|p| &mut p.v_stick),
        "a slower snap makes the cable stay taut if its tension would be positive"),
    key(Group::Stops, "stop_when_settled", "", Kind::Flag, Slot::Flag(|p| &mut p.stop_when_settled),
        "stop where a cable sticks, or both are taut, below y = 0.05"),
    key(Group::Stops, "stop_when_sliding", "", Kind::Flag, Slot::Flag(|p| &mut p.stop_when_sliding),
        "stop where a cable sticks at y = 0.05 or above"),
    key(Group::Stops, "max_impacts", "", IMPACTS, Slot::Count(|p| &mut p.max_impacts),
        "the run ends at more impacts than this"),
    key(Group::Body, "body", "", Kind::Choice(BodyKind::NAMES), Slot::Body(|p| &mut p.body),
        "a rigid body that turns, or a point mass (a = b = 0) that does not"),
];

/// The key of a name, or an error with the nearest one.
pub fn key_named(name: &str) -> Result<&'static Key, CaseError> {
    if let Some(key) = KEYS.iter().find(|key| key.name == name) {
        return Ok(key);
    }
    // The one quantity of the model that looks like a key and is none.
    if name == "h" {
        let allowed = "no h at all; it is derived, h = sqrt(r^2 - (1 - a)^2)";
        let error = CaseError::value("h", "(given)", allowed);
        return Err(error.with_hint("leave h out, and choose r and a instead"));
    }
    let known: Vec<&str> = KEYS.iter().map(|key| key.name).collect();
    Err(CaseError::unknown_key(name, nearest_key(name), &known))
}

/// The key of a name, if it exists and can take the value.
pub fn check_entry(name: &str, value: &Value) -> Result<&'static Key, CaseError> {
    let key = key_named(name).map_err(|error| error.given(value))?;
    key.store(&mut { Parameters::STANDARD }, value)?;
    Ok(key)
}

/// The key that was probably meant by a name.
pub fn nearest_key(name: &str) -> Option<&'static str> {
    // Case and underscores are where most slips are; length is bounded, as the distance is quadratic.
    let plain = |text: &str| -> String {
        text.chars()
            .take(40)
            .filter(char::is_ascii)
            .filter(|c| !"_- ".contains(*c))
            .collect()
    };
    let plain = |text: &str| plain(text).to_lowercase();
    let by_symbol =
        |key: &&Key| !name.is_empty() && key.symbol.to_lowercase() == name.to_lowercase();
    if let Some(key) = KEYS.iter().find(by_symbol) {
        return Some(key.name);
    }
    let wanted = plain(name);
    let mut best = (0.5, None);
    for key in KEYS {
        let score = strsim::normalized_damerau_levenshtein(&wanted, &plain(key.name));
        if score > best.0 || (score == best.0 && best.1.is_none()) {
            best = (score, Some(key.name));
        }
    }
    if wanted.is_empty() { None } else { best.1 }
}

impl Key {
    /// The allowed values in words, such as `0 <= e <= 1`.
    pub fn allowed(&self) -> String {
        let name = self.name;
        let range = match self.kind {
            Kind::Number {
                low,
                low_included,
                high,
            } => {
                let sign = if low_included { "<=" } else { "<" };
                format!("{} {sign} {name} <= {}", short(low), short(high))
            }
            Kind::Count { low, high } => {
                let (low, high) = (short(low as f64), short(high as f64));
                format!("a whole number, {low} <= {name} <= {high}")
            }
            Kind::Flag => "true or false".to_owned(),
            Kind::Choice(words) => words
                .iter()
                .map(|word| format!("\"{word}\""))
                .collect::<Vec<_>>()
                .join(" or "),
        };
        let join = if self.also.is_empty() { "" } else { "; " };
        format!("{range}{join}{}", self.also)
    }

    /// The default where it depends on other keys, in words; empty where it is a plain value.
    pub fn derived_default(&self) -> &'static str {
        self.derived_default
    }

    /// The default in words.
    pub fn default_words(&self) -> String {
        match self.get(&Parameters::STANDARD) {
            Some(value) if self.derived_default.is_empty() => value.to_string(),
            _ => self.derived_default.to_owned(),
        }
    }

    /// The value of this key in a case; none for the inertia of a point mass.
    pub fn get(&self, parameters: &Parameters) -> Option<Value> {
        let mut copy = *parameters;
        match self.slot {
            Slot::Number(place) => Some(Value::Number(*place(&mut copy))),
            Slot::MaybeNumber(place) => place(&mut copy).map(Value::Number),
            Slot::Count(place) => Some(Value::Integer(
                i64::try_from(*place(&mut copy)).unwrap_or(i64::MAX),
            )),
            Slot::Flag(place) => Some(Value::Bool(*place(&mut copy))),
            Slot::Body(place) => Some(Value::Text(place(&mut copy).name().to_owned())),
        }
    }

    /// Puts a value into a case, if its type and range are right.
    pub(crate) fn store(&self, p: &mut Parameters, value: &Value) -> Result<(), CaseError> {
        match self.slot {
            Slot::Number(place) => *place(p) = self.number(value)?,
            Slot::MaybeNumber(place) => *place(p) = Some(self.number(value)?),
            Slot::Count(place) => *place(p) = self.count(value)?,
            Slot::Flag(place) => match value {
                Value::Bool(flag) => *place(p) = *flag,
                _ => return Err(self.refuse(value)),
            },
            Slot::Body(place) => match value {
                Value::Text(word) => {
                    *place(p) = BodyKind::named(word).ok_or_else(|| self.refuse(value))?;
                }
                _ => return Err(self.refuse(value)),
            },
        }
        Ok(())
    }

    /// Checks the range of this key in a case that was filled in by hand.
    pub(crate) fn check(&self, p: &Parameters) -> Result<(), CaseError> {
        match self.get(p) {
            Some(value) => self.store(&mut { *p }, &value),
            None => Ok(()),
        }
    }

    fn number(&self, value: &Value) -> Result<f64, CaseError> {
        let number = match value {
            Value::Number(number) => *number,
            Value::Integer(number) => *number as f64,
            Value::Bool(_) | Value::Text(_) => return Err(self.refuse(value)),
        };
        let Kind::Number {
            low,
            low_included,
            high,
        } = self.kind
        else {
            return Err(self.refuse(value));
        };
        // NaN fails every comparison, infinity the upper or the lower one.
        let above = if low_included {
            number >= low
        } else {
            number > low
        };
        if above && number <= high {
            Ok(number)
        } else {
            Err(self.refuse(value))
        }
    }

    fn count(&self, value: &Value) -> Result<u64, CaseError> {
        let Kind::Count { low, high } = self.kind else {
            return Err(self.refuse(value));
        };
        let count = match value {
            Value::Integer(count) => u64::try_from(*count).ok(),
            // A cast of a whole number within the bounds is exact.
            Value::Number(n) if n.fract() == 0.0 && *n >= 0.0 && *n <= high as f64 => {
                Some(*n as u64)
            }
            _ => None,
        };
        count
            .filter(|n| (low..=high).contains(n))
            .ok_or_else(|| self.refuse(value))
    }

    /// The error of a value that this key can not take, whatever it is.
    pub fn refuse(&self, value: &Value) -> CaseError {
        let error = self.refuse_text(&value.to_string());
        match value {
            Value::Text(text) => match self.unquoted(text.trim()) {
                Some(meant) => error.with_hint(format!("write {} = {meant}", self.name)),
                None => error,
            },
            _ => error,
        }
    }

    /// The error of something that is not even a value, such as a table.
    pub fn refuse_text(&self, shown: &str) -> CaseError {
        let word = if matches!(self.kind, Kind::Number { .. }) {
            "a number, "
        } else {
            ""
        };
        CaseError::value(self.name, shown, format!("{word}{}", self.allowed()))
    }

    /// What a text would be if its author had written it in the way of the file.
    fn unquoted(&self, text: &str) -> Option<String> {
        match self.kind {
            Kind::Number { .. } | Kind::Count { .. } => {
                let comma = text.replacen(',', ".", 1);
                let meant = Value::Number(comma.parse().ok()?);
                let allowed = self.store(&mut { Parameters::STANDARD }, &meant).is_ok();
                allowed.then(|| meant.to_string())
            }
            Kind::Flag => match text.to_ascii_lowercase().as_str() {
                "true" | "yes" | "on" | "1" => Some("true".to_owned()),
                "false" | "no" | "off" | "0" => Some("false".to_owned()),
                _ => None,
            },
            Kind::Choice(words) => {
                let meant = words.iter().find(|word| word.eq_ignore_ascii_case(text))?;
                Some(format!("\"{meant}\""))
            }
        }
    }
}

/// A bound as one writes it: `1e6` rather than `1000000`.
fn short(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e5).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}
