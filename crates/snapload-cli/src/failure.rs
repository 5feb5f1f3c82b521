//! How a command fails: its message and its exit status.
use crate::standard_output::standard_output;
use snapload::CaseError;
use snapload::analysis::{Cancelled, Unfinished};
use snapload_study::StudyError;
pub(crate) use snapload_study::without_number;
use std::fmt::Display;
use std::io::{self, ErrorKind, StdoutLock, Write};
use std::path::Path;

/// Why a command did not succeed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The request is not possible: exit status 2.
    BadInput(String),
    /// Something failed during the work: exit status 1.
    Failed(String),
    /// It was interrupted, and stopped: exit status 130.
    Interrupted(String),
    /// The reader of our output closed the pipe, which is not a failure.
    OutputClosed,
    /// The exit status is the answer, which was also printed.
    ExitStatus(u8),
}

impl Failure {
    /// A request that is not possible.
    pub(crate) fn bad_input(message: impl Display) -> Self {
        Self::BadInput(message.to_string())
    }

    /// The same with its place or subject before the message.
    pub(crate) fn with_prefix(self, prefix: &str) -> Self {
        let before = |words: String| format!("{prefix}: {words}");
        match self {
            Self::BadInput(words) => Self::BadInput(before(words)),
            Self::Failed(words) => Self::Failed(before(words)),
            Self::Interrupted(words) => Self::Interrupted(before(words)),
            Self::OutputClosed => Self::OutputClosed,
            Self::ExitStatus(status) => Self::ExitStatus(status),
        }
    }

    /// Output that could not be written.
    pub(crate) fn write(place: impl Display, error: &io::Error) -> Self {
        match error.kind() {
            ErrorKind::BrokenPipe => Self::OutputClosed,
            _ => Self::Failed(format!("can not write {place}: {}", without_number(error))),
        }
    }

    /// A path for output to which nothing can be written.
    pub(crate) fn cannot_write_to(path: &Path, error: &io::Error) -> Self {
        Self::BadInput(format!(
            "can not write to {}: {}",
            path.display(),
            without_number(error)
        ))
    }
}

impl From<CaseError> for Failure {
    fn from(error: CaseError) -> Self {
        Self::bad_input(error)
    }
}

impl From<Cancelled> for Failure {
    fn from(_: Cancelled) -> Self {
        Self::Interrupted("nothing was written".to_owned())
    }
}

impl From<Unfinished> for Failure {
    fn from(unfinished: Unfinished) -> Self {
        match unfinished {
            Unfinished::Case(error) => Self::bad_input(error),
            Unfinished::Cancelled(cancelled) => cancelled.into(),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Failed(message) => Self::Failed(message),
            StudyError::Damaged { .. } => Self::Failed(error.to_string()),
            StudyError::Cancelled(cancelled) => cancelled.into(),
            other => Self::bad_input(other),
        }
    }
}

/// Prints the error on standard error, and chooses the exit status.
pub(crate) fn exit_status(result: Result<(), Failure>) -> u8 {
    let (kind, message, status) = match result {
        Ok(()) | Err(Failure::OutputClosed) => return 0,
        Err(Failure::ExitStatus(status)) => return status,
        Err(Failure::BadInput(message)) => ("error", message, 2),
        Err(Failure::Failed(message)) => ("error", message, 1),
        Err(Failure::Interrupted(message)) => ("interrupted", message, 130),
    };
    // Standard error may be closed too; the exit status is still returned.
    let _ = writeln!(io::stderr(), "{kind}: {message}");
    status
}

/// Writes text to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let write = |mut out: StdoutLock| out.write_all(text.as_bytes()).and_then(|()| out.flush());
    standard_output()
        .and_then(write)
        .map_err(|error| Failure::write("standard output", &error))
}
