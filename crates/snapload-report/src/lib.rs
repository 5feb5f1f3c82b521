//! Reports on a run, in words for people and in JSON for programs: the same on the command line and
//! in Python.

mod caption;
mod case_file;
mod certified;
mod critical;
mod digits;
mod motion;
mod question;
mod quoting;
mod report;
mod run_with_horizon;
mod run_with_trust;
mod sensitivities;
mod summary;
pub mod tables;
mod trust;
mod verified;

pub use caption::{case_as_written, case_in_words, case_without};
pub use case_file::{case_file, python_lines, shell_line};
pub use certified::{
    CertificateRow, Certified, Departure, Differs, nearest, prove, proved_in_words,
};
pub use critical::{CriticalRow, Probability};
pub use motion::{MOTION, MotionRow};
pub use question::{Answer, Options, Question, TOLERANCE};
pub use quoting::{python_text, shell_command};
pub use report::{CaseEcho, EndRow, NormsRow, Report, ValueRow, write_json};
pub use run_with_horizon::RunWithHorizon;
pub use run_with_trust::{RunWithTrust, neighbours, outcome_in_words, percent, trust_in_words};
pub use summary::{NormsKnown, accumulation_in_words, end_in_words, summary, summary_lines};
pub use trust::{HorizonRow, OutcomeRow, ShareRow, TrustRow};

/// All questions about one case, in the order in which help lists them.
pub static QUESTIONS: &[Question] = &[verified::VERIFY, sensitivities::SENSITIVITIES];

/// The question of a name; none where there is none.
pub fn question(name: &str) -> Option<&'static Question> {
    QUESTIONS.iter().find(|question| question.name == name)
}
