//! What is found of claims, and claims with their verdicts.

use super::words::{Value, tell};
use crate::ReportError;
pub use crate::verdict::Verdict;
use std::collections::BTreeMap;

/// What the judge of a claim found: the verdict, the values that the claim's words tell, and
/// whether that is so on which a remark hangs.
#[derive(Clone, Debug)]
pub(super) struct Finding {
    pub(super) verdict: Verdict,
    pub(super) values: BTreeMap<&'static str, Value>,
    pub(super) conditions: BTreeMap<&'static str, bool>,
}

impl Finding {
    pub(super) fn new(verdict: Verdict) -> Self {
        Self {
            verdict,
            values: BTreeMap::new(),
            conditions: BTreeMap::new(),
        }
    }

    /// Of a statement that either holds or does not.
    pub(super) fn of(holds: bool) -> Self {
        Self::new(Verdict::of(holds))
    }

    /// Of a statement on a number that each member of an ensemble has. Gives those numbers, too.
    pub(super) fn measured(
        name: &'static str,
        members: impl IntoIterator<Item = f64>,
        holds: impl Fn(f64) -> bool,
    ) -> Self {
        let members: Vec<f64> = members.into_iter().collect();
        Self::robust(&members, |member| holds(*member)).list(name, members)
    }

    /// Of a statement that is asked of each member of an ensemble.
    pub(super) fn robust<T>(members: &[T], holds: impl Fn(&T) -> bool) -> Self {
        Self::new(Verdict::robust(members.iter().map(holds)))
    }

    /// Gives a value for the place of this name.
    pub(super) fn value(mut self, name: &'static str, value: impl Into<Value>) -> Self {
        self.values.insert(name, value.into());
        self
    }

    /// Gives values for several places, whose names are apart by blanks.
    pub(super) fn values<T: Into<Value>, const N: usize>(
        self,
        names: &'static str,
        values: [T; N],
    ) -> Self {
        let pairs = names.split(' ').zip(values);
        pairs.fold(self, |finding, (name, value)| finding.value(name, value))
    }

    /// Gives numbers of which there is one list by start: each is told as it is where all starts
    /// agree on the digits that its place asks for, and else from the least to the greatest.
    pub(super) fn by_start<I>(self, name: &'static str, starts: impl IntoIterator<Item = I>) -> Self
    where
        I: IntoIterator<Item = f64>,
    {
        let starts = starts.into_iter().map(|list| list.into_iter().collect());
        self.value(name, Value::ByStart(starts.collect()))
    }

    /// Gives several numbers for one place.
    pub(super) fn list(self, name: &'static str, list: impl IntoIterator<Item = f64>) -> Self {
        self.value(name, Value::Numbers(list.into_iter().collect()))
    }

    /// Decides whether that is so on which the remark of this name hangs.
    pub(super) fn found(mut self, name: &'static str, holds: bool) -> Self {
        self.conditions.insert(name, holds);
        self
    }
}

/// What a judge answers.
pub(super) type Judged = Result<Finding, ReportError>;

/// Judges of the kind `F`, each with the id of its claim.
pub(super) type Judges<F> = [(&'static str, F)];

/// A judge that rests on the material `M`.
type Judge<M> = fn(&M) -> Judged;

/// Asks the judges of a section, which may stand in several tables.
pub(super) fn ask<M: ?Sized>(
    tables: &[&Judges<Judge<M>>],
    material: &M,
) -> Result<Vec<Claim>, ReportError> {
    let judges = tables.iter().flat_map(|judges| judges.iter());
    judges
        .map(|(id, judge)| tell(id, &judge(material)?))
        .collect()
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
    /// By which measure, threshold and range, where that is a choice.
    pub judged: String,
    /// Why we disagree, as far as it can be known; empty where we agree.
    pub remark: String,
}
