//! Natural motions with damping: which eigenvalue belongs to which motion.

use crate::common::{hydro, reading};
use nalgebra::{Complex, Matrix3};
use snapload_hydro::{
    Body, FitOptions, Hydrodynamics, Memory, Mode, Natural, Report, Request, Term, Weight, fit,
    natural_of_the_file, natural_of_the_memory, page,
};

/// The pontoon with the same added mass at all frequencies, so that its heave, which is coupled
/// with nothing, is a textbook's oscillator; with ω and mass of that.
fn oscillator() -> (Hydrodynamics, Body, Matrix3<f64>, [f64; 2]) {
    let mut hydro = hydro("pontoon-deep.nc");
    let inf = hydro.added_mass[0];
    hydro.added_mass.fill(inf);
    let body = Body::new(&hydro, &Weight::default()).expect("a body");
    let mass = body.mass[(1, 1)] + inf[(1, 1)];
    let omega = (body.stiffness[(1, 1)] / mass).sqrt();
    (hydro, body, inf, [omega, mass])
}

fn heave(natural: &[Natural], modes: &[Mode]) -> Mode {
    let mut both = natural.iter().zip(modes);
    let found = both.find(|(natural, _)| natural.freedom == 1);
    found.expect("heave").1.clone()
}

/// A memory of pitch alone, so faint that it does not change the motion, but with an eigenvalue of
/// its own next to iω of heave.
fn faint(omega: f64) -> Memory {
    let mut residue = Matrix3::zeros();
    residue[(2, 2)] = Complex::new(1.0, 0.0);
    let terms = vec![Term {
        pole: Complex::new(-0.02 * omega, omega),
        residue,
    }];
    Memory {
        terms,
        ..Memory::default()
    }
}

/// Heave has −ζω + iω sqrt(1 − ζ²), whatever waves of pitch oscillate near its frequency; from
/// ζ = 1 on it creeps back with −ω (ζ − sqrt(ζ² − 1)), the slower of two.
#[test]
fn heave_has_the_eigenvalue_of_an_oscillator() {
    let (hydro, mut body, inf, [omega, mass]) = oscillator();
    let natural = natural_of_the_file(&hydro, &body).expect("motions");
    for zeta in [0.0_f64, 0.05, 0.3, 0.8, 1.2, 3.0] {
        body.damping[(1, 1)] = 2.0 * zeta * omega * mass;
        let modes = natural_of_the_memory(&body, &faint(omega), &inf, &natural).expect("modes");
        let found = heave(&natural, &modes);
        let root = (1.0 - zeta * zeta).abs().sqrt();
        let (expected, ratio) = match zeta < 1.0 {
            true => (Complex::new(-zeta, root) * omega, zeta),
            false => (Complex::new((root - zeta) * omega, 0.0), 1.0),
        };
        assert!(
            (found.eigenvalue - expected).norm() < 1e-9,
            "{zeta}: {found:?} {expected}"
        );
        assert!((found.damping_ratio - ratio).abs() < 1e-9, "{found:?}");
        assert_eq!(found.is_overdamped(), zeta > 1.0);
    }
}

/// Heave that is coupled with nothing is damped as if it were alone, with the memory of a file, and
/// the more the more damping it has.
#[test]
fn a_motion_apart_from_others_is_damped_as_if_alone() {
    let hydro = hydro("pontoon-deep.nc");
    let fit = fit(&hydro, FitOptions::default()).expect("a fit");
    let own = |term: &&Term| term.residue[(1, 1)].norm() > 0.0;
    let terms = fit.memory.terms.iter().filter(own).cloned().collect();
    let alone = Memory {
        terms,
        ..Memory::default()
    };
    let mut body = Body::new(&hydro, &Weight::default()).expect("a body");
    let natural = natural_of_the_file(&hydro, &body).expect("motions");
    let mut last = 0.0;
    for damping in [0.0, 5e4, 1e5, 2e5] {
        body.damping[(1, 1)] = damping;
        let of = |memory: &Memory| {
            let inf = &fit.added_mass_inf;
            let modes = natural_of_the_memory(&body, memory, inf, &natural).expect("modes");
            heave(&natural, &modes)
        };
        let (found, known) = (of(&fit.memory), of(&alone));
        assert!(
            (found.eigenvalue - known.eigenvalue).norm() < 1e-9,
            "{damping}: {found:?} {known:?}"
        );
        assert!(found.damping_ratio > last, "{damping}: {found:?}");
        last = found.damping_ratio;
    }
}

/// An overdamped motion is called so in words and on the page, and has no period in JSON.
#[test]
fn an_overdamped_motion_is_called_so() {
    let request = Request {
        damping: [0.0, 3e6, 0.0],
        fit: FitOptions { pairs: Some(4) },
        ..Request::default()
    };
    let report = Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report");
    let rows = report.summary();
    let (_, periods) = rows
        .iter()
        .find(|(label, _)| label == "periods")
        .expect("a row");
    assert!(
        periods.contains("heave 3.254 s undamped, overdamped with damping"),
        "{periods}"
    );
    let page = page(&report, &[], "snapload hydro").expect("a page");
    assert!(page.contains("<td>overdamped</td>") && !page.contains("inf"));
    let json = serde_json::to_value(report.to_json()).expect("JSON");
    let row = json["floating"]["natural"].as_array().expect("motions");
    let row = row.iter().find(|row| row["freedom"] == "heave");
    let row = row.expect("heave");
    assert!(row["damped_period_s"].is_null() && row["damping_ratio"] == 1.0);
}

