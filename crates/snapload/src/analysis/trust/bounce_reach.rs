//! How far neighbours reach in a bounce, and bounds, without roots, by which none of them has
//! another event than the run; where a bound does not hold, [`crate::analysis::trust::causes`]
//! decides.

use crate::analysis::trust::covariance::SIGMA_REACH;
use crate::analysis::trust::spread::ERROR;
use crate::arithmetic::lane::Lane;
use crate::model::cable::{Cable, Normal};
use crate::motion::bounce_map::{Bounced, Rows};

/// Bounds are computed in rounded arithmetic; this factor makes them safe.
pub(super) const SAFE: f64 = 1.001;

/// How far neighbours reach at the start of a flight, each just after its own event: squares of
/// standard deviations.
pub(super) struct AtStart<L> {
    theta: L,
    height: L,
    /// Of what they reach from there within the flight along the cable that is open at the start
    /// ([`crate::analysis::trust::near_miss`]).
    open: L,
}

/// A cable that is open at the start of a flight.
pub(super) struct OpenCable<L> {
    cable: Cable<L>,
    /// Its normal there.
    normal: Normal<L>,
    reach: L,
}

impl<L: Lane> OpenCable<L> {
    /// The one that is open wider: after a snap the other is closed.
    #[inline(always)]
    pub(super) fn of(bounced: &Bounced<L>) -> Self {
        let [[first, _], [second, _]] = bounced.from.gaps;
        Self::either(bounced, second.below(first))
    }

    #[inline(always)]
    fn either(bounced: &Bounced<L>, second: L::Mask) -> Self {
        let (two_cables, from) = (bounced.two_cables, bounced.from);
        let cable = Cable::select(second, &two_cables.cables[1], &two_cables.cables[0]);
        let lever = cable.lever(from.rotation.sine, from.rotation.cosine);
        let span = cable.span_moved(cable.moved(&from.state, &from.rotation));
        Self {
            cable,
            normal: cable.normal_along(span, lever),
            reach: L::select(second, two_cables.reach[1], two_cables.reach[0]),
        }
    }

    /// Displacements of the body along it.
    #[inline(always)]
    pub(super) fn along<const N: usize>(&self, rows: &Rows<L, N>) -> [L; N] {
        let ([x, y, theta, ..], Normal { n, arm }) = (rows, self.normal);
        let mut along = [L::ZERO; N];
        for k in 0..N {
            along[k] = n.x.mul_add(x[k], n.y.mul_add(y[k], arm * theta[k]));
        }
        along
    }
}

impl OpenCable<f64> {
    /// The nearer of two open cables; none if it is closed.
    #[inline(always)]
    pub(super) fn nearer(bounced: &Bounced<f64>) -> Option<Self> {
        let [[first, _], [second, _]] = bounced.from.gaps;
        (first < 0.0 && second < 0.0).then(|| Self::either(bounced, second >= first))
    }
}

impl<L: Lane> AtStart<L> {
    /// From the squares of what neighbours reach at the start, by x, y and θ and along the open
    /// cable.
    #[inline(always)]
    pub(super) fn of(
        bounced: &Bounced<L>,
        open: &OpenCable<L>,
        [x, y, theta]: [L; 3],
        along: L,
    ) -> Self {
        let (two_cables, from) = (bounced.two_cables, bounced.from);
        let OpenCable { cable, reach, .. } = *open;
        let before = bounced.before;
        let s = bounced.t - from.t;
        let speed = before
            .vtheta
            .abs()
            .mul_add(reach, before.velocity().length_bound());
        let turned = two_cables.force[0].mul_add(s, speed) * s * cable.per_length() * 0.25;
        let swung = (before.vtheta.abs() * s).mul_add(L::from_f64(0.25), turned) * reach;
        let place = (swung * swung).mul_add(theta, turned * turned * (x + y)) * 2.0;
        Self {
            theta,
            height: y,
            open: (place + along) * 2.0,
        }
    }
}

impl AtStart<f64> {
    /// The same with another cable open, too.
    #[inline(always)]
    pub(super) fn with_open(self, other: &Self) -> Self {
        Self {
            open: self.open.max(other.open),
            ..self
        }
    }
}

/// How far neighbours reach: squares of standard deviations.
pub(super) struct Reach<L> {
    /// Of each component, at the neighbour's own impact.
    met: [L; 7],
    /// For the delay of the impact, and for its normal velocity.
    later: L,
    closing: L,
    /// Along a gap that was open at the start of the flight, there: a bound for each.
    start: L,
    /// Along the other cable, the largest of the values at the start, at the end at the previous
    /// event's time, and at the impact's; for the rotation and the height, bounds that hold at all
    /// of them.
    other: L,
    theta: L,
    height: L,
}

impl<L: Lane> Reach<L> {
    #[inline(always)]
    pub(super) fn of(
        bounced: &Bounced<L>,
        start: AtStart<L>,
        met: [L; 7],
        [later, closing]: [L; 2],
        [along, at_end]: [L; 2],
    ) -> Self {
        let before = bounced.before;
        let doubled = |square: L, rate: L| (rate * rate).mul_add(later, square) * 2.0;
        let [_, gap] = bounced.each(|k| bounced.from.gaps[k][0]);
        let of_other = L::select(gap.below(L::ZERO), start.open, L::ZERO);
        Self {
            met,
            later,
            closing,
            start: start.open,
            other: along.larger(at_end).larger(of_other),
            theta: doubled(met[2], before.vtheta).larger(start.theta),
            height: doubled(met[1], before.vy).larger(start.height),
        }
    }

