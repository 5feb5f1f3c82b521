//! Floquet multipliers, with exact zeros for directions that contact closes.
//!
//! A held surface allows no deviation of its gap and of the gap's velocity: two multipliers are
//! zero. An eigenvalue problem would give rounding errors, or roots of them, instead; so the orbit
//! is cut where most surfaces are held, and the problem is solved in the remaining directions
//! there. A snap without rebound stops a surface even if it is let go at once, and closes its gap;
//! where that closes more directions, the problem is solved in those that the whole lap leaves.

use crate::bordered::range;
use crate::eigenvalues::{eigenvalues, far_apart};
use crate::hybrid::{DURATION, Family, Hybrid, Jet, Point, constant, variable};
use crate::lap::{Lap, Leg};
use crate::newton::Closed;
use crate::sequence::Sequence;
use nalgebra::{DMatrix, DVector};
use snapload::TautSet;

/// The multipliers of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers {
    /// All of them, the largest first; exact zeros are 0.
    pub values: Vec<[f64; 2]>,
    /// How many are zero because surfaces are held during a part of the lap, or stopped in a snap.
    pub zeros_from_contact: usize,
    /// The product of the others.
    pub product: f64,
}

/// A modulus this close to 1 counts as 1.
const NEUTRAL: f64 = 1e-9;
/// A modulus this close to 1 is certainly neither inside nor outside of the unit circle: two
/// multipliers that meet there are known to half of the digits.
pub(crate) const NEAR_CIRCLE: f64 = 1e-6;

/// The stability of an orbit by its multipliers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// All multipliers are within the unit circle.
    Stable,
    /// One is outside.
    Unstable,
    /// None is outside the unit circle, but some are on it.
    Neutral,
    /// All are zero: a neighbour is on the orbit after one lap.
    Superstable,
}

impl Stability {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Neutral => "neutral",
            Self::Superstable => "superstable",
        }
    }
}

impl Multipliers {
    /// |μ| of the largest.
    pub fn largest(&self) -> f64 {
        self.values.first().map_or(0.0, |[re, im]| re.hypot(*im))
    }

