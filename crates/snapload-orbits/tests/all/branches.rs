//! Branches in one key, and the events along them.

use crate::common::{number, parameters, point, reference, tori};
use serde_json::Value as Json;
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{Branch, BranchEvent, BranchOptions, Kind, Moored, Orbit, OrbitRequest};

fn branch(reference: &Json, start: [f64; 6], range: [f64; 2]) -> Branch {
    let base = parameters(&reference["base"]);
    let keys = [Some("f_o"), None];
    let family = Moored::case(base, keys);
    let at = Moored::values(&base, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let options = BranchOptions {
        range,
        step: 0.02,
        most: 2000,
    };
    Branch::of(&family, &orbit, &options, &no_progress).unwrap()
}

fn name_of(kind: &str) -> &str {
    match kind {
        "pd" => "period_doubling",
        "ns" => "neimark_sacker",
        "upper_bound_reached" => "upper_bound",
        other => other,
    }
}

/// Every point of the reference is located, and no other that is admissible.
fn agrees(reference: &Json, branch: &Branch) {
    for end in &branch.ends {
        println!("ends at {}: {}", end.at, end.because);
    }
    for event in &branch.events {
        println!("{} {:.15} {:?}", event.kind.name(), event.value[0], event.t);
    }
    println!("{} points", branch.points.len());
    for known in reference["points"].as_array().unwrap() {
        let kind = name_of(known["kind"].as_str().unwrap());
        let value = number(&known["value"]);
        let nearest = branch
            .events
            .iter()
            .filter(|event| event.kind.name() == kind)
            .min_by(|a, b| {
                (a.value[0] - value)
                    .abs()
                    .total_cmp(&(b.value[0] - value).abs())
            })
            .unwrap_or_else(|| panic!("no {kind}"));
        let off = (nearest.value[0] - value).abs();
        assert!(off < 1e-9, "{kind} at {value}: off by {off:e}");
        let state = snapload_orbits::distance(&nearest.orbit.z, &point(&known["section_point"]));
        assert!(state < 1e-6, "{kind} at {value}: state off by {state:e}");
        if !known["sqrt_coefficient"].is_null() {
            let ours = nearest.sqrt_coefficient.unwrap();
            let theirs = number(&known["sqrt_coefficient"]);
            assert!((ours / theirs - 1.0).abs() < 1e-7, "{ours} {theirs}");
            let ours = nearest.normal_acceleration.unwrap();
            assert!((ours / number(&known["normal_acceleration"]) - 1.0).abs() < 1e-7);
        }
    }
    // All other located events need a cable longer than its length, and are inadmissible.
    let more = branch.events.iter().filter(|event| {
        let kind = event.kind.name();
        !reference["points"].as_array().unwrap().iter().any(|known| {
            kind == name_of(known["kind"].as_str().unwrap())
                && (event.value[0] - number(&known["value"])).abs() < 1e-9
        })
    });
    for event in more {
        assert!(!event.orbit.is_admissible(), "{}", event.kind.name());
        assert!(event.orbit.survey.largest_gap.unwrap().value > 0.0);
    }
}

#[test]
fn branch_a_is_that_of_the_reference() {
    let reference = &reference()["branches"][0];
    let start = [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0];
    agrees(reference, &branch(reference, start, [1.0, 4.0]));
}

#[test]
fn branch_b_is_that_of_the_reference() {
    let reference = &reference()["branches"][1];
    let start = [-0.0086, 0.7632, 0.0, 1.0527, -0.7738, 0.0];
    agrees(reference, &branch(reference, start, [0.8, 6.0]));
}

/// Each end at the range is a point of the branch on its border, and no event lies beyond.
#[test]
fn a_branch_ends_on_the_borders_of_its_range() {
    let reference = &reference()["branches"][0];
    let base = parameters(&reference["base"]);
    let keys = [Some("f_o"), None];
    let family = Moored::case(base, keys);
    let at = Moored::values(&base, keys);
    let start = [-0.27, 0.38, 0.0, 0.81, -0.43, 0.0];
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    for range in [[at[0] - 0.013, at[0] + 0.1], [at[0], at[0] + 0.05]] {
        let options = BranchOptions {
            range,
            step: 0.02,
            most: 2000,
        };
        let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
        let ends = branch
            .ends
            .each_ref()
            .map(|end| (end.at, end.because.as_str()));
        assert_eq!(ends, range.map(|border| (border, "the end of the range")));
        let values: Vec<f64> = branch.points.iter().map(|p| p.orbit.at[0]).collect();
        assert_eq!([values[0], values[values.len() - 1]], range);
        assert!(
            values.windows(2).all(|pair| pair[0] < pair[1]),
            "{values:?}"
        );
        let last = branch.points.last().unwrap();
        assert!(last.orbit.return_error.unwrap() < 1e-12);
    }
}

/// A closed branch is gone round once, however long its steps are and however many points each
/// half may have: it ends where it began, and has the same events, each once.
#[test]
fn a_closed_branch_is_gone_round_once() {
    let (case, start) = tori();
    let keys = [Some("omega"), None];
    let family = Moored::case(case, keys);
    let at = Moored::values(&case, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    for (step, most) in [(0.01, 800), (0.005, 800), (0.02, 800), (0.02, 36)] {
        let options = BranchOptions {
            range: [-5.0, 5.0],
            step,
            most,
        };
        let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
        for end in &branch.ends {
            assert_eq!(end.because, "the branch is closed");
        }
        let [first, last] = [branch.points.first(), branch.points.last()].map(Option::unwrap);
        assert!(snapload_orbits::distance(&first.orbit.z, &last.orbit.z) < 1e-8);
        let kinds = branch.events.iter().map(|event| event.kind);
        let folds = kinds.clone().filter(|kind| *kind == Kind::Fold).count();
        assert_eq!((folds, kinds.count()), (2, 3), "step {step}");
    }
}

/// The folds, period doublings and Neimark-Sacker points of a branch, by their places.
fn bifurcations(branch: &Branch) -> Vec<(Kind, f64)> {
    let kinds = [Kind::Fold, Kind::PeriodDoubling, Kind::NeimarkSacker];
    let events = branch.events.iter();
    let of_kind = events.filter(|event| kinds.contains(&event.kind));
    let mut all: Vec<_> = of_kind.map(|event| (event.kind, event.value[0])).collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    all
}

fn are_same(found: &Branch, known: &Branch) {
    let (found, known) = (bifurcations(found), bifurcations(known));
    let pairs = || found.iter().zip(&known);
    let same = pairs().all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-10);
    assert!(found.len() == known.len() && same, "{found:?} {known:?}");
}

/// The events of a branch do not depend on the orbit with which it is started: they are the same
/// where that is itself a fold, a period doubling or a Neimark-Sacker point, and then it is the
/// nearest one of its kind. They are the same two points beside it, too, from where the second step
/// comes to it again.
fn starts_at_each_event(case: Parameters, start: [f64; 6], key: &'static str, range: [f64; 2]) {
    let keys = [Some(key), None];
    let family = Moored::case(case, keys);
    let of = |orbit: &Orbit, range| {
        let options = BranchOptions {
            range,
            step: 0.01,
            most: 2000,
        };
        Branch::of(&family, orbit, &options, &no_progress).unwrap()
    };
    let at = Moored::values(&case, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let known = of(&orbit, range);
    let all = bifurcations(&known);
    assert_eq!(all.len(), 3, "{all:?}");
    let special = |event: &&BranchEvent| all.contains(&(event.kind, event.value[0]));
    for event in known.events.iter().filter(special) {
        let again = of(&event.orbit, range);
        are_same(&again, &known);
        let here = again.event(event.kind, None).unwrap();
        assert!(here.arclength.abs() < 1e-8, "{}", here.arclength);
        let points = &again.points;
        let middle = points.iter().position(|p| p.arclength == 0.0).unwrap();
        let beside = points.get(middle + 2).or_else(|| points.get(middle - 2));
        are_same(&of(&beside.unwrap().orbit, range), &known);
        // A fold may have its whole branch beyond a border.
        if event.kind == Kind::PeriodDoubling {
            let value = event.value[0];
            for range in [[value, range[1]], [range[0], value]] {
                let places = bifurcations(&of(&event.orbit, range));
                let is_here =
                    |(kind, at): &(Kind, f64)| *kind == event.kind && (at - value).abs() < 1e-10;
                assert!(places.iter().any(is_here), "{range:?} {places:?}");
            }
        }
    }
}

#[test]
fn a_branch_that_starts_at_an_event_has_it() {
    let case = crate::common::two_attractors();
    let near = [-0.045, 0.1744, 0.0, 0.4443, -0.594, 0.0];
    starts_at_each_event(case, near, "f_o", [0.5, 1.3]);
}

#[test]
fn a_closed_branch_that_starts_at_an_event_has_it() {
    let (case, start) = tori();
    starts_at_each_event(case, start, "omega", [-5.0, 5.0]);
}

/// A branch turns back at a fold: in a range that ends there, on the side without the branch, it is
/// that one orbit, which is still a fold.
#[test]
fn a_fold_with_its_branch_beyond_the_range_is_listed() {
    let reference = &reference()["branches"][0];
    let start = [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0];
    let known = branch(reference, start, [1.2, 1.5]);
    let fold = known.event(Kind::Fold, None).unwrap();
    let value = fold.value[0];
    assert!(known.points.iter().all(|p| p.orbit.at[0] > value));
    let family = Moored::case(parameters(&reference["base"]), [Some("f_o"), None]);
    let options = BranchOptions {
        range: [1.2, value],
        step: 0.02,
        most: 2000,
    };
    let found = Branch::of(&family, &fold.orbit, &options, &no_progress).unwrap();
    assert_eq!(found.points.len(), 1);
    assert_eq!(bifurcations(&found), [(Kind::Fold, value)]);
}
