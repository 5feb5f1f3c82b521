//! What is wrong with a case, in words that name the key, the value and what is allowed.
use std::fmt;

/// The longest piece of somebody's input that an error repeats, in characters.
const LONGEST_ECHO: usize = 60;

/// Which sort of fault a [`CaseError`] reports.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// The key is known, its value is not allowed.
    Value,
    /// There is no such key.
    UnknownKey {
        /// The key that was probably meant.
        nearest: Option<&'static str>,
    },
    /// There is no built-in case of this code.
    UnknownCase {
        /// The codes that look most like it, best first.
        nearest: Vec<&'static str>,
    },
}

/// A case that can not be run: which key, which value, what is allowed and what to do.
///
/// ```
/// use snapload::{Parameters, Value};
/// let error = Parameters::from_entries([("e", Value::Number(1.5))]).unwrap_err();
/// assert_eq!(error.key, "e");
/// assert_eq!(error.to_string(), "e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseError {
    /// Which sort of fault.
    pub fault: Fault,
    /// The key, or the code of an unknown case.
    pub key: String,
    /// The value as text; empty where there is none to speak of.
    pub value: String,
    /// What is allowed instead.
    pub allowed: String,
    /// What to do, where more than "choose what is allowed" can be said.
    pub hint: Option<String>,
}

impl CaseError {
    /// A value that is not allowed. `allowed` goes on after the word "allowed:".
    pub fn value(key: &str, value: impl fmt::Display, allowed: impl Into<String>) -> Self {
        Self {
            fault: Fault::Value,
            key: echo(key),
            value: echo(&value.to_string()),
            allowed: allowed.into(),
            hint: None,
        }
    }

    /// A key that does not exist.
    pub fn unknown_key(key: &str, nearest: Option<&'static str>, known: &[&str]) -> Self {
        Self {
            fault: Fault::UnknownKey { nearest },
            key: echo(key),
            value: String::new(),
            allowed: known.join(", "),
            hint: None,
        }
    }

    /// A code without a built-in case.
    pub fn unknown_case(code: &str, nearest: Vec<&'static str>) -> Self {
        Self {
            allowed: nearest.join(", "),
            fault: Fault::UnknownCase { nearest },
            key: echo(code),
            value: String::new(),
            hint: None,
        }
    }

    /// The same with the value that was given.
    #[must_use]
    pub(crate) fn given(mut self, value: impl fmt::Display) -> Self {
        self.value = echo(&value.to_string());
        self
    }

    /// The same with words on what to do.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            key,
            value,
            allowed,
            ..
        } = self;
        match &self.fault {
            // Such as `(left out)` or `(a table)`: words about the value, not the value itself.
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
            Fault::UnknownCase { .. } => {
                write!(
                    f,
                    "there is no built-in case \"{key}\"; the nearest are {allowed}"
                )?;
            }
        }
        match &self.hint {
            Some(hint) => write!(f, "\nhint: {hint}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for CaseError {}

/// Somebody's input made fit to repeat: control characters escaped, cut where it is long.
pub(crate) fn echo(text: &str) -> String {
    let mut shown: String = text
        .chars()
        .take(LONGEST_ECHO)
        .flat_map(|c| {
            let escaped = c.is_control().then(|| c.escape_default());
            let plain = escaped.is_none().then_some(c);
            escaped.into_iter().flatten().chain(plain)
        })
        .collect();
    if text.chars().nth(LONGEST_ECHO).is_some() {
        shown.push_str("...");
    }
    shown
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
            error.to_string(),
            "r = 0.5 is not allowed; allowed: r > 0.9\nhint: choose a longer one"
        );
        let error = CaseError::unknown_key("omgea", Some("omega"), &["r", "omega"]);
        assert_eq!(
            error.to_string(),
            "there is no key \"omgea\"; did you mean omega?\nthe keys are r, omega"
        );
    }
}
