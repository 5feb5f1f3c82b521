//! Errors in hydrodynamic coefficients, or in their use.

use crate::digits::in_full;
use std::fmt;

/// Why coefficients can not be used. The message says what is wrong, where, and how to correct it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HydroError {
    /// The file does not have the format that its name says, is truncated, or is damaged.
    #[error("can not be read: {0}")]
    Unreadable(String),
    /// Something required is missing.
    #[error("{what} is missing: {advice}")]
    Missing {
        /// The variable, freedom, wave direction or value.
        what: String,
        /// How to correct it.
        advice: String,
    },
    /// It is there, but not in the form that the format prescribes.
    #[error("{what}: {found}; {expected}")]
    Layout {
        /// The variable.
        what: String,
        /// What was found.
        found: String,
        /// The expected form.
        expected: String,
    },
    /// A number that is not possible.
    #[error("{what} = {}: {expected}", in_full(value))]
    Value {
        /// The quantity, and where it is.
        what: String,
        /// The value.
        value: f64,
        /// What is allowed.
        expected: String,
    },
    /// The numbers do not agree with the format's conventions of signs, phases or units.
    #[error("{what}: {message}")]
    Convention {
        /// The convention.
        what: &'static str,
        /// What was found, what was expected, and the probable cause.
        message: String,
    },
    /// The file and a value that is given in addition contradict each other.
    #[error(
        "{what} is {} in the file and {} {source_of_given}; they must agree",
        in_full(file),
        in_full(given)
    )]
    Disagreement {
        /// The quantity in which they differ.
        what: &'static str,
        /// The file's value.
        file: f64,
        /// The given value.
        given: f64,
        /// Where it was given.
        source_of_given: GivenSource,
    },
    /// A value is given that has no meaning for files of this format.
    #[error(
        "{key} is given {source_of_given}, but a file of {format} has no use for it; only files of WAMIT need it"
    )]
    OnlyForWamit {
        /// The name of the value in cases and options.
        key: &'static str,
        /// The format of the file.
        format: String,
        /// Where it was given.
        source_of_given: GivenSource,
    },
    /// No result is possible with these numbers.
    #[error("{0}")]
    Impossible(String),
}

impl HydroError {
    pub(crate) fn missing(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::Missing {
            what: what.into(),
            advice: advice.into(),
        }
    }

    pub(crate) fn layout(
        what: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self::Layout {
            what: what.into(),
            found: found.into(),
            expected: expected.into(),
        }
    }

    pub(crate) fn value(what: impl Into<String>, value: f64, expected: impl Into<String>) -> Self {
        Self::Value {
            what: what.into(),
            value,
            expected: expected.into(),
        }
    }

    pub(crate) fn convention(what: &'static str, message: impl Into<String>) -> Self {
        Self::Convention {
            what,
            message: message.into(),
        }
    }
}

/// A warning without which a reader could misjudge the results.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Warning {
    /// Its subject, in a word or two.
    pub what: &'static str,
    /// What was found, and what it means.
    #[serde(rename = "words")]
    pub message: String,
}

impl Warning {
    pub(crate) fn new(what: &'static str, message: impl Into<String>) -> Self {
        Self {
            what,
            message: message.into(),
        }
    }
}

/// Where values are given in addition to the file, for messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GivenSource {
    /// A case file.
    #[default]
    Case,
    /// The options of a command.
    CommandLine,
    /// The options of a function.
    Options,
}

impl fmt::Display for GivenSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Case => "in the case",
            Self::CommandLine => "on the command line",
            Self::Options => "in the options",
        })
    }
}
