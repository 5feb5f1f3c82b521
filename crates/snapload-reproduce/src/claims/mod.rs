//! What the chapter's text claims, checked. No verdict is typed in: each comes out of a computation.

mod equations;
mod near;
mod newton;
mod section_6_3;
mod section_6_4_1;
mod section_6_4_1_shape;
mod section_6_4_1_waves;
mod section_6_4_2;
mod section_6_4_3;
mod section_6_5;
mod section_6_5_1_1;
mod section_6_5_1_2;
mod section_6_5_2_1;
mod sliding;
mod sliding_story;
mod tools;

pub use tools::{ensemble, robust, spearman};

use crate::study::Study;

/// What the computation says of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The computation agrees.
    Reproduced,
    /// It disagrees.
    NotReproduced,
    /// It hangs on motion past the horizon: starts that differ by 1e-12 disagree.
    NotDecidable,
}

impl Verdict {
    /// Of a claim that either holds or does not.
    pub fn of(holds: bool) -> Self {
        if holds {
            Self::Reproduced
        } else {
            Self::NotReproduced
        }
    }

    /// As it is written in `claims.json` and in the report.
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::NotDecidable => "not decidable",
        }
    }
}

/// A claim of the chapter and what became of it.
#[derive(Clone, Debug)]
pub struct Claim {
    /// A name that stays, such as `6.4.1-03`.
    pub id: &'static str,
    /// The chapter's section.
    pub section: &'static str,
    /// The claim in our words.
    pub claim: &'static str,
    /// What the computation says.
    pub verdict: Verdict,
    /// The figures on which the verdict rests.
    pub evidence: String,
    /// Why we disagree, as far as it can be known; empty where we agree.
    pub remark: &'static str,
}

/// Checks all claims, in the chapter's order.
///
/// # Errors
/// [`snapload::CaseError`] only for a fault of the program.
pub fn claims(study: &Study) -> Result<Vec<Claim>, snapload::CaseError> {
    let sections = [
        section_6_3::claims,
        section_6_4_1::claims,
        section_6_4_2::claims,
        section_6_4_3::claims,
        section_6_5::claims,
        section_6_5_1_1::claims,
        section_6_5_1_2::claims,
        section_6_5_2_1::claims,
    ];
    let parts: Vec<Vec<Claim>> = sections
        .iter()
        .map(|section| section(study))
        .collect::<Result<_, _>>()?;
    Ok(parts.into_iter().flatten().collect())
}
