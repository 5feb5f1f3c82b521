//! Free decay: the body is released from a displacement in still water, without lines.

use super::body::Body;
use super::natural::state_matrix;
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use crate::memory::{DampingCurve, Memory};
use nalgebra::{Complex, DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::PI;

/// The motion after the release.
#[derive(Clone, Debug, PartialEq)]
pub struct Decay {
    /// t \[s\].
    pub t_s: Vec<f64>,
    /// q \[m, m, rad\].
    pub q: Vec<Vector3<f64>>,
    /// Whether a stiffness brings each freedom back to zero.
    pub comes_back: [bool; 3],
}

/// One swing of a decay, from one turning point to the next on the same side.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// When it begins \[s\].
    pub from_s: f64,
    /// The amplitude there: from zero, or of a freedom that does not come back there from where it
    /// swings about.
    pub amplitude: f64,
    /// How long it takes \[s\].
    pub period_s: f64,
    /// ζ = δ/sqrt(4π² + δ²), δ the logarithm of the ratio of the amplitudes.
    pub damping_ratio: f64,
}

/// The motion from rest at `start`, with the exponentials as the memory. It is linear with constant
/// coefficients, so that each step of a fixed length is one multiplication, y ← e^{Lh} y, exact to
/// rounding.
///
/// # Errors
/// A [`HydroError`] if the mass is not positive definite, or the times are not possible.
pub fn decay(
    body: &Body,
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
    start: impl Into<Vector3<f64>>,
    [duration_s, step_s]: [f64; 2],
) -> Result<Decay, HydroError> {
    let steps = duration_s / step_s;
    if !(step_s > 0.0 && steps.is_finite() && (0.0..=1e6).contains(&steps)) {
        let expected = "the step must be above 0, and the duration at most a million steps";
        return Err(HydroError::value("the step in s", step_s, expected));
    }
    let identity = DMatrix::identity(3, 3);
    let matrix = state_matrix(body, &body.stiffness, memory, added_mass_inf, &identity)?;
    let forward = (matrix * step_s).exp();
    let mut state = DVector::zeros(forward.nrows());
    state.rows_mut(0, 3).copy_from(&start.into());
    let count = (steps + 1e-9) as usize;
    let mut decay = Decay {
        t_s: Vec::with_capacity(count + 1),
        q: Vec::with_capacity(count + 1),
        comes_back: [0, 1, 2].map(|i| body.stiffness[(i, i)] != 0.0),
    };
    for step in 0..=count {
        decay.t_s.push(step as f64 * step_s);
        decay.q.push(Vector3::new(state[0], state[1], state[2]));
        state = &forward * state;
    }
    Ok(decay)
}

/// Ways between turns below so much of the furthest turn are rounding.
const ROUNDING: f64 = 1e-9;

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

/// The swings of one freedom, from its turning points: about zero where a stiffness brings it back
/// there. Surge without lines stays where it ends, and is described by the distances between its
/// turns: in a swing with the ratio q² of one amplitude to the next about any place, the way from a
/// turn to the next is the amplitude times 1 + q. Swings below a thousandth of the first are left
/// out.
pub fn swings(decay: &Decay, freedom: usize) -> Vec<Swing> {
    let turns = turns(decay, freedom);
    let about_zero = decay.comes_back[freedom];
    let heights: Vec<f64> = match about_zero {
        true => turns.iter().map(|turn| turn.1).collect(),
        false => turns.windows(2).map(|two| two[0].1 - two[1].1).collect(),
    };
    let furthest = turns.iter().map(|turn| turn.1.abs()).fold(0.0, f64::max);
    let first = heights.first().map_or(0.0, |height| height.abs());
    let least = (1e-3 * first).max(ROUNDING * furthest);
    let swing = |k: usize| {
        let (x0, x1) = (heights[k], heights[k + 2]);
        let ratio = x1 / x0;
        (ratio > 0.0 && x1.abs() > least).then(|| {
            let delta = -ratio.ln();
            Swing {
                from_s: turns[k].0,
                amplitude: if about_zero {
                    x0
                } else {
                    x0 / (1.0 + ratio.sqrt())
                },
                period_s: turns[k + 2].0 - turns[k].0,
                damping_ratio: delta / (4.0 * PI * PI + delta * delta).sqrt(),
            }
        })
    };
    (0..heights.len().saturating_sub(2))
        .filter_map(swing)
        .collect()
}

/// Where a freedom turns, and when, with its start.
fn turns(decay: &Decay, freedom: usize) -> Vec<(f64, f64)> {
    let x: Vec<f64> = decay.q.iter().map(|q| q[freedom]).collect();
    let [first_s, second_s, ..] = decay.t_s[..] else {
        return Vec::new();
    };
    let start = x.first().filter(|first| **first != 0.0);
    let start = start.map(|first| (first_s, *first));
    let within = (1..x.len().saturating_sub(1)).filter_map(|k| {
        let (before, here, after) = (x[k - 1], x[k], x[k + 1]);
        let turns = (here - before) * (after - here) <= 0.0 && here != before;
        (turns && here != 0.0).then(|| {
            // The vertex of the parabola through three points.
            let second_difference = before - 2.0 * here + after;
            let shift = if second_difference == 0.0 {
                0.0
            } else {
                0.5 * (before - after) / second_difference
            };
            let height = here - 0.25 * (before - after) * shift;
            ((k as f64 + shift) * (second_s - first_s), height)
        })
    });
    start.into_iter().chain(within).collect()
}
