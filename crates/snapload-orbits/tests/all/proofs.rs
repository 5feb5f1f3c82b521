//! Orbits as theorems: existing orbits are proved, and no others.

use crate::common::{number, parameters, point, reference};
use serde_json::{Value as Json, json};
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_certificate::{CandidateOrbit, ExactCase, ProvedOrbit, prove_orbit};
use snapload_orbits::{
    Branch, BranchOptions, Family, Kind, Lap, Moored, Orbit, OrbitRequest, Point, Starts, close,
    find_orbits, prove_all,
};

fn exact(parameters: &Parameters) -> ExactCase {
    ExactCase::of(parameters, |_| None).unwrap()
}

fn named(name: &str) -> Json {
    let all = reference();
    let orbits = all["orbits"].as_array().unwrap();
    orbits.iter().find(|o| o["name"] == name).unwrap().clone()
}

fn cables(orbit: &Json) -> Vec<usize> {
    let impacts = orbit["impacts"].as_array().unwrap();
    let cable = |impact: &Json| impact["cable"].as_u64().unwrap() as usize - 1;
    impacts.iter().map(cable).collect()
}

fn proved(p: &Parameters, phase: f64, z: &Point, struck: &[usize]) -> Result<ProvedOrbit, String> {
    let candidate = CandidateOrbit {
        phase,
        periods: 1,
        state: *z,
        struck,
    };
    prove_orbit(&exact(p), &candidate)
}

/// A decimal as an integer of units of 10⁻³⁰, truncated.
fn units(text: &str) -> i128 {
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |rest| (-1, rest));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let fraction: String = format!("{fraction:0<30}").chars().take(30).collect();
    sign * format!("{whole}{fraction}").parse::<i128>().unwrap()
}

/// At least half a unit of the last written digit, in units of 10⁻³⁰.
fn half_a_digit(text: &str) -> i128 {
    let places = text
        .split_once('.')
        .map_or(0, |(_, fraction)| fraction.len());
    10_i128.pow(30 - places.min(30) as u32)
}

const IN_SLACK_FLIGHT: [&str; 4] = ["volley", "three_saddle", "circle_three", "square_six"];

#[test]
fn reference_orbits_are_proved_where_independent_code_of_many_digits_has_them() {
    for name in IN_SLACK_FLIGHT {
        let known = named(name);
        let p = parameters(&known["case"]);
        let proof = proved(&p, 0.0, &point(&known["section_point"]), &cables(&known));
        let proof = proof.unwrap_or_else(|why| panic!("{name}: {why}"));
        for (ours, theirs) in proof
            .state
            .iter()
            .zip(known["section_point"].as_array().unwrap())
        {
            let theirs = theirs.as_str().unwrap();
            let off = (units(ours) - units(theirs)).abs();
            // Zero is written as 0.0.
            let allowed = half_a_digit(if units(theirs) == 0 { ours } else { theirs });
            assert!(off <= 1 + allowed, "{name}: {ours} {theirs}");
        }
        let impacts = known["impacts"].as_array().unwrap();
        assert_eq!(proof.snaps.len(), impacts.len());
        for ((cable, t, v_n), impact) in proof.snaps.iter().zip(impacts) {
            assert_eq!(*cable as f64 + 1.0, number(&impact["cable"]));
            let theirs = impact["t"].as_str().unwrap();
            assert!(
                (units(t) - units(theirs)).abs() <= 1 + half_a_digit(theirs),
                "{name}: {t}"
            );
            assert!((v_n.parse::<f64>().unwrap() - number(&impact["v_n"])).abs() < 1e-15);
        }
        let error = proof.error_of(&point(&known["section_point"]));
        assert!(error < 3e-16, "{name}: {error:e}");
        assert!(
            proof.unique_within > 1e-12,
            "{name}: {}",
            proof.unique_within
        );
    }
}

#[test]
fn other_snaps_than_those_of_the_motion_are_not_proved() {
    for name in IN_SLACK_FLIGHT {
        let known = named(name);
        let (p, z, struck) = (
            parameters(&known["case"]),
            point(&known["section_point"]),
            cables(&known),
        );
        let mut others: Vec<Vec<usize>> = vec![
            struck.iter().map(|cable| 1 - cable).collect(),
            struck[1..].to_vec(),
            [&struck[..], &[0]].concat(),
            Vec::new(),
        ];
        let mut turned = struck.clone();
        turned.rotate_left(1);
        others.extend(Some(turned).filter(|turned| *turned != struck));
        for other in others {
            assert!(proved(&p, 0.0, &z, &other).is_err(), "{name}: {other:?}");
        }
        // Neither is it proved for another case, for another section, or for twice its length.
        let stiff = Parameters { e: p.e + 0.05, ..p };
        let shifted = proved(&p, 0.25, &z, &struck);
        assert!(shifted.is_err(), "{name}");
        if let Ok(proof) = proved(&stiff, 0.0, &z, &struck) {
            assert!(proof.error_of(&z) > 1e-4, "{name}");
        }
    }
}

