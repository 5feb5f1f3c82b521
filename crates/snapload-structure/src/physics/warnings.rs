//! Warnings of conditions outside the range of the theory: rules of thumb, each with its numbers.

use super::afloat::{left_out, loaded};
use super::equilibrium::Equilibrium;
use super::implausible::implausible;
use super::model_at_rest::ModelAtRest;
use super::sea_records::few_components;
use super::softness::soft_lines;
use super::warning::{HYDROSTATICS, NO_ELASTIC_REST, Warning, warning_if};
use super::waterline::{Waterline, rest_beyond_in_words};
use super::wave::LinearWave;
use crate::structure::{Afloat, Structure, Water};
use crate::text_layout::{digits, kilo};
use snapload_hydro::{Format, LARGE_PITCH, Report};
use std::f64::consts::PI;

/// The highest wave of a three-hour sea is near this many significant heights: sqrt(ln 1000 / 2)
/// for a thousand Rayleigh-distributed waves (M. S. Longuet-Higgins, *J. Mar. Res.* 11 (1952) 245).
const HIGHEST: f64 = 1.86;
/// Above this Ursell number waves are not sinusoidal.
const URSELL: f64 = 26.0;
/// Above this Keulegan-Carpenter number drag matters besides inertia.
const KEULEGAN: f64 = 5.0;
/// A body larger than this part of the wave length scatters the waves.
const DIFFRACTION: f64 = 0.2;
/// Lines with more than this part of the moving mass are not massless, and lines whose weight is
/// more than this part of the net buoyancy are not weightless.
const LIGHT: f64 = 0.1;
/// The rotation of a body beyond this would be resisted by the water \[degrees\].
const FREE_TURN: f64 = 60.0;
/// Where the tensions at rest on elastic lines differ from those on inextensible lines by more than
/// this part, so may all others, as the water then carries part of what moves the body.
const STRETCHED: f64 = 0.1;
/// Where the memory of a floating body lacks more than this part of its largest value to be
/// passive, tensions are not reliable.
const NOT_PASSIVE: f64 = 0.1;
/// A change of the wave's phase of this much is no longer small \[rad\].
const MOST_PHASE: f64 = 0.3;

/// The warning of a rule that a number has to be below a limit.
fn warning_if_above(limit: f64, value: f64, rule: &'static str, words: &str) -> Option<Warning> {
    warning_if(value > limit, rule, [value, limit], words)
}

/// The rules that a structure violates at rest.
pub fn warnings(prepared: &ModelAtRest) -> Vec<Warning> {
    let (structure, rest) = (&prepared.structure, &prepared.rest);
    if let Some(afloat) = &structure.afloat {
        return warnings_afloat(prepared, afloat);
    }
    let body = &structure.body;
    let (z, half) = (rest.place_m[1], body.half_height_m(rest.theta_rad));
    let top = z + half;
    let half = body.height_m / 2.0;
    let mut found = vec![
        distribution_warning(rest),
        no_elastic_rest(rest),
        soft_lines_in_still_water(prepared),
        warning_if(top > 0.0, "submergence", [top, 0.0], ""),
        warning_if(top <= 0.0 && -top < half, "free surface", [-top, 0.0], ""),
        near_the_floor(structure, rest),
    ];
    if let Some((highest, wave)) = governing_wave(structure, z) {
        found.extend(in_waves(prepared, top, highest, &wave));
    }
    found.push(heavy_lines(structure, rest));
    found.extend(implausible(structure));
    found.into_iter().flatten().collect()
}

/// The warning that the floor adds to the added mass of a body that is given far from it.
fn near_the_floor(structure: &Structure, rest: &Equilibrium) -> Option<Warning> {
    let body = &structure.body;
    let half_m = body.half_height_m(rest.theta_rad);
    let above_floor = rest.place_m[1] - half_m + structure.site.depth_m;
    let is = above_floor < body.height_m / 2.0;
    warning_if(is, "floor", [above_floor, 0.0], "")
}

