//! A floating body on its lines: from the coefficients of a panel code to the engine's units, and
//! its position of rest (docs/floating.md).
//!
//! The origin of the engine's axes is the mean position, for which the coefficients were computed,
//! and not the position of rest. The units are M = m + A33(∞), F = M g and T = sqrt(L/g), as the
//! net buoyancy may be zero.

use super::equilibrium::{Equilibrium, steady_load_error_if_cause};
use super::model::{Groups, Model, Scales, cable, drag, rules, shape, waves};
use super::sea::Spectrum;
use super::wave::LinearWave;
use crate::structure::{Afloat, Structure, Water};
use crate::text_layout::kilo;
use nalgebra::{Complex, Matrix3, Vector3};
use snapload::{
    Body, CaseError, Excitation, Exponential, Floating, FloatingUnits, Forcing, System,
};
use snapload_hydro::{HydroError, Line, Mode, Natural, Term, rest, rest_without_tension};

/// The largest part of the sea's energy that waves outside the file's frequencies may have.
const ENERGY_OUTSIDE: f64 = 0.01;

/// A smaller displacement counts as zero \[m, rad\].
const ROUNDING: f64 = 1e-12;

/// A natural motion of a floating body that its taut lines allow, without damping and with it.
pub type TautMode = (Natural, Mode);

fn rows<T: Copy, U>(matrix: &Matrix3<T>, of: impl Fn(T) -> U) -> [[U; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| of(matrix[(i, j)])))
}

/// The units of a floating structure.
fn units(structure: &Structure, length_m: f64) -> FloatingUnits {
    let [_, mass_kg] = structure.body.moving_mass_kg();
    FloatingUnits::new(length_m, structure.site.gravity_m_s2, mass_kg)
}

/// The structure in the engine's units, about the mean position of the body's centre.
pub(super) fn model(structure: &Structure, afloat: &Afloat) -> Result<Model, CaseError> {
    let origin_m = structure.body.position_m;
    let scales = Scales::new(structure, origin_m);
    let units = units(structure, scales.length_m);
    let scales = Scales {
        force_n: units.force_n,
        time_s: units.time_s,
        ..scales
    };
    let fit = &afloat.report.fit;
    let mass = afloat.body.with_added_mass(&fit.added_mass_inf);
    let mass = units.mass_matrix(&rows(&mass.map_err(|error| impossible(&error))?, |m| m));
    let groups = Groups::of_body(structure, &scales, mass[2][2]);
    let shape = shape(structure, &groups);
    let body = Body::with_mass_matrix(shape, mass).ok_or_else(|| {
        let message = "the mass matrix is not positive definite".to_owned();
        impossible(&HydroError::Impossible(message))
    })?;
    let waves = waves(structure, origin_m[1].min(0.0));
    let term = |term: &Term| Exponential {
        pole: [term.pole.re, term.pole.im],
        residue: rows(&term.residue, |r| [r.re, r.im]),
    };
    let water = Floating {
        stiffness: rows(&afloat.body.stiffness, |c| c),
        damping: rows(&(afloat.body.damping + fit.memory.damping), |b| b),
        constant: afloat.steady().into(),
        memory: fit.memory.terms.iter().map(term).collect(),
        excitation: excitation(structure, afloat, &waves)?,
    };
    let [pushed, lifted] = structure
        .body
        .constant_force_n
        .map(|force| force / scales.force_n);
    let lines = 0..structure.lines.len();
    let system = System {
        body,
        cables: lines
            .map(|line| cable(structure, &scales, line, false))
            .collect(),
        forcing: Forcing {
            constant: [pushed, -lifted].into(),
            harmonics: Vec::new(),
        },
        drag: drag(structure, &scales, &waves, groups.inertia),
        floating: Some(units.floating(&water)),
        restitution: structure.restitution,
    };
    Ok(Model {
        rules: rules(structure, &scales),
        scales,
        system,
        waves,
        groups,
    })
}

