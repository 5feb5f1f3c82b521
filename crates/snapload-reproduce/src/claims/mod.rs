//! What the chapter's text claims, checked. No verdict is typed in: each comes out of a computation.

mod engine;
mod equations;
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
mod verdict;

pub use verdict::{Claim, Verdict};

use crate::study::Study;

/// Checks all claims, in the order of their names.
///
/// # Errors
/// [`snapload::CaseError`] only for a fault of the program.
pub fn claims(study: &Study) -> Result<Vec<Claim>, snapload::CaseError> {
    let tabled = runs::Tabled::new(study)?;
    let mut all = section_6_3::claims(study, &tabled)?;
    all.extend(section_6_4_1::claims(study, &tabled)?);
    all.extend(section_6_4_2::claims(study)?);
    all.extend(section_6_4_3::claims(study)?);
    all.extend(section_6_5::claims(study)?);
    all.extend(section_6_5_1_1::claims(study));
    all.extend(section_6_5_1_2::claims(study)?);
    all.extend(section_6_5_2_1::claims(study)?);
    all.sort_by_key(|claim| claim.id);
    Ok(all)
}
