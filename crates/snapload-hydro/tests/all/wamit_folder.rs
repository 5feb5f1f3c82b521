//! Which files of WAMIT are read, and which of their lines are numbers.

use crate::common::{path, wamit_files, wamit_given};
use nalgebra::Matrix3;
use snapload_hydro::{WamitText, files_of, from_wamit, read};

/// A folder with the pontoon's files under these endings.
fn folder(files: [(&str, &str); 3]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (own, ending) in files {
        let to = folder.path().join(format!("pontoon.{ending}"));
        std::fs::copy(path(&format!("pontoon-deep.{own}")), to).expect("a copy");
    }
    folder
}

/// WAMIT writes the wave forces by Haskind's relation (`.2`) and by pressure (`.3`), which differ.
#[test]
fn the_wave_forces_are_those_that_were_asked_for() {
    let folder = folder([("1", "1"), ("3", "3"), ("hst", "hst")]);
    let at = |ending: &str| folder.path().join(format!("pontoon.{ending}"));
    let third = read(&at("3"), &wamit_given()).expect("a reading").hydro;
    // Each force is a tenth smaller in the other file: MOD, RE and IM.
    let text = std::fs::read_to_string(at("3")).expect("text");
    let smaller = text.lines().map(|line| {
        let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        for column in [3, 5, 6] {
            let value: f64 = words[column].parse().expect("a number");
            words[column] = format!("{:e}", 0.9 * value);
        }
        words.join(" ") + "\n"
    });
    std::fs::write(at("2"), smaller.collect::<String>()).expect("written");
    let heave = |ending: &str| {
        let reading = read(&at(ending), &wamit_given()).expect("a reading");
        reading.hydro.excitation[0].force[20][1].norm() / third.excitation[0].force[20][1].norm()
    };
    for (ending, expected) in [("1", 1.0), ("3", 1.0), ("hst", 1.0), ("2", 0.9)] {
        let found = heave(ending);
        assert!((found - expected).abs() < 1e-9, "{ending}: {found}");
    }
    // Without the file that was asked for, another one does not take its place.
    for ending in ["3", "hst"] {
        std::fs::remove_file(at(ending)).expect("removed");
        let error = read(&at(ending), &wamit_given()).expect_err("a refusal");
        assert!(error.to_string().contains("No such file"), "{error}");
    }
    assert!((heave("1") - 0.9).abs() < 1e-9);
}

/// What is read for one of the files is that one and all others that belong to it.
#[test]
fn the_files_of_one_are_those_that_belong_to_it() {
    let folder = folder([("1", "1"), ("3", "3"), ("hst", "HST")]);
    let at = |ending: &str| folder.path().join(format!("pontoon.{ending}"));
    for asked in ["1", "3", "HST"] {
        assert_eq!(files_of(&at(asked)), ["1", "3", "HST"].map(at), "{asked}");
    }
    assert_eq!(files_of(&at("2")), ["1", "2", "HST"].map(at));
    assert_eq!(files_of(&at("nc")), [at("nc")]);
    let nemoh = ["RadiationCoefficients.tec", "ExcitationForce.tec"];
    let inside = nemoh.map(|name| folder.path().join(name));
    assert_eq!(files_of(folder.path()), inside);
    assert_eq!(files_of(&inside[1]), inside);
}

#[test]
fn endings_in_capitals_are_found() {
    let folder = folder([("1", "1"), ("3", "3"), ("hst", "HST")]);
    for ending in ["1", "HST"] {
        let at = folder.path().join(format!("pontoon.{ending}"));
        let reading = read(&at, &wamit_given()).expect("a reading");
        assert!(reading.hydro.hydrostatics.stiffness.is_some(), "{ending}");
    }
}

fn with_hst(text: &str) -> WamitText {
    WamitText {
        hydrostatics: Some(text.to_owned()),
        ..wamit_files()
    }
}

/// A first line of numbers that can not be read is no heading, and a stiffness of pitch that is
/// missing is not zero.
#[test]
fn lines_of_numbers_are_not_taken_for_headings() {
    let refusal = |files: &WamitText| {
        let error = from_wamit(files, &wamit_given()).expect_err("a refusal");
        error.to_string()
    };
    // Two numbers without a space between them, and what Fortran writes of one that does not fit.
    for pitch in ["5 5 67.82-12.5", "5 5 *****", "5 5"] {
        let message = refusal(&with_hst(&format!("{pitch}\n3 3 80.0\n")));
        assert!(message.contains("the .hst file: line 1"), "{message}");
    }
    for (text, missing) in [("3 3 80.0\n", "5,5"), ("5 5 67.8\n", "3,3"), ("", "3,3")] {
        let message = refusal(&with_hst(text));
        assert!(
            message.contains(missing) && message.contains("missing"),
            "{message}"
        );
    }
    let mut files = wamit_files();
    files.radiation = files.radiation.replacen(' ', " *", 1);
    let message = refusal(&files);
    assert!(message.contains("the .1 file: line 1 is"), "{message}");
}

#[test]
fn several_lines_of_words_may_precede_the_numbers() {
    let plain = from_wamit(&wamit_files(), &wamit_given()).expect("coefficients");
    for heading in [
        "\n",
        "PER I J A B\n",
        "28-Nov-2026 15:46:12 a run of WAMIT\n",
        "# the pontoon, 20 by 4 m\n\n20 m of it\n",
    ] {
        let own = wamit_files();
        let files = WamitText {
            radiation: heading.to_owned() + &own.radiation,
            excitation: heading.to_owned() + &own.excitation,
            hydrostatics: own.hydrostatics.map(|text| heading.to_owned() + &text),
        };
        assert_eq!(from_wamit(&files, &wamit_given()), Ok(plain.clone()));
    }
}

/// C is symmetric: one of its triangles says what the other is, whether that is left out or zero.
#[test]
fn one_triangle_of_the_stiffness_is_enough() {
    let stiffness = |text: &str| {
        let hydro = from_wamit(&with_hst(text), &wamit_given()).expect("coefficients");
        hydro.hydrostatics.stiffness.expect("a stiffness")
    };
    // ρ g of the given water.
    let scale = 1025.0 * 9.81;
    let expected = Matrix3::new(0.0, 0.0, 0.0, 0.0, 80.0, -7.5, 0.0, -7.5, 67.8) * scale;
    let diagonal = "3 3 80.0\n5 5 67.8\n";
    for entry in [
        "3 5 -7.5\n",
        "5 3 -7.5\n",
        "3 5 -7.5\n5 3 0.0\n",
        "3 5 0.0\n5 3 -7.5\n",
        "3 5 -7.5\n5 3 -7.5\n",
    ] {
        let found = stiffness(&(diagonal.to_owned() + entry));
        assert!((found - expected).amax() < 1e-9 * scale, "{entry}{found}");
    }
}