/// A body ninety times as heavy as the water that it displaces swings in heave with C33 over its
/// mass and in pitch, with surge free to follow, with C55 over what is left of its inertia, far
/// beyond the file's frequencies. The periods of both are found and printed.
#[test]
fn a_heavy_body_keeps_all_of_its_motions() {
    let (hydro, light, inf, _) = oscillator();
    let weight = Weight {
        mass_kg: Some(90.0 * light.mass_kg),
        ..Weight::default()
    };
    let body = Body::new(&hydro, &weight).expect("a body").afloat();
    let (mass, stiffness) = (body.mass + inf, body.stiffness);
    let turning = mass[(2, 2)] - mass[(0, 2)] * mass[(0, 2)] / mass[(0, 0)];
    let heave = (stiffness[(1, 1)] / mass[(1, 1)]).sqrt();
    let pitch = (stiffness[(2, 2)] / turning).sqrt();
    assert!(pitch > 10.0 * hydro.range_rad_s()[1]);
    let natural = natural_of_the_file(&hydro, &body).expect("motions");
    let found: Vec<_> = natural.iter().map(|one| one.freedom).collect();
    assert_eq!(found, [1, 2], "{natural:?}");
    for (one, omega) in natural.iter().zip([heave, pitch]) {
        assert!((one.omega_rad_s / omega - 1.0).abs() < 1e-6, "{one:?}");
    }
}

/// Weights, damping and loads of other units are refused with what is allowed. What is allowed
/// leaves heave, which neither moment of inertia nor damping of other freedoms touch, as it is.
#[test]
fn a_body_of_other_units_is_refused() {
    let of = |weight: Weight, damping: [f64; 3], force: [f64; 3]| {
        let request = Request {
            weight,
            damping,
            force,
            fit: FitOptions { pairs: Some(4) },
            ..Request::default()
        };
        Report::new("pontoon", reading("pontoon-deep.nc"), &request)
    };
    let heaving = |weight: Weight, damping: [f64; 3]| {
        let report = of(weight, damping, [0.0; 3]).expect("a report");
        let floating = report.floating.expect("a body");
        heave(&floating.natural, &floating.modes).eigenvalue
    };
    let (own, none) = (Weight::default(), [0.0; 3]);
    let inertia = |inertia_kg_m2: f64| Weight {
        inertia_kg_m2: Some(inertia_kg_m2),
        ..own
    };
    let mass = |mass_kg: f64| Weight {
        mass_kg: Some(mass_kg),
        ..own
    };
    let known = heaving(own, none);
    for (weight, damping) in [(inertia(2e12), none), (own, [1e11, 0.0, 1e12])] {
        let found = heaving(weight, damping);
        assert!((found - known).norm() < 1e-6, "{found} {known}");
    }
    for (weight, damping, force, says) in [
        (mass(1e13), none, none, "the mass in kg = 1e13: it must be"),
        (mass(0.0), none, none, "9.839e6 (--mass; body.mass"),
        (inertia(1e300), none, none, "kg m² = 1e300: it must be"),
        (own, [0.0, 1e300, 0.0], none, "the damping of heave in"),
        (own, [0.0, 0.0, -1.0], none, "of waves = -1: it must be 0"),
        (own, none, [0.0, -1e300, 0.0], "load on heave = -1e300: it"),
    ] {
        let error = of(weight, damping, force).expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// The peak of heave does not depend on the damping of a pitch that resonates at the same
/// frequency, as the two are not coupled; surge, which is, does.
#[test]
fn peaks_depend_on_resonances_of_their_own() {
    let request = |inertia: f64| Request {
        weight: Weight {
            inertia_kg_m2: Some(inertia),
            ..Weight::default()
        },
        fit: FitOptions { pairs: Some(4) },
        ..Request::default()
    };
    let largest = |inertia| {
        let reading = reading("pontoon-deep.nc");
        let report = Report::new("pontoon", reading, &request(inertia)).expect("a report");
        report.floating.expect("a body").largest(0)
    };
    // One natural frequency of pitch is that of heave, the other far from it.
    let (same, apart) = (largest(110_000.0), largest(174_000.0));
    for peaks in [&same, &apart] {
        let narrow = peaks.map(|(_, narrow)| narrow.is_some());
        assert_eq!(narrow, [true, false, true], "{peaks:?}");
    }
    let [heave, pitch] = [1, 2].map(|i| same[i].0.omega_rad_s);
    assert!((heave / pitch - 1.0).abs() < 0.02, "{same:?}");
    let height = same[1].0.amplitude / apart[1].0.amplitude;
    assert!((height - 1.0).abs() < 1e-3, "{same:?} {apart:?}");
}
