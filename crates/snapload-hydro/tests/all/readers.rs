//! Files of three programs are read into one type, with one sign convention of time.

use crate::common::{dataset, hydro, path, reading, wamit_given};
use nalgebra::{Complex, Matrix3};
use snapload_hydro::{
    FirstColumn, Format, Given, Values, WamitText, from_dataset, from_nemoh, from_wamit, read,
    wave_number,
};

fn close(a: f64, b: f64, part: f64) -> bool {
    (a - b).abs() <= part * b.abs()
}

/// The pontoon's numbers as xarray prints them.
#[test]
fn capytaine_is_read() {
    let Format::Capytaine = reading("pontoon-deep.nc").format else {
        panic!("another format");
    };
    let hydro = hydro("pontoon-deep.nc");
    assert_eq!(hydro.omega_rad_s.len(), 58);
    assert_eq!(hydro.range_rad_s(), [0.08, 4.64]);
    assert_eq!(hydro.water.density_kg_m3, 1025.0);
    assert_eq!(hydro.water.gravity_m_s2, 9.81);
    assert_eq!(hydro.water.depth_m, f64::INFINITY);
    assert_eq!(hydro.reference_m, [0.0, 0.0]);
    let statics = &hydro.hydrostatics;
    // 1025 kg/m³ × 20 m × 4 m × 1.2 m, and ρ g × 80 m².
    assert!(close(
        statics.displaced_mass_kg.expect("a mass"),
        98_400.0,
        1e-12
    ));
    let stiffness = statics.stiffness.expect("a stiffness");
    assert!(close(stiffness[(1, 1)], 804_420.0, 1e-9));
    assert_eq!(statics.centre_of_mass_m, Some([0.0, -0.2]));
    // A(∞) and A(0) are stored separately.
    let inf = hydro.added_mass_inf.expect("A(∞)");
    assert!(close(inf[(1, 1)], 158_551.4, 1e-5), "{inf}");
    assert!(hydro.added_mass_zero.is_some());
    // A wave to −x is the mirror image of one to +x: surge and pitch change sign, heave does not.
    let (plus, minus) = (
        hydro.excitation_to(1.0).expect("+x"),
        hydro.excitation_to(-1.0).expect("-x"),
    );
    for (a, b) in plus.force.iter().zip(&minus.force) {
        let scale = a.norm();
        assert!((a[0] + b[0]).norm() < 1e-3 * scale);
        assert!((a[1] - b[1]).norm() < 1e-3 * scale);
        assert!((a[2] + b[2]).norm() < 1e-3 * scale);
    }
    assert!(hydro.asymmetry < 0.01);
}

/// Good files pass all checks of signs and phases; a poor one does not.
#[test]
fn good_files_have_no_warning_of_signs() {
    for name in ["pontoon-deep.nc", "sphere.nc", "cylinder.nc"] {
        let reading = reading(name);
        let wrong = [
            "negative damping",
            "symmetry",
            "low frequencies",
            "few frequencies",
        ];
        for warning in &reading.warnings {
            assert!(
                !wrong.contains(&warning.what),
                "{name}: {}",
                warning.message
            );
        }
    }
    let poor = reading("cylinder-poor.nc");
    let negative = poor.warnings.iter().find(|w| w.what == "negative damping");
    assert!(negative.is_some(), "{:?}", poor.warnings);
}

