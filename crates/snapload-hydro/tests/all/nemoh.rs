//! Nemoh's files, as its own Fortran writes them.

use nalgebra::Complex;
use snapload_hydro::{Given, HydroError, Hydrodynamics, from_nemoh};
use std::f64::consts::TAU;

/// ω, A and B of surge and of heave, and modulus and phase of the forces on surge and on heave.
type Row = (f64, [&'static str; 2], [f64; 4]);

/// The cylinder of Nemoh's verification cases, of which two frequencies are copied; the others are
/// added, as four are the minimum.
const ROWS: [Row; 4] = [
    (
        0.1,
        ["0.5841456E+06 0.4911802E-01", "0.2777910E+06 0.3014295E+03"],
        [0.1353778E+05, -0.1570795E+01, 0.7512185E+06, -0.4013285E-04],
    ),
    (
        0.2,
        ["0.58E+06 0.5E-01", "0.27E+06 0.31E+03"],
        [0.2706E+05, -0.15708, 0.7510E+06, -0.5E-04],
    ),
    (
        0.3,
        ["0.57E+06 0.6E-01", "0.26E+06 0.32E+03"],
        [0.4059E+05, -0.15709, 0.7508E+06, -0.6E-04],
    ),
    (
        2.0,
        ["0.2391126E+06 0.3558177E+06", "0.2365571E+06 0.3732594E+03"],
        [0.4083025E+06, -0.1703013E+01, 0.4223298E+04, -0.1596240E+01],
    ),
];

/// `RadiationCoefficients.tec` and `ExcitationForce.tec`, with the first columns of these
/// frequencies and their name.
fn files(column: &str, first: impl Fn(f64) -> String) -> [String; 2] {
    let mut radiation = format!("VARIABLES=\"{column}\"\n\"A   1   1\" \"B   1   1\"\n");
    for motion in 1..=6 {
        radiation +=
            &format!("Zone t=\"Motion of body    1 in DoF   {motion}\",I=     4,F=POINT\n");
        for (omega, [surge, heave], _) in &ROWS {
            radiation += &format!("  {} ", first(*omega));
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
    let mut excitation = format!("VARIABLES=\"{column}\"\n");
    excitation += "Zone t=\"Diffraction force - beta =   0.000 deg\",I=     4,F=POINT\n";
    for (omega, _, [surge, phase, heave, heave_phase]) in &ROWS {
        let first = first(*omega);
        excitation +=
            &format!("{first} {surge} {phase} 0 0 {heave} {heave_phase} 0 0 1e4 -1.57 0 0\n");
    }
    [radiation, excitation]
}

fn in_rad_s() -> [String; 2] {
    files("w (rad/s)", |omega| omega.to_string())
}

fn reading([radiation, excitation]: &[String; 2]) -> Result<Hydrodynamics, HydroError> {
    let given = Given {
        density_kg_m3: Some(1000.0),
        gravity_m_s2: Some(9.81),
        depth_m: Some(f64::INFINITY),
        reference_m: Some([0.0, 0.0]),
        ..Given::default()
    };
    from_nemoh(radiation, excitation, &given)
}

fn assert_refused(files: &[String; 2], parts: &[&str]) {
    let message = reading(files).expect_err("a refusal").to_string();
    assert!(parts.iter().all(|part| message.contains(part)), "{message}");
}

#[test]
fn nemoh_is_read() {
    let hydro = reading(&in_rad_s()).expect("coefficients");
    assert_eq!(hydro.omega_rad_s, [0.1, 0.2, 0.3, 2.0]);
    assert_eq!(hydro.added_mass[3][(0, 0)], 0.2391126e6);
    assert_eq!(hydro.damping[0][(1, 1)], 0.3014295e3);
    assert_eq!(hydro.added_mass[0][(0, 2)], 1.78e6);
    let force = hydro.excitation_to(1.0).expect("+x").force[0];
    assert!((force[0] - Complex::new(0.0, -13537.78)).norm() < 0.1);
    assert!((force[1] - Complex::new(751_218.5, 0.0)).norm() < 40.0);
}

/// Fortran leaves out the E of an exponent with three digits.
#[test]
fn tiny_numbers_of_nemoh_are_read() {
    let [radiation, excitation] = in_rad_s();
    let tiny = [
        radiation.replace("0.0 0.0", "-0.1234567-104 0.1234567-113"),
        excitation,
    ];
    let hydro = reading(&tiny).expect("coefficients");
    assert_eq!(hydro.added_mass[0][(0, 1)], -1.234567e-105);
    assert_eq!(hydro.damping[0][(0, 1)], 1.234567e-114);
}

/// Nemoh v3 writes ω = 2πf = 2π/T by choice as f or as T, in seven digits.
#[test]
fn first_columns_of_nemoh_are_those_that_it_names() {
    let plain = reading(&in_rad_s()).expect("coefficients");
    let hertz = files("f (Hz)", |omega| format!("{:.7E}", omega / TAU));
    let periods = files("T (s)", |omega| format!("{:.7E}", TAU / omega));
    for files in [hertz, periods] {
        let mut hydro = reading(&files).expect("coefficients");
        for (found, expected) in hydro.omega_rad_s.iter().zip(&plain.omega_rad_s) {
            assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
        }
        hydro.omega_rad_s.clone_from(&plain.omega_rad_s);
        assert_eq!(hydro, plain);
    }
    let [radiation, excitation] = in_rad_s();
    for other in [
        "VARIABLES=\"w (Hz)\"",
        "VARIABLES=\"k (1/m)\"",
        "TITLE=\"w (rad/s)\"",
        "",
    ] {
        let changed = excitation.replacen("VARIABLES=\"w (rad/s)\"", other, 1);
        let begins = other.replace('"', "\\\"");
        assert_refused(
            &[radiation.clone(), changed],
            &[
                "ExcitationForce.tec",
                "it begins with",
                &begins,
                "f (Hz)",
                "T (s)",
            ],
        );
    }
}

/// The same phase in degrees, and without the headings of Nemoh, as Capytaine writes it.
#[test]
fn other_files_than_those_of_nemoh_are_refused() {
    let [radiation, excitation] = in_rad_s();
    let degrees = excitation.replace("-1.570795", "-90.0");
    assert_refused(
        &[radiation.clone(), degrees],
        &["at ω = 0.1 rad/s = -90", "radians"],
    );
    // Frequencies of another run, in one zone or in all of the other file.
    let other_waves = excitation.replace("2 408302.5", "2.6 408302.5");
    let other_motion = radiation
        .replacen("  0.3 ", "  0.39 ", 3)
        .replacen("  0.39 ", "  0.3 ", 2);
    let expected = "is expected in that row";
    assert_refused(
        &[radiation.clone(), other_waves],
        &["ExcitationForce.tec", "rad/s", expected],
    );
    assert_refused(
        &[other_motion, excitation.clone()],
        &["RadiationCoefficients.tec", "rad/s", expected],
    );
    let no_zones = radiation.replace("Zone", "Surge");
    assert_refused(&[no_zones, excitation], &["Capytaine"]);
}
