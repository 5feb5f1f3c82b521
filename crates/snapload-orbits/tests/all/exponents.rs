//! Exponents of motions in which snaps accumulate.

use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{Section, SectionOptions, section_summary};

fn exponents(case: Parameters, v_stick: f64) -> (Vec<[f64; 2]>, String) {
    let options = SectionOptions {
        phase: 0.0,
        skip: 50,
        keep: 250,
        exponents: true,
        impacts: false,
    };
    let case = Parameters { v_stick, ..case };
    let section = Section::of(&case, &options, &no_progress).expect("a section");
    let text = section_summary(&section);
    (section.exponents, text)
}

/// Where the snaps of two cables accumulate in turn, deviations grow by a factor with every tenth of
/// the speed: by 1.1 per unit of time, as a program in numbers of 113 bits confirms. The exponent
/// then follows `v_stick`, and has no error that would make it known.
#[test]
fn an_exponent_that_v_stick_decides_is_not_known() {
    let both = Parameters {
        inertia: Some(0.06),
        a: 0.3,
        b: 0.3,
        omega: 2.5,
        f_o: 0.3,
        ..Parameters::STANDARD
    };
    let mut means = Vec::new();
    for v_stick in [1e-4, 1e-6, 1e-8] {
        let (found, text) = exponents(both, v_stick);
        let [mean, error] = found[0];
        assert_eq!(error, f64::INFINITY, "{mean}");
        assert!(text.contains("not known: it depends on v_stick"), "{text}");
        means.push(mean);
    }
    let rises: Vec<f64> = means.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(rises.iter().all(|rise| *rise > 0.5), "{means:?}");
}

/// Where snaps of one cable accumulate it does not, and the exponents are those of any `v_stick`.
#[test]
fn exponents_of_snaps_of_one_cable_do_not_depend_on_v_stick() {
    let one = Parameters {
        e: 0.4,
        f_o: 0.2,
        omega: 1.3,
        ..Parameters::STANDARD
    };
    let (first, _) = exponents(one, 1e-6);
    let (second, _) = exponents(one, 1e-8);
    let finite = first.iter().filter(|[mean, _]| mean.is_finite()).count();
    assert!(finite > 0);
    for ([a, first_error], [b, second_error]) in first.iter().zip(&second) {
        let apart = (a - b).abs();
        let known = a == b || apart < 3.0 * first_error.hypot(*second_error);
        assert!(known && first_error.is_finite(), "{a} and {b}");
    }
}
