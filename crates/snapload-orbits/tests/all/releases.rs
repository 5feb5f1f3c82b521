//! Branches of orbits with releases, whose tension is zero there on every orbit.

use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{
    Branch, BranchOptions, Kind, Moored, Orbit, OrbitRequest, Point, of_attractor,
};

/// A point mass.
fn point(r: f64, e: f64, nu: f64, omega: f64, f_o: f64) -> Parameters {
    Parameters {
        inertia: None,
        a: 0.0,
        r,
        e,
        nu,
        omega,
        f_o,
        ..Parameters::STANDARD
    }
}

/// The branch of an orbit along a key.
fn branch(case: Parameters, start: Point, key: &'static str, range: [f64; 2]) -> Branch {
    let keys = [Some(key), None];
    let family = Moored::case(case, keys);
    let at = Moored::values(&case, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let options = BranchOptions {
        range,
        step: 0.02,
        most: 200,
    };
    Branch::of(&family, &orbit, &options, &no_progress).unwrap()
}

/// The values at which tension is lost.
fn losses(branch: &Branch) -> Vec<f64> {
    let events = branch.events.iter();
    let lost = events.filter(|event| event.kind == Kind::TensionLost);
    lost.map(|event| event.value[0]).collect()
}

/// All orbits are possible motions, which runs confirm, so that no tension is lost on the way; that
/// of a cable vanishes at its own release.
#[test]
fn a_release_is_no_loss_of_tension() {
    let case = point(1.703, 0.1, 0.4, 3.23, 1.998);
    let start = [
        -0.044_700_524,
        0.069_208_241,
        0.0,
        0.638_727_288,
        -0.360_806_664,
        0.0,
    ];
    let branch = branch(case, start, "omega", [2.6, 3.9]);
    let all = || branch.points.iter().map(|point| &point.orbit);
    assert!(all().all(|orbit| orbit.is_admissible()));
    assert!(all().all(|orbit| {
        let symbol = orbit.lap.sequence.symbol();
        symbol.contains(&"release 2".to_owned()) && orbit.survey.least_tension.unwrap().value > 1e-6
    }));
    assert_eq!(losses(&branch), [0.0; 0]);
}

/// The one loss lies between the last orbit that a run confirms and the first one from which a run
/// goes elsewhere.
#[test]
fn the_loss_after_which_a_run_leaves_the_orbit_is_located() {
    let starts = [
        (
            point(1.666, 0.0, 0.78, 2.61, 1.774),
            [
                -0.074_767_105,
                0.059_538_136,
                0.0,
                0.904_633_390,
                -0.763_785_867,
                0.0,
            ],
            [1.75, 2.4],
        ),
        (
            point(1.631, 0.0, 0.25, 3.3, 1.225),
            [
                0.014_638_979,
                0.011_495_945,
                0.0,
                0.092_867_251,
                0.073_788_938,
                0.0,
            ],
            [1.217, 1.7],
        ),
    ];
    for (case, start, range) in starts {
        let found = branch(case, start, "f_o", range);
        let values = losses(&found);
        let [value] = values[..] else {
            panic!("{values:?}");
        };
        for (border, goes) in [(value - 1e-4, true), (value + 1e-4, false)] {
            let part = branch(case, start, "f_o", [range[0], border]);
            let last = &part.points.last().unwrap().orbit;
            assert_eq!(last.at[0], border);
            let leaves = last.why_not.iter().any(|why| why.contains("other events"));
            assert_eq!((last.is_admissible(), leaves), (goes, !goes), "{border}");
        }
    }
}

/// A release comes earlier or later along a branch. Where it passes the section no tension is lost.
#[test]
fn a_release_may_pass_the_section() {
    let case = point(1.2552, 0.0, 1.0096, 2.5825, 1.23);
    let start = Parameters {
        x: -0.0889,
        y: 0.4196,
        ..case
    };
    let orbit = of_attractor(&start, &OrbitRequest::default(), &no_progress);
    let branch = branch(case, orbit.unwrap().unwrap().z, "f_o", [1.1, 1.6]);
    let all = || branch.points.iter().map(|point| &point.orbit);
    assert!(all().all(|orbit| orbit.is_admissible()));
    let [first, last] = [all().next(), all().next_back()].map(|orbit| {
        let symbol = orbit.unwrap().lap.sequence.symbol();
        symbol[0].clone()
    });
    assert_ne!(first, last);
    assert_eq!(losses(&branch), [0.0; 0]);
}
