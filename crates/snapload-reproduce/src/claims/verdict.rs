//! Verdicts, how they combine, and claims with what was found of them.

use super::words::{Value, tell};
use crate::ReportError;
use serde::Deserialize;
use std::collections::BTreeMap;

/// What the computation says of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The computation agrees.
    Reproduced,
    /// It disagrees.
    NotReproduced,
    /// It speaks of several families of cases, holds for some of them and fails for others.
    Mixed,
    /// It hangs on motion past the horizon: starts that differ by 1e-12 disagree.
    NotDecidable,
}

impl Verdict {
    /// Of a statement that either holds or does not.
    pub(super) fn of(holds: bool) -> Self {
        if holds {
            Self::Reproduced
        } else {
            Self::NotReproduced
        }
    }

    /// Of a statement that holds for some members of an ensemble: all, none, or neither. Without
    /// members nothing was shown.
    pub(super) fn robust(members: impl IntoIterator<Item = bool>) -> Self {
        let (mut yes, mut no) = (false, false);
        for holds in members {
            yes |= holds;
            no |= !holds;
        }
        match (yes, no) {
            (true, false) => Self::Reproduced,
            (true, true) => Self::NotDecidable,
            _ => Self::NotReproduced,
        }
    }

    /// Of a statement that holds if all its parts do. One part that surely fails decides it;
    /// without parts nothing was shown.
    pub(super) fn all(parts: impl IntoIterator<Item = Self>) -> Self {
        let worst = [Self::NotReproduced, Self::Mixed, Self::NotDecidable];
        Self::first_of(worst, parts).unwrap_or(Self::Reproduced)
    }

    /// Of a statement that holds if one of its parts does.
    pub(super) fn any(parts: impl IntoIterator<Item = Self>) -> Self {
        let best = [Self::Reproduced, Self::Mixed, Self::NotDecidable];
        Self::first_of(best, parts).unwrap_or(Self::NotReproduced)
    }

    /// Of a statement that speaks of several families of cases, or that can be taken in several
    /// ways: mixed where it holds for one and fails for another.
    pub(super) fn families(parts: impl IntoIterator<Item = Self>) -> Self {
        let parts: Vec<Self> = parts.into_iter().collect();
        let both = [Self::Reproduced, Self::NotReproduced];
        if both.iter().all(|verdict| parts.contains(verdict)) {
            Self::Mixed
        } else {
            Self::all(parts)
        }
    }

    /// The first of three verdicts that is among some; the first of all of none.
    fn first_of(order: [Self; 3], parts: impl IntoIterator<Item = Self>) -> Option<Self> {
        let parts: Vec<Self> = parts.into_iter().collect();
        if parts.is_empty() {
            return Some(Self::NotReproduced);
        }
        order.into_iter().find(|verdict| parts.contains(verdict))
    }

    /// How many came to this verdict.
    pub(super) fn count(self, verdicts: impl IntoIterator<Item = Self>) -> usize {
        verdicts
            .into_iter()
            .filter(|verdict| *verdict == self)
            .count()
    }

    /// As it is written in `claims.json` and in the report.
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::Mixed => "mixed",
            Self::NotDecidable => "not decidable",
        }
    }
}

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

#[cfg(test)]
mod tests {
    use super::Verdict::{Mixed, NotDecidable, NotReproduced, Reproduced};
    use super::*;

    const ALL: [Verdict; 4] = [Reproduced, NotReproduced, Mixed, NotDecidable];

    fn opposite(verdict: Verdict) -> Verdict {
        match verdict {
            Reproduced => NotReproduced,
            NotReproduced => Reproduced,
            neither => neither,
        }
    }

    #[test]
    fn the_negation_of_a_statement_gets_the_opposite_verdict() {
        for members in [&[true, true][..], &[false], &[true, false], &[false, true]] {
            let negated = members.iter().map(|holds| !holds);
            let verdict = Verdict::robust(members.iter().copied());
            assert_eq!(Verdict::robust(negated), opposite(verdict), "{members:?}");
        }
        assert_eq!(Verdict::of(false), opposite(Verdict::of(true)));
    }

    #[test]
    fn a_false_statement_is_not_reproduced() {
        assert_eq!(Verdict::of(false), NotReproduced);
        assert_eq!(Verdict::robust([false, false]), NotReproduced);
        assert_eq!(Verdict::robust([true, false]), NotDecidable);
        assert_eq!(Verdict::robust([true, true]), Reproduced);
    }

    #[test]
    fn one_failing_part_decides_all_and_one_that_holds_decides_any() {
        for part in ALL {
            assert_eq!(Verdict::all([part, NotReproduced]), NotReproduced);
            assert_eq!(Verdict::all([Reproduced, part]), part);
            assert_eq!(Verdict::any([part, Reproduced]), Reproduced);
            assert_eq!(Verdict::any([NotReproduced, part]), part);
            for other in ALL {
                // not (p and q) = not p or not q
                assert_eq!(
                    opposite(Verdict::all([part, other])),
                    Verdict::any([part, other].map(opposite))
                );
            }
        }
    }

    #[test]
    fn what_holds_for_some_families_and_fails_for_others_is_mixed() {
        let families = |parts: &[Verdict]| Verdict::families(parts.iter().copied());
        assert_eq!(families(&[Reproduced, NotReproduced]), Mixed);
        assert_eq!(families(&[NotDecidable, NotReproduced, Reproduced]), Mixed);
        assert_eq!(families(&[Reproduced, Reproduced]), Reproduced);
        assert_eq!(families(&[NotReproduced]), NotReproduced);
        assert_eq!(families(&[Reproduced, NotDecidable]), NotDecidable);
        assert_eq!(families(&[]), NotReproduced);
    }

    #[test]
    fn nothing_looked_at_shows_nothing() {
        assert_eq!(Verdict::robust([]), NotReproduced);
        assert_eq!(Verdict::all([]), NotReproduced);
        assert_eq!(Verdict::any([]), NotReproduced);
    }
}
