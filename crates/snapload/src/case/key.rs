//! The description of a key: name, words, unit, type, range and default. Everything that describes
//! a key to users is made from it.

use crate::case::error::CaseError;
use crate::case::value::Value;
use crate::model::quantity::title_of;
use std::fmt::Display;

/// The type of a key and the range of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A finite number.
    Number(Bounds),
    /// Two numbers `[x, z]`, neither larger in magnitude than this.
    Pair(f64),
    /// A number from 0 to this, or three, `[surge, heave, pitch]`.
    PerFreedom(f64),
    /// Three numbers `[surge, heave, pitch]`, each from 0 to this.
    Triple(f64),
    /// A whole number from the first to the second, both allowed.
    Count(u64, u64),
    /// `true` or `false`.
    Flag,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// Any text.
    Text,
}

/// The bounds of a number; the upper one is always allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // they are what they are called
pub struct Bounds {
    pub low: f64,
    pub low_included: bool,
    pub high: f64,
}

impl Kind {
    /// A number above 0; up to `f64::MAX` where nothing bounds it.
    pub const fn positive(high: f64) -> Self {
        let (low, low_included) = (0.0, false);
        Self::Number(Bounds {
            low,
            low_included,
            high,
        })
    }

    /// A number from `low` to `high`, both allowed.
    pub const fn number(low: f64, high: f64) -> Self {
        let low_included = true;
        Self::Number(Bounds {
            low,
            low_included,
            high,
        })
    }
}

/// The value of a key that is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DefaultValue {
    /// It must not be left out.
    Required,
    /// This number.
    Number(f64),
    /// This whole number.
    Count(i64),
    /// This flag.
    Flag(bool),
    /// This word.
    Word(&'static str),
    /// These words describe it: it depends on other keys, or there is none.
    Derived(&'static str),
}

impl DefaultValue {
    /// The default as a value; none where it is required or derived.
    pub fn value(self) -> Option<Value> {
        match self {
            Self::Required | Self::Derived(_) => None,
            Self::Number(number) => Some(number.into()),
            Self::Count(count) => Some(count.into()),
            Self::Flag(flag) => Some(flag.into()),
            Self::Word(word) => Some(word.into()),
        }
    }
}

/// One key of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// Its symbol in the text of the model; the name if it has none.
    pub symbol: &'static str,
    /// Its unit; `1` if it is dimensionless, empty if it is no number.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Its subject; the keys of a group are shown together.
    pub group: &'static str,
    /// Its type and range.
    pub kind: Kind,
    /// Its value where it is left out.
    pub default: DefaultValue,
    /// The usual range, which a slider spans. None where a slider makes no sense.
    pub usual: Option<[f64; 2]>,
    /// A condition beside the range; empty where there is none.
    pub also: &'static str,
}