/// The same body in WAMIT's format, which has seven digits, is the same body.
#[test]
fn wamit_agrees_with_capytaine() {
    let wamit = read(&path("pontoon-deep.3"), &wamit_given()).expect("a reading");
    assert_eq!(wamit.format, Format::Wamit);
    let (a, b) = (wamit.hydro, hydro("pontoon-deep.nc"));
    assert_eq!(a.omega_rad_s.len(), b.omega_rad_s.len());
    let matrices = [(&a.added_mass, &b.added_mass), (&a.damping, &b.damping)];
    for (a, b) in matrices {
        let largest = b.iter().fold(0.0, |most: f64, m| most.max(m.amax()));
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).amax() < 1e-6 * largest, "{a}{b}");
        }
    }
    for direction in [1.0, -1.0] {
        let (a, b) = (a.excitation_to(direction), b.excitation_to(direction));
        let (a, b) = (a.expect("a direction"), b.expect("a direction"));
        for (a, b) in a.force.iter().zip(&b.force) {
            assert!((a - b).norm() < 2e-6 * b.norm(), "{a}{b}");
        }
    }
    let stiffness = [&a, &b].map(|h| h.hydrostatics.stiffness.expect("a stiffness"));
    assert!((stiffness[0] - stiffness[1]).amax() < 1e-6 * stiffness[1].amax());
    assert_eq!(a.added_mass_zero.is_some(), b.added_mass_zero.is_some());
    let infinite = [&a, &b].map(|h| h.added_mass_inf.expect("A(∞)"));
    assert!((infinite[0] - infinite[1]).amax() < 1e-6 * infinite[1].amax());
}

/// A model in other units of length: its numbers scale as WAMIT's manual says.
#[test]
fn wamit_scales_with_its_length() {
    let one = read(&path("pontoon-deep.1"), &wamit_given()).expect("a reading");
    let given = Given {
        unit_length_m: Some(2.0),
        ..wamit_given()
    };
    // A body twice as large is another one; only the powers of the length are tested.
    let two = read(&path("pontoon-deep.1"), &given).expect("a reading");
    let powers = Matrix3::new(8.0, 8.0, 16.0, 8.0, 8.0, 16.0, 16.0, 16.0, 32.0);
    let expected = one.hydro.added_mass[7].component_mul(&powers);
    assert!((two.hydro.added_mass[7] - expected).amax() < 1e-9 * expected.amax());
    let force = two.hydro.excitation[0].force[7].component_div(&one.hydro.excitation[0].force[7]);
    assert!((force[0] - Complex::new(4.0, 0.0)).norm() < 1e-12);
    assert!((force[2] - Complex::new(8.0, 0.0)).norm() < 1e-12);
}

/// A first column of another kind, of the same waves in water of 10 m
/// and with a unit length of 2 m.
#[test]
fn wamit_has_four_first_columns() {
    let [g, depth, length] = [9.81, 10.0, 2.0];
    let k = [0.02, 0.1, 0.2, 0.5];
    let omega = k.map(|k: f64| (g * k * (k * depth).tanh()).sqrt());
    let columns = [
        ("period", omega.map(|omega| std::f64::consts::TAU / omega)),
        ("frequency", omega),
        ("wavenumber", k.map(|k| k * length)),
        (
            "infinite-depth-wavenumber",
            omega.map(|omega| omega * omega / g * length),
        ),
    ];
    for (word, column) in columns {
        let (mut radiation, mut excitation) = (String::new(), String::new());
        for first in column {
            for mode in [1, 3, 5] {
                radiation += &format!("{first:e} {mode} {mode} 1 1\n");
                excitation += &format!("{first:e} 0 {mode} 1 0 1 0\n");
            }
        }
        let files = WamitText {
            radiation,
            excitation,
            hydrostatics: None,
        };
        let given = Given {
            depth_m: Some(depth),
            unit_length_m: Some(length),
            first_column: Some(FirstColumn::from_word(word).expect(word)),
            ..wamit_given()
        };
        let read = from_wamit(&files, &given).expect(word).omega_rad_s;
        assert_eq!(read.len(), 4, "{word}");
        let same = read.iter().zip(omega).all(|(a, b)| close(*a, b, 1e-12));
        assert!(same, "{word}: {read:?}");
    }
    assert_eq!(FirstColumn::from_word("rows"), None);
}

