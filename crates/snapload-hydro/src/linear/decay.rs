//! Free decay: the body is released from a displacement in still water, without lines.

use super::body::Body;
use super::natural::{of_matrix, state_matrix};
use super::swings::{Turn, changes_sign};
use crate::coefficients::Hydrodynamics;
use crate::digits::{digits, in_full};
use crate::error::HydroError;
use crate::memory::{DampingCurve, Memory};
use nalgebra::{Complex, DMatrix, Matrix3, Vector3};
use std::f64::consts::PI;

/// The motion after the release.
#[derive(Clone, Debug, PartialEq)]
pub struct Decay {
    /// t \[s\]: every step, and the end of the duration.
    pub t_s: Vec<f64>,
    /// q \[m, m, rad\].
    pub q: Vec<Vector3<f64>>,
    /// The turns of each freedom, between the rows, too. The release is the first.
    pub turns: [Vec<Turn>; 3],
    /// Whether a stiffness brings each freedom back to zero.
    pub comes_back: [bool; 3],
}

/// The most steps of a motion and the most rows of its table.
const MOST_STEPS: f64 = 1e7;
const MOST_ROWS: f64 = 1e6;
/// The shortest and the longest time between rows \[s\].
const STEPS_S: [f64; 2] = [1e-6, 1e6];
/// Times less than this part of a step apart are the same.
const SAME_TIME: f64 = 1e-9;
/// The longest step as a part of 1/|λ| of the fastest oscillation: a cubic through velocities and
/// accelerations that far apart is off by less than a millionth.
const PART_OF_OSCILLATION: f64 = 0.125;

/// The motion from rest at `start`, with the exponentials as the memory. It is linear with constant
/// coefficients, so that each step of a fixed length is one multiplication, y ← e^{Lh} y, exact to
/// rounding. Turns are found in steps that are short enough for the motion, however far the rows
/// are apart, and up to the duration, which may be after the last row. `on_progress` is called with
/// the part that is done.
///
/// # Errors
/// A [`HydroError`] if the mass is not positive definite, or the times are not possible.
pub fn decay(
    body: &Body,
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
    start: impl Into<Vector3<f64>>,
    [duration_s, row_s]: [f64; 2],
    on_progress: &dyn Fn(f64),
) -> Result<Decay, HydroError> {
    let last_row = last_row(duration_s, row_s)?;
    let identity = DMatrix::identity(3, 3);
    let matrix = state_matrix(body, &body.stiffness, memory, added_mass_inf, &identity)?;
    let parts = steps_per_row(&matrix, [duration_s, row_s])?;
    let step_s = row_s / parts as f64;
    let steps = (duration_s / step_s + SAME_TIME) as usize;
    let (to_row, step) = (Flow::new(&matrix, row_s), Flow::new(&matrix, step_s));
    let mut row_state = vec![0.0; matrix.nrows()];
    row_state[..3].copy_from_slice(start.into().as_slice());
    let mut state = row_state.clone();
    let mut decay = Decay {
        t_s: Vec::with_capacity(last_row + 1),
        q: Vec::with_capacity(last_row + 1),
        turns: std::array::from_fn(|i| Turn::at_release(state[i]).into_iter().collect()),
        comes_back: [0, 1, 2].map(|i| body.stiffness[(i, i)] != 0.0),
    };
    for row in 0..=last_row {
        let t_s = row as f64 * row_s;
        decay.t_s.push(t_s);
        decay.q.push(Vector3::from_column_slice(&row_state[..3]));
        for part in 0..parts.min(steps.saturating_sub(row * parts)) {
            let next = step.applied(&state);
            let times = [t_s + part as f64 * step_s, step_s];
            decay.turns_within(times, &matrix, [&state, &next]);
            state = next;
        }
        if row == last_row {
            break;
        }
        row_state = match parts {
            1 => state.clone(),
            _ => to_row.applied(&row_state),
        };
        on_progress(row as f64 / last_row as f64);
    }
    let rest_s = duration_s - last_row as f64 * row_s;
    if rest_s > SAME_TIME * row_s {
        let end = Flow::new(&matrix, rest_s).applied(&row_state);
        decay.t_s.push(duration_s);
        decay.q.push(Vector3::from_column_slice(&end[..3]));
    }
    Ok(decay)
}

/// The number of the last row that is a multiple of the step, the first being 0.
fn last_row(duration_s: f64, row_s: f64) -> Result<usize, HydroError> {
    let [least, most] = STEPS_S;
    if !(least..=most).contains(&row_s) {
        let expected = format!("the step must be above 0, from {least:e} to {most:e}");
        return Err(HydroError::value("the step in s", row_s, expected));
    }
    if !(duration_s >= 0.0 && duration_s <= MOST_ROWS * row_s) {
        let most = MOST_ROWS * row_s;
        let [most, row_s] = [most, row_s].map(|time_s| in_full(&time_s));
        let expected = format!("0 to {most} is allowed, a million steps of {row_s} s");
        return Err(HydroError::value("the duration in s", duration_s, expected));
    }
    Ok((duration_s / row_s + SAME_TIME) as usize)
}

/// Into how many steps the motion from one row to the next is divided. Eigenvalues that are real
/// make nothing turn back.
fn steps_per_row(
    matrix: &DMatrix<f64>,
    [duration_s, row_s]: [f64; 2],
) -> Result<usize, HydroError> {
    let values = of_matrix(matrix.clone())?;
    let oscillations = values.iter().filter(|value| value.im != 0.0);
    let fastest = oscillations.map(|value| value.norm()).fold(0.0, f64::max);
    let parts = (row_s * fastest / PART_OF_OSCILLATION).ceil().max(1.0);
    if parts * duration_s / row_s > MOST_STEPS {
        let most = (MOST_STEPS * row_s / parts).floor();
        let expected = format!(
            "as the body oscillates with up to {} rad/s, it is followed for at most {most} s",
            digits(&fastest, 1)
        );
        return Err(HydroError::value("the duration in s", duration_s, expected));
    }
    Ok(parts as usize)
}

