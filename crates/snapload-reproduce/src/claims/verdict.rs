//! The findings of checks, and claims with their verdicts.

use super::texts::{Value, with_texts};
use crate::ReportError;
pub use crate::verdict::Verdict;
use std::collections::BTreeMap;

/// The finding of a claim's check: the verdict, the values for the claim's text, and whether the
/// conditions of its remarks hold.
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

    /// The finding on a statement that either holds or does not.
    pub(super) fn of(holds: bool) -> Self {
        Self::new(Verdict::of(holds))
    }

    /// The finding on a statement about a number of each member of an ensemble, with those numbers
    /// as a value.
    pub(super) fn measured(
        name: &'static str,
        members: impl IntoIterator<Item = f64>,
        holds: impl Fn(f64) -> bool,
    ) -> Self {
        let members: Vec<f64> = members.into_iter().collect();
        Self::robust(&members, |member| holds(*member)).list(name, members)
    }

    /// The finding on a statement about each member of an ensemble.
    pub(super) fn robust<T>(members: &[T], holds: impl Fn(&T) -> bool) -> Self {
        Self::new(Verdict::robust(members.iter().map(holds)))
    }

    /// Adds a value for the place of this name in the text.
    pub(super) fn value(mut self, name: &'static str, value: impl Into<Value>) -> Self {
        self.values.insert(name, value.into());
        self
    }

    /// Adds values for several places, whose names are separated by blanks.
    pub(super) fn values<T: Into<Value>, const N: usize>(
        self,
        names: &'static str,
        values: [T; N],
    ) -> Self {
        let pairs = names.split(' ').zip(values);
        pairs.fold(self, |finding, (name, value)| finding.value(name, value))
    }

    /// Adds numbers, as one list for each start: each number is shown as it is if all starts agree
    /// to the digits that its place shows, and otherwise as a range from the least to the greatest.
    pub(super) fn by_start<I>(self, name: &'static str, starts: impl IntoIterator<Item = I>) -> Self
    where
        I: IntoIterator<Item = f64>,
    {
        let starts = starts.into_iter().map(|list| list.into_iter().collect());
        self.value(name, Value::ByStart(starts.collect()))
    }

    /// Adds several numbers for one place.
    pub(super) fn list(self, name: &'static str, list: impl IntoIterator<Item = f64>) -> Self {
        self.value(name, Value::Numbers(list.into_iter().collect()))
    }

    /// Says whether the condition of the remark of this name holds.
    pub(super) fn condition(mut self, name: &'static str, holds: bool) -> Self {
        self.conditions.insert(name, holds);
        self
    }
}

/// The answer of a check.
pub(super) type Checked = Result<Finding, ReportError>;

/// Checks of the kind `F`, each with the id of its claim.
pub(super) type Checks<F> = [(&'static str, F)];

/// A check whose evidence is the material `M`.
type Check<M> = fn(&M) -> Checked;

/// Runs the checks of a section, which may be in several tables.
pub(super) fn run_checks<M: ?Sized>(
    tables: &[&Checks<Check<M>>],
    material: &M,
) -> Result<Vec<Claim>, ReportError> {
    let checks = tables.iter().flat_map(|checks| checks.iter());
    checks
        .map(|(id, check)| with_texts(id, &check(material)?))
        .collect()
}

/// A claim of the chapter with its verdict.
#[derive(Clone, Debug)]
pub struct Claim {
    /// A permanent name, such as `6.4.1-03`.
    pub id: &'static str,
    /// The chapter's section.
    pub section: &'static str,
    /// The claim in our words.
    pub claim: &'static str,
    /// The verdict of the computation.
    pub verdict: Verdict,
    /// The numbers on which the verdict is based.
    pub evidence: String,
    /// The measure, threshold and range of the judgement, where these are a choice.
    pub judged: String,
    /// Why we disagree, if that is known; empty where we agree.
    pub remark: String,
}