/// Axes are identified by their names, whatever their order; the frequencies may be along another
/// dimension, and degrees of freedom outside the plane are dropped.
#[test]
fn axes_are_found_by_name() {
    let plain = hydro("sphere.nc");
    let turned = dataset("sphere.nc").with("added_mass", |variable| {
        let Values::Numbers(numbers) = &mut variable.values else {
            panic!("no numbers");
        };
        let n = variable.shape[0];
        let old = numbers.clone();
        // (omega, i, j) to (j, omega, i)
        *numbers = (0..3)
            .flat_map(|j| (0..n).flat_map(move |k| (0..3).map(move |i| (k * 3 + i) * 3 + j)))
            .map(|index| old[index])
            .collect();
        variable.shape = vec![3, n, 3];
        let names = ["radiating_dof", "omega", "influenced_dof"];
        variable.dims = names.map(str::to_owned).to_vec();
    });
    let read = from_dataset(&turned.0, &Given::default()).expect("coefficients");
    assert_eq!(read, plain);

    let mut renamed = dataset("sphere.nc").all();
    for (_, variable) in &mut renamed {
        for dim in &mut variable.dims {
            if dim == "omega" {
                "period".clone_into(dim);
            }
        }
    }
    let renamed = snapload_hydro::Dataset::new(renamed).expect("a dataset");
    let read = from_dataset(&renamed, &Given::default()).expect("coefficients");
    assert_eq!(read, plain);
}

/// A body along y with sway, heave and roll is the same body with x for y and the pitch for −roll.
#[test]
fn a_section_along_y_is_turned_round() {
    let plain = hydro("pontoon-deep.nc");
    let sign = |index: usize| if index % 3 == 2 { -1.0 } else { 1.0 };
    let words = |names: [&str; 3]| Values::Words(names.map(str::to_owned).to_vec());
    let mut turned = dataset("pontoon-deep.nc");
    for name in ["influenced_dof", "radiating_dof"] {
        turned = turned.with(name, |v| v.values = words(["Sway", "Heave", "Roll"]));
    }
    for name in [
        "added_mass",
        "radiation_damping",
        "hydrostatic_stiffness",
        "inertia_matrix",
    ] {
        turned = turned.numbers(name, |at, value| value * sign(at) * sign(at / 3));
    }
    for name in [
        "diffraction_force",
        "Froude_Krylov_force",
        "excitation_force",
    ] {
        turned = turned.numbers(name, |at, value| value * sign(at));
    }
    let turned = turned.numbers("wave_direction", |_, beta| {
        std::f64::consts::FRAC_PI_2 + beta
    });
    let read = from_dataset(&turned.0, &Given::default()).expect("coefficients");
    assert_eq!(read.added_mass, plain.added_mass);
    assert_eq!(read.excitation, plain.excitation);
}

