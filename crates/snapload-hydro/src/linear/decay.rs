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
}

/// One swing of a decay, from one turning point to the next on the same side.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// When it begins \[s\].
    pub from_s: f64,
    /// The amplitude there.
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
        let wanted = "a positive step is wanted, and at most a million of them";
        return Err(HydroError::value("the step in s", step_s, wanted));
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
    };
    for step in 0..=count {
        decay.t_s.push(step as f64 * step_s);
        decay.q.push(Vector3::new(state[0], state[1], state[2]));
        state = &forward * state;
    }
    Ok(decay)
}

/// The ends of the two ranges of the Fourier integral, in units of the last frequency, and the
/// panels of each: resonances lie in the first.
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

/// The swings of one freedom about its rest at zero, from its turning points. Swings below a
/// thousandth of the first are left out.
pub fn swings(decay: &Decay, freedom: usize) -> Vec<Swing> {
    let x: Vec<f64> = decay.q.iter().map(|q| q[freedom]).collect();
    let step = match decay.t_s.as_slice() {
        [first, second, ..] => second - first,
        _ => return Vec::new(),
    };
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    if let Some(first) = x.first().filter(|first| **first != 0.0) {
        peaks.push((0.0, *first));
    }
    for k in 1..x.len().saturating_sub(1) {
        let (before, here, after) = (x[k - 1], x[k], x[k + 1]);
        let turns = (here - before) * (after - here) <= 0.0 && here != before;
        if turns && here.abs() > 0.0 {
            // The vertex of the parabola through three points.
            let bend = before - 2.0 * here + after;
            let shift = if bend == 0.0 {
                0.0
            } else {
                0.5 * (before - after) / bend
            };
            let height = here - 0.25 * (before - after) * shift;
            peaks.push(((k as f64 + shift) * step, height));
        }
    }
    let least = peaks.first().map_or(0.0, |peak| 1e-3 * peak.1.abs());
    let pairs = peaks.windows(3).map(|three| (three[0], three[2]));
    let alike = |(a, b): &((f64, f64), (f64, f64))| a.1 * b.1 > 0.0 && b.1.abs() > least;
    let swing = |((t0, x0), (t1, x1)): ((f64, f64), (f64, f64))| {
        let delta = (x0 / x1).ln();
        Swing {
            from_s: t0,
            amplitude: x0,
            period_s: t1 - t0,
            damping_ratio: delta / (4.0 * PI * PI + delta * delta).sqrt(),
        }
    };
    pairs.filter(alike).map(swing).collect()
}
