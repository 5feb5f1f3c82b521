//! Chapter 6 of the 1999 thesis on snap loading of moored breakwaters, reproduced: its tables and
//! figures as one report.
//!
//! [`Study`] computes all runs, each once, in two readings: the chapter's own studies ended a run that
//! begins to slide; the motion really slides on. [`Report`] makes files of it.

pub mod claims;
mod configurations;
mod figures;
mod html;
mod story;
mod study;
mod tables;

pub use figures::{Figure, Row, figures};
pub use story::story;
pub use study::{
    Both, CaseRuns, CriticalCurve, CriticalPoint, CriticalRow, NormCurve, Progress, Reading, Study,
};

use snapload_figures::FigureError;

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
    /// [`FigureError`] only for a fault of the program.
    pub fn new(study: &Study) -> Result<Self, FigureError> {
        let rows = figures(study)?;
        let mut files = vec![
            (
                "report.html".to_owned(),
                html::page(study, &rows).into_bytes(),
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