/// A branch of the references in f_o, from an orbit of it, and its case.
fn branch(place: usize, start: Point, range: [f64; 2]) -> (Parameters, Branch) {
    let p = parameters(&reference()["branches"][place]["base"]);
    let family = Moored::case(p, [Some("f_o"), None]);
    let orbit = Orbit::find(&family, [p.f_o, 0.0], &start, &OrbitRequest::default()).unwrap();
    let (step, most) = (0.02, 2000);
    let options = BranchOptions { range, step, most };
    (
        p,
        Branch::of(&family, &orbit, &options, &no_progress).unwrap(),
    )
}

/// Below the fold there is no orbit, above it there are two.
#[test]
fn nothing_is_proved_below_a_fold_and_two_orbits_above() {
    let (p, branch) = branch(0, [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0], [1.3, 1.5]);
    let fold = branch.event(Kind::Fold, None).unwrap();
    let at = fold.value[0];
    let struck = fold.orbit.lap.sequence.struck();
    for below in [1e-9, 1e-6, 1e-4, 1e-2] {
        let p = Parameters {
            f_o: at - below,
            ..p
        };
        assert!(proved(&p, 0.0, &fold.orbit.z, &struck).is_err(), "{below}");
    }
    // The parabola of the branch through a point on either side gives both orbits at a value
    // between.
    let near = |side: f64| {
        let points = branch
            .points
            .iter()
            .filter(|p| (p.arclength - fold.arclength) * side > 0.0);
        let nearest = points.min_by(|a, b| a.orbit.at[0].total_cmp(&b.orbit.at[0]));
        nearest.unwrap().orbit.clone()
    };
    let above = 1e-6;
    let p = Parameters {
        f_o: at + above,
        ..p
    };
    let two = [near(1.0), near(-1.0)].map(|orbit| {
        let part = (above / (orbit.at[0] - at)).sqrt();
        let z = std::array::from_fn(|i| fold.orbit.z[i] + part * (orbit.z[i] - fold.orbit.z[i]));
        proved(&p, 0.0, &z, &struck).unwrap()
    });
    assert!(two[0].differs_from(&two[1]));
}

/// Beyond a graze the sequence still closes, but its lap would violate the constraint of a cable.
#[test]
fn nothing_is_proved_beyond_a_graze() {
    let (p, branch) = branch(1, [-0.0086, 0.7632, 0.0, 1.0527, -0.7738, 0.0], [0.8, 1.8]);
    let graze = branch.event(Kind::Graze, None).unwrap();
    let struck = graze.orbit.lap.sequence.struck();
    let tried = |f_o: f64| {
        let p = Parameters { f_o, ..p };
        let lap = Lap {
            family: &Moored::case(p, [None; 2]),
            at: [0.0; 2],
            sequence: &graze.orbit.lap.sequence,
            phase: 0.0,
            periods: 1,
        };
        let closed = close(&lap, &graze.orbit.z, &graze.orbit.lap.durations).unwrap();
        proved(&p, 0.0, &closed.z, &struck)
    };
    for off in [1e-10, 1e-7, 1e-4] {
        tried(graze.value[0] - off).unwrap();
        let why = tried(graze.value[0] + off).unwrap_err();
        assert!(why.contains("other snaps"), "{why}");
    }
    // Exactly those points of the branch are proved that are reported as admissible.
    for point in &branch.points {
        let p = Parameters {
            f_o: point.orbit.at[0],
            ..p
        };
        let proof = point.orbit.prove(&exact(&p));
        let candidate = proved(&p, 0.0, &point.orbit.z, &struck);
        assert_eq!(proof.is_ok(), point.orbit.is_admissible(), "{}", p.f_o);
        assert_eq!(candidate.is_ok(), point.orbit.is_admissible(), "{}", p.f_o);
    }
}