/// That a body rests nowhere on its lines, or would without the loads of the case; `adrift` is
/// where it floats without tension, and how far the ends of each line are apart there.
fn no_equilibrium_error(
    structure: &Structure,
    afloat: &Afloat,
    error: &HydroError,
    adrift: Option<(Vector3<f64>, Vec<f64>)>,
) -> CaseError {
    if let Some(error) =
        steady_load_error_if_cause(structure, |calm| rest_afloat(calm, afloat).is_ok())
    {
        return error;
    }
    if afloat.constant_moment_n_m != 0.0 {
        let calm = Afloat {
            constant_moment_n_m: 0.0,
            ..afloat.clone()
        };
        if rest_afloat(structure, &calm).is_ok() {
            let allowed = "a moment with which the water and the lines hold the body";
            let moment = afloat.constant_moment_n_m;
            return CaseError::value("float.constant_moment", moment, allowed);
        }
    }
    let lengths = structure.lines.iter().map(|line| line.length_m.to_string());
    let shown = format!("[{}]", lengths.collect::<Vec<_>>().join(", "));
    let Some((q, apart_m)) = adrift else {
        return CaseError::value(
            "line.length",
            shown,
            format!("lines that hold the body; {error}"),
        )
        .with_hint("give run.start, or change anchors, fairleads or lengths");
    };
    let [_, z] = structure.body.position_m;
    let apart = apart_m.iter().map(|apart| format!("{apart:.3}"));
    let allowed = format!(
        "lengths with which at least one line is taut at rest, so that the body is held in surge; without tension it \
         floats at z = {:.3} m, where the ends of the lines are [{}] m apart",
        z + q[1],
        apart.collect::<Vec<_>>().join(", ")
    );
    let error = CaseError::value("line.length", shown, allowed);
    let [mass_kg, displaced_kg] = [structure.body.mass_kg, structure.displaced_mass_kg()];
    error.with_hint(match mass_kg > displaced_kg {
        true => format!(
            "the body weighs {} t but displaces {} t: make it lighter, or the lines shorter; or give run.start, \
             where a body that is not held starts",
            kilo(&mass_kg, 1),
            kilo(&displaced_kg, 1)
        ),
        false => "shorten the lines, or give run.start, where a body that is not held starts".to_owned(),
    })
}

fn impossible(error: &HydroError) -> CaseError {
    CaseError::value(
        "body.mass",
        "(with the file's added mass)",
        error.to_string(),
    )
}

/// The waves' force, Re a e^{iε} X(ω) e^{−iωt} of each. A surface A sin(ωt + ε') over the body is
/// a cos(−ωt + ε) with a = A and ε = π/2 − ε', so a e^{iε} = A (sin ε' + i cos ε').
fn excitation(
    structure: &Structure,
    afloat: &Afloat,
    waves: &[LinearWave],
) -> Result<Vec<Excitation>, CaseError> {
    if waves.is_empty() {
        return Ok(Vec::new());
    }
    let hydro = &afloat.report.reading.hydro;
    let shown = || format!("{:?}", afloat.report.name);
    let curve = hydro.excitation_curve(structure.heading);
    let curve =
        curve.map_err(|error| CaseError::value("float.file", shown(), error.to_string()))?;
    let lost = left_out(structure, afloat);
    if lost > ENERGY_OUTSIDE {
        let [low, high] = hydro.range_rad_s();
        let allowed = format!(
            "coefficients at the frequencies of the waves: {:.1} % of their energy is outside the \
             file's {low:.3} to {high:.3} rad/s",
            100.0 * lost
        );
        return Err(CaseError::value("float.file", shown(), allowed)
            .with_hint("compute more frequencies, or take waves of another period"));
    }
    let one = |wave: &LinearWave| {
        let (sine, cosine) = wave.phase_rad.sin_cos();
        let amplitude = Complex::new(sine, cosine) * wave.amplitude_m;
        let force: Vector3<Complex<f64>> = curve.at(wave.omega_rad_s)? * amplitude;
        let amplitudes = [0, 1, 2].map(|i| [force[i].re, force[i].im]);
        Some(Excitation::of_amplitudes(wave.omega_rad_s, amplitudes))
    };
    Ok(waves.iter().filter_map(one).collect())
}

