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

/// Tries with more and more bits, each time a third more, as long as something stays undecided.
pub(crate) fn with_more_bits<T>(
    first: usize,
    mut attempt: impl FnMut(usize) -> Result<T, ProofFailure>,
) -> Result<(T, usize), ProofFailure> {
    let mut limbs = first.clamp(2, MOST_LIMBS);
    loop {
        match attempt(limbs) {
            Err(ProofFailure::Undecided {
                more_bits: true, ..
            }) if limbs < MOST_LIMBS => {
                limbs = (limbs * 4).div_ceil(3).min(MOST_LIMBS);
            }
            result => return result.map(|found| (found, limbs)),
        }
    }
}
