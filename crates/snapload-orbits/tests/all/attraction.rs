//! Basins of attraction.

use crate::common::{parameters, reference};
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{
    Attraction, CellOutcome, Section, SectionOptions, Window, attraction_summary,
};

/// Below f_c rest in the corner and an orbit of three snaps are both attractors.
#[test]
fn two_attractors_share_the_starts() {
    let base = crate::common::two_attractors();
    let window = Window {
        base,
        keys: ["x", "y"],
        values: [vec![-0.1, 0.0, 0.1], vec![0.2, 0.425, 0.65]],
    };
    let found = Attraction::of(window, 200, true, &no_progress).unwrap();
    let symbols: Vec<_> = found
        .attractors
        .iter()
        .map(|attractor| attractor.orbit.as_ref().unwrap().lap.sequence.symbol())
        .collect();
    let undecided = found.undecided().unwrap();
    assert!(undecided < found.cells.len(), "{:?}", found.cells);
    assert!(symbols.contains(&Vec::new()));
    assert!(symbols.iter().any(|symbol| symbol.len() == 3));
    assert_eq!(found.count(|o| *o == CellOutcome::Aperiodic), 0);
}

/// A motion that takes long to come to its orbit, near a fold, is not called one without a period.
#[test]
fn cells_without_a_period_are_told_of() {
    let case = Parameters {
        f_o: 1.304_055,
        vx: 0.786,
        vy: -0.3735,
        ..parameters(&reference()["branches"][0]["base"])
    };
    let window = Window {
        base: case,
        keys: ["x", "y"],
        values: [vec![-3.2131, -0.2131, 2.7869], vec![0.2575, 0.2615]],
    };
    let found = Attraction::of(window, 100, false, &no_progress).unwrap();
    let open = found.count(|o| *o == CellOutcome::Aperiodic);
    assert!(open > 0, "{:?}", found.cells);
    let words = attraction_summary(&found);
    let line = format!("Open      {open} cells: no period up to 15 was found");
    assert!(words.contains(&line), "{words}");
    assert!(words.contains("Legal     2 of 6 cells"), "{words}");
    // A period is one that nine stretches of as many periods agree in: 137 points have 15 of these.
    let options = SectionOptions {
        skip: 0,
        keep: 136,
        phase: 0.0,
        exponents: false,
        impacts: false,
    };
    let section = Section::of(&case, &options, &no_progress).unwrap();
    assert_eq!(section.longest_period(), 15);
}

/// A chaotic motion that begins otherwise by a rounding or two comes to another end, or stops at
/// another time: no cell where that happens is decided, or its time trusted.
#[test]
fn what_a_rounding_decides_is_not_certain() {
    let base = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.9,
        e: 0.85,
        nu: 0.8,
        omega: 4.2,
        f_o: 0.9,
        ..Parameters::STANDARD
    };
    let of = |vx: f64, trust: bool| {
        let window = Window {
            base: Parameters { vx, ..base },
            keys: ["x", "y"],
            values: [vec![-0.45, -0.2, 0.05, 0.3], vec![0.164, 0.4, 0.636]],
        };
        Attraction::of(window, 100, trust, &no_progress).unwrap()
    };
    let found = of(0.0, true);
    let mut changed = 0;
    for vx in [1e-13, -1e-13, 3e-13] {
        for (cell, other) in found.cells.iter().zip(of(vx, false).cells) {
            let is_same = match (cell.outcome, other.outcome) {
                (CellOutcome::Stopped(one, t), CellOutcome::Stopped(other, s)) => {
                    assert!(!cell.trusted || (t - s).abs() < 1e-3, "{cell:?}");
                    one == other
                }
                (one, other) => one == other,
            };
            assert!(is_same || !cell.decided, "{cell:?} {other:?}");
            changed += usize::from(!is_same);
        }
    }
    assert!(changed > 0);
    assert!(found.cells.iter().any(|cell| cell.trusted));
}
