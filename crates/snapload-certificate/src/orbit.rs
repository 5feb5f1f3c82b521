//! Periodic orbits as theorems: that an orbit exists, where it is, and that no other one is near.
//!
//! Let P be the map from the section to the section a lap later. A lap of all states of a box X
//! about a number ẑ is proved to have one sequence of snaps, each at a velocity above zero, with no
//! other gap closed and no limit reached in between, so that P is smooth on X; and its derivative
//! lies in an interval matrix A there. Let C be any matrix, f = P − 1 and
//!
//! ```text
//! q = ‖1 − C (A − 1)‖,      c = ‖C f(ẑ)‖,
//! ```
//!
//! in the largest-component norm. The map z → z − C f(z) has the derivative 1 − C (P' − 1), and so
//! contracts X by q; if c + q δ < δ, δ the radius of X, it maps X into itself and has there exactly
//! one fixed point, by Banach. As q < 1, C is not singular, and the fixed point closes the lap. It
//! is within c/(1 − q) of ẑ (R. Krawczyk, *Computing* 4 (1969) 187; R. E. Moore, *SIAM J. Numer.
//! Anal.* 14 (1977) 611).

mod lap;

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::{Decimal, fixed, significant};
use crate::arithmetic::radius::Radius;
use crate::case::ExactCase;
use crate::model::State;
use crate::slack::impact::Matrix;
use crate::verdict::ProofFailure;
use lap::{Lap, Laps};

/// Limbs of the numbers: 256 bits.
const LIMBS: usize = 4;
/// Newton's steps before the proof at most: two or three from a guess of doubles, more near a fold.
const STEPS: usize = 12;
/// A residual below 2^this needs no further step.
const CLOSED: i64 = -130;
/// Radii of the box, as powers of two: the first with which the proof succeeds is taken.
const RADII: [i64; 6] = [-27, -34, -41, -50, -64, -80];
/// Places after the point of states and times, and digits of velocities.
const PLACES: i64 = 30;
const DIGITS: i64 = 17;

/// An orbit known approximately, whose existence is to be proved.
#[derive(Clone, Copy, Debug)]
pub struct CandidateOrbit<'a> {
    /// The time of its section, in periods of the forcing.
    pub phase: f64,
    /// How many periods of the forcing it has.
    pub periods: u32,
    /// The state at the section, next to the true one.
    pub state: [f64; 6],
    /// The cables that snap in a lap, one after the other, by index from 0.
    pub struck: &'a [usize],
}

/// An orbit that is proved to exist.
#[derive(Clone, Debug)]
pub struct ProvedOrbit {
    /// The state at the section; each number is within half a unit of its last digit of the true
    /// one.
    pub state: [String; 6],
    /// Its snaps: the cable by index from 0, time and v_n, in the same way.
    pub snaps: Vec<(usize, String, String)>,
    /// No other orbit with these snaps starts at a state that differs from this one's by less than
    /// this in every component.
    pub unique_within: f64,
    /// Enclosures of the states at all sections of a lap, one a period of the forcing.
    sections: Vec<State>,
}

impl ProvedOrbit {
    /// An upper bound on the difference of the numbers of a state from the true ones.
    pub fn error_of(&self, state: &[f64; 6]) -> f64 {
        let off = |(ball, number): (&Ball, &f64)| (ball - &Ball::double(*number)).upper();
        let errors = self.sections[0].iter().zip(state).map(off);
        above(errors.max().unwrap_or(Radius::ZERO))
    }

    /// Whether it is certainly another orbit: its state at the section differs from all section
    /// states of the other orbit.
    pub fn differs_from(&self, other: &Self) -> bool {
        let apart = |theirs: &State| are_apart(&self.sections[0], theirs);
        other.sections.iter().all(apart)
    }

    /// Whether it certainly does not repeat after fewer periods of the forcing.
    pub fn is_prime(&self) -> bool {
        let first = &self.sections[0];
        self.sections[1..]
            .iter()
            .all(|later| are_apart(first, later))
    }
}

/// Proves that an orbit in slack flight exists near the supposed one.
///
/// # Errors
/// Why that is not proved, in words: it is false, or could not be decided.
pub fn prove_orbit(
    case: &ExactCase,
    candidate: &CandidateOrbit<'_>,
) -> Result<ProvedOrbit, String> {
    proved(case, candidate).map_err(|failure| match failure {
        ProofFailure::Refuted(what) => what,
        ProofFailure::Undecided { what, .. } => format!("it could not be decided: {what}"),
        ProofFailure::StoppedEarly | ProofFailure::Cancelled => "the proof was given up".to_owned(),
    })
}

