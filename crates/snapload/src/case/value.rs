//! A value of a key, as it comes from a file, a command line or Python.
use std::fmt;

/// A value of a key before it is checked, and as it is echoed.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number with a fraction or an exponent.
    Number(f64),
    /// A whole number; accepted wherever a number is.
    Integer(i64),
    /// `true` or `false`.
    Bool(bool),
    /// Text, such as `point`.
    Text(String),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<i64> for Value {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Self::Bool(flag)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl fmt::Display for Value {
    /// As it would stand in a case file, except that `NaN` and `inf` are Rust's.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Digits for the usual sizes, an exponent where digits would run on.
            Self::Number(n) if *n != 0.0 && !(1e-4..1e7).contains(&n.abs()) && n.is_finite() => {
                write!(f, "{n:e}")
            }
            Self::Number(n) => write!(f, "{n}"),
            Self::Integer(n) => write!(f, "{n}"),
            Self::Bool(flag) => write!(f, "{flag}"),
            Self::Text(text) => write!(f, "\"{text}\""),
        }
    }
}
