//! What can go wrong with a study, in words.

use snapload::CaseError;
use std::fmt;
use std::io;
use std::path::Path;

/// Why a study can not be begun, or not go on.
#[derive(Debug)]
pub enum StudyError {
    /// What was asked for can not be done as it is.
    Input(String),
    /// Something broke on the way, such as a full disk.
    Failed(String),
}

impl StudyError {
    /// A file that can not be written.
    pub(crate) fn write(path: &Path, error: impl Into<io::Error>) -> Self {
        Self::Failed(format!(
            "can not write {}: {}",
            path.display(),
            plain(&error.into())
        ))
    }

    /// The same for a file that somebody named: it is the name that is wrong.
    pub(crate) fn of_input(self) -> Self {
        match self {
            Self::Input(words) | Self::Failed(words) => Self::Input(words),
        }
    }

    /// A file that can not be read.
    pub(crate) fn read(path: &Path, error: impl fmt::Display) -> Self {
        let text = error.to_string();
        Self::Failed(format!(
            "can not read {}: {}",
            path.display(),
            without_number(&text)
        ))
    }
}

/// The system's words without its number: `No space left on device`.
fn plain(error: &io::Error) -> String {
    without_number(&error.to_string()).to_owned()
}

fn without_number(text: &str) -> &str {
    text.find(" (os error").map_or(text, |end| &text[..end])
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(words) | Self::Failed(words) => f.write_str(words),
        }
    }
}

impl std::error::Error for StudyError {}

impl From<CaseError> for StudyError {
    fn from(error: CaseError) -> Self {
        Self::Input(error.to_string())
    }
}
