//! The errors of a study.

use snapload::CaseError;
use snapload::analysis::Cancelled;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// Why a study can not begin, or not continue.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A key is unknown, or can not take a value.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The request is not possible.
    #[error("{0}")]
    Input(String),
    /// Random points were requested, but no key has a range; the number of points.
    #[error("{}", no_random_range(*.0, "--vary KEY=low:high, such as --vary e=0.5:0.9"))]
    NoRandomRange(usize),
    /// Something stands where the rows are to be kept.
    #[error("{}", .0.in_words("--resume", "--out"))]
    Occupied(Occupied),
    /// Something failed during the work, such as a full disk.
    #[error("{0}")]
    Failed(String),
    /// A file of rows is damaged, or can not be read.
    #[error("can not read {}: {why}", .file.display())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// What is already in the place where the rows of a study are to be kept.
#[derive(Debug)]
pub enum Occupied {
    /// This same study, complete.
    Complete(PathBuf),
    /// This study, but damaged.
    Damaged(PathBuf),
    /// A file with other contents.
    OtherFile(PathBuf),
    /// Some rows of this study.
    Partial {
        /// Where they are.
        directory: PathBuf,
        /// The number of rows that are there.
        saved: u64,
        /// The number of rows of the study.
        total: u64,
    },
    /// Rows of another study.
    OtherStudy {
        /// Where they are.
        directory: PathBuf,
        /// A line of that study that this one does not have.
        there: String,
        /// A line of this study that the other does not have.
        here: String,
    },
    /// Another program is writing there.
    InUse(PathBuf),
}

impl Occupied {
    /// A message that says what is there and what to do; it names the option to resume and the
    /// option for the file.
    pub fn in_words(&self, resume: &str, out: &str) -> String {
        match self {
            Self::Complete(file) => format!(
                "{} exists already and holds this complete study; {resume} accepts it",
                file.display()
            ),
            Self::Damaged(file) => format!(
                "{} exists already and held this study, but it is damaged: its checksum is not that of its bytes; \
                 remove it to compute it again, or choose another {out}",
                file.display()
            ),
            Self::OtherFile(file) => format!(
                "{} exists already and holds something else; choose another {out}, or remove it",
                file.display()
            ),
            Self::Partial {
                directory,
                saved,
                total,
            } => format!(
                "{} holds {saved} of {total} rows of this study already; continue with {resume}, or remove it to start \
                 again",
                directory.display()
            ),
            Self::OtherStudy {
                directory,
                there,
                here,
            } => {
                let directory = directory.display();
                format!(
                    "{directory} holds rows of another study\nthere: {there}\nhere:  {here}\nhint: choose another \
                     {out}, or remove {directory} to start again"
                )
            }
            Self::InUse(directory) => format!(
                "another snapload process is writing to {}; wait for it, or choose another {out}",
                directory.display()
            ),
        }
    }
}

impl StudyError {
    /// A file that can not be written.
    pub(crate) fn write(path: &Path, error: impl Into<io::Error>) -> Self {
        Self::Failed(about("write", path.display(), &error.into()))
    }

    /// A file that can not be read.
    pub(crate) fn read(called: impl Display, error: impl Display) -> Self {
        Self::Failed(about("read", called, &error))
    }

    /// A file of rows that can not be read.
    pub(crate) fn damaged(file: &Path, why: impl Display) -> Self {
        Self::Damaged {
            file: file.to_owned(),
            why: without_number(&why),
        }
    }

    /// The same error for a file named by the user, where the name is probably wrong.
    pub(crate) fn of_input(self) -> Self {
        match self {
            Self::Failed(message) => Self::Input(message),
            other => other,
        }
    }
}

/// That nothing varies, with words on how a key is let vary.
pub fn no_random_range(most: usize, how: &str) -> String {
    format!(
        "random points are drawn from the ranges of 1 to {most} keys, and none varies; vary one with {how}"
    )
}

fn about(verb: &str, called: impl Display, error: &impl Display) -> String {
    let error = without_number(error);
    format!("can not {verb} {called}: {error}")
}

/// The system's message without its error number: `No space left on device`.
pub fn without_number(error: &impl Display) -> String {
    let mut text = error.to_string();
    text.truncate(text.find(" (os error").unwrap_or(text.len()));
    text
}
