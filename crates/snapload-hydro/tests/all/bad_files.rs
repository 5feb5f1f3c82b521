//! Every bad file is refused with a message that names the error, and none causes a panic.

use crate::common::{Spoilt, bytes, dataset, path, wamit_files};
use nalgebra::Matrix3;
use snapload_hydro::{
    Dataset, FirstColumn, Format, Given, Reading, Values, WamitText, from_dataset, from_wamit, read,
};

fn refusal(spoilt: Spoilt) -> String {
    refusal_given(spoilt, &Given::default())
}

fn refusal_given(spoilt: Spoilt, given: &Given) -> String {
    let hydro = from_dataset(&spoilt.0, given);
    let read = hydro.and_then(|hydro| Reading::new(Format::Capytaine, hydro));
    read.map(|reading| reading.warnings)
        .expect_err("a refusal")
        .to_string()
}

fn assert_message_contains(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "no {part:?} in {message:?}");
    }
}

fn pontoon() -> Spoilt {
    dataset("pontoon-deep.nc")
}

#[test]
fn what_is_missing_is_named() {
    assert_message_contains(
        &refusal(pontoon().without(&["added_mass"])),
        &["added_mass is missing", "omega"],
    );
    assert_message_contains(
        &refusal(pontoon().without(&["omega", "period", "freq"])),
        &["omega is missing"],
    );
    assert_message_contains(
        &refusal(pontoon().without(&["rho"])),
        &["density", "missing", "give it"],
    );
    assert_message_contains(
        &refusal(pontoon().without(&["rotation_center"])),
        &["rotation_center", "reference point"],
    );
    let no_force = pontoon().without(&["diffraction_force", "excitation_force"]);
    assert_message_contains(&refusal(no_force), &["excitation_force is missing"]);
    let mut spoilt = pontoon();
    for name in ["influenced_dof", "radiating_dof"] {
        spoilt = spoilt.with(name, |v| {
            v.values = Values::Words(["Surge", "Heave", "Yaw"].map(str::to_owned).to_vec());
        });
    }
    assert_message_contains(
        &refusal(spoilt),
        &["freedom Pitch is missing", "Surge, Heave, Yaw"],
    );
    let spoilt = pontoon().numbers("wave_direction", |_, beta| beta + 0.5);
    assert_message_contains(&refusal(spoilt), &["wave_direction", "0 or π"]);
    let spoilt = pontoon().numbers("wave_direction", |_, beta| beta.to_degrees());
    assert_message_contains(&refusal(spoilt), &["wave_direction", "degrees"]);
}

/// If there are several bodies, one has to be named.
#[test]
fn one_of_several_bodies_must_be_chosen() {
    let mut spoilt = pontoon();
    for name in ["influenced_dof", "radiating_dof"] {
        spoilt = spoilt.with(name, |v| {
            let names = ["left__Surge", "left__Heave", "left__Pitch"];
            v.values = Values::Words(names.map(str::to_owned).to_vec());
        });
    }
    spoilt = spoilt.with("body", |v| {
        v.values = Values::Words(vec!["left".to_owned()])
    });
    // A single body is used without a name; the name of another one is refused.
    let hydro = from_dataset(&spoilt.0, &Given::default()).expect("coefficients");
    assert_eq!(hydro.omega_rad_s.len(), 58);
    let given = Given {
        body: Some("right".to_owned()),
        ..Given::default()
    };
    assert_message_contains(
        &refusal_given(spoilt, &given),
        &["the body right is missing", "left"],
    );
}

#[test]
fn numbers_that_can_not_be_are_named() {
    let nan = |at: usize, value: f64| if at == 200 { f64::NAN } else { value };
    assert_message_contains(
        &refusal(pontoon().numbers("added_mass", nan)),
        &["added mass of", "ω = ", "NaN"],
    );
    assert_message_contains(
        &refusal(pontoon().numbers("radiation_damping", nan)),
        &["damping of", "NaN"],
    );
    assert_message_contains(
        &refusal(pontoon().numbers("Froude_Krylov_force", nan)),
        &["wave force on", "NaN"],
    );
    let spoilt = pontoon().numbers("omega", |at, w| if at == 5 { 0.08 } else { w });
    assert_message_contains(&refusal(spoilt), &["ω = 0.08", "once"]);
    let spoilt = pontoon().numbers("omega", |at, w| if at == 5 { -1.0 } else { w });
    assert_message_contains(&refusal(spoilt), &["ω = -1"]);
    // Tonnes instead of kilograms, feet instead of metres.
    assert_message_contains(
        &refusal(pontoon().numbers("rho", |_, _| 1.025)),
        &["density", "1.025", "units"],
    );
    let spoilt = pontoon().numbers("hydrostatic_stiffness", |_, c| c / 1000.0);
    assert_message_contains(&refusal(spoilt), &["low-frequency limit of X3", "units"]);
    assert_message_contains(
        &refusal(pontoon().numbers("forward_speed", |_, _| 2.0)),
        &["forward_speed = 2"],
    );
}