/// e^{Lh}, by columns. Its products are loops of this crate, which is compiled with optimisation
/// where the library of matrices is not.
struct Flow {
    size: usize,
    columns: Vec<f64>,
}

impl Flow {
    fn new(matrix: &DMatrix<f64>, h_s: f64) -> Self {
        Self {
            size: matrix.nrows(),
            columns: (matrix * h_s).exp().as_slice().to_vec(),
        }
    }

    /// The state h later.
    fn applied(&self, state: &[f64]) -> Vec<f64> {
        let mut later = vec![0.0; self.size];
        for (column, value) in self.columns.chunks_exact(self.size).zip(state) {
            for (sum, entry) in later.iter_mut().zip(column) {
                *sum += entry * value;
            }
        }
        later
    }
}

impl Decay {
    /// Adds the turns between two states a step apart.
    fn turns_within(&mut self, times: [f64; 2], matrix: &DMatrix<f64>, [state, next]: [&[f64]; 2]) {
        for (i, turns) in self.turns.iter_mut().enumerate() {
            let acceleration = |state: &[f64]| -> f64 {
                let row = matrix.row(3 + i);
                row.iter().zip(state).map(|(entry, y)| entry * y).sum()
            };
            let v = [state, next].map(|state| state[3 + i]);
            if changes_sign(v) {
                let a = [state, next].map(acceleration);
                turns.push(Turn::between(times, state[i], v, a));
            }
        }
    }
}

/// Ends of the two ranges of the Fourier integral in last frequencies, and panels of each:
/// resonances lie in the first.
const RANGES: [(f64, usize); 2] = [(1.3, 12_000), (12.0, 2_000)];

/// The decay of heave alone, computed from the file's damping without exponentials: with A∞ and K̂
/// from B (Kramers and Kronig), the Fourier integral of the frequency response,
///
/// ```text
/// x̂(iω) = x0 (iω(M + A∞) + K̂)/(C − ω²(M + A∞) + iωK̂),    x(t) = (2/π) ∫ Re x̂ cos ωt dω
/// ```
///
/// for a motion that is zero before t = 0. The difference from the other decay is the error of the
/// exponentials.
pub fn decay_of_the_damping(
    hydro: &Hydrodynamics,
    body: &Body,
    added_mass_inf: &Matrix3<f64>,
    start_m: f64,
    t_s: &[f64],
) -> Vec<f64> {
    let curve = DampingCurve::new(&hydro.omega_rad_s, &hydro.damping_entry(1, 1));
    let mass = body.mass[(1, 1)] + added_mass_inf[(1, 1)];
    let (c, extra) = (body.stiffness[(1, 1)], body.damping[(1, 1)]);
    let last = hydro.range_rad_s()[1];
    let i = Complex::new(0.0, 1.0);
    let value = |omega: f64| {
        let transform = match omega > 0.0 {
            true => Complex::new(curve.at(omega), omega * curve.added_mass(omega)),
            false => Complex::new(0.0, 0.0),
        };
        let resistance = transform + extra;
        let up = i * omega * mass + resistance;
        let down = c - omega * omega * mass + i * omega * resistance;
        (omega, start_m * (up / down).re)
    };
    let mut values = vec![value(0.0)];
    let mut from = 0.0;
    for (end, panels) in RANGES {
        let step = (end * last - from) / panels as f64;
        values.extend((1..=panels).map(|k| value(from + step * k as f64)));
        from = end * last;
    }
    let at = |t: &f64| 2.0 / PI * filon(&values, *t);
    t_s.iter().map(at).collect()
}

/// ∫ f cos ωt dω of a function that is linear between the given points, exactly.
fn filon(values: &[(f64, f64)], t: f64) -> f64 {
    let mut sum = 0.0;
    let (mut a, mut fa) = values[0];
    let (mut sine, mut cosine) = (a * t).sin_cos();
    for (b, fb) in values[1..].iter().copied() {
        let h = b - a;
        let (next_sine, next_cosine) = (b * t).sin_cos();
        sum += if t * h < 1e-4 {
            0.5 * h * (fa * cosine + fb * next_cosine)
        } else {
            let slope = (fb - fa) / h;
            (fb * next_sine - fa * sine) / t + slope * (next_cosine - cosine) / (t * t)
        };
        (a, fa, sine, cosine) = (b, fb, next_sine, next_cosine);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The longest duration that a refusal names is allowed, and a longer one is not. A mass that
    /// oscillates with 1 rad/s is followed in steps of at most 0.125 s: 11 of them from row to row,
    /// where 10.02 would do, so that ten million steps are 10^7/11 rows.
    #[test]
    fn the_longest_duration_that_is_named_is_allowed() {
        let oscillator = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0]);
        let row_s = 10.02 * 0.125;
        let of = |duration_s: f64| steps_per_row(&oscillator, [duration_s, row_s]);
        let most = (1e7 / 11.0 * row_s).floor();
        assert_eq!(of(most), Ok(11));
        let error = of(most + 1.0).expect_err("a refusal").to_string();
        assert!(error.ends_with(&format!("at most {most} s")), "{error}");
    }
}