/// The warning that the mass of lines, or their weight in air, is not negligible: beside the net
/// buoyancy, or, where that is less than the weight, beside the largest tension at rest.
fn heavy_lines(structure: &Structure, rest: &Equilibrium) -> Option<Warning> {
    let lines = structure.lines.iter();
    let masses = lines.filter_map(|line| Some(line.mass_per_length_kg_m? * line.length_m));
    let mass = masses.sum::<f64>();
    let [along, up] = structure.body.moving_mass_kg();
    let of_mass = mass / along.min(up);
    let (weight_n, buoyancy_n) = (
        mass * structure.site.gravity_m_s2,
        structure.net_buoyancy_n(),
    );
    if weight_n <= buoyancy_n {
        let of_buoyancy = weight_n / buoyancy_n;
        let is = of_mass > LIGHT || of_buoyancy > LIGHT;
        return warning_if(is, "light lines", [of_mass, of_buoyancy], "");
    }
    let tensions_n: Option<Vec<f64>> = rest.known_tensions_n().into_iter().collect();
    let pull_n = tensions_n.map(|all| all.into_iter().fold(0.0, f64::max));
    let Some(pull_n) = pull_n.filter(|pull_n| weight_n > LIGHT * pull_n) else {
        return warning_if(of_mass > LIGHT, "light lines", [of_mass, 0.0], "");
    };
    let words = format!(
        "{} kN, more than the net buoyancy of {} kN, and no line pulls by more than {} kN at rest",
        kilo(&weight_n, 1),
        kilo(&buoyancy_n, 1),
        kilo(&pull_n, 1)
    );
    warning_if(true, "light lines", [of_mass, 0.0], &words)
}

/// The rules of a floating body: those of its coefficients, of its position of rest, of the waves
/// and of the lines. That it is at the surface and makes waves is covered by its coefficients.
fn warnings_afloat(prepared: &ModelAtRest, afloat: &Afloat) -> Vec<Warning> {
    let (structure, rest) = (&prepared.structure, &prepared.rest);
    let report = &afloat.report;
    // The loads of the case, too, decide how the body floats without lines.
    let of_file = report
        .warnings
        .iter()
        .filter(|warning| warning.what != "balance");
    let of_file = of_file.map(|warning| Warning {
        rule: warning.what,
        message: warning.message.clone(),
        decided_by: None,
        leaves_open: warning.what == "passivity" && is_far_from_passive(report),
    });
    let body = &structure.body;
    let heave = rest.place_m[1] - body.position_m[1];
    let draft = 0.5 * body.height_m - body.position_m[1];
    let degrees = rest.theta_rad.to_degrees();
    let elsewhere = heave.abs() > 0.1 * draft || rest.theta_rad.abs() > 0.05;
    let deep =
        report.reading.hydro.water.depth_m.is_infinite() && structure.site.depth_m.is_finite();
    let lost = 100.0 * left_out(structure, afloat);
    let textbook = report.reading.format == Format::Section;
    let again = match textbook {
        true => "give body.position and displaced_volume for the place of rest",
        false => "compute them for the place of rest",
    };
    // Pitch is clockwise.
    let turned = loaded(structure, afloat).unbalanced_pitch();
    let turned = turned.map_or(0.0, |pitch| -pitch.to_degrees());
    let mut found = vec![
        warning_if(turned != 0.0, "balance", [turned, LARGE_PITCH], ""),
        distribution_warning(rest),
        no_elastic_rest(rest),
        soft_lines_in_still_water(prepared),
        stretch_at_rest(rest),
        warning_if(elsewhere, "place of rest", [heave, degrees], again),
        hydrostatics_warning(rest_beyond_in_words(structure, afloat, rest)),
        near_the_floor(structure, rest).filter(|_| textbook),
        warning_if(deep, "deep water", [structure.site.depth_m, 0.0], ""),
        warning_if(lost > 0.0, "frequencies left out", [lost, 0.0], ""),
    ];
    if let Some((highest, wave)) = governing_wave(structure, body.position_m[1].min(0.0)) {
        // The effects of waves that a file's coefficients include are missing in a textbook's.
        let all = in_waves(prepared, f64::INFINITY, highest, &wave).into_iter();
        found.extend(all.filter(|found| {
            found
                .as_ref()
                .is_some_and(|w| textbook || w.rule != "diffraction")
        }));
    }
    found.push(heavy_lines(structure, rest));
    found.extend(implausible(structure));
    of_file.chain(found.into_iter().flatten()).collect()
}

