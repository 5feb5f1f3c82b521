//! Floating bodies of one section, without results of a panel code.

use nalgebra::Complex;
use snapload_hydro::{
    Body, HydroError, Line, Report, Request, SectionBody, Shape, Water, Weight,
    natural_of_the_file, wave_number,
};
use std::f64::consts::PI;

fn box_of(half_width_m: f64, draft_m: f64) -> SectionBody {
    SectionBody {
        shape: Shape::Rectangle,
        half_width_m,
        draft_m,
        length_m: 20.0,
        x_m: 0.0,
        centre_of_gravity_m: [0.0, -0.2],
    }
}

fn water(depth_m: f64) -> Water {
    Water {
        density_kg_m3: 1025.0,
        gravity_m_s2: 9.81,
        depth_m,
    }
}

/// The force of a long wave's undisturbed pressure on a box, integrated over its sides and bottom:
///
/// ```text
/// p = ρg cosh k(z + d)/cosh kd · e^{ikx}
/// ```
///
/// Without the added mass the textbook's force tends to it as kb and kT go to zero.
#[test]
fn long_waves_push_by_their_pressure() {
    let (b, t, d, length) = (2.0, 1.2, 10.0, 20.0);
    let water = water(d);
    let reading = box_of(b, t).reading(water).expect("a body");
    let hydro = &reading.hydro;
    let added = hydro.added_mass_inf.expect("A");
    let at = |omega: f64| {
        hydro
            .excitation_curve(1.0)
            .expect("to +x")
            .at(omega)
            .expect("X")
    };
    let part = |omega: f64| {
        let k = wave_number(omega, d, 9.81);
        let pressure = |x: f64, z: f64| {
            let size = 1025.0 * 9.81 * (k * (z + d)).cosh() / (k * d).cosh();
            Complex::from_polar(size, k * x)
        };
        // On the sides n = (±1, 0), on the bottom (0, −1), out of the body; the force is −p n.
        let steps = 2000;
        let mut force = [Complex::new(0.0, 0.0); 3];
        for j in 0..steps {
            let s = (f64::from(j) + 0.5) / f64::from(steps);
            let (x, z) = (-b + 2.0 * b * s, -t * s);
            let up = pressure(x, -t) * (2.0 * b / f64::from(steps) * length);
            force[1] += up;
            force[2] -= up * x;
            for side in [1.0, -1.0] {
                let along = pressure(side * b, z) * (-side * t / f64::from(steps) * length);
                force[0] += along;
                force[2] += along * z;
            }
        }
        // The added mass times the water's acceleration at the middle of the body, (−i a_x, −a_z).
        let z = -0.5 * t;
        let a_x = omega * omega * (k * (z + d)).cosh() / (k * d).sinh();
        let a_z = omega * omega * (k * (z + d)).sinh() / (k * d).sinh();
        let along = Complex::new(0.0, -a_x);
        let with_mass = [
            along * added[(0, 0)],
            Complex::new(-a_z * added[(1, 1)], 0.0),
            along * added[(0, 2)],
        ];
        let ours = at(omega);
        (0..3)
            .map(|i| (ours[i] - with_mass[i] - force[i]).norm() / force[i].norm())
            .fold(0.0, f64::max)
    };
    let [long, longer] = [0.2, 0.1].map(part);
    assert!(long < 1e-2 && longer < 0.3 * long, "{long} {longer}");
}

/// Heave oscillates with ω² = ρg S/(m + A33), and a body that makes no waves has no damping, which
/// is reported.
#[test]
fn it_swings_without_damping() {
    let body = box_of(2.0, 1.2);
    let reading = body.reading(water(f64::INFINITY)).expect("a body");
    let request = Request {
        weight: Weight {
            inertia_kg_m2: Some(1.6e5),
            ..Weight::default()
        },
        ..Request::default()
    };
    let report = Report::new("box", reading, &request).expect("a report");
    let floating = report.floating.as_ref().expect("periods");
    let heave = floating.natural.iter().find(|natural| natural.freedom == 1);
    let mass = 1025.0 * 96.0 + report.fit.added_mass_inf[(1, 1)];
    let omega = (1025.0 * 9.81 * 80.0 / mass).sqrt();
    assert!((heave.expect("heave").omega_rad_s / omega - 1.0).abs() < 1e-9);
    assert!(
        floating
            .modes
            .iter()
            .all(|mode| mode.damping_ratio.abs() < 1e-9)
    );
    assert_eq!(report.fit.memory.states(), 0);
    let warned: Vec<&str> = report.warnings.iter().map(|warning| warning.what).collect();
    assert!(
        warned.contains(&"textbook section") && warned.contains(&"ends"),
        "{warned:?}"
    );
    assert!(!warned.contains(&"low frequencies"), "{warned:?}");
    let summary: String = report
        .summary()
        .into_iter()
        .map(|(_, words)| words + "\n")
        .collect();
    assert!(
        summary.contains("with 0.00 % of critical damping"),
        "{summary}"
    );
    assert!(!summary.contains("-0.0"), "{summary}");
}

