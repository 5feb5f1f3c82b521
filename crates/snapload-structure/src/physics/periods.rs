//! Natural periods: small undamped motions about the position of rest in still water.
//!
//! ```text
//! M q̈ + K q = 0,    K = Σ T_i ∇(n_i, s_i)  +  Σ k_i (n_i, s_i)ᵀ (n_i, s_i)
//! ```
//!
//! over q = (x, y, θ), with the mass matrix M, which includes the added mass, and T_i and k_i the
//! tension at rest and the spring rate of line i. The first sum is the stiffness of the tension as
//! the lines turn, the second that of the springs. On inextensible lines the second is left
//! out, and q is restricted to the motions that keep taut every line that pulls. From K v = ω² M v
//! follow ω² and the mode v (L. Meirovitch, *Elements of Vibration Analysis* (1986), section 4.3).

use super::afloat::TautMode;
use super::elastic::{ElasticLine, elastic_lines, undamped};
use super::equilibrium::SmallMotions;
use super::mean_drag::damping_by_drag;
use super::model_at_rest::ModelAtRest;
use crate::structure::Afloat;
use nalgebra::{DMatrix, Matrix3};
use serde::Serialize;
use snapload::CaseError;
use snapload_hydro::{Body, HydroError, natural_of_the_file, natural_of_the_memory};

/// Below this ω², in the engine's units, a degree of freedom counts as having no restoring force.
const LEAST_OMEGA_SQUARED: f64 = 1e-7;
/// A component is part of a mode's name if it has at least this part of its kinetic energy.
const NAMED_FROM: f64 = 0.2;

/// A natural small motion of the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NaturalMode {
    /// Its period; none if there is no restoring force \[s\].
    pub period_s: Option<f64>,
    /// Its direction: surge, heave, pitch, or two or three of them.
    pub motion: String,
    /// Its surge \[m\], heave \[m\] and pitch \[rad\], the largest of the three numbers being 1.
    #[serde(rename = "surge_heave_pitch")]
    pub mode: [f64; 3],
    /// The rate 2ζω at which its energy decays by drag and damping of the body, and by the dampers
    /// of elastic lines \[1/s\].
    #[serde(skip)]
    pub energy_decay_1_s: f64,
    /// The part of its kinetic energy that is not in rotation.
    #[serde(skip)]
    pub translation: f64,
}

/// The natural periods for both models of a line, the longest first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NaturalPeriods {
    /// On inextensible lines: one for each degree of freedom that the taut lines allow.
    pub inextensible: Vec<NaturalMode>,
    /// On elastic lines, if their stiffness is known and the body rests on them.
    pub elastic: Option<Vec<NaturalMode>>,
}

impl NaturalPeriods {
    /// Of a submerged structure at rest in still water; a floating one also has the water's
    /// stiffness.
    pub fn of(prepared: &ModelAtRest) -> Option<Self> {
        if prepared.structure.afloat.is_some() {
            return None;
        }
        let elastic = undamped(prepared, 1.0).ok().and_then(|elastic_lines| {
            let elastic_case = prepared.with_elastic_lines(&elastic_lines).ok()?;
            Some(modes_with_elastic_lines(&elastic_case, &elastic_lines))
        });
        Some(Self {
            inextensible: modes_on_inextensible_lines(prepared),
            elastic,
        })
    }
}

impl ModelAtRest {
    /// The small motions of a floating body on elastic lines, if their stiffness is known.
    pub fn modes_on_elastic_lines(&self) -> Vec<TautMode> {
        self.afloat_modes(|prepared| undamped(prepared, 1.0))
    }

    /// The same with the dampers of the lines.
    pub(super) fn modes_on_damped_lines(&self) -> Vec<TautMode> {
        self.afloat_modes(|prepared| elastic_lines(prepared, 1.0))
    }

