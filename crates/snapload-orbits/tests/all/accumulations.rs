//! Snaps of two cables that accumulate in turn, down to rest where both cables end.

use crate::common::POINT;
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{Branch, BranchOptions, Kind, Moored, Orbit, OrbitRequest, of_attractor};

/// Each snap of one cable lets the other go, whose snaps accumulate before the next one.
const NESTED: Parameters = Parameters {
    r: 1.441,
    e: 0.455,
    nu: 0.232,
    omega: 2.652,
    x: 0.05,
    y: 0.4,
    f_o: 1.0,
    ..POINT
};

fn attractor(case: &Parameters) -> Orbit {
    let found = of_attractor(case, &OrbitRequest::default(), &no_progress);
    found.unwrap().unwrap()
}

fn branch(case: &Parameters, key: &'static str, range: [f64; 2], step: f64) -> Branch {
    let family = Moored::case(*case, [Some(key), None]);
    let orbit = attractor(case).with_at(Moored::values(case, [Some(key), None]));
    let options = BranchOptions {
        range,
        step,
        most: 400,
    };
    Branch::of(&family, &orbit, &options, &no_progress).unwrap()
}

/// A cable can not push, and a list of events is one of times.
#[test]
fn all_snaps_close_and_follow_each_other() {
    for f_o in [0.98, 1.0, 1.03] {
        let orbit = attractor(&Parameters { f_o, ..NESTED });
        assert!(orbit.is_admissible());
        let mut snaps = orbit.rows.iter().filter(|row| row.kind == "snap");
        assert!(snaps.all(|row| row.speed > 0.0 && row.impulse > 0.0));
        assert!(orbit.rows.is_sorted_by(|a, b| a.t <= b.t));
    }
}

/// The motion at either end is found without the branch, and changes as smoothly as between them.
#[test]
fn the_tails_of_accumulations_end_no_branch() {
    let range = [0.999, 1.001];
    let found = branch(&NESTED, "f_o", range, 0.01);
    assert!(found.events.is_empty());
    let ends = found.ends.each_ref().map(|end| end.at);
    assert_eq!(ends, range);
    for point in &found.points {
        let orbit = &point.orbit;
        assert!(orbit.is_admissible(), "{:?}", orbit.why_not);
        let f_o = orbit.at[0];
        let alone = attractor(&Parameters { f_o, ..NESTED });
        assert!(snapload_orbits::distance(&alone.z, &orbit.z) < 1e-11);
    }
}

/// Below f_c = 1/√(h² + ν²) the mass stays in the corner: there the accumulations have shrunk to
/// nothing, and their first snap has no velocity left.
#[test]
fn accumulations_shrink_to_rest_in_the_corner() {
    let case = Parameters {
        f_o: 0.941,
        ..NESTED
    };
    let found = branch(&case, "f_o", [0.93, 0.941], 0.01);
    let known = 1.0 / (case.r * case.r - 1.0 + case.nu * case.nu).sqrt();
    assert!((found.ends[0].at - known).abs() < 1e-9, "{:?}", found.ends);
    assert!(found.points.iter().all(|point| point.orbit.is_admissible()));
}

/// Both cables snap in turn into the corner, where the mass rests at the section: another number of
/// those snaps is no corner of the branch.
#[test]
fn snaps_in_turn_into_the_corner_end_no_branch() {
    let case = Parameters {
        r: 1.804_469_420_201_758_6,
        e: 0.3,
        f_o: 0.756_690_946_863_074_9,
        omega: 2.738_440_732_491_697_7,
        nu: 1.208,
        ..POINT
    };
    let found = branch(&case, "nu", [1.2075, 1.211], 0.01);
    assert!(found.events.is_empty(), "{:?}", found.events[0].kind);
    let ends = found.ends.each_ref().map(|end| end.at);
    assert_eq!(ends, [1.2075, 1.211]);
    assert!(found.points.iter().all(|point| point.orbit.is_admissible()));
}

/// A branch ends where its accumulation no longer comes to rest, wherever and however it is
/// followed: the simulated motion has the stick just before that place, and not just behind it.
#[test]
fn the_end_of_an_accumulation_depends_on_no_step() {
    let case = Parameters {
        r: 1.841_461_093_597_187,
        e: 0.2,
        nu: 0.045_884_974_550_330_304,
        omega: 2.101_783_443_973_843,
        f_o: 1.840,
        ..POINT
    };
    let sticks = |f_o: f64| {
        let orbit = attractor(&Parameters { f_o, ..case });
        let sticks = orbit.rows.iter().filter(|row| row.kind == "stick");
        sticks.count()
    };
    for (f_o, step) in [(1.840, 0.01), (1.840, 0.001), (1.842, 0.003)] {
        let found = branch(&Parameters { f_o, ..case }, "f_o", [1.839, 1.85], step);
        let end = &found.ends[1];
        assert!(end.because.starts_with("an accumulation of snaps changes"));
        let special = |kind| found.events.iter().any(|event| event.kind == kind);
        assert!(!special(Kind::Graze) && !special(Kind::Corner) && !special(Kind::Fold));
        assert_eq!([sticks(end.at - 1e-7), sticks(end.at + 1e-7)], [2, 1]);
    }
}

/// Where fast snaps of the two cables change their order a branch still ends: the motions on either
/// side, found without it, begin with other snaps.
#[test]
fn a_corner_of_fast_snaps_still_ends_a_branch() {
    let case = Parameters {
        r: 1.236,
        e: 0.415,
        nu: 0.3181,
        omega: 3.1405,
        f_o: 1.425,
        ..POINT
    };
    let found = branch(&case, "f_o", [1.415, 1.426], 0.01);
    let kinds: Vec<Kind> = found.events.iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [Kind::Corner]);
    let corner = found.events[0].value[0];
    assert_eq!(found.ends[0].at, corner);
    let first_two = |f_o: f64| {
        let orbit = attractor(&Parameters { f_o, ..case });
        let snaps = orbit.rows.iter().filter(|row| row.kind == "snap");
        snaps.take(2).map(|row| row.surface).collect::<Vec<_>>()
    };
    let [below, above] = [-1e-4, 1e-4].map(|by| first_two(corner + by));
    assert_ne!(below, above);
}
