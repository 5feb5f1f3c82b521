//! Verdicts, how they combine, and claims with what was found of them.

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
    /// Of a statement that either holds or does not.
    pub(super) fn of(holds: bool) -> Self {
        if holds {
            Self::Reproduced
        } else {
            Self::NotReproduced
        }
    }

    /// Of a statement that holds for some members of an ensemble: all, none, or neither. Without members
    /// nothing was shown.
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

    /// Of a statement that holds if all its parts do. One part that surely fails decides it; without
    /// parts nothing was shown.
    pub(super) fn all(parts: impl IntoIterator<Item = Self>) -> Self {
        let worse = |p, q| match (p, q) {
            (Self::Reproduced, Self::Reproduced) => Self::Reproduced,
            (Self::NotReproduced, _) | (_, Self::NotReproduced) => Self::NotReproduced,
            _ => Self::NotDecidable,
        };
        parts
            .into_iter()
            .reduce(worse)
            .unwrap_or(Self::NotReproduced)
    }

    /// Of a statement that holds if one of its parts does.
    pub(super) fn any(parts: impl IntoIterator<Item = Self>) -> Self {
        let better = |p, q| match (p, q) {
            (Self::Reproduced, _) | (_, Self::Reproduced) => Self::Reproduced,
            (Self::NotReproduced, Self::NotReproduced) => Self::NotReproduced,
            _ => Self::NotDecidable,
        };
        parts
            .into_iter()
            .reduce(better)
            .unwrap_or(Self::NotReproduced)
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

/// What was found of a claim.
#[derive(Clone, Debug)]
pub(super) struct Finding {
    pub(super) verdict: Verdict,
    evidence: String,
    remark: String,
}

impl Finding {
    /// A verdict and the figures on which it rests.
    pub(super) fn new(verdict: Verdict, evidence: impl Into<String>) -> Self {
        Self {
            verdict,
            evidence: evidence.into(),
            remark: String::new(),
        }
    }

    /// Adds why we disagree. It stands only beside the verdict that it explains, and only where the
    /// computation found what it says; so it can not outlive the figures from which it was written.
    pub(super) fn because(mut self, explains: Verdict, found: bool, why: impl AsRef<str>) -> Self {
        if self.verdict == explains && found {
            if !self.remark.is_empty() {
                self.remark.push(' ');
            }
            self.remark.push_str(why.as_ref());
        }
        self
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
    pub remark: String,
}

/// A claim with what was found; its section is the head of its id.
pub(super) fn claim(id: &'static str, claim: &'static str, finding: Finding) -> Claim {
    Claim {
        id,
        section: id.rsplit_once('-').map_or(id, |(section, _)| section),
        claim,
        verdict: finding.verdict,
        evidence: finding.evidence,
        remark: finding.remark,
    }
}

#[cfg(test)]
mod tests {
    use super::Verdict::{NotDecidable, NotReproduced, Reproduced};
    use super::*;

    const ALL: [Verdict; 3] = [Reproduced, NotReproduced, NotDecidable];

    fn opposite(verdict: Verdict) -> Verdict {
        match verdict {
            Reproduced => NotReproduced,
            NotReproduced => Reproduced,
            NotDecidable => NotDecidable,
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
    fn nothing_looked_at_shows_nothing() {
        assert_eq!(Verdict::robust([]), NotReproduced);
        assert_eq!(Verdict::all([]), NotReproduced);
        assert_eq!(Verdict::any([]), NotReproduced);
    }

    #[test]
    fn a_reason_stands_only_beside_the_verdict_that_it_explains() {
        for verdict in ALL {
            let found = Finding::new(verdict, "1 of 2")
                .because(NotReproduced, true, "one fails")
                .because(NotReproduced, false, "it rains")
                .because(NotDecidable, true, "by chance");
            let claim = claim("6.4.1-03", "both hold", found);
            let remark = match verdict {
                Reproduced => "",
                NotReproduced => "one fails",
                NotDecidable => "by chance",
            };
            assert_eq!((claim.section, &*claim.remark), ("6.4.1", remark));
        }
    }
}