    fn afloat_modes(&self, lines: ElasticLinesOf) -> Vec<TautMode> {
        let afloat = self.structure.afloat.as_deref();
        let found = afloat.map(|afloat| afloat_modes_on_elastic_lines(self, afloat, lines));
        found.and_then(Result::ok).unwrap_or_default()
    }
}

/// Finds the elastic lines of a structure.
type ElasticLinesOf = fn(&ModelAtRest) -> Result<Vec<ElasticLine>, CaseError>;

/// Natural motions of a floating body on elastic lines: K of the springs and of the water
/// together, with A(ω) of the file and with the memory. None where a stiffness is not known.
///
/// # Errors
/// A [`HydroError`] if mass and added mass are not positive definite.
fn afloat_modes_on_elastic_lines(
    prepared: &ModelAtRest,
    afloat: &Afloat,
    lines: ElasticLinesOf,
) -> Result<Vec<TautMode>, HydroError> {
    let of_lines = lines(prepared).and_then(|elastic_lines| {
        let elastic_case = prepared.with_elastic_lines(&elastic_lines)?;
        let stiffness = elastic_case.stiffness_on(&elastic_lines);
        Ok((stiffness, elastic_case.damping_on(&elastic_lines)))
    });
    let Ok((stiffness, damping)) = of_lines else {
        return Ok(Vec::new());
    };
    // A factor of a length for each rotation, and y up.
    let scales = &prepared.model.scales;
    let unit = [1.0, -1.0, scales.length_m];
    let per = scales.force_n / scales.length_m;
    let in_si = |matrix: &Matrix3<f64>, per: f64| {
        Matrix3::from_fn(|i, j| matrix[(i, j)] * per * unit[i] * unit[j])
    };
    let body = Body {
        stiffness: in_si(&stiffness, per),
        damping: afloat.body.damping + in_si(&damping, per * scales.time_s),
        ..afloat.body.clone()
    };
    let (hydro, fit) = (&afloat.report.reading.hydro, &afloat.report.fit);
    let natural = natural_of_the_file(hydro, &body)?;
    let modes = natural_of_the_memory(&body, &fit.memory, &fit.added_mass_inf, &natural)?;
    Ok(natural.into_iter().zip(modes).collect())
}

pub(super) fn modes_on_inextensible_lines(prepared: &ModelAtRest) -> Vec<NaturalMode> {
    let (rest, model) = (&prepared.rest, &prepared.model);
    let at = model.at_rest(rest.place_m, rest.theta_rad);
    let pulls: Vec<f64> = rest
        .inextensible_tensions_n()
        .iter()
        .map(|tension| tension / model.scales.force_n)
        .collect();
    let lines: Vec<usize> = (0..pulls.len()).collect();
    let motions = SmallMotions::new(&model.system, &lines, &pulls, &at);
    let damping = damping_of_body(prepared);
    modes(prepared, [&motions.curvature, &damping], &motions.basis())
}

pub(super) fn modes_with_elastic_lines(
    elastic_case: &ModelAtRest,
    elastic_lines: &[ElasticLine],
) -> Vec<NaturalMode> {
    let stiffness = elastic_case.stiffness_on(elastic_lines);
    let damping = damping_of_body(elastic_case) + elastic_case.damping_on(elastic_lines);
    modes(
        elastic_case,
        [&stiffness, &damping],
        &DMatrix::identity(3, 3),
    )
}

/// Drag and damping of a submerged body over its velocity (x, y, θ), in the engine's units.
fn damping_of_body(prepared: &ModelAtRest) -> Matrix3<f64> {
    let (body, scales) = (&prepared.structure.body, &prepared.model.scales);
    let (m, l, t) = (scales.mass_kg, scales.length_m, scales.time_s);
    let drag = prepared.model.system.drag.as_ref();
    let [along, up] = drag.map_or([0.0; 2], damping_by_drag);
    let linear = body.linear_damping_n_s_m * t / m;
    let turning = body.turning_damping_n_m_s * t / (m * l * l);
    Matrix3::from_diagonal(&[linear + along, linear + up, turning].into())
}