/// Wrong signs are detected by physical checks.
#[test]
fn broken_conventions_are_named() {
    let spoilt = pontoon().numbers("radiation_damping", |_, b| -b);
    assert_message_contains(&refusal(spoilt), &["positive damping", "other sign"]);
    // The second half of a complex variable is its imaginary part.
    let mut conjugate = pontoon();
    for name in ["diffraction_force", "Froude_Krylov_force"] {
        conjugate = conjugate.numbers(name, |at, x| if at >= 60 * 2 * 3 { -x } else { x });
    }
    assert_message_contains(&refusal(conjugate), &["phase of X1", "conjugate", "β"]);
    let mut from = pontoon();
    from = from.numbers("wave_direction", |_, beta| {
        if beta == 0.0 {
            std::f64::consts::PI
        } else {
            0.0
        }
    });
    assert_message_contains(&refusal(from), &["phase of X1", "conjugate", "come from"]);
    let mut upside_down = pontoon();
    for name in ["diffraction_force", "Froude_Krylov_force"] {
        upside_down = upside_down.numbers(name, |_, x| -x);
    }
    assert_message_contains(&refusal(upside_down), &["phase of X3"]);
    let mixed = pontoon().numbers("added_mass", |at, a| if at % 9 == 1 { a + 5e4 } else { a });
    assert_message_contains(&refusal(mixed), &["symmetry", "A_ij", "mixed up"]);
    // Damping of surge by pitch without that of pitch by surge, or a tenth smaller.
    let scaled = |part: f64| {
        pontoon().numbers(
            "radiation_damping",
            move |at, b| {
                if at % 9 == 2 { part * b } else { b }
            },
        )
    };
    assert_message_contains(&refusal(scaled(0.0)), &["symmetry", "B_ij", "mixed up"]);
    let hydro = from_dataset(&scaled(0.9).0, &Given::default()).expect("coefficients");
    let reading = Reading::new(Format::Capytaine, hydro).expect("a reading");
    let doubtful = reading.warnings.iter().find(|w| w.what == "symmetry");
    assert_message_contains(&doubtful.expect("a warning").message, &["B_ij", "mesh"]);
}

#[test]
fn other_layouts_are_named() {
    let spoilt = pontoon().with("complex", |v| {
        v.values = Values::Words(["real", "imag"].map(str::to_owned).to_vec());
    });
    assert_message_contains(&refusal(spoilt), &["complex", "real, imag", "re and im"]);
    // Complex numbers as pairs in one variable, as newer libraries write them.
    let pairs = |v: &mut snapload_hydro::Variable| {
        v.values = Values::Other("Compound of r and i".to_owned());
        v.dims.remove(0);
        v.shape.remove(0);
    };
    let spoilt = pontoon().with("diffraction_force", pairs);
    assert_message_contains(
        &refusal(spoilt),
        &[
            "diffraction_force",
            "Compound of r and i",
            "separate_complex_values",
        ],
    );
    let spoilt = pontoon().with("added_mass", |v| "frequency".clone_into(&mut v.dims[0]));
    assert_message_contains(
        &refusal(spoilt),
        &["added_mass", "frequency, influenced_dof"],
    );
    // Two depths in one file.
    let spoilt = pontoon().with("water_depth", |v| {
        v.dims = vec!["water_depth".to_owned()];
        v.shape = vec![2];
        v.values = Values::Numbers(vec![10.0, 20.0]);
    });
    assert_message_contains(
        &refusal(spoilt),
        &["water_depth", "2 values", "one is expected"],
    );
}

/// Values that both the file and the case give have to agree.
#[test]
fn the_case_has_to_agree() {
    let with = |density, depth, reference| Given {
        density_kg_m3: density,
        depth_m: depth,
        reference_m: reference,
        ..Given::default()
    };
    let words = refusal_given(pontoon(), &with(Some(1000.0), None, None));
    assert_message_contains(&words, &["density", "1025", "1000", "agree"]);
    let words = refusal_given(pontoon(), &with(None, Some(10.0), None));
    assert_message_contains(&words, &["depth", "inf", "10"]);
    let words = refusal_given(pontoon(), &with(None, None, Some([0.0, -0.5])));
    assert_message_contains(&words, &["reference point's z", "-0.5 in the case"]);
    let same = with(Some(1025.5), Some(f64::INFINITY), Some([0.0, 0.0]));
    assert!(from_dataset(&pontoon().0, &same).is_ok());
}

