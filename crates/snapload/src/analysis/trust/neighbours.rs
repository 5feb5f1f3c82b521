//! The spread of a run's neighbours at the ends of a step.

use crate::analysis::trust::covariance::{CovarianceFactor, SIGMA_REACH};
use crate::analysis::trust::parts::squares;
use crate::analysis::trust::uncertain_key::UncertainKey;
use crate::model::taut_set::TautSet;
use crate::motion::step_map::{Deviation, join};

/// The spread of the neighbours at some instant.
pub(super) struct Spread<'a> {
    pub(super) covariance: &'a CovarianceFactor,
    /// Standard deviation of each component.
    pub(super) sizes: Deviation,
    /// The part of it that the start and rounding cause, without uncertain parameters.
    of_parts: Deviation,
}

impl<'a> Spread<'a> {
    #[inline(always)]
    pub(super) fn of(covariance: &'a CovarianceFactor) -> Self {
        let sizes = covariance.sizes();
        let of_parts = match covariance.columns.is_empty() {
            true => sizes,
            false => squares(&covariance.parts.rows).map(f64::sqrt),
        };
        Self {
            covariance,
            sizes,
            of_parts,
        }
    }

    /// The largest deviation of the neighbours along a linear function of the state.
    #[inline(always)]
    pub(super) fn reach(&self, direction: &[f64; 6]) -> f64 {
        SIGMA_REACH * self.covariance.along(direction)
    }

    /// The same by the start and rounding alone.
    #[inline(always)]
    pub(super) fn reach_of_parts(&self, direction: &Deviation) -> f64 {
        SIGMA_REACH * self.covariance.variance_of_parts(direction).sqrt()
    }

    /// A bound on the reach along every function whose derivatives are at most these.
    #[inline(always)]
    pub(super) fn at_most(&self, slopes: &[f64; 6]) -> f64 {
        bound(slopes, &self.sizes)
    }

    /// The same by the start and rounding alone.
    #[inline(always)]
    pub(super) fn parts_at_most(&self, slopes: &[f64; 6]) -> f64 {
        bound(slopes, &self.of_parts)
    }
}

#[inline(always)]
fn bound(slopes: &[f64; 6], sizes: &Deviation) -> f64 {
    let mut sum = 0.0;
    for (slope, size) in slopes.iter().zip(sizes) {
        // Zero slopes are skipped, as 0 × ∞ would be NaN.
        sum += if *slope > 0.0 { slope * size } else { 0.0 };
    }
    SIGMA_REACH * sum
}

/// The spread of the neighbours of a step. By their start and by rounding they drift away from
/// the run with constant velocities between its ends if it is a free flight, so that each is
/// furthest from it at one of them. An uncertain parameter changes the forces, the cables and
/// the limits, too: its effect on a gap, on a limit or on v_n is that of the run with
/// derivatives by it ([`UncertainKey`]).
pub(super) struct Neighbours<'a> {
    /// Just after the previous event, each at the time of its own.
    pub(super) before: Spread<'a>,
    /// Just before its event, at the time of the previous event.
    pub(super) along: Spread<'a>,
    /// Each neighbour at the time of its own event.
    pub(super) met: Spread<'a>,
    /// Standard deviation of the error, by rounding, of the time at which the event is located.
    pub(super) late: f64,
    /// Cables that have been open since the start, in all of them.
    pub(super) opening: TautSet,
    /// The uncertain parameters, after the step.
    pub(super) keys: &'a [UncertainKey],
}

/// How the run approaches its event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// ż just before it.
    pub(super) rate: [f64; 6],
    /// −∇h/ḣ, the delay of the event per deviation.
    pub(super) delay: [f64; 6],
}

impl<'a> Neighbours<'a> {
    /// Those of a bounce without uncertain parameters, just before it, at its end at the time of
    /// the previous event, and at its own.
    #[inline(always)]
    pub(super) fn of_bounce([before, along, met]: [Spread<'a>; 3]) -> Self {
        Self {
            before,
            along,
            met,
            late: 0.0,
            opening: TautSet::SLACK,
            keys: &[],
        }
    }

    /// The largest time by which neighbours reach the event before or after the run.
    #[inline(always)]
    pub(super) fn reach_in_time(&self, approach: &Approach) -> f64 {
        let along = &self.along.covariance;
        let by_parts = along.variance_of_parts(&join(&approach.delay, 0.0));
        let by_keys: f64 = self.keys.iter().map(|key| key.delay() * key.delay()).sum();
        SIGMA_REACH * (by_parts + by_keys + self.late * self.late).sqrt()
    }
}
