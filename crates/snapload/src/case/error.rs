//! The errors of a case: messages that name the key, the value, what is allowed and where it was
//! given.

use std::fmt;

/// The place of a value that was given on the command line.
pub(crate) const SET: &str = "--set";

/// The longest piece of the input that an error repeats, in characters.
const LONGEST_ECHO: usize = 60;

/// The kind of fault that a [`CaseError`] reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// The key is known, its value is not allowed.
    Value,
    /// There is no such key.
    UnknownKey {
        /// The key that was probably meant.
        nearest: Option<&'static str>,
    },
    /// There is no built-in case of this code; the allowed values are the codes that are most
    /// similar to it.
    UnknownCase,
    /// The text can not be parsed as keys and values; the value is the parser's message.
    Syntax,
}

/// A case that can not be run: which key, which value, what is allowed, where it was given and how
/// to correct it.
///
/// ```
/// use snapload::{Parameters, Value};
/// let error = Parameters::from_entries([("e", Value::Number(1.5))]).unwrap_err();
/// assert_eq!(error.key, "e");
/// assert_eq!(error.to_string(), "e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseError {
    /// The kind of fault.
    pub fault: Fault,
    /// The key, or the code of an unknown case.
    pub key: String,
    /// The value as text; empty where there is none to report.
    pub value: String,
    /// What is allowed instead.
    pub allowed: Box<str>,
    /// Where the value stands, such as `mooring.toml, line 3` or `--set`.
    pub place: Option<Box<str>>,
    /// How to correct it, where that is more than choosing an allowed value.
    pub hint: Option<Box<str>>,
}

impl CaseError {
    fn new(fault: Fault, key: &str, value: &str, allowed: String) -> Self {
        let (key, value, place, hint) = (echo(key), echo(value), None, None);
        Self {
            fault,
            key,
            value,
            allowed: allowed.into(),
            place,
            hint,
        }
    }

    /// A value that is not allowed. `allowed` continues the message after the word "allowed:".
    pub fn value(key: &str, value: impl fmt::Display, allowed: impl Into<String>) -> Self {
        Self::new(Fault::Value, key, &value.to_string(), allowed.into())
    }

    /// A key that does not exist.
    pub fn unknown_key(key: &str, nearest: Option<&'static str>, known: &[&str]) -> Self {
        Self::new(Fault::UnknownKey { nearest }, key, "", known.join(", "))
    }

    /// A code without a built-in case.
    pub fn unknown_case(code: &str, nearest: &[&str]) -> Self {
        Self::new(Fault::UnknownCase, code, "", nearest.join(", "))
    }

    /// A text that can not be read, and why.
    pub fn syntax(reason: impl Into<String>) -> Self {
        let mut error = Self::new(Fault::Syntax, "", "", String::new());
        error.value = reason.into();
        error
    }

    /// The same with the value that was given.
    #[must_use]
    pub fn given(mut self, value: impl fmt::Display) -> Self {
        self.value = echo(&value.to_string());
        self
    }

    /// The same with advice on how to correct it.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<Box<str>>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The same without a place on the command line, for callers that have none.
    #[must_use]
    pub fn off_the_command_line(mut self) -> Self {
        self.place = self.place.filter(|place| !place.starts_with(SET));
        self
    }

    /// The same with the place where the value stands.
    #[must_use]
    pub fn at(mut self, place: impl Into<Box<str>>) -> Self {
        self.place = Some(place.into());
        self
    }
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            fault,
            key,
            value,
            allowed,
            place,
            hint,
        } = self;
        if let Some(place) = place {
            write!(f, "{place}: ")?;
        }
        match fault {
            // Values such as `(left out)` or `(a table)` are descriptions and not the value itself.
            Fault::Value if value.starts_with('(') => {
                write!(f, "{key} {value} is not allowed; allowed: {allowed}")?;
            }
            Fault::Value => write!(f, "{key} = {value} is not allowed; allowed: {allowed}")?,
            Fault::UnknownKey { nearest } => {
                write!(f, "there is no key \"{key}\"")?;
                if !value.is_empty() {
                    write!(f, " ({key} = {value})")?;
                }
                if let Some(nearest) = nearest {
                    write!(f, "; did you mean {nearest}?")?;
                }
                write!(f, "\nthe keys are {allowed}")?;
            }
            Fault::UnknownCase => {
                let what = format!("there is no built-in case \"{key}\"");
                write!(f, "{what}; the nearest are {allowed}")?;
            }
            Fault::Syntax => f.write_str(value)?,
        }
        match hint {
            Some(hint) => write!(f, "\nhint: {hint}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for CaseError {}

/// Input made safe to repeat in a message: control characters are escaped, long text is cut.
pub(crate) fn echo(text: &str) -> String {
    let shown = text
        .chars()
        .take(LONGEST_ECHO)
        .map(|c| match c.is_control() {
            true => c.escape_default().to_string(),
            false => c.to_string(),
        });
    let cut = text.chars().nth(LONGEST_ECHO).map(|_| "...".to_owned());
    shown.chain(cut).collect()
}

#[cfg(test)]
mod tests {
    use super::{CaseError, echo};

    #[test]
    fn echo_is_short_and_printable() {
        assert_eq!(echo("a\nb\u{1b}[31m"), "a\\nb\\u{1b}[31m");
        assert_eq!(echo(&"x".repeat(1000)).len(), 63);
        assert_eq!(echo("Ω"), "Ω");
    }

    #[test]
    fn texts_name_everything() {
        let error = CaseError::value("r", 0.5, "r > 0.9").with_hint("choose a longer one");
        assert_eq!(
            error.at("case.toml, line 3").to_string(),
            "case.toml, line 3: r = 0.5 is not allowed; allowed: r > 0.9\nhint: choose a longer one"
        );
        let error = CaseError::unknown_key("omgea", Some("omega"), &["r", "omega"]);
        assert_eq!(
            error.to_string(),
            "there is no key \"omgea\"; did you mean omega?\nthe keys are r, omega"
        );
    }
}