fn wamit() -> (WamitText, Given) {
    let files = wamit_files();
    let given = Given {
        density_kg_m3: Some(1025.0),
        gravity_m_s2: Some(9.81),
        depth_m: Some(f64::INFINITY),
        reference_m: Some([0.0, 0.0]),
        unit_length_m: Some(1.0),
        ..Given::default()
    };
    (files, given)
}

fn wamit_lines(text: &str, keep: impl Fn(&&str) -> bool) -> String {
    let lines = text.lines().filter(keep);
    lines.map(|line| line.to_owned() + "\n").collect()
}

/// Files of bodies with symmetries have only one of two transposed entries, or none that vanishes:
/// the other one equals it, and the vanishing ones are zero.
#[test]
fn wamit_may_leave_out_entries_by_symmetry() {
    let (files, given) = wamit();
    let whole = from_wamit(&files, &given).expect("coefficients");
    let kept = [["1", "1"], ["3", "3"], ["5", "5"], ["1", "5"]];
    let mut upper = files.clone();
    upper.radiation = wamit_lines(&files.radiation, |line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        kept.iter().any(|entry| words[1..3] == entry[..])
    });
    let hydro = from_wamit(&upper, &given).expect("coefficients");
    let matrices = [
        (&whole.added_mass, &hydro.added_mass),
        (&whole.damping, &hydro.damping),
    ];
    for (whole, half) in matrices {
        let coupling = |m: &Matrix3<f64>| m[(0, 2)].abs();
        let largest = whole.iter().map(coupling).fold(0.0, f64::max);
        for (a, b) in whole.iter().zip(half) {
            assert_eq!((b[(0, 2)], b[(0, 1)], b[(1, 2)]), (b[(2, 0)], 0.0, 0.0));
            // The whole file's is the mean of 1,5 and 5,1, which differ a little on this mesh.
            assert!((a[(0, 2)] - b[(0, 2)]).abs() < 0.05 * largest, "{a}{b}");
        }
    }
    assert_eq!((hydro.asymmetry, hydro.added_mass.len()), (0.0, 58));
}

/// The warning that no frequency is low enough asks about WAMIT's first column, for its files only.
#[test]
fn periods_taken_as_frequencies_are_suspected() {
    let warning = |format, hydro| {
        let reading = Reading::new(format, hydro).expect("a reading");
        let found = reading.warnings.into_iter();
        let mut found = found.filter(|warning| warning.what == "low frequencies");
        found.next().expect("a warning").message
    };
    let (files, given) = wamit();
    let given = Given {
        first_column: Some(FirstColumn::Frequency),
        ..given
    };
    let periods = from_wamit(&files, &given).expect("coefficients");
    let question = "first column";
    assert_message_contains(&warning(Format::Wamit, periods), &[question, "periods"]);
    let high = pontoon().numbers("omega", |_, omega| 20.0 * omega);
    let high = from_dataset(&high.0, &Given::default()).expect("coefficients");
    assert!(!warning(Format::Capytaine, high).contains(question));
}

fn wamit_refusal(files: &WamitText, given: &Given) -> String {
    let hydro = from_wamit(files, given);
    let read = hydro.and_then(|hydro| Reading::new(Format::Wamit, hydro));
    read.map(|reading| reading.warnings)
        .expect_err("a refusal")
        .to_string()
}

