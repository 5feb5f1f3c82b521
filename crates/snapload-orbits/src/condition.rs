//! The condition that special orbits along a curve satisfy, as one equation in addition to those of
//! the closed lap.
//!
//! A matrix A that is singular at the special orbit is bordered ([`crate::bordered`]), and the g of
//! its border vanishes. With the derivatives ∂F of the closed lap's equations
//! by state z and times, A is ∂F at a fold; ∂F + 2 ∂z/∂z at a period doubling, where P δz = −δz has
//! a solution in place of P δz = δz; and the second compound matrix of the monodromy matrix, whose
//! eigenvalues are the products μ_i μ_j, less the unit matrix, where a pair is on the unit circle.
//! The first two do not divide by the speed of a snap, so that they are smooth through grazes.

use crate::bordered::{null_vectors, solved};
use crate::branch_events::{BranchEvent, Kind};
use crate::continuation::{Continuation, DIFFERENCE, Unknowns};
use crate::hybrid::{DURATION, Family, Hybrid, Jet, Point, constant};
use crate::orbit::Orbit;
use nalgebra::{DMatrix, DVector};

/// The condition on the orbits of a curve.
#[derive(Clone, Debug)]
pub(crate) enum Condition {
    /// A matrix is singular; with its bordering vectors.
    Singular {
        of: Kind,
        left: DVector<f64>,
        right: DVector<f64>,
    },
    /// A slack surface is touched between events.
    Touch(Contact),
    /// The snap of an event has zero velocity.
    Speed { leg: usize },
}

/// The closest approach of a slack surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    surface: usize,
    leg: usize,
    t: f64,
}

/// Steps of Newton's method towards the time of a surface's closest approach.
const MOST_STEPS: usize = 8;

impl Condition {
    /// The condition that an event satisfies; none if its kind has no curve.
    pub(crate) fn of<F: Family>(
        continuation: &Continuation<F>,
        u: &Unknowns,
        event: &BranchEvent,
    ) -> Option<Self> {
        let survey = &event.orbit.survey;
        match event.kind {
            Kind::Fold | Kind::PeriodDoubling | Kind::NeimarkSacker => {
                singular(event.kind, continuation, u)
            }
            Kind::Graze if event.is_own_snap => {
                let leg = survey.least_speed?.leg;
                Some(Self::Speed { leg })
            }
            Kind::Graze => {
                let nearest = survey.largest_gap?;
                Some(Self::Touch(Contact {
                    surface: nearest.surface,
                    leg: nearest.leg,
                    t: nearest.t,
                }))
            }
            _ => None,
        }
    }

    /// The value that vanishes along the curve.
    pub(crate) fn value<F: Family>(
        &self,
        continuation: &Continuation<F>,
        u: &Unknowns,
    ) -> Option<f64> {
        match self {
            Self::Singular { of, left, right } => {
                Some(solved(&matrix(*of, continuation, u), left, right)?.1)
            }
            Self::Touch(contact) => contact.found(continuation, u).map(|(gap, _)| gap),
            Self::Speed { leg } => {
                let system = continuation.family.plain(u.at);
                let legs = continuation.lap(u.at).legs(&system, &u.z, &u.durations);
                let surface = continuation.sequence.events.get(*leg)?.surface();
                Some(system.speed(surface, &legs[*leg].end))
            }
        }
    }

    /// Its derivatives by all unknowns and both parameters, by central differences: the solution is
    /// as accurate as the value itself.
    pub(crate) fn slopes<F: Family>(
        &self,
        continuation: &Continuation<F>,
        u: &Unknowns,
    ) -> Option<DVector<f64>> {
        let count = continuation.size() + 2;
        let variables = continuation.family.variables();
        let mut slopes = DVector::zeros(count);
        for i in 0..count {
            let at = |by: f64| {
                let mut step = DVector::zeros(count);
                step[i] = by;
                self.value(continuation, &u.moved(variables, &step))
            };
            slopes[i] = (at(DIFFERENCE)? - at(-DIFFERENCE)?) / (2.0 * DIFFERENCE);
        }
        slopes
            .iter()
            .all(|slope| slope.is_finite())
            .then_some(slopes)
    }