#[test]
fn mirrored_orbits_are_orbits_of_the_mirrored_case_half_a_period_later() {
    for name in IN_SLACK_FLIGHT {
        let known = named(name);
        let p = parameters(&known["case"]);
        let z = point(&known["section_point"]);
        let mirrored = Parameters { nu: -p.nu, ..p };
        let sides = [-1.0, 1.0, -1.0, -1.0, 1.0, -1.0];
        let image = std::array::from_fn(|i| sides[i] * z[i]);
        let struck: Vec<usize> = cables(&known).iter().map(|cable| 1 - cable).collect();
        let ours = proved(&p, 0.0, &z, &cables(&known)).unwrap();
        let theirs = proved(&mirrored, 0.5, &image, &struck).unwrap();
        for ((a, b), side) in ours.state.iter().zip(&theirs.state).zip(sides) {
            assert!(
                (units(a) - side as i128 * units(b)).abs() <= 1,
                "{name}: {a} {b}"
            );
        }
    }
}

fn random(count: usize, seed: u64) -> Starts<'static> {
    let near = &[];
    Starts { count, seed, near }
}

#[test]
fn orbits_found_by_chance_are_proved_and_distinguished() {
    let square = parameters(&json!({"a": 0.3, "b": 0.3, "f_o": 0.5, "omega": 2.5}));
    let mut orbits = find_orbits(
        &square,
        &random(200, 1),
        &OrbitRequest::default(),
        &no_progress,
    )
    .unwrap();
    assert!(orbits.len() >= 15, "{}", orbits.len());
    // Most orbits of a case are found from those of a neighbouring one, without random starts.
    let near: Vec<Point> = orbits.iter().map(|orbit| orbit.z).collect();
    let near = Starts {
        near: &near,
        ..random(0, 0)
    };
    let beside = Parameters {
        f_o: 0.49,
        ..square
    };
    let others = find_orbits(&beside, &near, &OrbitRequest::default(), &no_progress).unwrap();
    assert!(
        2 * others.len() > orbits.len(),
        "{} {}",
        others.len(),
        orbits.len()
    );
    let twice: Vec<Orbit> = orbits.iter().chain(&orbits).cloned().collect();
    let proofs = prove_all(&mut orbits, &exact(&square), &no_progress).unwrap();
    assert_eq!([proofs.proved, proofs.distinct], [orbits.len(); 2]);
    // An orbit that is listed twice is counted once.
    let mut twice = twice;
    let again = prove_all(&mut twice, &exact(&square), &no_progress).unwrap();
    assert_eq!(
        [again.proved, again.distinct],
        [2 * orbits.len(), orbits.len()]
    );
}

/// An orbit of two periods is found once, from whichever period, and is proved not to have one
/// period.
#[test]
fn orbits_of_two_periods_are_found_once_and_proved_not_to_be_shorter() {
    let square = parameters(&json!({"a": 0.3, "b": 0.3, "f_o": 0.5, "omega": 2.5}));
    let two = OrbitRequest {
        periods: Some(2),
        ..OrbitRequest::default()
    };
    let mut orbits = find_orbits(&square, &random(150, 2), &two, &no_progress).unwrap();
    let proofs = prove_all(&mut orbits, &exact(&square), &no_progress).unwrap();
    assert!(
        proofs.distinct == orbits.len() && proofs.distinct >= 5,
        "{proofs:?}"
    );
    for orbit in &orbits {
        let proof = orbit.proof.as_ref().unwrap().as_ref().unwrap();
        assert!(proof.is_prime());
        assert!(proof.error_of(&orbit.z) < 1e-10);
        // The same orbit from its second section is not another one.
        let later = Moored::case(square, [None; 2]);
        let period = later.period([0.0; 2]);
        let run = later.simulate([0.0; 2], 0.0, &orbit.z, period).unwrap();
        let mut struck = orbit.lap.sequence.struck();
        struck.rotate_left(run.lap.sequence.snaps());
        let candidate = CandidateOrbit {
            phase: 0.0,
            periods: 2,
            state: run.end,
            struck: &struck,
        };
        let same = prove_orbit(&exact(&square), &candidate).unwrap();
        assert!(!same.differs_from(proof));
    }
}

/// If a cable stays taut, nothing is proved.
#[test]
fn taut_laps_are_reported_as_not_covered() {
    for name in ["slide_stable", "rock_circle", "corner_rest_e0"] {
        let known = named(name);
        let p = parameters(&known["case"]);
        let family = Moored::case(p, [None; 2]);
        let start = point(&known["section_point"]);
        let orbit = Orbit::find(&family, [0.0; 2], &start, &OrbitRequest::default()).unwrap();
        let why = orbit.prove(&exact(&p)).unwrap_err();
        assert!(why.contains("taut"), "{why}");
        assert!(proved(&p, 0.0, &start, &cables(&known)).is_err());
    }
}