/// The part of the waves' energy that is left out because the file has no coefficients there.
pub(super) fn left_out(structure: &Structure, afloat: &Afloat) -> f64 {
    let [low, high] = afloat.report.reading.hydro.range_rad_s();
    let outside = |omega: f64| f64::from(u8::from(!(low..=high).contains(&omega)));
    match structure.water {
        Water::Still => 0.0,
        Water::Wave(wave) => outside(wave.omega_rad_s()),
        Water::Sea(sea) => {
            let spectrum = Spectrum::new(&sea);
            spectrum.integral(outside) / spectrum.moment(0).max(f64::MIN_POSITIVE)
        }
    }
}

/// A displacement; what is left by rounding of a place that is symmetric has no sign.
fn without_rounding(displacement: f64) -> f64 {
    if displacement.abs() < ROUNDING {
        0.0
    } else {
        displacement
    }
}

/// The body with all constant loads of the case, besides those of its lines.
pub(super) fn loaded(structure: &Structure, afloat: &Afloat) -> snapload_hydro::Body {
    let [pushed, lifted] = structure.body.constant_force_n;
    let pushed = pushed + structure.drag_of_current_n();
    snapload_hydro::Body {
        constant_force: afloat.steady() + Vector3::new(pushed, lifted, 0.0),
        ..afloat.body.clone()
    }
}

/// Where it rests on its lines, and the small motion that they leave it there. Where no line holds
/// it in surge, one that floats without tension rests at the surge of the case's start; one that
/// would not has no place of rest that is known.
pub(super) fn rest_afloat(
    structure: &Structure,
    afloat: &Afloat,
) -> Result<(Equilibrium, Vec<TautMode>), CaseError> {
    let [x, z] = structure.body.position_m;
    let line = |line: &crate::structure::LineSi| Line {
        anchor_m: line.anchor_m,
        fairlead_m: [line.fairlead_m[0] - x, line.fairlead_m[1] - z],
        length_m: line.length_m,
    };
    let lines: Vec<Line> = structure.lines.iter().map(line).collect();
    let hydro = &afloat.report.reading.hydro;
    let body = loaded(structure, afloat);
    let place = match (rest(hydro, &body, &lines), structure.start_m) {
        (Ok(place), _) => place,
        (Err(_), Some(place_m)) => {
            let adrift = rest_without_tension(hydro, &body, &lines, place_m[0] - x);
            let [_, heave, pitch] = match &adrift {
                Some((q, _)) => q.map(without_rounding).into(),
                None => [0.0; 3],
            };
            let equilibrium = Equilibrium {
                place_m: match adrift {
                    Some(_) => [place_m[0], z + heave],
                    None => place_m,
                },
                theta_rad: 0.0 - pitch,
                tension_n: vec![0.0; lines.len()],
                rests: adrift.is_some(),
                ..Equilibrium::default()
            };
            return Ok((equilibrium, Vec::new()));
        }
        (Err(error), None) => {
            let adrift = rest_without_tension(hydro, &body, &lines, 0.0);
            return Err(no_equilibrium_error(structure, afloat, &error, adrift));
        }
    };
    let fit = &afloat.report.fit;
    let held = place.natural(hydro, &body, &fit.memory, &fit.added_mass_inf);
    let (natural, modes) = held.map_err(|error| impossible(&error))?;
    let [surge, heave, pitch] = place.q.map(without_rounding).into();
    let equilibrium = Equilibrium {
        place_m: [x + surge, z + heave],
        theta_rad: 0.0 - pitch,
        rests: true,
        taut: place.taut,
        tension_n: place.tension_n,
        ..Equilibrium::default()
    };
    Ok((equilibrium, natural.into_iter().zip(modes).collect()))
}
