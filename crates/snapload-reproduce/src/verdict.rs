//! Verdicts, and their combination.

use serde::Deserialize;

/// The verdict of the computation on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The computation agrees.
    Reproduced,
    /// It disagrees.
    NotReproduced,
    /// The claim is about several families of cases, and holds for some of them but not for others.
    Mixed,
    /// It depends on motion past the horizon: starts that differ by 1e-12 disagree.
    NotDecidable,
}

impl Verdict {
    /// The verdict on a statement that either holds or does not.
    pub(crate) fn of(holds: bool) -> Self {
        if holds {
            Self::Reproduced
        } else {
            Self::NotReproduced
        }
    }

    /// The verdict on a statement that holds for all, none, or some members of an ensemble. Without
    /// members nothing is shown.
    pub(crate) fn robust(members: impl IntoIterator<Item = bool>) -> Self {
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

    /// The verdict on a statement that holds if all its parts do. One part that certainly fails
    /// decides it; without parts nothing is shown.
    pub(crate) fn all(parts: impl IntoIterator<Item = Self>) -> Self {
        let worst = [Self::NotReproduced, Self::Mixed, Self::NotDecidable];
        Self::first_of(worst, parts).unwrap_or(Self::Reproduced)
    }

    /// The verdict on a statement that holds if one of its parts does.
    pub(crate) fn any(parts: impl IntoIterator<Item = Self>) -> Self {
        let best = [Self::Reproduced, Self::Mixed, Self::NotDecidable];
        Self::first_of(best, parts).unwrap_or(Self::NotReproduced)
    }

    /// The verdict on a statement about several families of cases, or with several interpretations:
    /// mixed if it holds for one and fails for another.
    pub(crate) fn families(parts: impl IntoIterator<Item = Self>) -> Self {
        let parts: Vec<Self> = parts.into_iter().collect();
        let both = [Self::Reproduced, Self::NotReproduced];
        if both.iter().all(|verdict| parts.contains(verdict)) {
            Self::Mixed
        } else {
            Self::all(parts)
        }
    }

    /// The first of three verdicts, in this order, that is among some; for none the first of all.
    fn first_of(order: [Self; 3], parts: impl IntoIterator<Item = Self>) -> Option<Self> {
        let parts: Vec<Self> = parts.into_iter().collect();
        if parts.is_empty() {
            return Some(Self::NotReproduced);
        }
        order.into_iter().find(|verdict| parts.contains(verdict))
    }

    /// The number of verdicts equal to this one.
    pub(crate) fn count(self, verdicts: impl IntoIterator<Item = Self>) -> usize {
        verdicts
            .into_iter()
            .filter(|verdict| *verdict == self)
            .count()
    }

    /// Its text in `claims.json` and in the report.
    pub fn label(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::Mixed => "mixed",
            Self::NotDecidable => "not decidable",
        }
    }
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