    /// The places of the two whose product is nearest to 1, in their order: on the unit circle they
    /// are the pair of a torus, and on its curve, where they become real, still the same.
    pub(crate) fn pair_of_torus(&self) -> Option<[usize; 2]> {
        let values = &self.values;
        let off = |[i, j]: &[usize; 2]| {
            let ([a, b], [c, d]) = (values[*i], values[*j]);
            (a * c - b * d - 1.0).hypot(a * d + b * c)
        };
        let pairs = (0..values.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
        pairs.min_by(|one, other| off(one).total_cmp(&off(other)))
    }

    /// The least and the greatest number of them that may be outside the unit circle: those that
    /// certainly are, and those that are not certainly inside.
    pub(crate) fn outside(&self) -> [usize; 2] {
        [1.0 + NEAR_CIRCLE, 1.0 - NEAR_CIRCLE].map(|least| {
            let sizes = self.values.iter().map(|[re, im]| re.hypot(*im));
            sizes.filter(|size| *size > least).count()
        })
    }

    /// The stability that they imply.
    pub fn stability(&self) -> Stability {
        match self.largest() {
            0.0 => Stability::Superstable,
            largest if largest > 1.0 + NEUTRAL => Stability::Unstable,
            largest if largest < 1.0 - NEUTRAL => Stability::Stable,
            _ => Stability::Neutral,
        }
    }
}

/// The multipliers of a closed lap, given its legs.
pub fn multipliers<F: Family>(
    lap: &Lap<F>,
    closed: &Closed,
    system: &F::Plain,
    legs: &[Leg],
) -> Multipliers {
    let variables = lap.family.variables();
    let (most, leg) = most_taut(lap.sequence, &closed.durations, lap.times().1);
    let (linear, left) = if most.is_empty() {
        (lap.linearise(&closed.z, &closed.durations), None)
    } else {
        let cut = cut_within(lap, system, legs, leg);
        let here = Lap {
            sequence: &cut.sequence,
            phase: cut.phase,
            ..*lap
        };
        let left = directions_left(lap, most, &cut.z);
        (here.linearise(&cut.z, &cut.durations), Some(left))
    };
    let within = |basis: &DMatrix<f64>, whole: DMatrix<f64>| basis.transpose() * whole * basis;
    let whole = linear.monodromy(variables);
    let mut reduced = match &left {
        None => whole,
        Some(left) => within(left, whole),
    };
    let mut left = left.unwrap_or_else(|| DMatrix::identity(variables.len(), variables.len()));
    let rank = variables.len() - closed_in_events(lap, legs);
    if reduced.nrows() > rank && reduced.iter().all(|entry| entry.is_finite()) {
        // The other eigenvalues of a matrix of this rank are exact zeros.
        let range = range(&reduced, rank);
        reduced = within(&range, reduced);
        left *= range;
    }
    let zeros = variables.len() - reduced.nrows();
    let (mut values, product) = match reduced.nrows() {
        0 => (Vec::new(), 1.0),
        _ => {
            let values = eigenvalues(reduced.clone());
            far_apart((&reduced, &values), &linear, variables, &left)
                .unwrap_or_else(|| (values, reduced.determinant()))
        }
    };
    values.resize(variables.len(), [0.0; 2]);
    Multipliers {
        values,
        zeros_from_contact: zeros,
        product,
    }
}

/// The most directions that an event of the lap closes which stops surfaces and lets them go.
fn closed_in_events<F: Family>(lap: &Lap<F>, legs: &[Leg]) -> usize {
    let (system, variables) = (lap.family.jets(lap.at), lap.family.variables());
    let rebounds = lap.family.snap_contraction(lap.at) > 0.0;
    let events = lap.sequence.events.iter().zip(&legs[1..]);
    let closed = events.map(|(event, leg)| {
        let stops = event.stops(rebounds);
        match stops.is_empty() {
            true => 0,
            false => {
                let after = (leg.t, &leg.start);
                closed_after(&system, variables, [event.after, stops], after).len()
            }
        }
    });
    closed.max().unwrap_or(0)
}

/// The largest set of held surfaces, and the longest leg with it.
fn most_taut(sequence: &Sequence, durations: &[f64], length: f64) -> (TautSet, usize) {
    let rest = length - durations.iter().sum::<f64>();
    let durations = durations.iter().copied().chain([rest]);
    let mut found = (TautSet::SLACK, 0);
    let mut longest = 0.0;
    for (k, (taut, s)) in sequence.taut_sets().into_iter().zip(durations).enumerate() {
        let more = taut.len() > found.0.len() && s > 0.0;
        if more || (taut.len() == found.0.len() && s > longest) {
            (found, longest) = ((taut, k), s);
        }
    }
    found
}

/// The same lap from another section.
struct Cut {
    sequence: Sequence,
    durations: Vec<f64>,
    z: Point,
    phase: f64,
}

/// Cuts a lap in the middle of a leg.
fn cut_within<F: Family>(lap: &Lap<F>, system: &F::Plain, legs: &[Leg], leg: usize) -> Cut {
    let (t_start, length) = lap.times();
    let here = &legs[leg];
    // The first and the last leg are joined, as the section cuts one leg.
    let half = here.s * 0.5;
    let z = system.flow(here.taut, here.t, &here.start, half);
    let mut events = lap.sequence.events.clone();
    events.rotate_left(leg);
    let mut durations = Vec::with_capacity(events.len());
    let times: Vec<f64> = legs[1..].iter().map(|leg| leg.t).collect();
    let cut = here.t + half;
    let mut since = cut;
    for k in 0..times.len() {
        let place = (k + leg) % times.len();
        let t = times[place] + if place < leg { length } else { 0.0 };
        durations.push(t - since);
        since = t;
    }
    Cut {
        sequence: Sequence {
            start: here.taut,
            events,
        },
        durations,
        z,
        phase: lap.phase + (cut - t_start) / length * f64::from(lap.periods),
    }
}

/// An orthonormal basis of the deviations that keep held surfaces closed.
fn directions_left<F: Family>(lap: &Lap<F>, taut: TautSet, z: &Point) -> DMatrix<f64> {
    let (system, variables) = (lap.family.jets(lap.at), lap.family.variables());
    let mut taken = closed_by(&system, variables, taut, z);
    let constraints = taken.len();
    // Unit vectors that are nearly spanned already are left out at first; then the basis is
    // completed with them.
    for least in [0.2, 1e-6] {
        for i in 0..variables.len() {
            if taken.len() < variables.len() {
                let mut unit = DVector::zeros(variables.len());
                unit[i] = 1.0;
                taken.extend(orthogonal(unit, &taken, least).map(|(left, _)| left));
            }
        }
    }
    let left = &taken[constraints..];
    DMatrix::from_fn(variables.len(), left.len(), |i, j| left[j][i])
}

/// An orthonormal basis of the deviations that held surfaces do not allow: of gap and of velocity.
pub(crate) fn closed_by<H: Hybrid<Jet>>(
    system: &H,
    variables: &[usize],
    taut: TautSet,
    z: &Point,
) -> Vec<DVector<f64>> {
    let jets = variable(z);
    let mut taken: Vec<DVector<f64>> = Vec::new();
    for surface in taut.iter() {
        for closed in [system.gap(surface, &jets), system.speed(surface, &jets)] {
            close(&mut taken, &closed, variables);
        }
    }
    taken
}

/// The same just after an event at a time. Surfaces that the event `stops` without holding them
/// open from rest: their gaps are closed to first order, and a delay of the event changes all of
/// their velocities together, each by its acceleration.
pub(crate) fn closed_after<H: Hybrid<Jet>>(
    system: &H,
    variables: &[usize],
    [taut, stops]: [TautSet; 2],
    (t, z): (f64, &Point),
) -> Vec<DVector<f64>> {
    let mut taken = closed_by(system, variables, taut, z);
    let jets = variable(z);
    let soon = Jet::variable(0.0, DURATION);
    let later = || system.flow(taut, constant(t), &z.map(constant), soon);
    let mut first = None;
    for surface in stops.iter() {
        close(&mut taken, &system.gap(surface, &jets), variables);
        let speed = system.speed(surface, &jets);
        let acceleration = system.speed(surface, &later()).slope[DURATION];
        match first {
            None => first = Some((speed, acceleration)),
            Some((other, of_other)) => {
                let together = speed * constant(of_other) - other * constant(acceleration);
                close(&mut taken, &together, variables);
            }
        }
    }
    taken
}

/// Adds the direction in which a number changes.
fn close(taken: &mut Vec<DVector<f64>>, number: &Jet, variables: &[usize]) {
    let row = variables.iter().map(|&i| number.slope[i]);
    let row = DVector::from_iterator(variables.len(), row);
    taken.extend(orthogonal(row, taken, 1e-9).map(|(left, _)| left));
}

/// The part of a vector that is orthogonal to others, as a unit vector, and its length; none if
/// hardly anything of the vector is left.
pub(crate) fn orthogonal(
    mut vector: DVector<f64>,
    others: &[DVector<f64>],
    least: f64,
) -> Option<(DVector<f64>, f64)> {
    let whole = vector.norm();
    for _ in 0..2 {
        for other in others {
            let along = other.dot(&vector);
            vector.axpy(-along, other, 1.0);
        }
    }
    let left = vector.norm();
    (left > least * whole && left > 0.0).then(|| (vector / left, left))
}

#[cfg(test)]
mod tests {
    use super::closed_after;
    use crate::hybrid::{Hybrid, Jet, Point};
    use snapload::{PerCable, Real, TautSet};