fn proved(case: &ExactCase, candidate: &CandidateOrbit<'_>) -> Result<ProvedOrbit, ProofFailure> {
    let CandidateOrbit {
        phase,
        periods,
        state,
        struck,
    } = *candidate;
    let no_number = || {
        ProofFailure::Refuted(
            "the phase or the state of the orbit is not finite, or its number of periods is 0"
                .to_owned(),
        )
    };
    let phase = Decimal::shortest(phase).ok_or_else(no_number)?.ball(LIMBS);
    if periods == 0 || !state.iter().all(|number| number.is_finite()) {
        return Err(no_number());
    }
    let laps = Laps::new(case, (&phase, periods), LIMBS)?;
    let moving: &[usize] = if case.is_point {
        &[0, 1, 3, 4]
    } else {
        &[0, 1, 2, 3, 4, 5]
    };
    let guess = state.map(|number| Ball::double(number).with_limbs(LIMBS));
    let near = refined(&laps, guess, struck, moving)?;
    let (centre, reach, radius) = contracting(&laps, near, struck, moving)?;
    let found = about(&centre, reach, moving);
    let lap = laps.of(&found, struck)?;
    let mut sections = lap.sections;
    sections.insert(0, found);
    let unclear = || ProofFailure::undecided("the digits of the orbit");
    let digits: Option<Vec<String>> = sections[0].iter().map(|ball| fixed(ball, PLACES)).collect();
    let state = digits.and_then(|digits| digits.try_into().ok());
    let snaps = lap.impacts.iter().map(|impact| {
        let (t, v_n) = (fixed(&impact.t, PLACES)?, significant(&impact.v_n, DIGITS)?);
        Some((impact.cable, t, v_n))
    });
    Ok(ProvedOrbit {
        state: state.ok_or_else(unclear)?,
        snaps: snaps.collect::<Option<_>>().ok_or_else(unclear)?,
        unique_within: below(radius.minus(reach)),
        sections,
    })
}

/// A state ẑ near the orbit, with C and C f(ẑ).
struct ApproximateOrbit {
    centre: State,
    inverse: Vec<Vec<Ball>>,
    /// ‖C f(ẑ)‖.
    size: Radius,
}

/// Newton's method from a guess. The proof does not depend on its accuracy, only on the last
/// residual.
fn refined(
    laps: &Laps,
    mut centre: State,
    struck: &[usize],
    moving: &[usize],
) -> Result<ApproximateOrbit, ProofFailure> {
    let mut step = 0;
    loop {
        let lap = laps.of(&centre, struck)?;
        let inverse = inverse(&lap.derivative, moving)?;
        let off = moving.iter().map(|&i| &lap.image[i] - &centre[i]);
        let steps = applied(&inverse, &off.collect::<Vec<_>>());
        let size = steps.iter().map(Ball::upper).max().unwrap_or(Radius::ZERO);
        if step == STEPS || size < Radius::power_of_two(CLOSED) {
            return Ok(ApproximateOrbit {
                centre,
                inverse,
                size,
            });
        }
        for (&i, change) in moving.iter().zip(&steps) {
            centre[i] = (&centre[i] - change).with_limbs(LIMBS).centre();
        }
        step += 1;
    }
}

/// The largest box on which the map contracts: ẑ, a bound on the orbit's distance from it, and δ.
fn contracting(
    laps: &Laps,
    near: ApproximateOrbit,
    struck: &[usize],
    moving: &[usize],
) -> Result<(State, Radius, Radius), ProofFailure> {
    let ApproximateOrbit {
        centre,
        inverse,
        size,
    } = near;
    let mut why = ProofFailure::undecided("whether the map of the lap is a contraction");
    for radius in RADII.map(Radius::power_of_two) {
        let lap = match laps.of(&about(&centre, radius, moving), struck) {
            Ok(lap) => lap,
            Err(failure) => {
                why = failure;
                continue;
            }
        };
        let q = contraction(&lap, &inverse, moving);
        let left = Radius::power_of_two(0).minus(q);
        if left.is_zero() {
            continue;
        }
        let reach = size.over(left);
        if reach < radius {
            return Ok((centre, reach, radius));
        }
    }
    Err(why)
}

/// ‖1 − C (A − 1)‖.
fn contraction(lap: &Lap, inverse: &[Vec<Ball>], moving: &[usize]) -> Radius {
    let unit = |i: usize, j: usize| Ball::integer(i64::from(i == j));
    let columns: Vec<Vec<Ball>> = moving
        .iter()
        .map(|&j| {
            let column = moving.iter().map(|&i| &lap.derivative[i][j] - &unit(i, j));
            applied(inverse, &column.collect::<Vec<_>>())
        })
        .collect();
    let row = |i: usize| {
        let entries = columns.iter().enumerate();
        let sizes = entries.map(|(j, column)| (unit(i, j) - &column[i]).upper());
        sizes.fold(Radius::ZERO, Radius::plus)
    };
    (0..moving.len()).map(row).max().unwrap_or(Radius::ZERO)
}

/// The box of a radius about a state, in the components that move.
fn about(centre: &State, radius: Radius, moving: &[usize]) -> State {
    let mut states = centre.clone();
    for &i in moving {
        states[i] = states[i].clone().widened(radius);
    }
    states
}

