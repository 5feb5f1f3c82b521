//! How a proof can fail.

/// Why a proof does not go on.
#[derive(Clone, Debug)]
pub(crate) enum ProofFailure {
    /// A quantity's sign stays undecided with this number of bits.
    Undecided {
        /// The quantity, in words.
        what: String,
        /// The approximate time.
        t: Option<f64>,
        /// Whether more bits may decide it.
        more_bits: bool,
    },
    /// The model has no such motion, or a claim about it is false.
    Refuted(String),
    /// All that was requested is proved, and the proof is stopped.
    StoppedEarly,
    /// The caller cancelled the work.
    Cancelled,
}

impl ProofFailure {
    /// A quantity's sign is undecided; the time is added later.
    pub(crate) fn undecided(what: impl Into<String>) -> Self {
        Self::Undecided {
            what: what.into(),
            t: None,
            more_bits: true,
        }
    }

    /// This program has no proof of it, with any number of bits.
    pub(crate) fn not_covered(what: impl Into<String>) -> Self {
        Self::Undecided {
            what: what.into(),
            t: None,
            more_bits: false,
        }
    }

    /// The approximate time up to which nothing else was undecided, if it is known.
    fn time(&self) -> Option<f64> {
        match self {
            Self::Undecided { t, .. } => *t,
            _ => None,
        }
    }

    /// The same with the time, if it has none yet.
    pub(crate) fn at(self, time: f64) -> Self {
        match self {
            Self::Undecided { what, t, more_bits } => Self::Undecided {
                what,
                t: t.or(Some(time)),
                more_bits,
            },
            other => other,
        }
    }
}

/// A proof begins with this many limbs of 64 bits, and has at most `MOST_LIMBS`, which is 2944
/// bits.
pub(crate) const FIRST_LIMBS: usize = 4;
pub(crate) const MOST_LIMBS: usize = 46;

/// Tries with more and more bits, each time a third more, as long as something stays undecided. If
/// it stays so, the failure is that of the attempt that came farthest: it need not be the last one,
/// as coefficients of high orders can be larger than the doubles in which they are bounded.
pub(crate) fn with_more_bits<T>(
    first: usize,
    mut attempt: impl FnMut(usize) -> Result<T, ProofFailure>,
) -> Result<(T, usize), ProofFailure> {
    let mut limbs = first.clamp(2, MOST_LIMBS);
    let mut farthest: Option<ProofFailure> = None;
    loop {
        let result = attempt(limbs);
        let Err(failure @ ProofFailure::Undecided { more_bits, .. }) = result else {
            return result.map(|found| (found, limbs));
        };
        let farther = farthest.filter(|known| known.time() > failure.time());
        if !more_bits || limbs == MOST_LIMBS {
            return Err(farther.unwrap_or(failure));
        }
        farthest = farther.or(Some(failure));
        limbs = (limbs * 4).div_ceil(3).min(MOST_LIMBS);
    }
}

#[cfg(test)]
mod tests {
    use super::{ProofFailure, with_more_bits};

    #[test]
    fn the_failure_is_that_of_the_attempt_that_came_farthest() {
        for (times, farthest) in [
            ([0.5, 0.75, 0.6], 1),
            ([0.5, 0.5, 0.5], 2),
            ([0.5, 0.6, 0.75], 2),
        ] {
            let mut attempts = 0;
            let result = with_more_bits::<()>(4, |_| {
                let (nth, last) = (attempts, attempts + 1 == times.len());
                attempts += 1;
                let what = format!("attempt {nth}");
                Err(match last {
                    true => ProofFailure::not_covered(what),
                    false => ProofFailure::undecided(what),
                }
                .at(times[nth]))
            });
            let Err(ProofFailure::Undecided { what, t, .. }) = result else {
                panic!("{result:?}");
            };
            assert_eq!(
                (what, t),
                (format!("attempt {farthest}"), Some(times[farthest]))
            );
        }
    }
}
