//! How far deviations have grown along a motion, and what rounding may have decided by that.

/// Beyond this growth roundings may have come to the digits that are printed of the time of a stop:
/// that of 1e-16 at one step to 1e-6, and there is one at each.
const KNOWN: f64 = 1e10;

/// The growth of deviations along a motion, as far as they grow smoothly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Growth {
    /// ln of the factor by which they have grown at the end, the largest since any earlier time.
    at_end: f64,
    /// The largest value of it along the motion.
    most: f64,
}

impl Growth {
    /// Follows one more step, which magnifies deviations by this factor, as its logarithm.
    pub(crate) fn follow(&mut self, magnified: f64) {
        self.at_end = (self.at_end + magnified).max(0.0);
        self.most = self.most.max(self.at_end);
    }

    /// Whether the end is known in spite of rounding.
    pub fn end_is_known(self) -> bool {
        self.at_end < KNOWN.ln()
    }

    /// Whether the whole motion is. Deviations that have grown may fall again on an attractor,
    /// which then has been chosen by rounding.
    pub fn whole_is_known(self) -> bool {
        self.most < KNOWN.ln()
    }
}

#[cfg(test)]
mod tests {
    use super::Growth;

    /// A motion that is chaotic for a while and then comes to an orbit forgets how it came there,
    /// but not that rounding has chosen the orbit.
    #[test]
    fn what_has_grown_and_fallen_is_known_at_the_end_alone() {
        let mut growth = Growth::default();
        for magnified in [12.0, 12.0, -20.0, -20.0] {
            growth.follow(magnified);
        }
        assert!(growth.end_is_known() && !growth.whole_is_known());
    }
}
