//! Chapter 6 of the 1999 thesis on snap loading of moored breakwaters, reproduced: its tables, figures
//! and claims as one report.
//!
//! [`Study`] computes all runs, each once, in two readings: the chapter's own studies ended a run that
//! begins to slide; the motion really slides on. [`Report`] makes files of it.

pub mod claims;
mod configurations;
mod figures;
mod html;
mod source;
mod story;
mod study;
mod tables;

pub use figures::{Figure, Row, Source, figures};
pub use source::Number;
pub use story::{Step, story};
pub use study::{
    Both, CaseRuns, CriticalCurve, CriticalPoint, CriticalRow, NormCurve, Progress, Reading, Study,
};

use claims::Claim;
use snapload::CaseError;
use snapload_figures::FigureError;
use std::fmt;

/// Why the report could not be made: a fault of the program.
#[derive(Debug)]
pub enum ReportError {
    /// A figure could not be drawn.
    Figure(FigureError),
    /// A case is not legal.
    Case(CaseError),
}

impl fmt::Display for ReportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Figure(error) => write!(f, "a figure can not be drawn: {error}"),
            Self::Case(error) => write!(f, "a case can not be run: {error}"),
        }
    }
}

impl std::error::Error for ReportError {}

impl From<FigureError> for ReportError {
    fn from(error: FigureError) -> Self {
        Self::Figure(error)
    }
}

impl From<CaseError> for ReportError {
    fn from(error: CaseError) -> Self {
        Self::Case(error)
    }
}

/// The section in a claim's id: `6.4.1` of `6.4.1-03`.
fn section_of(claim: &Claim) -> &'static str {
    claim
        .id
        .rsplit_once('-')
        .map_or(claim.id, |(section, _)| section)
}

/// `claims.json`: id, section, claim, verdict and evidence, which ends with why we disagree where we do.
fn claims_json(claims: &[Claim]) -> String {
    let rows: Vec<serde_json::Value> = claims
        .iter()
        .map(|claim| {
            let evidence = [claim.evidence.as_str(), claim.remark.as_str()].join(" ");
            serde_json::json!({
                "id": claim.id,
                "section": claim.section,
                "claim": claim.claim,
                "verdict": claim.verdict.words(),
                "evidence": evidence.trim_end(),
            })
        })
        .collect();
    let mut text = serde_json::Value::from(rows).to_string();
    text.push('\n');
    text
}

/// The report: its page, and the data beside it.
#[derive(Clone, Debug)]
pub struct Report {
    /// The files, by their place below the report's directory.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Report {
    /// Of a study.
    ///
    /// # Errors
    /// [`ReportError`] only for a fault of the program.
    pub fn new(study: &Study) -> Result<Self, ReportError> {
        let rows = figures(study)?;
        let mut claims = claims::claims(study)?;
        // In the chapter's order, section by section.
        claims.sort_by_key(section_of);
        let mut files = vec![
            (
                "report.html".to_owned(),
                html::page(study, &rows, &claims).into_bytes(),
            ),
            (
                "table-6-1.csv".to_owned(),
                tables::csv_6_1(study).into_bytes(),
            ),
            (
                "table-6-2.csv".to_owned(),
                tables::csv_6_2(study).into_bytes(),
            ),
        ];
        files.push(("claims.json".to_owned(), claims_json(&claims).into_bytes()));
        for figure in rows.iter().flat_map(|row| &row.figures) {
            let place = format!("figures/{}", figure.picture.name);
            files.push((
                format!("{place}.svg"),
                figure.picture.svg().as_bytes().to_vec(),
            ));
            files.push((format!("{place}.csv"), figure.data.clone().into_bytes()));
        }
        Ok(Self { files })
    }
}
