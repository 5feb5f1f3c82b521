//! Branches of a mirror-symmetric case, which cross those of orbits without the symmetry.

use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{
    Branch, BranchEvent, BranchOptions, Kind, Moored, Orbit, OrbitRequest, Stability,
    branch_summary,
};

const STEEP: Parameters = Parameters {
    inertia: None,
    a: 0.0,
    r: 2.15,
    e: 0.37,
    nu: 0.0,
    omega: 3.89,
    ..Parameters::STANDARD
};
/// Near a symmetric orbit at f_o = 2, and near one of a pair without the symmetry at 1.84.
const SYMMETRIC: [f64; 6] = [-0.178, 0.179, 0.0, 0.268, 0.172, 0.0];
const TWIN: [f64; 6] = [-0.16639, 0.18155, 0.0, 0.23986, 0.13314, 0.0];

fn branch(case: Parameters, f_o: f64, start: [f64; 6], range: [f64; 2]) -> Branch {
    let (case, keys) = (Parameters { f_o, ..case }, [Some("f_o"), None]);
    let family = Moored::case(case, keys);
    let at = Moored::values(&case, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let options = BranchOptions {
        range,
        step: 0.01,
        most: 400,
    };
    Branch::of(&family, &orbit, &options, &no_progress).unwrap()
}

fn bifurcations(branch: &Branch) -> Vec<&BranchEvent> {
    let kinds = [
        Kind::Fold,
        Kind::PeriodDoubling,
        Kind::NeimarkSacker,
        Kind::BranchPoint,
    ];
    let events = branch.events.iter();
    events.filter(|event| kinds.contains(&event.kind)).collect()
}

/// Stability changes nowhere but at a bifurcation.
fn no_change_is_passed_over(branch: &Branch) {
    for pair in branch.points.windows(2) {
        let [here, there] = [&pair[0], &pair[1]].map(|p| p.orbit.stability() == Stability::Stable);
        let between = pair[0].arclength..=pair[1].arclength;
        let events = bifurcations(branch);
        assert!(
            here == there
                || events
                    .iter()
                    .any(|event| between.contains(&event.arclength)),
            "passed over at f_o = {}",
            pair[0].orbit.at[0]
        );
    }
}

/// The branch of the symmetric orbits loses its stability where that of the pair turns back: both
/// have this one point in common.
#[test]
fn branches_of_symmetric_orbits_and_of_pairs_cross_in_one_point() {
    let symmetric = branch(STEEP, 2.0, SYMMETRIC, [1.7, 2.3]);
    let pair = branch(STEEP, 1.84, TWIN, [1.7, 2.0]);
    no_change_is_passed_over(&symmetric);
    let [here, there] = [&symmetric, &pair].map(|branch| {
        let all = bifurcations(branch);
        let [event] = all[..] else { panic!("{all:?}") };
        assert_eq!(event.kind, Kind::BranchPoint);
        let nearest = event.orbit.multipliers.values.iter();
        let off = nearest
            .map(|[re, im]| (re - 1.0).hypot(*im))
            .min_by(f64::total_cmp);
        assert!(off < Some(1e-8), "{off:?}");
        event
    });
    assert!((here.value[0] - there.value[0]).abs() < 1e-9);
    assert!(snapload_orbits::distance(&here.orbit.z, &there.orbit.z) < 1e-8);
    let lowest = pair.points.iter().map(|point| point.orbit.at[0]);
    assert!(lowest.min_by(f64::total_cmp) >= Some(there.value[0]));
    let words = branch_summary("f_o", &symmetric);
    assert!(words.contains("branch point     f_o = 1.82"), "{words}");
}

#[test]
fn a_fold_and_a_crossing_are_told_apart() {
    let case = Parameters {
        r: 1.7,
        e: 0.6,
        omega: 3.1,
        ..STEEP
    };
    let start = [0.000474, 0.201498, 0.0, 0.455839, -0.274973, 0.0];
    let branch = branch(case, 1.0, start, [0.5, 1.5]);
    no_change_is_passed_over(&branch);
    let kinds: Vec<Kind> = bifurcations(&branch)
        .iter()
        .map(|event| event.kind)
        .collect();
    assert_eq!(kinds, [Kind::Fold, Kind::BranchPoint]);
    let crossing = bifurcations(&branch)[1].value[0];
    assert!(0.8073 < crossing && crossing < 0.8173, "{crossing}");
}

/// A slight asymmetry keeps the branches apart: a single one goes through no crossing, and loses
/// its stability at a fold.
#[test]
fn what_is_nearly_a_crossing_is_none() {
    let nearly = Parameters { nu: 1e-6, ..STEEP };
    let branch = branch(nearly, 2.0, SYMMETRIC, [1.7, 2.3]);
    no_change_is_passed_over(&branch);
    let kinds = bifurcations(&branch).into_iter().map(|event| event.kind);
    assert!(
        kinds.clone().all(|kind| kind != Kind::BranchPoint),
        "{:?}",
        kinds.collect::<Vec<_>>()
    );
}
