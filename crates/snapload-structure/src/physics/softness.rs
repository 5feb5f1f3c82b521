//! Whether lines are too soft to be computed as inextensible.
//!
//! The engine's snap takes no time; a line of spring rate k takes half a period, π sqrt(m/k) with
//! the mass m = M/w that it stops. Lines that are taut together stop the body in more directions
//! than one, and in some of them it may swing far more slowly on these springs than along any one
//! line: in heave on flat lines, above all with a large added mass. With K = Gᵀ diag(k) G of their
//! rows G and the mass matrix M, the ω² of these motions are the eigenvalues other than zero of
//!
//! ```text
//! sqrt(k_i) G_i M⁻¹ G_jᵀ sqrt(k_j),    for one line alone k w/M
//! ```
//!
//! A snap that lasts less than a tenth of the waves' period T is also one whose motion has less
//! than a fifth of it, 2π/ω < T/5. In it the waves' loads then reach the lines as they reach lines
//! that do not stretch: a linear oscillator amplifies them by 1/(1 − (2π/ωT)²), by less than 4.2 %.

use super::model_at_rest::ModelAtRest;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// A snap that lasts longer than this part of a period is not instantaneous.
const INSTANT: f64 = 0.1;
/// An eigenvalue below this part of the largest is that of a motion which the lines do not resist.
const FREE: f64 = 1e-9;

/// Lists the lines that need more than a tenth of a period to stop the body: each alone, and those
/// that are taut at rest together where these take longest.
pub(super) fn soft_lines(prepared: &ModelAtRest, period_s: f64) -> String {
    let lines = prepared.structure.lines.iter().enumerate();
    let alone: Vec<(f64, String)> = lines
        .filter_map(|(index, line)| {
            let stopped_kg = prepared.mass_stopped(index) * prepared.model.scales.mass_kg;
            let lasts = PI * (stopped_kg / line.spring_rate_n_m()?).sqrt();
            Some((lasts, format!("line {}", index + 1)))
        })
        .collect();
    let longest = alone.iter().map(|(lasts, _)| *lasts).fold(0.0, f64::max);
    let together = lasts_together(prepared).filter(|lasts| *lasts > longest * (1.0 + 1e-9));
    let together = together.map(|lasts| (lasts, "the lines that are taut at rest together".into()));
    let soft = alone.into_iter().chain(together);
    let soft = soft.filter(|(lasts, _)| *lasts > INSTANT * period_s);
    let each = soft.map(|(lasts, lines)| format!("{lasts:.2} s in {lines}"));
    each.collect::<Vec<_>>().join(", ")
}

/// Half a period of the slowest motion that the lines with tension at rest resist together; none
/// if there are none, or a spring rate is not known \[s\].
fn lasts_together(prepared: &ModelAtRest) -> Option<f64> {
    let (rest, model) = (&prepared.rest, &prepared.model);
    let (system, scales) = (&model.system, &model.scales);
    let at = model.at_rest(rest.place_m, rest.theta_rad);
    let pulling = (0..system.cables.len()).filter(|&line| rest.tension_n[line] > 0.0);
    let rows = pulling.map(|line| {
        let normal = system.cables[line].normal(&at);
        let rate = prepared.structure.lines[line].spring_rate_n_m()?;
        let root = (rate * scales.length_m / scales.force_n).sqrt();
        Some([normal.n.x, normal.n.y, normal.arm].map(|part| part * root))
    });
    let rows: Vec<[f64; 3]> = rows.collect::<Option<_>>()?;
    let moved: Vec<[f64; 3]> = rows.iter().map(|row| system.body.moved_by(*row)).collect();
    let dot = |i: usize, j: usize| (0..3).map(|k| rows[i][k] * moved[j][k]).sum::<f64>();
    let together = DMatrix::from_fn(rows.len(), rows.len(), |i, j| dot(i.max(j), i.min(j)));
    let squared = (!rows.is_empty()).then(|| together.symmetric_eigenvalues())?;
    let resisted = squared
        .iter()
        .copied()
        .filter(|one| *one > FREE * squared.max());
    let slowest = resisted.fold(f64::INFINITY, f64::min);
    Some(PI / slowest.sqrt() * scales.time_s)
}