/// A matrix times a vector.
fn applied(matrix: &[Vec<Ball>], vector: &[Ball]) -> Vec<Ball> {
    let row = |row: &Vec<Ball>| {
        let products = row.iter().zip(vector).map(|(a, b)| a * b);
        products.fold(Ball::zero(), |sum, part| sum + part)
    };
    matrix.iter().map(row).collect()
}

/// Doubles next to the inverse of A − 1, by Gauss and Jordan with the largest pivots.
fn inverse(derivative: &Matrix, moving: &[usize]) -> Result<Vec<Vec<Ball>>, ProofFailure> {
    let n = moving.len();
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let entry = |j: usize| derivative[moving[i]][moving[j]].to_f64();
            let left = (0..n).map(|j| entry(j) - f64::from(u8::from(i == j)));
            let right = (0..n).map(|j| f64::from(u8::from(i == j)));
            left.chain(right).collect()
        })
        .collect();
    for k in 0..n {
        let size = |row: &usize| rows[*row][k].abs();
        let pivot = (k..n).max_by(|a, b| size(a).total_cmp(&size(b)));
        rows.swap(k, pivot.unwrap_or(k));
        let (row, scale) = (rows[k].clone(), 1.0 / rows[k][k]);
        if !scale.is_finite() {
            return Err(ProofFailure::undecided("an orbit with a multiplier of one"));
        }
        for (i, other) in rows.iter_mut().enumerate() {
            let factor = if i == k {
                1.0 - scale
            } else {
                other[k] * scale
            };
            for (entry, part) in other.iter_mut().zip(&row) {
                *entry -= factor * part;
            }
        }
    }
    let balls = |row: Vec<f64>| row[n..].iter().map(|entry| Ball::double(*entry)).collect();
    Ok(rows.into_iter().map(balls).collect())
}

/// Whether no state of one box is one of the other.
fn are_apart(a: &State, b: &State) -> bool {
    a.iter().zip(b).any(|(a, b)| a.is_below(b) || b.is_below(a))
}

/// A double that is at least a bound, and one that is at most a bound.
fn above(bound: Radius) -> f64 {
    bound.to_f64().next_up()
}

fn below(bound: Radius) -> f64 {
    bound.to_f64().next_down().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload::Parameters;

    /// The determinant, by elimination.
    fn determinant(matrix: &Matrix, moving: &[usize]) -> Ball {
        let n = moving.len();
        let mut rows: Vec<Vec<Ball>> = moving
            .iter()
            .map(|&i| moving.iter().map(|&j| matrix[i][j].clone()).collect())
            .collect();
        let mut product = Ball::integer(1);
        for k in 0..n {
            let pivot = (k..n).max_by(|a, b| {
                let size = |row: &usize| rows[*row][k].to_f64().abs();
                size(a).total_cmp(&size(b))
            });
            let pivot = pivot.expect("a row");
            rows.swap(k, pivot);
            product = if pivot == k { product } else { -product } * &rows[k][k];
            let row = rows[k].clone();
            for other in &mut rows[k + 1..] {
                let factor = other[k].over(&row[k]).expect("a pivot");
                for j in k..n {
                    other[j] = &other[j] - &(&factor * &row[j]);
                }
            }
        }
        product
    }

    /// Flights preserve volume in the phase space and each snap multiplies it by e²: det M = e^(2N)
    /// for every body, in all digits.
    #[test]
    fn the_derivative_of_a_lap_has_the_determinant_of_its_snaps() {
        let point = Parameters {
            inertia: None,
            a: 0.0,
            r: 1.7,
            e: 0.35,
            f_o: 1.4,
            nu: 0.8,
            omega: 3.1,
            ..Parameters::STANDARD
        };
        let ring = Parameters {
            omega: 3.0,
            ..Parameters::STANDARD
        };
        type OneCase<'a> = (Parameters, [f64; 6], &'a [usize], &'a [usize]);
        let cases: [OneCase<'_>; 2] = [
            (
                point,
                [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0],
                &[1, 0],
                &[0, 1, 3, 4],
            ),
            (
                ring,
                [
                    -0.0645452, 0.1182095, 0.4786847, 0.3865887, 0.6466434, -1.6661558,
                ],
                &[1, 1, 0],
                &[0, 1, 2, 3, 4, 5],
            ),
        ];
        for (parameters, state, struck, moving) in cases {
            let case = ExactCase::of(&parameters, |_| None).expect("a case");
            let laps = Laps::new(&case, (&Ball::zero(), 1), LIMBS).expect("a lap");
            let lap = laps.of(&state.map(Ball::double), struck).expect("a lap");
            let found = determinant(&lap.derivative, moving);
            let e = case.number("e").ball(LIMBS);
            let rule = (0..2 * struck.len()).fold(Ball::integer(1), |power, _| power * &e);
            let off = &found - &rule;
            assert!(!off.is_positive() && !off.is_negative(), "{}", off.to_f64());
            assert!(off.upper() < Radius::power_of_two(-90));
        }
    }
}