    /// The condition updated at a point of the curve: bordered by the null vectors there, or with
    /// the present time of closest approach.
    pub(crate) fn renewed<F: Family>(
        &self,
        continuation: &Continuation<F>,
        u: &Unknowns,
    ) -> Option<Self> {
        match self {
            Self::Singular { of, left, right } => {
                let matrix = matrix(*of, continuation, u);
                let (v, _) = solved(&matrix, left, right)?;
                let (w, _) = solved(&matrix.transpose(), right, left)?;
                Some(Self::Singular {
                    of: *of,
                    left: w.normalize(),
                    right: v.normalize(),
                })
            }
            Self::Touch(contact) => {
                let (_, t) = contact.found(continuation, u)?;
                Some(Self::Touch(Contact { t, ..*contact }))
            }
            Self::Speed { .. } => Some(self.clone()),
        }
    }

    /// The condition after the events were renumbered.
    pub(crate) fn renumbered<F: Family>(
        &self,
        continuation: &Continuation<F>,
        u: &Unknowns,
        shift: isize,
    ) -> Option<Self> {
        let events = continuation.sequence.events.len();
        match self {
            Self::Singular { of, .. } => singular(*of, continuation, u),
            Self::Touch(contact) => {
                // The last leg and the first are one flight, in which the contact may be on the
                // other side of the section than its leg.
                let flight = contact.leg as isize + shift;
                let leg = flight.rem_euclid((events as isize).max(1)) as usize;
                let system = continuation.family.plain(u.at);
                let legs = continuation.lap(u.at).legs(&system, &u.z, &u.durations);
                let (first, last, own) = (legs.first()?, legs.last()?, legs.get(leg)?);
                let length = last.t + last.s - first.t;
                let before = if leg == 0 && events > 0 { last.s } else { 0.0 };
                let middle = own.t + 0.5 * (own.s - before);
                let laps = ((middle - contact.t) / length).round();
                let t = contact.t + laps * length;
                Some(Self::Touch(Contact { leg, t, ..*contact }))
            }
            Self::Speed { leg } => {
                let leg = (*leg as isize + shift).rem_euclid(events as isize) as usize;
                Some(Self::Speed { leg })
            }
        }
    }

    /// a = −g̈/2r where a surface is touched, between events or by a snap of zero velocity.
    pub(crate) fn normal_acceleration<F: Family>(
        &self,
        continuation: &Continuation<F>,
        u: &Unknowns,
    ) -> Option<f64> {
        let (surface, leg, t) = match self {
            Self::Singular { .. } => return None,
            Self::Touch(contact) => (contact.surface, contact.leg, Some(contact.t)),
            Self::Speed { leg } => (
                continuation.sequence.events.get(*leg)?.surface(),
                *leg,
                None,
            ),
        };
        let system = continuation.family.plain(u.at);
        let legs = continuation.lap(u.at).legs(&system, &u.z, &u.durations);
        let leg = legs.get(leg)?;
        let s = t.map_or(leg.s, |t| t - leg.t);
        Some(-rate(continuation, u, leg, surface, s))
    }

    /// The time from a graze to the nearest other event of the lap, negative beyond it: there the
    /// surface would be touched in the continuation of a flight that has ended. Without bound where
    /// there is no other event, or no graze.
    ///
    /// The gap at that event says the same less well: it is zero there without a change of sign.
    pub(crate) fn time_to_events<F: Family>(
        &self,
        continuation: &Continuation<F>,
        u: &Unknowns,
    ) -> f64 {
        let system = continuation.family.plain(u.at);
        let legs = continuation.lap(u.at).legs(&system, &u.z, &u.durations);
        // The last leg and the first are one flight, which the section cuts.
        let last = legs.len() - 1;
        let [from_event, to_event] = match self {
            Self::Touch(contact) if last > 0 && contact.leg <= last => {
                let leg = &legs[contact.leg];
                let s = contact.t - leg.t;
                let [before, after] = [contact.leg == 0, contact.leg == last];
                [
                    s + if before { legs[last].s } else { 0.0 },
                    leg.s - s + if after { legs[0].s } else { 0.0 },
                ]
            }
            Self::Speed { leg } if last > 1 => {
                let [before, after] = [*leg == 0, *leg + 1 == last];
                [
                    legs[*leg].s + if before { legs[last].s } else { 0.0 },
                    legs[*leg + 1].s + if after { legs[0].s } else { 0.0 },
                ]
            }
            _ => [f64::INFINITY; 2],
        };
        from_event.min(to_event)
    }

    /// The event whose snap has zero velocity.
    pub(crate) fn leg(&self) -> Option<usize> {
        match self {
            Self::Speed { leg } => Some(*leg),
            _ => None,
        }
    }

    /// The kind of special orbit.
    pub(crate) fn kind(&self) -> Kind {
        match self {
            Self::Singular { of, .. } => *of,
            Self::Touch(_) | Self::Speed { .. } => Kind::Graze,
        }
    }

