//! Boxes that are proved to contain a taut motion over a step, and the bounds on its remainder that
//! follow from them.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::arithmetic::radius::Radius;
use crate::arithmetic::scalar::{Jet, Scalar};
use crate::taut::series::Expansion;
use crate::taut::step::{Equations, slopes_of, value_of};

/// By how much the boxes are larger than the ranges of the polynomials, both for the states and for
/// the derivatives with respect to the beginning.
const ROOM: Radius = Radius::power_of_two(-48);
const SLOPE_ROOM: Radius = Radius::power_of_two(-24);

/// A box that is proved to contain the motion over a length of time.
pub(super) struct Enclosed<'a, const N: usize> {
    equations: &'a Equations<'a>,
    length: f64,
    over: Interval,
    times: Interval,
    wide: [Interval; N],
    /// The logarithm of the largest contribution of the coefficients of order n + 1 over the box to
    /// the state.
    pub(super) bits: f64,
}

/// Such a box; none if the box that is tried is too small.
pub(super) fn enclosed<'a, const N: usize>(
    equations: &'a Equations<'a>,
    time: &Ball,
    whole: &Expansion<Jet<Interval, N>, N>,
    length: f64,
) -> Option<Enclosed<'a, N>> {
    let h = Ball::double(length);
    let within = h.half().widened(h.upper().scaled(-1));
    let over = Interval::of(&within);
    let mut wide = [Interval::zero(); N];
    for (wide, series) in wide.iter_mut().zip(&whole.state) {
        let series: Vec<Interval> = series.iter().map(|jet| jet.value).collect();
        *wide = widened(value_of(&series, over), ROOM)?;
    }
    let order = whole.state[0].len();
    let times = Interval::of(&(time + &within));
    let rest = equations
        .few
        .expand(&wide, &times, order, &equations.functions)?;
    let last = rest.state.iter().map(|series| series.last().copied());
    let largest = largest(last, length, order)?;
    // The range plus the remainder stays within the box if the remainder is less than the room.
    (largest < ROOM).then(|| Enclosed {
        equations,
        length,
        over,
        times,
        wide,
        bits: largest.to_f64().log2(),
    })
}

impl<const N: usize> Enclosed<'_, N> {
    /// The coefficients of order n + 1 over the box, and their derivatives by the start; none if
    /// the box that is tried for the derivatives is too small.
    pub(super) fn rest(
        self,
        whole: &Expansion<Jet<Interval, N>, N>,
    ) -> Option<Expansion<Jet<Interval, N>, N>> {
        let mut jets: [Jet<Interval, N>; N] = std::array::from_fn(|i| Jet::constant(&self.wide[i]));
        for (jet, series) in jets.iter_mut().zip(&whole.state) {
            for (slope, range) in jet.slopes.iter_mut().zip(slopes_of(series, self.over)) {
                *slope = widened(range, SLOPE_ROOM)?;
            }
        }
        let order = whole.state[0].len();
        let Equations { few, functions, .. } = self.equations;
        let rest = few.expand(&jets, &Jet::constant(&self.times), order, functions)?;
        let last = rest.state.iter().flat_map(|series| {
            let slopes = series.last().map(|jet| jet.slopes);
            (0..N).map(move |j| slopes.map(|slopes| slopes[j]))
        });
        (largest(last, self.length, order)? < SLOPE_ROOM).then_some(rest)
    }
}

fn widened(interval: Interval, by: Radius) -> Option<Interval> {
    Some(Interval::of(&interval.ball()?.widened(by)))
}

/// The largest of some coefficients of τ^order, over a length.
fn largest(
    mut coefficients: impl Iterator<Item = Option<Interval>>,
    length: f64,
    order: usize,
) -> Option<Radius> {
    let h = Ball::double(length).upper();
    let power = (1..order).fold(h, |power, _| power.times(h));
    coefficients.try_fold(Radius::ZERO, |largest, coefficient| {
        Some(largest.max(coefficient?.upper()?.times(power)))
    })
}