/// Whether what a memory lacks to be passive is no longer small: where linear damping is added for
/// it, which the waves do not have, motions and tensions are too small, and a given memory feeds
/// energy into the motion.
fn is_far_from_passive(report: &Report) -> bool {
    let fit = &report.fit;
    let fitted = fit.blocks.iter().map(|block| block.least);
    let last = report.reading.hydro.range_rad_s()[1];
    let given = fit
        .blocks
        .is_empty()
        .then(|| fit.memory.least_eigenvalue(last));
    fitted.chain(given).any(|least| least < -NOT_PASSIVE)
}

/// The warnings where the motion of a floating body left the range of linear theory; the verdict
/// may depend on tensions for which linear hydrostatics do not hold.
pub(crate) fn limits_afloat(
    structure: &Structure,
    seen: Option<&Waterline>,
    turned_rad: f64,
    depends_on_hydrostatics: bool,
) -> Vec<Warning> {
    let Some(seen) = seen else {
        return Vec::new();
    };
    let body = &structure.body;
    let z = body.position_m[1];
    let (draft, freeboard) = (0.5 * body.height_m - z, 0.5 * body.height_m + z);
    let [low, high] = seen.heave_m;
    let (heave, least) = (high.max(-low), 0.5 * draft.min(freeboard));
    let pitch = turned_rad.to_degrees();
    let beyond = hydrostatics_warning(seen.beyond_in_words()).map(|found| Warning {
        leaves_open: depends_on_hydrostatics,
        ..found
    });
    let found = [
        beyond,
        warning_if(heave > least, "small heave", [heave, least], ""),
        warning_if(pitch > LARGE_PITCH, "small pitch", [pitch, LARGE_PITCH], ""),
        warning_if(
            seen.deck_m < 0.0,
            "deck under water",
            [-seen.deck_m, 0.0],
            "",
        ),
        warning_if(
            seen.bilge_m > 0.0,
            "out of the water",
            [seen.bilge_m, 0.0],
            "",
        ),
    ];
    found.into_iter().flatten().collect()
}

/// The warning that linear hydrostatics do not hold for what a body does, in words.
fn hydrostatics_warning(words: Option<String>) -> Option<Warning> {
    warning_if(true, HYDROSTATICS, [0.0; 2], &words?)
}

/// The warning that inextensible lines do not determine the distribution of the load at rest.
fn distribution_warning(rest: &Equilibrium) -> Option<Warning> {
    let words = rest.by_stiffness.as_ref().map(|by_stiffness| {
        format!(
            "{} kN at z = {:.3} m, elastic lines {} kN at z = {:.3} m",
            each_kilo(&by_stiffness.inextensible_n),
            rest.place_m[1],
            each_kilo(&rest.tension_n),
            by_stiffness.place_m[1]
        )
    });
    let is = rest.indeterminate || words.is_some();
    warning_if(is, "shared loads", [0.0; 2], &words.unwrap_or_default())
}

/// The warning that elastic lines of the stiffness given hold the body nowhere at rest.
fn no_elastic_rest(rest: &Equilibrium) -> Option<Warning> {
    let is = rest.not_on_elastic_lines;
    warning_if(is, NO_ELASTIC_REST, [0.0; 2], "")
}

/// The warning that lines are too soft for a motion in still water, by the scale of its time, 2πT.
fn soft_lines_in_still_water(prepared: &ModelAtRest) -> Option<Warning> {
    let structure = &prepared.structure;
    let moves = structure.start_m.is_some() && !structure.has_waves();
    let scale_s = 2.0 * PI * prepared.model.scales.time_s;
    let soft = soft_lines(prepared, scale_s);
    let is = moves && !soft.is_empty();
    warning_if(is, "instant snap", [scale_s, 1.0], &soft)
}

/// The warning that the lines of a floating body carry a different load if they are elastic.
fn stretch_at_rest(rest: &Equilibrium) -> Option<Warning> {
    let relaxed = rest.elastic_tension_n.as_ref()?;
    let words = format!(
        "{} kN instead of {}",
        each_kilo(relaxed),
        each_kilo(&rest.tension_n)
    );
    let pairs = || rest.tension_n.iter().zip(relaxed);
    let largest = pairs().fold(0.0_f64, |most, (a, b)| most.max(*a).max(*b));
    let is_far = pairs().any(|(a, b)| (a - b).abs() > STRETCHED * largest);
    let found = warning_if(true, "stretch at rest", [0.0; 2], &words);
    found.map(|found| Warning {
        decided_by: is_far.then_some("snapload elastic"),
        leaves_open: is_far,
        ..found
    })
}