    /// Whether an orbit still satisfies it: a pair that has become real is no longer a torus.
    pub(crate) fn is_met(&self, orbit: &Orbit) -> bool {
        match self {
            Self::Singular { of, .. } if *of == Kind::NeimarkSacker => orbit
                .multipliers
                .values
                .iter()
                .any(|[re, im]| *im != 0.0 && (re.hypot(*im) - 1.0).abs() < 1e-5),
            _ => true,
        }
    }
}

/// The derivative of the velocity at which a surface closes, a time `s` into a leg.
fn rate<F: Family>(
    continuation: &Continuation<F>,
    u: &Unknowns,
    leg: &crate::lap::Leg,
    surface: usize,
    s: f64,
) -> f64 {
    let jets = continuation.family.jets(u.at);
    let start: Point<Jet> = leg.start.map(constant);
    let there = jets.flow(
        leg.taut,
        constant(leg.t),
        &start,
        Jet::variable(s, DURATION),
    );
    jets.speed(surface, &there).slope[DURATION]
}

impl Contact {
    /// The gap at the closest approach of the surface, and its time.
    fn found<F: Family>(&self, continuation: &Continuation<F>, u: &Unknowns) -> Option<(f64, f64)> {
        let system = continuation.family.plain(u.at);
        let legs = continuation.lap(u.at).legs(&system, &u.z, &u.durations);
        let leg = legs.get(self.leg)?;
        let mut s = self.t - leg.t;
        let there = |s: f64| system.flow(leg.taut, leg.t, &leg.start, s);
        for _ in 0..MOST_STEPS {
            let speed = system.speed(self.surface, &there(s));
            let step = speed / rate(continuation, u, leg, self.surface, s);
            s -= step;
            // The error of the gap is of second order in that of the time.
            if step.abs() < 1e-9 {
                return Some((system.gap(self.surface, &there(s)), leg.t + s));
            }
        }
        None
    }
}

/// A singular matrix with its null vectors as borders.
fn singular<F: Family>(
    of: Kind,
    continuation: &Continuation<F>,
    u: &Unknowns,
) -> Option<Condition> {
    let [right, left] = null_vectors(&matrix(of, continuation, u))?;
    Some(Condition::Singular { of, left, right })
}

/// The matrix that is singular at a special orbit.
fn matrix<F: Family>(of: Kind, continuation: &Continuation<F>, u: &Unknowns) -> DMatrix<f64> {
    let variables = continuation.family.variables();
    if of == Kind::NeimarkSacker {
        let linear = continuation.lap(u.at).linearise(&u.z, &u.durations);
        let mut compound = compound(&linear.monodromy(variables));
        for i in 0..compound.nrows() {
            compound[(i, i)] -= 1.0;
        }
        return compound;
    }
    let (_, mut jacobian) = continuation.equations(u, 0);
    if of == Kind::PeriodDoubling {
        for i in 0..variables.len() {
            jacobian[(i, i)] += 2.0;
        }
    }
    jacobian
}

/// The second compound matrix: all minors of two rows and two columns.
fn compound(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.nrows();
    let pairs: Vec<[usize; 2]> = (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| [i, j]))
        .collect();
    DMatrix::from_fn(pairs.len(), pairs.len(), |row, column| {
        let ([a, b], [c, d]) = (pairs[row], pairs[column]);
        matrix[(a, c)] * matrix[(b, d)] - matrix[(a, d)] * matrix[(b, c)]
    })
}

#[cfg(test)]
mod tests {
    use super::compound;
    use nalgebra::DMatrix;

    /// The eigenvalues of the second compound matrix are the products of two eigenvalues.
    #[test]
    fn the_compound_matrix_has_the_products() {
        let (angle, size) = (0.7_f64, 0.9);
        let (sine, cosine) = (size * angle.sin(), size * angle.cos());
        let blocks = [[cosine, -sine, 0.3], [sine, cosine, -0.2], [0.0, 0.0, 0.5]];
        let matrix = DMatrix::from_fn(3, 3, |i, j| blocks[i][j]);
        let whole = compound(&matrix);
        // μ₁ μ₂ = |μ|², μ₁ μ₃ and μ₂ μ₃ a pair.
        let products = size * size + 2.0 * 0.5 * cosine;
        assert!((whole.trace() - products).abs() < 1e-14);
        assert!((whole.determinant() - matrix.determinant().powi(2)).abs() < 1e-14);
    }
}