#[test]
fn bad_files_of_wamit_are_named() {
    let (files, given) = wamit();
    let no_length = Given {
        unit_length_m: None,
        ..given.clone()
    };
    assert_message_contains(&wamit_refusal(&files, &no_length), &["ULEN", "missing"]);
    let no_density = Given {
        density_kg_m3: None,
        ..given.clone()
    };
    assert_message_contains(&wamit_refusal(&files, &no_density), &["density", "missing"]);
    // e^{−iωt} instead of e^{+iωt}.
    let mut conjugate = files.clone();
    conjugate.excitation = files
        .excitation
        .lines()
        .map(|line| {
            let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
            for at in [4, 6] {
                let value: f64 = words[at].parse().expect("a number");
                words[at] = (-value).to_string();
            }
            words.join(" ") + "\n"
        })
        .collect();
    assert_message_contains(
        &wamit_refusal(&conjugate, &given),
        &["phase of X1", "conjugate"],
    );
    let mut no_heave = files.clone();
    let keep = |line: &&str| line.split_whitespace().nth(1) != Some("3");
    no_heave.radiation = wamit_lines(&files.radiation, keep);
    assert_message_contains(&wamit_refusal(&no_heave, &given), &["3,3", "missing"]);
    // A line that is missing at one frequency only is no zero.
    for [force, motion] in [["3", "3"], ["1", "5"]] {
        let mut hole = files.clone();
        let keep = |line: &&str| {
            let words: Vec<&str> = line.split_whitespace().collect();
            words[..3] != ["1.377892e+00", force, motion]
        };
        hole.radiation = wamit_lines(&files.radiation, keep);
        let entry = format!("{force},{motion} at PER = 1.377892");
        assert_message_contains(
            &wamit_refusal(&hole, &given),
            &[&entry, "missing", ".3 file"],
        );
    }
    let mut words = files.clone();
    words.radiation += "and so on\n";
    assert_message_contains(
        &wamit_refusal(&words, &given),
        &[".1 file", "line", "and so on"],
    );
    let mut columns = files.clone();
    columns.excitation = "1.0 0.0 1 2.0 90.0 2.0 0.0\n".to_owned();
    assert_message_contains(&wamit_refusal(&columns, &given), &["PHA", "degrees"]);
    let mut nan = files.clone();
    nan.radiation = files.radiation.replace("2.674251e+02", "NaN");
    assert!(
        from_wamit(&nan, &given).is_ok(),
        "A(0) that is no number is left out"
    );
    let mut other = files.clone();
    other.excitation = other.excitation.replace("1.354135e+00", "1.354000e+00");
    assert_message_contains(
        &wamit_refusal(&other, &given),
        &["frequencies of the .1 and the .3 file"],
    );
    // A header line is skipped.
    let mut header = files;
    header.radiation = "PER I J A B\n".to_owned() + &header.radiation;
    assert!(from_wamit(&header, &given).is_ok());
}

#[test]
fn files_of_other_sorts_are_refused() {
    let refused = |name: &str| {
        let reading = read(&path(name), &Given::default());
        reading
            .map(|reading| reading.warnings)
            .expect_err("a refusal")
            .to_string()
    };
    let missing = "can not be read: No such file or directory";
    assert_eq!(refused("nothing.nc"), missing);
    let beside = "can not be read: RadiationCoefficients.tec: No such file or directory";
    assert_eq!(refused("nothing.tec"), beside);
    assert_message_contains(&refused("pontoon.xyz"), &["Capytaine", "WAMIT", "Nemoh"]);
    let error = Dataset::from_netcdf(b"not a netCDF file at all").expect_err("a refusal");
    assert_message_contains(&error.to_string(), &["can not be read", "netCDF"]);
    assert!(Dataset::from_netcdf(b"").is_err());
}

/// A small generator of random numbers (Marsaglia's xorshift).
fn next(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

/// Flipped bits, overwritten bytes and truncated files: a result or an error, never a panic, and
/// the numbers of a result are finite.
#[test]
fn damaged_files_do_no_harm() {
    let whole = bytes("pontoon-deep.nc");
    let mut state = 0x9e37_79b9_7f4a_7c15;
    let mut refused = 0;
    for round in 0..1500 {
        let mut bytes = whole.clone();
        match round % 3 {
            0 => bytes.truncate(next(&mut state) as usize % whole.len()),
            1 => {
                for _ in 0..1 + next(&mut state) % 4 {
                    let at = next(&mut state) as usize % whole.len();
                    bytes[at] ^= 1 << (next(&mut state) % 8);
                }
            }
            _ => {
                let at = next(&mut state) as usize % whole.len();
                let end = (at + 1 + next(&mut state) as usize % 64).min(whole.len());
                let value = next(&mut state) as u8;
                bytes[at..end].fill(value);
            }
        }
        let hydro =
            Dataset::from_netcdf(&bytes).and_then(|set| from_dataset(&set, &Given::default()));
        match hydro.and_then(|hydro| Reading::new(Format::Capytaine, hydro)) {
            Ok(reading) => assert!(
                reading
                    .hydro
                    .added_mass
                    .iter()
                    .all(|a| a.amax().is_finite())
            ),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    // Most damage to names, sizes and addresses is detected; bits of single numbers can not be.
    assert!(refused > 600, "{refused}");
}