    /// A bound on the square of the error, given the squares of the velocities after the impact.
    /// What rounding adds to the position is given by `place_added`, as
    /// (a + b)² ≤ (1 + 1/64) a² + 65 b².
    #[inline(always)]
    pub(super) fn error(&self, velocities_after: [L; 3], place_added: L) -> L {
        let mut sum = place_added * 65.0;
        for square in self.met {
            sum = square.mul_add(L::from_f64(1.0 + 1.0 / 64.0), sum);
        }
        for square in velocities_after {
            sum = sum + square;
        }
        sum * (ERROR * ERROR)
    }

    /// Whether all neighbours have the impact before the end of time, and rebound from it.
    #[inline(always)]
    pub(super) fn meets_all(&self, bounced: &Bounced<L>) -> L::Mask {
        const SQUARE: f64 = SIGMA_REACH * SIGMA_REACH * SAFE;
        let (two_cables, before) = (bounced.two_cables, bounced.before);
        let [one, two] = two_cables.reach;
        let reach = one.larger(two);
        // The closing velocity of the gap decreases at most at the rate |P̈|.
        let slowing = (before.vtheta * before.vtheta).mul_add(reach, two_cables.force[0]);
        let v_n = bounced.v_n;
        let closes = (self.later * slowing * slowing * (4.0 * SQUARE)).below(v_n * v_n);
        let left = v_n - two_cables.v_stick;
        let rebounds = (self.closing * SQUARE).below(left * left);
        let left = two_cables.t_end - bounced.t;
        closes & rebounds & (self.met[6] * SQUARE).below(left * left)
    }

    /// Whether the gap that closes is open by more than the neighbours' reach up to its last rise.
    /// At the end that is its rate times their reach in time; before, the normal had another
    /// direction, by no more than the way over the cable's length; and they reach as far as at the
    /// start, unless all of them begin with this cable closed.
    #[inline(always)]
    pub(super) fn rises_once(&self, bounced: &Bounced<L>) -> L::Mask {
        const FACTOR: f64 = 8.0 * SIGMA_REACH * SIGMA_REACH * SAFE;
        let (before, s) = (bounced.before, bounced.t - bounced.from.t);
        let [length, _] = bounced.each(|k| bounced.two_cables.cables[k].length());
        let [reach, _] = bounced.each(|k| bounced.two_cables.reach[k]);
        let speed = before
            .vtheta
            .abs()
            .mul_add(reach, before.velocity().length_bound());
        let way = bounced.two_cables.force[0].mul_add(s, speed) * s;
        let place = self.met[0] + (reach * reach).mul_add(self.met[2], self.met[1]);
        let place = (speed * speed).mul_add(self.later, place) * 4.0;
        let rate = length * bounced.v_n;
        let at_end = (rate * rate).mul_add(self.later, place * way * way) * FACTOR;
        let [gap, _] = bounced.each(|k| bounced.from.gaps[k][0]);
        let at_start = self.start * length * length * (FACTOR * 0.5);
        let at_start = L::select(gap.below(L::ZERO), at_start, L::ZERO);
        bounced.is_open_before_last_rise(at_end.larger(at_start))
    }

    /// Whether the other gap stays open by more than the neighbours' reach. A cable that was closed
    /// at the start of the flight is closed for all neighbours then, and their gaps spread from
    /// zero.
    #[inline(always)]
    pub(super) fn leaves_the_other_open(&self, bounced: &Bounced<L>) -> L::Mask {
        let [_, gap] = bounced.each(|k| bounced.from.gaps[k][0]);
        let [_, length] = bounced.each(|k| bounced.two_cables.cables[k].length());
        let s = bounced.t - bounced.from.t;
        let largest = Bounced::largest_early(gap, bounced.facts.slope, s)
            .larger(bounced.facts.late)
            .larger(bounced.other_gap[0]);
        const FACTOR: f64 = 4.0 * SIGMA_REACH * SIGMA_REACH * SAFE;
        let margin = length * length * self.other * FACTOR;
        largest.below(L::ZERO) & margin.below(largest * largest)
    }

    /// Whether no neighbour reaches a limit.
    #[inline(always)]
    pub(super) fn reaches_no_limit(&self, bounced: &Bounced<L>) -> L::Mask {
        const SQUARE: f64 = SIGMA_REACH * SIGMA_REACH * SAFE;
        let two_cables = bounced.two_cables;
        let (start, end) = (&bounced.from.state, bounced.before);
        let s = bounced.t - bounced.from.t;
        let turned = start.theta.abs().larger(end.theta.abs());
        let left = two_cables.rotation_limit - turned;
        let turns = L::ZERO.below(left) & (self.theta * SQUARE).below(left * left);
        let bulge = two_cables.vertical_acceleration_bound * s * s * 0.125;
        let left = two_cables.level - (start.y.larger(end.y) + bulge);
        let outline = two_cables.outline;
        let top = (outline * outline).mul_add(self.theta, self.height) * 2.0;
        turns & L::ZERO.below(left) & (top * SQUARE).below(left * left)
    }
}