/// The modes in words: `3.231 s (surge), 0.502 s (heave)`.
pub(crate) fn periods_text(modes: &[NaturalMode]) -> String {
    let one = |mode: &NaturalMode| match mode.period_s {
        Some(period) => format!("{period:.3} s ({})", mode.motion),
        None => format!("none ({})", mode.motion),
    };
    match modes {
        [] => "none, as the lines allow no motion".to_owned(),
        modes => modes.iter().map(one).collect::<Vec<_>>().join(", "),
    }
}

/// The modes of K within the motions that the columns of `basis` span, the slowest first.
fn modes(
    prepared: &ModelAtRest,
    [stiffness, damping]: [&Matrix3<f64>; 2],
    basis: &DMatrix<f64>,
) -> Vec<NaturalMode> {
    if basis.ncols() == 0 {
        return Vec::new();
    }
    let mass = mass_matrix(prepared);
    let within = |matrix: &Matrix3<f64>| basis.transpose() * matrix * basis;
    // With M = R Rᵀ, K v = ω² M v becomes the eigenvalue problem of the symmetric R⁻¹ K R⁻ᵀ.
    let Some(root) = within(&mass).cholesky() else {
        return Vec::new();
    };
    let Some(inverse) = root.l().try_inverse() else {
        return Vec::new();
    };
    let scaled = &inverse * within(stiffness) * inverse.transpose();
    let frame = ((&scaled + scaled.transpose()) * 0.5).symmetric_eigen();
    let mut order: Vec<usize> = (0..frame.eigenvalues.len()).collect();
    order.sort_by(|&i, &j| frame.eigenvalues[i].total_cmp(&frame.eigenvalues[j]));
    let one = |&index: &usize| {
        // R⁻ᵀ makes vᵀMv = 1.
        let mode = basis * inverse.transpose() * frame.eigenvectors.column(index);
        let of_mode = |matrix: &Matrix3<f64>| (mode.transpose() * matrix * &mode)[(0, 0)];
        let squared = frame.eigenvalues[index];
        let omega = (squared > LEAST_OMEGA_SQUARED).then(|| squared.sqrt());
        let scales = &prepared.model.scales;
        NaturalMode {
            period_s: omega.map(|omega| std::f64::consts::TAU / omega * scales.time_s),
            motion: motion(&mass, [mode[0], mode[1], mode[2]]),
            mode: in_si([mode[0], mode[1], mode[2]], scales.length_m),
            energy_decay_1_s: of_mode(damping) / scales.time_s,
            translation: 1.0 - mass[(2, 2)] * mode[2] * mode[2],
        }
    };
    order.iter().map(one).collect()
}

/// M over (x, y, θ), in the engine's units.
fn mass_matrix(prepared: &ModelAtRest) -> Matrix3<f64> {
    let body = &prepared.model.system.body;
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| body.moved_by(e));
    let inverse = Matrix3::from_fn(|row, column| columns[column][row]);
    inverse.try_inverse().unwrap_or_else(Matrix3::zeros)
}

/// A mode in metres and radians with z up, scaled so that its largest component is 1.
fn in_si([x, y, theta]: [f64; 3], length_m: f64) -> [f64; 3] {
    let all = [x * length_m, -y * length_m, -theta];
    let largest = all.into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let unit = largest.filter(|largest| *largest != 0.0).unwrap_or(1.0);
    all.map(|part| part / unit)
}

/// The degrees of freedom that have an appreciable part of a mode's kinetic energy.
fn motion(mass: &Matrix3<f64>, mode: [f64; 3]) -> String {
    let energy = |k: usize| mass[(k, k)] * mode[k] * mode[k];
    let all: f64 = (0..3).map(energy).sum();
    let names = ["surge", "heave", "pitch"];
    let named = (0..3).filter(|&k| energy(k) >= NAMED_FROM * all);
    named.map(|k| names[k]).collect::<Vec<_>>().join(" and ")
}