/// Nemoh's files, as its own Fortran writes them: the cylinder of its verification cases, of which
/// two frequencies are copied; the others are added, as four are the minimum.
#[test]
fn nemoh_is_read() {
    let rows = [
        (
            0.1,
            "0.5841456E+06 0.4911802E-01",
            "0.2777910E+06 0.3014295E+03",
            0.1353778E+05,
            -0.1570795E+01,
            0.7512185E+06,
            -0.4013285E-04,
        ),
        (
            0.2,
            "0.58E+06 0.5E-01",
            "0.27E+06 0.31E+03",
            0.2706E+05,
            -0.15708,
            0.7510E+06,
            -0.5E-04,
        ),
        (
            0.3,
            "0.57E+06 0.6E-01",
            "0.26E+06 0.32E+03",
            0.4059E+05,
            -0.15709,
            0.7508E+06,
            -0.6E-04,
        ),
        (
            2.0,
            "0.2391126E+06 0.3558177E+06",
            "0.2365571E+06 0.3732594E+03",
            0.4083025E+06,
            -0.1703013E+01,
            0.4223298E+04,
            -0.1596240E+01,
        ),
    ];
    let mut radiation = "VARIABLES=\"w (rad/s)\"\n\"A   1   1\" \"B   1   1\"\n".to_owned();
    for motion in 1..=6 {
        radiation +=
            &format!("Zone t=\"Motion of body    1 in DoF   {motion}\",I=     4,F=POINT\n");
        for (omega, surge, heave, ..) in &rows {
            radiation += &format!("  {omega} ");
            for force in 1..=6 {
                radiation += match (force, motion) {
                    (1, 1) | (2, 2) => surge,
                    (3, 3) => heave,
                    (5, 5) | (4, 4) => "8.1E+06 0.47",
                    (1, 5) | (5, 1) => "1.78E+06 0.15",
                    _ => "0.0 0.0",
                };
                radiation += " ";
            }
            radiation += "\n";
        }
    }
    let mut excitation = "VARIABLES=\"w (rad/s)\"\n".to_owned();
    excitation += "Zone t=\"Diffraction force - beta =   0.000 deg\",I=     4,F=POINT\n";
    for (omega, _, _, surge, phase, heave, heave_phase) in &rows {
        excitation +=
            &format!("{omega} {surge} {phase} 0 0 {heave} {heave_phase} 0 0 1e4 -1.57 0 0\n");
    }
    let given = Given {
        density_kg_m3: Some(1000.0),
        gravity_m_s2: Some(9.81),
        depth_m: Some(f64::INFINITY),
        reference_m: Some([0.0, 0.0]),
        ..Given::default()
    };
    let hydro = from_nemoh(&radiation, &excitation, &given).expect("coefficients");
    assert_eq!(hydro.omega_rad_s, [0.1, 0.2, 0.3, 2.0]);
    assert_eq!(hydro.added_mass[3][(0, 0)], 0.2391126e6);
    assert_eq!(hydro.damping[0][(1, 1)], 0.3014295e3);
    assert_eq!(hydro.added_mass[0][(0, 2)], 1.78e6);
    let force = hydro.excitation_to(1.0).expect("+x").force[0];
    assert!((force[0] - Complex::new(0.0, -13537.78)).norm() < 0.1);
    assert!((force[1] - Complex::new(751_218.5, 0.0)).norm() < 40.0);

    // The same phase in degrees, and without the headings of Nemoh, as Capytaine writes it.
    let degrees = excitation.replace("-1.570795", "-90.0");
    let error = from_nemoh(&radiation, &degrees, &given).expect_err("a refusal");
    let message = error.to_string();
    assert!(
        message.contains("at ω = 0.1 rad/s = -90") && message.contains("radians"),
        "{message}"
    );
    // Frequencies of another run, in one zone or in all of the other file.
    let other_waves = excitation.replace("2 408302.5", "2.6 408302.5");
    let other_motion = radiation
        .replacen("  0.3 ", "  0.39 ", 3)
        .replacen("  0.39 ", "  0.3 ", 2);
    for (radiation, excitation, file) in [
        (&radiation, &other_waves, "ExcitationForce.tec"),
        (&other_motion, &excitation, "RadiationCoefficients.tec"),
    ] {
        let error = from_nemoh(radiation, excitation, &given).expect_err("a refusal");
        let message = error.to_string();
        let parts = [file, "rad/s", "is expected in that row"];
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    let no_zones = radiation.replace("Zone", "Surge");
    let error = from_nemoh(&no_zones, &excitation, &given).expect_err("a refusal");
    assert!(error.to_string().contains("Capytaine"), "{error}");
}

/// Another reference point: the power of damping is the same for the same motion of the body, the
/// force is that of a crest over the new point, and transforming back gives the original
/// coefficients.
#[test]
fn coefficients_follow_the_reference_point() {
    let here = hydro("cylinder.nc");
    let there = here.about([1.5, 0.7]);
    let j = snapload_hydro::transport([1.5, 1.1]);
    let back = there.about(here.reference_m);
    for (index, b) in here.damping.iter().enumerate() {
        // The body's velocity about the new point, and the same motion about the old one.
        let v = nalgebra::Vector3::new(0.3, -0.2, 0.1);
        let (old, new) = (
            (j * v).dot(&(b * (j * v))),
            v.dot(&(there.damping[index] * v)),
        );
        assert!((old - new).abs() <= 1e-9 * old.abs(), "{old} {new}");
        assert!((back.damping[index] - b).amax() < 1e-9 * b.amax());
        let (x, y) = (
            here.excitation[0].force[index],
            there.excitation[0].force[index],
        );
        let moment = x[2] - x[0] * 1.1 + x[1] * 1.5;
        let k = wave_number(here.omega_rad_s[index], here.water.depth_m, 9.81);
        let direction = here.excitation[0].direction;
        let later = Complex::from_polar(1.0, -direction * k * 1.5);
        assert!((y[2] - moment * later).norm() < 1e-9 * x.norm());
        assert!((back.excitation[0].force[index] - x).norm() < 1e-9 * x.norm());
    }
}
