//! The mode of motion: which cables are taut.

/// The most cables that one system may have.
pub const MAX_CABLES: usize = 16;

/// One number a cable.
pub type PerCable<T> = [T; MAX_CABLES];

/// A set of cables, by index from 0; the set of taut cables is the mode of motion: empty is slack
/// flight, one cable is sliding, two are rocking.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct TautSet(u16);

/// The mode of motion by the number of taut cables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// No cable is taut: the body flies freely.
    Slack,
    /// One is taut: the body slides along a circle about its anchor.
    Sliding,
    /// Two or more are taut: the body rocks.
    Rocking,
}

impl Mode {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Slack, Self::Sliding, Self::Rocking];

    /// Its name, in files and for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Slack => "slack",
            Self::Sliding => "sliding",
            Self::Rocking => "rocking",
        }
    }
}

/// The bit of a cable; zero for an index that no system can have.
const fn bit(cable: usize) -> u16 {
    if cable < MAX_CABLES { 1 << cable } else { 0 }
}

impl TautSet {
    /// No cable: slack flight.
    pub const SLACK: Self = Self(0);

    /// The set of one cable.
    pub fn only(cable: usize) -> Self {
        Self(bit(cable))
    }

    /// The set as a number, one bit a cable.
    pub(crate) fn bits(self) -> u16 {
        self.0
    }

    /// The set that is this number.
    pub(crate) fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// Whether the cable is in the set.
    pub fn contains(self, cable: usize) -> bool {
        self.0 & bit(cable) != 0
    }

    /// The set with the cable added.
    #[must_use]
    pub fn with(self, cable: usize) -> Self {
        self.union(Self::only(cable))
    }

    /// The set with the cable taken out.
    #[must_use]
    pub fn without(self, cable: usize) -> Self {
        Self(self.0 & !bit(cable))
    }

    /// Cables of either set.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Cables of both sets.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// How many cables.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether no cable is in it.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The cables, by rising index.
    pub fn iter(self) -> impl Iterator<Item = usize> + Clone {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let cable = rest.trailing_zeros() as usize;
            rest &= rest.checked_sub(1)?;
            Some(cable)
        })
    }

    /// Every subset, the empty one first and the set itself last.
    pub fn subsets(self) -> impl Iterator<Item = Self> {
        let full = self.0;
        let mut next = Some(0u16);
        std::iter::from_fn(move || {
            let this = next?;
            next = (this != full).then(|| (this.wrapping_sub(full)) & full);
            Some(Self(this))
        })
    }

    /// The mode of motion in which these cables are taut.
    pub fn mode(self) -> Mode {
        match self.len() {
            0 => Mode::Slack,
            1 => Mode::Sliding,
            _ => Mode::Rocking,
        }
    }
}

impl FromIterator<usize> for TautSet {
    fn from_iter<I: IntoIterator<Item = usize>>(cables: I) -> Self {
        cables.into_iter().fold(Self::SLACK, Self::with)
    }
}

#[cfg(test)]
mod tests {
    use super::TautSet;

    #[test]
    fn subsets_are_complete_and_ordered() {
        let set: TautSet = [0, 2, 5].into_iter().collect();
        let all: Vec<_> = set.subsets().collect();
        assert_eq!(all.len(), 8);
        assert_eq!(all[0], TautSet::SLACK);
        assert_eq!(all[7], set);
        assert!(all.iter().all(|s| s.intersection(set) == *s));
        assert_eq!(TautSet::SLACK.subsets().count(), 1);
    }
}
