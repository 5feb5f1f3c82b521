//! What can be wrong with hydrodynamic coefficients, or with what is asked of them.

/// Why coefficients can not be used. The words name what is wrong, where, and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HydroError {
    /// The file is not what its name says, is cut off, or is damaged.
    #[error("can not be read: {0}")]
    Unreadable(String),
    /// Something that has to be there is not.
    #[error("{what} is missing: {advice}")]
    Missing {
        /// The variable, freedom, wave direction or value.
        what: String,
        /// What to do.
        advice: String,
    },
    /// It is there in another form than the format has it.
    #[error("{what}: {found}; {wanted}")]
    Layout {
        /// The variable.
        what: String,
        /// What was found.
        found: String,
        /// What is wanted.
        wanted: String,
    },
    /// A number that can not be.
    #[error("{what} = {value}: {wanted}")]
    Value {
        /// What has the value, and where.
        what: String,
        /// The value.
        value: f64,
        /// What is allowed.
        wanted: String,
    },
    /// The numbers do not agree with the format's conventions of signs, phases or units.
    #[error("{what}: {words}")]
    Convention {
        /// The convention.
        what: &'static str,
        /// What was found, what was expected, and what may have gone wrong.
        words: String,
    },
    /// The file and the case say different things.
    #[error("{what} is {file} in the file and {case} in the case; they have to agree")]
    Disagreement {
        /// What they differ in.
        what: &'static str,
        /// The file's value.
        file: f64,
        /// The case's value.
        case: f64,
    },
    /// The numbers can not be worked with.
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
        wanted: impl Into<String>,
    ) -> Self {
        Self::Layout {
            what: what.into(),
            found: found.into(),
            wanted: wanted.into(),
        }
    }

    pub(crate) fn value(what: impl Into<String>, value: f64, wanted: impl Into<String>) -> Self {
        Self::Value {
            what: what.into(),
            value,
            wanted: wanted.into(),
        }
    }

    pub(crate) fn convention(what: &'static str, words: impl Into<String>) -> Self {
        Self::Convention {
            what,
            words: words.into(),
        }
    }
}

/// Something that a reader of the results should know, without which they could be misjudged.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Warning {
    /// What it is about, in a word or two.
    pub what: &'static str,
    /// What was found, and what it means.
    pub words: String,
}

impl Warning {
    pub(crate) fn new(what: &'static str, words: impl Into<String>) -> Self {
        Self {
            what,
            words: words.into(),
        }
    }
}
