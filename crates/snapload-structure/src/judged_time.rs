//! How much of the waves a run judges, and whether that tells that nothing fails.

use crate::structure::{Structure, THREE_HOURS_S, Water};

/// If no line breaks in so many times three hours, one breaks in three hours with a probability
/// below a tenth, whatever the distribution, with 97.5 % confidence: 0.9^36 = 0.0225.
pub(crate) const ENOUGH: f64 = 36.0;

/// A record whose judged time is so large a part of three hours counts as one of three hours.
const WHOLE: f64 = 0.95;

impl Structure {
    /// The time that is judged: what follows the transient, which is
    /// shorter than the duration \[s\].
    pub(crate) fn judged_s(&self) -> f64 {
        self.duration_s - self.transient_s
    }

    /// The judged time in periods of the waves, the peak period for a sea; none in still water.
    pub(crate) fn judged_periods(&self) -> Option<f64> {
        let period_s = match self.water {
            Water::Still => None,
            Water::Wave(wave) => Some(wave.period_s),
            Water::Sea(sea) => Some(sea.peak_period_s),
        };
        let period_s = period_s.filter(|_| self.has_waves())?;
        Some(self.judged_s() / period_s)
    }

    /// Whether less than one period of the waves is judged, which is too little for a verdict that
    /// nothing fails.
    pub(crate) fn judges_too_little(&self) -> bool {
        self.judged_periods().is_some_and(|periods| periods < 1.0)
    }

    /// Whether a record judges three hours, except for its beginning.
    pub(crate) fn judges_three_hours(&self) -> bool {
        self.judged_s() >= WHOLE * THREE_HOURS_S
    }

    /// Whether a record judges so much more than three hours that its largest load is not that of
    /// three.
    pub(crate) fn judges_more(&self) -> bool {
        self.has_waves() && WHOLE * self.judged_s() > THREE_HOURS_S
    }

    /// Whether so many records judge enough of a sea to tell without a distribution that no line
    /// breaks in nine of ten three-hour seas. In still water all records are equal.
    pub(crate) fn judges_enough(&self, records: usize) -> bool {
        !self.has_waves() || records as f64 * self.judged_s() >= ENOUGH * THREE_HOURS_S
    }

    /// Whether a run in which nothing fails does not tell that nothing does: less than one period of
    /// the waves is judged, or it is one record of a sea, of which others have higher loads.
    pub(crate) fn one_run_is_too_little(&self) -> bool {
        let is_sea = matches!(self.water, Water::Sea(_));
        self.judges_too_little() || is_sea && !self.judges_enough(1)
    }
}