impl Key {
    /// A key whose name is also its symbol, and whose range is its only condition.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        kind: Kind,
        default: DefaultValue,
        meaning: &'static str,
    ) -> Self {
        let (symbol, group, also, usual) = (name, "", "", None);
        Self {
            name,
            symbol,
            unit,
            meaning,
            group,
            kind,
            default,
            usual,
            also,
        }
    }

    /// An option of which only the range is defined once: its default and its meaning are
    /// given where it is offered.
    pub const fn option(name: &'static str, kind: Kind) -> Self {
        Self::new(name, "1", kind, DefaultValue::Required, "")
    }

    /// The same under the name that it has where it is offered.
    pub const fn called(mut self, name: &'static str) -> Self {
        self.name = name;
        self
    }

    /// Its meaning in short, without what its group says already.
    pub fn title(&self) -> &'static str {
        let meaning = self.meaning;
        title_of(meaning.strip_prefix("start: ").unwrap_or(meaning))
    }

    /// The same with the usual range, which a slider spans.
    pub const fn usual(mut self, low: f64, high: f64) -> Self {
        self.usual = Some([low, high]);
        self
    }

    /// The same in a group of keys.
    pub const fn in_group(mut self, group: &'static str) -> Self {
        self.group = group;
        self
    }

    /// The same with a default that these words describe.
    pub const fn default_in_words(mut self, words: &'static str) -> Self {
        self.default = DefaultValue::Derived(words);
        self
    }

    /// The same with a symbol.
    pub const fn symbol(mut self, symbol: &'static str) -> Self {
        self.symbol = symbol;
        self
    }

    /// The same with a condition beside the range, in words.
    pub const fn also(mut self, also: &'static str) -> Self {
        self.also = also;
        self
    }

    /// The allowed values in words, such as `0 <= e <= 1`.
    pub fn allowed(&self) -> String {
        let name = self.name;
        let range = match self.kind {
            Kind::Number(Bounds {
                low,
                low_included,
                high,
            }) if high < f64::MAX => {
                let sign = if low_included { "<=" } else { "<" };
                format!("{} {sign} {name} <= {}", short(low), short(high))
            }
            Kind::Number(Bounds {
                low, low_included, ..
            }) => {
                let above = if low_included { "from" } else { "above" };
                let such = self.default.value();
                let such = such.map_or(String::new(), |value| format!(", such as {value}"));
                format!("a number {above} {}{such}", short(low))
            }
            Kind::Pair(limit) => format!("[x, z], each from -{0} to {0}", short(limit)),
            Kind::PerFreedom(limit) => {
                let limit = short(limit);
                format!("0 <= {name} <= {limit}, or [surge, heave, pitch], each from 0 to {limit}")
            }
            Kind::Triple(limit) => {
                format!("[surge, heave, pitch], each from 0 to {}", short(limit))
            }
            Kind::Count(low, u64::MAX) => format!("a whole number, {low} <= {name} < 2^64"),
            Kind::Count(low, high) => {
                let (low, high) = (short(low as f64), short(high as f64));
                format!("a whole number, {low} <= {name} <= {high}")
            }
            Kind::Flag => "true or false".to_owned(),
            Kind::Choice(words) => {
                let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
                quoted.join(" or ")
            }
            Kind::Text => "a text in quotes".to_owned(),
        };
        let join = if self.also.is_empty() { "" } else { "; " };
        format!("{range}{join}{}", self.also)
    }

    /// Its default in words.
    pub fn default_words(&self) -> String {
        match (self.default, self.default.value()) {
            (DefaultValue::Derived(words), _) => words.to_owned(),
            (_, Some(value)) => value.to_string(),
            (_, None) => "required".to_owned(),
        }
    }

    /// Its unit, if it has one.
    pub fn own_unit(&self) -> Option<&'static str> {
        (!matches!(self.unit, "" | "1")).then_some(self.unit)
    }

    /// Whether this key can take a whole number, of which [`Value`] can not hold the largest.
    pub fn takes_count(&self, number: u64) -> bool {
        matches!(self.kind, Kind::Count(low, high) if (low..=high).contains(&number))
    }

    /// Whether some lists are values of this key.
    fn takes_lists(&self) -> bool {
        matches!(
            self.kind,
            Kind::Pair(_) | Kind::PerFreedom(_) | Kind::Triple(_)
        )
    }

    /// Whether this key can take the value.
    pub(crate) fn takes(&self, value: &Value) -> bool {
        match self.kind {
            Kind::Number(Bounds {
                low,
                low_included,
                high,
            }) => {
                // NaN fails every comparison, infinity the upper or the lower one.
                let above = |n: f64| n > low || (low_included && n == low);
                value.number().is_some_and(|n| above(n) && n <= high)
            }
            Kind::Pair(limit) => {
                let pair = value.pair();
                pair.is_some_and(|pair| pair.iter().all(|n| n.abs() <= limit))
            }
            Kind::PerFreedom(limit) | Kind::Triple(limit) => {
                let within = |n: &f64| (0.0..=limit).contains(n);
                let may_be_one = matches!(self.kind, Kind::PerFreedom(_));
                let one = value.number().filter(|_| may_be_one);
                one.as_ref().is_some_and(within)
                    || value.triple().is_some_and(|three| three.iter().all(within))
            }
            Kind::Count(..) => value.count().is_some_and(|n| self.takes_count(n)),
            Kind::Flag => matches!(value, Value::Bool(_)),
            Kind::Choice(words) => value.text().is_some_and(|word| words.contains(&word)),
            Kind::Text => value.text().is_some(),
        }
    }

    /// An error unless this key can take the value; `path` is the key's name in the error.
    ///
    /// # Errors
    /// A [`CaseError`] that names the key by its path, the value and what is allowed.
    pub fn check(&self, path: &str, value: &Value) -> Result<(), CaseError> {
        match value {
            value if self.takes(value) => Ok(()),
            Value::List(_) if !self.takes_lists() => Err(self.refuse(path, "(a list)")),
            value => {
                let meant = value.text().and_then(|text| self.unquoted(text.trim()));
                let mut error = self.refuse(path, value);
                error.hint = meant.map(|meant| format!("write {path} = {meant}").into());
                Err(error)
            }
        }
    }

    /// The error of a value that this key can not take; `path` is the key's name in the error, such
    /// as `e` or `body.mass`.
    pub fn refuse(&self, path: &str, shown: impl Display) -> CaseError {
        let numbers = match self.kind {
            Kind::Number(Bounds { high, .. }) if high < f64::MAX => "a number",
            Kind::Pair(_) => "two numbers",
            Kind::PerFreedom(_) => "one number or three",
            Kind::Triple(_) => "three numbers",
            _ => return CaseError::value(path, shown, self.allowed()),
        };
        // The keys of a case without tables are nondimensional, and errors do not name their unit.
        let unit = self.own_unit().filter(|_| path != self.name);
        let unit = unit.map_or(String::new(), |unit| format!(" in {unit}"));
        CaseError::value(path, shown, format!("{numbers}{unit}, {}", self.allowed()))
    }

    /// The value that a quoted text would be without its quotes.
    fn unquoted(&self, text: &str) -> Option<String> {
        match self.kind {
            Kind::Number(_) | Kind::Count(..) => {
                let comma = text.replacen(',', ".", 1);
                let meant = Value::Number(comma.parse().ok()?);
                self.takes(&meant).then(|| meant.to_string())
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
            Kind::Pair(_) | Kind::PerFreedom(_) | Kind::Triple(_) | Kind::Text => None,
        }
    }
}

/// A bound in its usual notation: `1e6` rather than `1000000`.
fn short(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e5).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}