/// Half a circle turns about its centre without moving water; it displaces half a cylinder.
#[test]
fn half_a_circle_displaces_half_a_cylinder() {
    let body = SectionBody {
        shape: Shape::Ellipse,
        draft_m: 2.0,
        ..box_of(2.0, 2.0)
    };
    let body = body.displacing(0.5 * PI * 4.0 * 30.0);
    assert!((body.length_m - 30.0).abs() < 1e-12);
    let reading = body.reading(water(12.0)).expect("a body");
    let added = reading.hydro.added_mass_inf.expect("A");
    assert!(added[(2, 2)].abs() < 1e-9 * added[(1, 1)] && added[(0, 2)].abs() < 1e-9);
    assert!((added[(1, 1)] - 1025.0 * 30.0 * 0.5 * PI * 4.0).abs() < 1e-6);
    // ρgI + ρgV z_B is zero: the metacentre of a circle is its centre.
    let c55 = reading.hydro.hydrostatics.stiffness.expect("C")[(2, 2)];
    let weight = 1025.0 * 0.5 * PI * 4.0 * 30.0 * 9.81;
    assert!((c55 - weight * 0.2).abs() < 1e-6 * weight, "{c55}");
    let too_flat = box_of(20.0, 1.0)
        .reading(water(12.0))
        .expect_err("no such rows");
    assert!(too_flat.to_string().contains("tabulated"), "{too_flat}");
}

/// A textbook's added mass is that of all frequencies: a swing however slow is not outside of them.
#[test]
fn no_swing_is_outside_a_textbook() {
    let reading = box_of(2.0, 1.2).reading(water(10.0)).expect("a body");
    let weight = Weight {
        inertia_kg_m2: Some(2e5),
        ..Weight::default()
    };
    let mut body = Body::new(&reading.hydro, &weight).expect("a body");
    body.stiffness[(2, 2)] = 1e-6 * body.stiffness[(1, 1)];
    let natural = natural_of_the_file(&reading.hydro, &body).expect("motions");
    let slowest = &natural[0];
    assert!(slowest.omega_rad_s < reading.hydro.range_rad_s()[0]);
    assert!(natural.iter().all(|natural| !natural.outside));
}

/// One body at two sizes in waves that are as long for it (Froude): lengths four times as
/// large and ω half as large give 16 times the force per amplitude and 64 times the
/// moment. As all factors are powers of two, floating-point numbers follow to the last bit
/// wherever ω is, and so does a motion.
#[test]
fn a_larger_twin_has_the_same_force_to_the_bit() {
    let force = |scale: f64, omega: f64| {
        let body = SectionBody {
            length_m: 20.0 * scale,
            centre_of_gravity_m: [0.0, -0.2 * scale],
            ..box_of(2.0 * scale, 1.2 * scale)
        };
        let reading = body.reading(water(10.0 * scale)).expect("a body");
        let hydro = reading.hydro.about([0.0, -0.2 * scale]);
        let curve = hydro.excitation_curve(-1.0).expect("to -x");
        curve.at(omega).expect("X")
    };
    for omega in [0.437, 0.8951, 1.6, 4.21] {
        let [own, twin] = [force(1.0, omega), force(4.0, 0.5 * omega)];
        assert_eq!([0, 1].map(|i| own[i] * 16.0), [0, 1].map(|i| twin[i]));
        assert_eq!(own[2] * 64.0, twin[2], "ω = {omega}");
    }
}

/// The report on a box of 80 t, 4 m wide and 1.2 m deep in the water, on two lines.
fn box_on(lines: [Line; 2]) -> Result<Report, HydroError> {
    let request = Request {
        weight: Weight {
            mass_kg: Some(8e4),
            inertia_kg_m2: Some(1.33e5),
            ..Weight::default()
        },
        lines: lines.to_vec(),
        ..Request::default()
    };
    let reading = box_of(2.0, 1.2).reading(water(10.0)).expect("a body");
    Report::new("box", reading, &request)
}

/// On lines that hold a box of 80 t above its draft of 1.2 m, clear of the water, it weighs 784.8
/// kN and no more, whatever C33 z is; on lines that hold it below its position the height of its
/// sides is not known, and named. Where it floats at its position nothing is told.
#[test]
fn a_box_clear_of_the_water_weighs_no_more_than_its_weight() {
    let warning = |anchor: f64, fairlead: f64, length: f64| {
        let line = |x: f64| Line {
            anchor_m: [x, anchor],
            fairlead_m: [x, fairlead],
            length_m: length,
        };
        let report = box_on([line(2.0), line(-2.0)]).expect("a report");
        let found = report.warnings.iter().find(|w| w.what == "hydrostatics");
        found.map(|warning| warning.message.clone())
    };
    let clear = warning(6.0, 1.0, 2.8).expect("2.2 m above its position");
    assert!(clear.contains("weighs only 784.8 kN"), "{clear}");
    let deep = warning(-10.0, -1.2, 7.0).expect("1.8 m below its position");
    assert!(
        deep.contains("rests 1.80 m below") && deep.contains("vertical sides"),
        "{deep}"
    );
    assert_eq!(warning(-10.0, -1.2, 8.8), None);
}

/// Lines end on the floor or above it.
#[test]
fn anchors_below_the_floor_are_refused() {
    let report = |anchor: f64| {
        let line = |x: f64| Line {
            anchor_m: [x, anchor],
            fairlead_m: [x, -1.2],
            length_m: -1.4 - anchor,
        };
        box_on([line(2.0), line(-2.0)]).map(|_| ())
    };
    let refused = report(-10.5).expect_err("a refusal").to_string();
    let words = "z of the anchor of line 1 = -10.5";
    assert!(
        refused.contains(words) && refused.contains("z >= -10"),
        "{refused}"
    );
    assert!(!report(-10.0).is_err_and(|error| error.to_string().contains("anchor")));
}
