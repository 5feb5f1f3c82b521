//! Lines of WAMIT's files that occur twice.

use crate::common::{wamit_files, wamit_given};
use snapload_hydro::{HydroError, Hydrodynamics, WamitText, from_wamit};

/// The lines that begin with some words, with a factor at some columns; the words may be replaced.
fn lines(text: &str, from: &[&str], to: &[&str], columns: &[usize], factor: f64) -> String {
    let chosen = text.lines().filter_map(|line| {
        let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        let begins = from.iter().zip(&words).all(|(from, word)| from == word);
        if !begins {
            return None;
        }
        for (word, to) in words.iter_mut().zip(to) {
            (*to).clone_into(word);
        }
        for at in columns {
            let value: f64 = words[*at].parse().expect("a number");
            words[*at] = format!("{:e}", value * factor);
        }
        Some(words.join(" ") + "\n")
    });
    chosen.collect()
}

/// The text after a heading of the file whose waves go to +x.
fn per_and_heading(excitation: &str) -> [String; 2] {
    let first = excitation.lines().find(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        words[1].parse::<f64>() == Ok(0.0) && words[0].parse::<f64>().is_ok_and(|per| per > 0.0)
    });
    let words: Vec<&str> = first.expect("a line").split_whitespace().collect();
    [words[0].to_owned(), words[1].to_owned()]
}

/// A copy of lines changes nothing. With another value the file is refused, with the place: which
/// of the two is right is not known.
#[test]
fn lines_that_contradict_each_other_are_refused() {
    let plain = from_wamit(&wamit_files(), &wamit_given()).expect("coefficients");
    let [per, heading] = per_and_heading(&wamit_files().excitation);
    let (per, heading) = (per.as_str(), heading.as_str());
    let more = |factor: f64| {
        let own = wamit_files();
        let one = lines(&own.radiation, &[per, "3", "3"], &[], &[3], factor);
        let three = lines(
            &own.excitation,
            &[per, heading, "3"],
            &[],
            &[3, 5, 6],
            factor,
        );
        let hydrostatics = own.hydrostatics.expect("a stiffness");
        let hst = lines(&hydrostatics, &["3", "3"], &[], &[2], factor);
        [one, three, hst]
    };
    let with = |[one, three, hst]: [&str; 3]| {
        let mut files = wamit_files();
        files.radiation += one;
        files.excitation += three;
        *files.hydrostatics.as_mut().expect("a stiffness") += hst;
        from_wamit(&files, &wamit_given())
    };
    let copies = more(1.0);
    assert!(
        copies.iter().all(|copy| copy.lines().count() == 1),
        "{copies:?}"
    );
    let [one, three, hst] = &copies;
    assert_eq!(with([one, three, hst]), Ok(plain));
    let [one, three, hst] = &more(0.2);
    for (lines, file, place) in [
        ([one.as_str(), "", ""], "the .1 file", "3,3 at PER"),
        (["", three.as_str(), ""], "the .3 file", "3 at PER"),
        (["", "", hst.as_str()], "the .hst file", "3,3 occurs"),
    ] {
        let error = with(lines).expect_err("a refusal").to_string();
        let words = ["occurs twice, with different values", file, place];
        assert!(words.iter().all(|words| error.contains(words)), "{error}");
    }
}

/// The lines of the heading of 0 degrees as lines of another one, with factors at forces and pitch.
fn turned(excitation: &str, heading: &str, [forces, pitch]: [f64; 2]) -> String {
    let mut turned = String::new();
    for line in excitation.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words[1].parse::<f64>() == Ok(0.0) {
            let factor = if words[2] == "5" { pitch } else { forces };
            turned += &lines(line, &[], &[words[0], heading], &[3, 5, 6], factor);
        }
    }
    turned
}

fn with_excitation(excitation: String) -> Result<Hydrodynamics, HydroError> {
    let files = WamitText {
        excitation,
        ..wamit_files()
    };
    from_wamit(&files, &wamit_given())
}

/// 360 degrees are 0 degrees: their forces may differ by rounding, and by no more.
#[test]
fn a_full_turn_is_the_same_heading() {
    let plain = from_wamit(&wamit_files(), &wamit_given()).expect("coefficients");
    let own = wamit_files().excitation;
    let with = |factors: [f64; 2]| with_excitation(own.clone() + &turned(&own, "360.0", factors));
    assert_eq!(with([1.0 + 1e-6; 2]), Ok(plain));
    for factors in [[0.5; 2], [1.0, 0.5], [0.5, 1.0]] {
        let error = with(factors).expect_err("a refusal").to_string();
        let words = "BETA = 0 and 360, occurs twice, with different values";
        assert!(error.contains(words), "{error}");
    }
}

/// A circle is not turned by waves about its centre: what a file has there is rounding, which is
/// not the same at both headings.
#[test]
fn a_moment_that_is_rounding_may_be_another_after_a_full_turn() {
    let own = wamit_files().excitation;
    let round = turned(&own, "0.0", [1.0, 1e-9]);
    let plain = with_excitation(round.clone()).expect("coefficients");
    let other = turned(&own, "360.0", [1.0, -3e-9]);
    assert_eq!(with_excitation(round + &other), Ok(plain));
}

/// Numbers with commas or semicolons between them are not taken for headings.
#[test]
fn lines_with_other_separators_are_named() {
    let plain = wamit_files().radiation;
    for separator in [";", ",", "; "] {
        let rows = plain.lines().map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            words.join(separator)
        });
        let mut files = wamit_files();
        files.radiation = rows.collect::<Vec<_>>().join("\n");
        let error = from_wamit(&files, &wamit_given()).expect_err("a refusal");
        let error = error.to_string();
        let words = [
            "the .1 file",
            "line 1 is",
            "spaces between them are expected",
        ];
        assert!(words.iter().all(|words| error.contains(words)), "{error}");
    }
}
