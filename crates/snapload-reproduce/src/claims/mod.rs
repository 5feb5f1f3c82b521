//! The claims of the chapter's text, checked. Every verdict is the result of a computation; none is
//! written down.
//!
//! The text of a claim and of its evidence is in `claims/*.toml` ([`texts`]); its check is in the
//! table `CHECKS` of its section here, and returns a verdict and the values for the text. To add a
//! claim, add one entry to each.

mod motions;
mod newton;
mod numbers;
mod runs;
mod section_6_3;
mod section_6_4_1;
mod section_6_4_2;
mod section_6_4_3;
mod section_6_5;
mod section_6_5_1_1;
mod section_6_5_1_2;
mod section_6_5_2_1;
mod texts;
mod verdict;

pub(crate) use numbers::ROUNDING;
pub(crate) use runs::{FEW, MANY};
pub use verdict::{Claim, Verdict};

use crate::ReportError;
use crate::study::Study;

/// Checks all claims, in the order of their names.
///
/// # Errors
/// [`ReportError`] only for an error of the program.
pub fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let table_runs = runs::TableRuns::new(study)?;
    let sections = [
        section_6_3::claims(&table_runs)?,
        section_6_4_1::claims(&table_runs)?,
        section_6_4_2::claims(study)?,
        section_6_4_3::claims(study)?,
        section_6_5::claims(study)?,
        section_6_5_1_1::claims(study)?,
        section_6_5_1_2::claims(study)?,
        section_6_5_2_1::claims(study)?,
    ];
    let mut all = sections.concat();
    all.sort_by_key(|claim| claim.id);
    texts::check_all(&all.iter().map(|claim| claim.id).collect::<Vec<_>>())?;
    Ok(all)
}
