//! Files of three programs are read into one type, with one sign convention of time.

use crate::common::{bytes, dataset, hydro, path, reading, wamit_given};
use nalgebra::{Complex, Matrix3};
use snapload_hydro::{
    Dataset, FirstColumn, Format, Given, Values, WamitText, from_dataset, from_wamit, read,
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

/// The same numbers as integers with a factor, an offset and a value for missing ones, and strings
/// as arrays of letters, as xarray packs them for the classic model: equal to half a step.
#[test]
fn packed_numbers_and_arrays_of_letters_are_read() {
    let (packed, plain) = (hydro("pontoon-packed.nc"), hydro("pontoon-deep.nc"));
    let half = 0.5e-3 * (1.0 + 1e-6);
    let matrices = [
        (&packed.added_mass, &plain.added_mass),
        (&packed.damping, &plain.damping),
    ];
    for (packed, plain) in matrices {
        assert_eq!(packed.len(), plain.len());
        for (a, b) in packed.iter().zip(plain) {
            assert!((a - b).amax() <= half, "{a}{b}");
        }
    }
    let stiffness = [&packed, &plain].map(|h| h.hydrostatics.stiffness.expect("a stiffness"));
    // Single numbers of four bytes have 24 bits.
    assert!((stiffness[0] - stiffness[1]).amax() < 1e-7 * stiffness[1].amax());
    // A(∞) is marked as missing.
    assert!(packed.added_mass_inf.is_none() && plain.added_mass_inf.is_some());
    assert_eq!(packed.excitation, plain.excitation);
    let file = Dataset::from_netcdf(&bytes("pontoon-packed.nc")).expect("a dataset");
    let name = file.variable("body").expect("a name");
    assert_eq!(name.values, Values::Words(vec!["pontoon-deep".to_owned()]));
    assert_eq!(
        file.words("complex"),
        Ok(&["re", "im"].map(str::to_owned)[..])
    );
}

/// A dataset of which one direction of the waves was selected, as by xarray's `isel`.
#[test]
fn one_direction_may_be_selected() {
    let plain = hydro("pontoon-deep.nc");
    let selected = dataset("pontoon-deep.nc").0.at("wave_direction", 1);
    let read = from_dataset(&selected, &Given::default()).expect("coefficients");
    assert_eq!(read.excitation, plain.excitation[1..]);
    assert_eq!(read.added_mass, plain.added_mass);
}

/// A wave whose crest is at x = c at t = 0 has the complex amplitude e^{−ikc} at x = 0 (to +x; its
/// conjugate to −x): a force for that wave is the one with the crest over a reference point at c,
/// and divided by that amplitude the one with the crest over x = 0.
#[test]
fn a_dataset_may_say_where_the_crest_is() {
    let at = |name: &str, x: f64| {
        let point = |index: usize, value: f64| if index == 0 { x } else { value };
        let moved = dataset("pontoon-deep.nc").numbers(name, point);
        let crest = snapload_hydro::Variable {
            dims: Vec::new(),
            shape: Vec::new(),
            values: Values::Numbers(vec![3.5]),
        };
        let all = moved
            .all()
            .into_iter()
            .chain([("crest_x".to_owned(), crest)]);
        let with_crest = Dataset::new(all).expect("a dataset");
        from_dataset(&with_crest, &Given::default()).expect("coefficients")
    };
    let plain = hydro("pontoon-deep.nc");
    assert_eq!(at("rotation_center", 3.5).excitation, plain.excitation);
    let away = at("rotation_center", 0.0);
    for (moved, own) in away.excitation.iter().zip(&plain.excitation) {
        for (step, omega) in plain.omega_rad_s.iter().enumerate() {
            // Deep water.
            let k = omega * omega / 9.81;
            let amplitude = Complex::from_polar(1.0, -own.direction * k * 3.5);
            let apart = moved.force[step] - own.force[step] / amplitude;
            assert!(apart.norm() < 1e-9 * own.force[step].norm(), "{omega}");
        }
    }
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
