//! Chapter 6 of the 1999 thesis on snap loading of moored breakwaters, reproduced: its tables,
//! figures and claims as one report.
//!
//! [`Study`] computes all runs, each once, in two readings: in the chapter's own studies a run
//! ended where it begins to slide; the actual motion continues to slide. [`Report`] writes the
//! files.

mod claims;
mod critical_row;
mod example_steps;
mod figures;
mod page;
mod proved;
mod reading;
mod sentences;
mod source;
mod study;
mod tables;
mod verdict;

pub use example_steps::taut_intervals;
pub use proved::proofs;
pub use study::Study;

use claims::Claim;

/// Why the report could not be made: an error of the program.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A figure could not be drawn.
    #[error("a figure can not be drawn: {0}")]
    Figure(#[from] snapload_figures::FigureError),
    /// A case is not legal.
    #[error("a case can not be run: {0}")]
    Case(#[from] snapload::CaseError),
    /// A run was not finished.
    #[error("a run was not finished: {0}")]
    Run(#[from] snapload::analysis::Unfinished),
    /// The list of figures can not be read.
    #[error("the list of figures can not be read: {0}")]
    List(#[from] toml::de::Error),
    /// The list of figures or the page refers to something that was not computed.
    #[error("the report refers to {0}, which was not computed")]
    Missing(String),
    /// Texts and check of a claim do not match, or a run on which it is based is missing.
    #[error("a claim can not be reported: {0}")]
    Claim(String),
}

/// The report: its page, and its data files.
#[derive(Clone, Debug)]
pub struct Report {
    /// The files, by their place below the report's directory.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Report {
    /// The report of a study.
    ///
    /// # Errors
    /// [`ReportError`] only for an error of the program.
    pub fn new(study: &Study) -> Result<Self, ReportError> {
        let rows = figures::figures(study)?;
        let mut claims = claims::claims(study)?;
        // In the chapter's order, section by section.
        claims.sort_by_key(|claim| claim.section);
        let mut files = vec![
            ("report.html".to_owned(), page::page(study, &rows, &claims)?),
            ("table-6-1.csv".to_owned(), tables::csv_6_1(study)),
            ("table-6-2.csv".to_owned(), tables::csv_6_2(study)),
            ("claims.json".to_owned(), claims_json(&claims)),
        ];
        for figure in rows.into_iter().flat_map(|row| row.figures) {
            let place = format!("figures/{}", figure.picture.name);
            files.push((format!("{place}.svg"), figure.picture.svg().to_owned()));
            files.push((format!("{place}.csv"), figure.data));
        }
        let bytes = |(place, text): (String, String)| (place, text.into_bytes());
        Ok(Self {
            files: files.into_iter().map(bytes).collect(),
        })
    }
}

/// `claims.json`: id, section, claim, verdict and evidence, which ends with our reasons where we
/// disagree.
fn claims_json(claims: &[Claim]) -> String {
    let row = |claim: &Claim| {
        let evidence = match claim.remark.as_str() {
            "" => claim.evidence.clone(),
            remark => format!("{}. {remark}", claim.evidence.trim_end_matches('.')),
        };
        serde_json::json!({
            "id": claim.id,
            "section": claim.section,
            "claim": claim.claim,
            "verdict": claim.verdict.label(),
            "evidence": evidence,
            "judged": claim.judged,
        })
    };
    let rows: serde_json::Value = claims.iter().map(row).collect();
    format!("{rows}\n")
}
