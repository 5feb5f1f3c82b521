//! A submerged body that comes out of the water as it moves.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{ElasticComparison, ModelAtRest, VerdictKind, compare_elastic};

const RATE_N_M: f64 = 2e5;
const VOLUME_M3: f64 = 16.0;
const MASS_KG: f64 = 6000.0;

/// A cylinder of 2 m across on one upright elastic line that does not lose energy; on the line
/// without stretch its top is 2 m under the still water. It is let go so far below that.
fn let_go(below_m: f64) -> ElasticComparison {
    let case = structure(&format!(
        "[body]\nmass = {MASS_KG}\ndisplaced_volume = {VOLUME_M3}\nwidth = 2\nposition = [0, -3]\n\
         [[line]]\nanchor = [0, -30]\nfairlead = [0, -3]\nlength = 27\nbreaking_load = 1e8\n\
         spring_rate = {RATE_N_M}\n[site]\ndepth = 30\n[run]\nrestitution = 1\nduration = 20\n\
         start = [0, {}]\n",
        -3.0 - below_m
    ));
    let prepared = ModelAtRest::for_elastic_lines(case).expect("a start");
    compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).expect("a run")
}

/// How far its top then rises above the line's end without stretch: the net buoyancy B does the
/// work B (d + s), which is the energy k s²/2 of the spring.
fn rises_m(below_m: f64) -> f64 {
    let buoyancy_n = 9.80665 * (1025.0 * VOLUME_M3 - MASS_KG);
    let sag = buoyancy_n / RATE_N_M;
    sag + (sag * sag + 2.0 * sag * below_m).sqrt()
}

/// The distance from which it is let go for its top to come out of the water by `out_m`.
fn below_m(out_m: f64) -> f64 {
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        match rises_m(middle) < 2.0 + out_m {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

/// A body that loses much of its buoyancy in the air is not known to hold, with a warning of how
/// far it comes out. One that stays in the water holds without a word, and one of which 2 cm come
/// out, half a percent of its section, holds with the warning.
#[test]
fn what_happens_after_the_body_came_out_of_the_water_is_open() {
    for (out_m, standing, says) in [
        (
            1.5,
            VerdictKind::Open,
            Some("up to 1.50 m out of the water"),
        ),
        (0.02, VerdictKind::Holds, Some("out of the water")),
        (-0.02, VerdictKind::Holds, None),
    ] {
        let found = let_go(below_m(out_m));
        // Places are seen at 16 times of a step.
        let seen_m = found.outcome.emergence.out_m;
        assert!((seen_m - out_m.max(0.0)).abs() < 2e-3, "{seen_m} {out_m}");
        let verdict = found.verdict();
        assert_eq!(verdict.standing, standing, "{out_m}: {}", verdict.words);
        let warnings = found.warnings();
        let warning = warnings.iter().find(|warning| warning.rule == "emergence");
        assert_eq!(warning.is_some(), says.is_some(), "{out_m}");
        if let Some((warning, says)) = warning.zip(says) {
            assert!(warning.message.contains(says), "{}", warning.message);
        }
        let see = verdict.words.contains("not reliable (see emergence)");
        assert_eq!(see, standing == VerdictKind::Open, "{}", verdict.words);
    }
}
