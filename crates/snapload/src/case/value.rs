//! A value of a key, from a file, a command line, a request or Python.

use std::fmt::{self, Write as _};

/// A value of a key, before it is checked and as it is printed.
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
    /// Several values, such as the two numbers of a position.
    List(Vec<Value>),
}

impl Value {
    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Integer(number) => Some(*number as f64),
            _ => None,
        }
    }

    /// The whole number from 0 on, if it is one.
    pub fn count(&self) -> Option<u64> {
        match self {
            Self::Integer(count) => u64::try_from(*count).ok(),
            // The cast of a whole number below 2^53 is exact.
            Self::Number(n) if n.fract() == 0.0 && (0.0..9e15).contains(n) => Some(*n as u64),
            _ => None,
        }
    }

    /// The two numbers, if it is a list of two.
    pub fn pair(&self) -> Option<[f64; 2]> {
        match self {
            Self::List(values) => match &values[..] {
                [x, z] => Some([x.number()?, z.number()?]),
                _ => None,
            },
            _ => None,
        }
    }

    /// The three numbers, if it is a list of three.
    pub fn triple(&self) -> Option<[f64; 3]> {
        match self {
            Self::List(values) => match &values[..] {
                [a, b, c] => Some([a.number()?, b.number()?, c.number()?]),
                _ => None,
            },
            _ => None,
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }
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

impl From<[f64; 2]> for Value {
    fn from(pair: [f64; 2]) -> Self {
        Self::List(pair.map(Self::Number).to_vec())
    }
}

impl From<[f64; 3]> for Value {
    fn from(triple: [f64; 3]) -> Self {
        Self::List(triple.map(Self::Number).to_vec())
    }
}

impl fmt::Display for Value {
    /// In the notation of a case file, except that `NaN` and `inf` are Rust's.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Plain digits for the usual sizes, an exponent where there would be too many digits.
            Self::Number(n) if *n != 0.0 && !(1e-4..1e7).contains(&n.abs()) && n.is_finite() => {
                write!(f, "{n:e}")
            }
            Self::Number(n) => write!(f, "{n}"),
            Self::Integer(n) => write!(f, "{n}"),
            Self::Bool(flag) => write!(f, "{flag}"),
            Self::Text(text) => write_text(f, text),
            Self::List(values) => {
                let values: Vec<String> = values.iter().map(Self::to_string).collect();
                write!(f, "[{}]", values.join(", "))
            }
        }
    }
}

/// A basic string of TOML: quotation marks, backslashes and control characters are escaped.
fn write_text(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    f.write_char('"')?;
    for character in text.chars() {
        match character {
            '"' | '\\' => write!(f, "\\{character}")?,
            '\n' => f.write_str("\\n")?,
            '\r' => f.write_str("\\r")?,
            '\t' => f.write_str("\\t")?,
            control if control.is_control() => write!(f, "\\u{:04X}", u32::from(control))?,
            _ => f.write_char(character)?,
        }
    }
    f.write_char('"')
}
