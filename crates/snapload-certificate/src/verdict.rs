//! How a proof can fail.

/// Why a proof does not go on.
#[derive(Clone, Debug)]
pub(crate) enum Trouble {
    /// Something has no sign with so many bits.
    Undecided {
        /// What, in words.
        what: String,
        /// Next to when.
        t: Option<f64>,
        /// Whether more bits may decide it.
        more_bits: bool,
    },
    /// The model has no such motion, or what is claimed of it is false.
    False(String),
    /// All that was asked for is proved, and more than that is not wanted.
    Enough,
    /// Whoever waits for it has had enough.
    Cancelled,
}

impl Trouble {
    /// Something has no sign, at a time yet to be told.
    pub(crate) fn undecided(what: impl Into<String>) -> Self {
        Self::Undecided {
            what: what.into(),
            t: None,
            more_bits: true,
        }
    }

    /// Something that this program has no proof of, with any bits.
    pub(crate) fn beyond(what: impl Into<String>) -> Self {
        Self::Undecided {
            what: what.into(),
            t: None,
            more_bits: false,
        }
    }

    /// The same with the time, where it is not known yet.
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

/// So many limbs of 64 bits does a proof begin with, and so many has it at most: 2944 bits.
pub(crate) const FIRST_LIMBS: usize = 4;
pub(crate) const MOST_LIMBS: usize = 46;

/// Tries with more and more bits, each time a third more, while something stays undecided.
pub(crate) fn with_more_bits<T>(
    first: usize,
    mut attempt: impl FnMut(usize) -> Result<T, Trouble>,
) -> Result<(T, usize), Trouble> {
    let mut limbs = first.clamp(2, MOST_LIMBS);
    loop {
        match attempt(limbs) {
            Err(Trouble::Undecided {
                more_bits: true, ..
            }) if limbs < MOST_LIMBS => {
                limbs = (limbs * 4).div_ceil(3).min(MOST_LIMBS);
            }
            result => return result.map(|found| (found, limbs)),
        }
    }
}
