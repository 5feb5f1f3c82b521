//! The borders at which a curve of special orbits ends.

use crate::branch_events::Kind;
use crate::follower::{CORNER, END_OF_RANGE, TOO_LONG, beyond_largest_gap};
use crate::hybrid::Family;
use crate::on_curve::OnCurve;
use crate::orbit::Orbit;
use crate::roots::root;

/// The least part of phase space that a lap on a curve of Neimark-Sacker points loses. Without any
/// loss the multipliers of every orbit come in pairs with the product 1: the condition holds for
/// all orbits, so that it determines no curve, and close to that it determines one badly.
const LEAST_LOSS: f64 = 1e-4;

// Why a curve ends, besides the end of a range and a cable that would be too long.
const TOGETHER: &str = "corner: the graze comes at the instant of another event of the lap; \
                        beyond it there is no such graze";
const GRAZE: &str =
    "graze: another snap of the sequence has zero velocity here, and a negative one beyond it";
const ONE_TO_ONE: &str =
    "resonance 1:1: both multipliers of the pair are 1 here, and real beyond it";
const ONE_TO_TWO: &str =
    "resonance 1:2: both multipliers of the pair are -1 here, and real beyond it";
pub(crate) const NO_LOSS: &str = "hardly any energy is lost here: without loss every orbit has a pair of multipliers with the product 1";

/// What is at the borders, and the distances to them, negative beyond; the first four are those of
/// the range.
pub(crate) type Margins = [(&'static str, f64); 11];

/// A point this close to a border counts as on it.
const ON_BORDER: f64 = 1e-8;

/// The distance to each border.
pub(crate) fn margins<F: Family>(
    [[a, b], [c, d]]: [[f64; 2]; 2],
    on_curve: &OnCurve<F>,
    orbit: &Orbit,
) -> Margins {
    let [x, y] = orbit.at;
    let corner = orbit.survey.corner_gap;
    let corner = corner.map_or(f64::INFINITY, |gap| -gap.value);
    let together = on_curve
        .condition
        .time_to_events(&on_curve.continuation, &on_curve.here);
    let own = on_curve.condition.leg();
    let events = orbit.lap.sequence.events.iter().zip(&orbit.lap.speeds);
    let others = events
        .enumerate()
        .filter(|(k, (event, _))| own != Some(*k) && !event.struck().is_empty());
    let slowest = others.map(|(_, (_, speed))| *speed);
    let slowest = slowest.fold(f64::INFINITY, f64::min);
    let of_torus = on_curve.condition.kind() == Kind::NeimarkSacker;
    let multipliers = &orbit.multipliers;
    let trace = of_torus.then(|| multipliers.pair_of_torus()).flatten();
    let trace = trace.map(|pair| pair.map(|k| multipliers.values[k][0]).iter().sum());
    let resonances = trace.map_or([f64::INFINITY; 2], |sum: f64| [2.0 - sum, 2.0 + sum]);
    let [one, two] = resonances;
    let loss = match of_torus && multipliers.zeros_from_contact == 0 {
        true => 1.0 - multipliers.product.abs() - LEAST_LOSS,
        false => f64::INFINITY,
    };
    [
        (END_OF_RANGE, x - a),
        (END_OF_RANGE, b - x),
        (END_OF_RANGE, y - c),
        (END_OF_RANGE, d - y),
        (CORNER, corner),
        (TOGETHER, together),
        (GRAZE, slowest),
        (ONE_TO_ONE, one),
        (ONE_TO_TWO, two),
        (NO_LOSS, loss),
        (TOO_LONG, -beyond_largest_gap(orbit)),
    ]
}

/// The first border between two points.
pub(crate) fn passed<'a, F: Family>(
    ranges: [[f64; 2]; 2],
    on_curve: &OnCurve<'a, F>,
    step: f64,
    before: &Margins,
    after: &Margins,
) -> Option<Border<'a, F>> {
    let crossed = (0..before.len()).filter(|&k| before[k].1 >= 0.0 && after[k].1 < 0.0);
    let border = |number: usize| {
        let what = before[number].0;
        let margin = |there: &OnCurve<F>| margins(ranges, there, &there.orbit())[number].1;
        let at = |sigma: f64| on_curve.moved(sigma).as_ref().map_or(f64::NAN, margin);
        let sigma = root(&at, (0.0, before[number].1), (step, after[number].1));
        // The largest gap may jump from one closest approach to another.
        let is_on = |there: &OnCurve<F>| margin(there).abs() < ON_BORDER;
        let found = |there: &OnCurve<F>| what == TOO_LONG || is_on(there);
        Border {
            what,
            number,
            sigma,
            place: on_curve.moved(sigma).filter(found),
        }
    };
    crossed
        .map(border)
        .min_by(|a, b| a.sigma.total_cmp(&b.sigma))
}

/// Whether a curve that begins beyond the border of too little loss leads further beyond it.
pub(crate) fn loses_less(before: &Margins, after: &Margins) -> bool {
    let mut both = before.iter().zip(after);
    both.any(|((what, before), (_, after))| *what == NO_LOSS && *before < 0.0 && after < before)
}

/// A border that a curve passes, the distance to it, and the point there, if it was found.
pub(crate) struct Border<'a, F: Family> {
    pub(crate) what: &'static str,
    /// Its place among the distances.
    pub(crate) number: usize,
    pub(crate) sigma: f64,
    pub(crate) place: Option<OnCurve<'a, F>>,
}

impl<F: Family> Border<'_, F> {
    /// Whether rounding decides there what a simulation does: two events are at one instant, or a
    /// snap has zero velocity.
    pub(crate) fn is_between_sequences(&self) -> bool {
        [CORNER, TOGETHER, GRAZE].contains(&self.what)
    }
}
