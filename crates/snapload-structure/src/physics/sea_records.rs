//! Warnings of records that do not show the largest tension: they are too short, or of a sea of too
//! few sinusoids.

use super::warning::{COMPONENTS, Warning, warning_if};
use crate::structure::{Structure, THREE_HOURS_S, Water};
use snapload::Stop;

/// With fewer judged wave periods the start of the waves may still decide the largest tension.
const FEW_PERIODS: f64 = 10.0;
/// Records whose judged time is less than three hours divided by this say little about three hours.
const SHORT: f64 = 12.0;
/// With fewer sinusoids a sea has too few high waves. The highest crest of n waves is lower in N
/// sinusoids of equal amplitude than in a Gaussian sea by (ln n/2 - 1)/4N of itself, to first
/// order in 1/N: as the end of a random walk of N steps, the envelope exceeds sqrt(2x) standard
/// deviations with the probability exp(-x) (1 - (x^2/2 - x)/2N). For the thousand waves of three
/// hours that is 0.6/N. A load that only a part of the spectrum excites has only that part of the
/// sinusoids: the largest tensions of docs/structures.md are lower by some 3/N, a quarter for 10
/// and 6 % for 50; those of 100 and 200 do not differ measurably.
/// Records of fewer can be computed, and compared with other programs, but decide nothing.
const FEWEST_COMPONENTS: f64 = 100.0;

/// The warning that a distribution in three hours is based on much shorter records.
pub(crate) fn short_records(structure: &Structure) -> Option<Warning> {
    let judged_s = structure.judged_s();
    let times = THREE_HOURS_S / judged_s;
    let is = structure.has_waves() && times > SHORT;
    warning_if(is, "short records", [judged_s, times], "")
}

/// The warning that only few periods of the waves are judged, or of a sea, in which higher waves
/// come for hours, a record as short as those of the warning above. A run that ended by itself
/// would not be longer with a longer duration.
pub(crate) fn short_run(structure: &Structure, stop: Stop) -> Option<Warning> {
    let judged = structure.judged_periods()?;
    let is_sea = matches!(structure.water, Water::Sea(_));
    let is_short = judged < FEW_PERIODS || is_sea && short_records(structure).is_some();
    let numbers = [structure.judged_s(), judged];
    let is_short = is_short && stop == Stop::EndTime;
    warning_if(is_short, "short run", numbers, "")
}

/// The warning that a sea has fewer sinusoids than a Gaussian one needs.
pub(crate) fn few_components(structure: &Structure) -> Option<Warning> {
    let Water::Sea(sea) = structure.water else {
        return None;
    };
    let count = sea.components as f64;
    let numbers = [count, FEWEST_COMPONENTS];
    warning_if(count < FEWEST_COMPONENTS, COMPONENTS, numbers, "")
}