/// Tensions in kN, one after the other.
fn each_kilo(tensions_n: &[f64]) -> String {
    let each = tensions_n.iter().map(|pull| kilo(pull, 0));
    each.collect::<Vec<_>>().join("/")
}

/// The rules in waves, given the height of the highest one.
fn in_waves(
    prepared: &ModelAtRest,
    top: f64,
    highest: f64,
    wave: &LinearWave,
) -> [Option<Warning>; 7] {
    let structure = &prepared.structure;
    let (body, depth, length) = (&structure.body, structure.site.depth_m, wave.length_m());
    let words = match structure.water {
        Water::Sea(_) => {
            format!(
                "the highest wave of three hours, about {HIGHEST} Hs = {} m",
                digits(&highest, 2)
            )
        }
        _ => format!("the wave, {} m", digits(&highest, 2)),
    };
    let miche = 0.142 * (wave.wave_number_1_m * depth).tanh();
    let ursell = highest * length * length / depth.powi(3);
    let trough = -highest / 2.0;
    let size = body.width_m.max(body.height_m);
    let stroke = wave.a_x_m_s2 / (wave.omega_rad_s * wave.omega_rad_s);
    let keulegan = 2.0 * PI * stroke / size;
    let drag_given = body.drag_area_m2 != 0.0;
    let drag = warning_if_above(KEULEGAN, keulegan, "inertia (Keulegan-Carpenter)", "");
    let period = 2.0 * PI / wave.omega_rad_s;
    let soft = soft_lines(prepared, period);
    [
        warning_if_above(miche, highest / length, "breaking (Miche)", &words),
        warning_if_above(URSELL, ursell, "linear theory (Ursell)", &words),
        warning_if(
            top > trough && top <= 0.0,
            "submergence",
            [trough, top],
            &words,
        ),
        drag.filter(|_| !drag_given),
        warning_if_above(DIFFRACTION, size / length, "diffraction", ""),
        warning_if(!soft.is_empty(), "instant snap", [period, 0.0], &soft),
        few_components(structure),
    ]
}

/// The warning that a body moves so far that the wave's phase at its position differs from that at
/// its position of rest.
pub(crate) fn phase_warning(structure: &Structure, z_m: f64, excursion_m: f64) -> Option<Warning> {
    let (_, wave) = governing_wave(structure, z_m)?;
    let phase = wave.wave_number_1_m * excursion_m;
    let numbers = [excursion_m, phase.to_degrees()];
    warning_if(phase > MOST_PHASE, "phase", numbers, "")
}

/// The warning that a body turns so far that a resistance to its rotation matters, and the case has
/// none.
pub(crate) fn turning_warning(structure: &Structure, turned_rad: f64) -> Option<Warning> {
    let (damped, key) = match &structure.afloat {
        Some(afloat) => {
            let mut terms = afloat.report.fit.memory.terms.iter();
            let radiates = terms.any(|term| term.residue[(2, 2)].norm() > 0.0);
            let given = afloat.body.damping[(2, 2)] != 0.0;
            (radiates || given, "the third number of float.damping")
        }
        None => (
            structure.body.turning_damping_n_m_s != 0.0,
            "turning_damping",
        ),
    };
    let numbers = [turned_rad.to_degrees(), FREE_TURN];
    warning_if(!damped && numbers[0] > FREE_TURN, "turning", numbers, key)
}

/// The wave by which a structure is judged: the regular one, or the highest of a sea at its peak
/// period; with its height.
fn governing_wave(structure: &Structure, z_m: f64) -> Option<(f64, LinearWave)> {
    let (height, omega) = match structure.water {
        Water::Still => return None,
        Water::Wave(wave) => (wave.height_m, wave.omega_rad_s()),
        Water::Sea(sea) => {
            let height = HIGHEST * sea.significant_height_m;
            (height, 2.0 * PI / sea.peak_period_s)
        }
    };
    // Waves of no height are still water.
    let wave = || LinearWave::new(&structure.site, height / 2.0, omega, z_m);
    (height > 0.0).then(|| (height, wave()))
}