    /// A point mass on two cables of length √2 from (±1, −1), both of which are taut at the origin;
    /// free, it has a constant acceleration.
    struct PointMass;

    const ACCELERATION: [f64; 2] = [0.3, -0.8];

    /// From the anchor of a cable to the mass.
    fn along(cable: usize, z: &Point<Jet>) -> [Jet; 2] {
        let anchor = [[1.0, -1.0][cable], -1.0];
        [0, 1].map(|i| z[i] - Jet::constant(anchor[i]))
    }

    impl Hybrid<Jet> for PointMass {
        fn surfaces(&self) -> TautSet {
            TautSet::only(0).with(1)
        }

        fn flow(&self, _: TautSet, _: Jet, z: &Point<Jet>, s: Jet) -> Point<Jet> {
            let [ax, ay] = ACCELERATION.map(Jet::constant);
            let half = Jet::constant(0.5) * s * s;
            let [vx, vy] = [z[3] + ax * s, z[4] + ay * s];
            let (x, y) = (z[0] + z[3] * s + ax * half, z[1] + z[4] * s + ay * half);
            [x, y, z[2], vx, vy, z[5]]
        }

        fn gap(&self, cable: usize, z: &Point<Jet>) -> Jet {
            let [x, y] = along(cable, z);
            (x * x + y * y).sqrt() - Jet::constant(2.0_f64.sqrt())
        }

        fn speed(&self, cable: usize, z: &Point<Jet>) -> Jet {
            let [x, y] = along(cable, z);
            (x * z[3] + y * z[4]) / (x * x + y * y).sqrt()
        }

        fn tension(&self, _: usize, _: TautSet, _: Jet, _: &Point<Jet>) -> Jet {
            Jet::constant(0.0)
        }

        fn law(&self, _: TautSet, _: TautSet, z: &Point<Jet>) -> (Point<Jet>, PerCable<Jet>) {
            (*z, [Jet::constant(0.0); snapload::MAX_CABLES])
        }

        fn placed(&self, _: TautSet, _: TautSet, z: &Point<Jet>) -> Point<Jet> {
            *z
        }
    }

    /// A point mass that is stopped in the corner and let go by both cables is at rest there, so
    /// that soon after all that may differ is how long it has fallen: its velocity, along the
    /// acceleration.
    #[test]
    fn a_delay_changes_all_velocities_together() {
        let stops = [TautSet::SLACK, PointMass.surfaces()];
        let corner = (0.7, &[0.0; 6]);
        let closed = closed_after(&PointMass, &[0, 1, 3, 4], stops, corner);
        assert_eq!(closed.len(), 3);
        for direction in closed {
            let along = direction[2] * ACCELERATION[0] + direction[3] * ACCELERATION[1];
            assert!(along.abs() < 1e-15, "{along}");
        }
    }
}
