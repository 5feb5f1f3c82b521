//! Orbits of bodies on cables.

use crate::common::{number, numbers, parameters, point, reference, relative};
use serde_json::Value as Json;
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_certificate::ExactCase;
use snapload_orbits::{
    Family, Lap, Moored, Orbit, OrbitRequest, Point, Stability, branch_options, distance,
    followed_key, of_attractor, orbit_summary,
};

/// The orbit near the reference's, from a start at a distance of 1e-4.
fn found(reference: &Json, distance_from_it: f64) -> Orbit {
    let family = Moored::case(parameters(&reference["case"]), [None; 2]);
    let mut start = point(&reference["section_point"]);
    let turns = parameters(&reference["case"]).inertia.is_some();
    for (i, component) in start.iter_mut().enumerate() {
        if turns || i % 3 != 2 {
            *component += if i % 2 == 0 {
                distance_from_it
            } else {
                -distance_from_it
            };
        }
    }
    let name = &reference["name"];
    Orbit::find(&family, [0.0; 2], &start, &OrbitRequest::default())
        .unwrap_or_else(|why| panic!("{name}: {why}"))
}

fn orbits() -> Vec<Json> {
    reference()["orbits"].as_array().unwrap().clone()
}

#[test]
fn reference_orbits_are_found_from_nearby() {
    for reference in orbits() {
        for distance_from_it in [1e-4, -1e-4] {
            let orbit = found(&reference, distance_from_it);
            let name = reference["name"].as_str().unwrap();
            let largest = orbit.multipliers.largest();
            let off = distance(&orbit.z, &point(&reference["section_point"]));
            println!(
                "{name}: off by {off:.1e}, returns to {:?}, {:?}",
                orbit.return_error, orbit.why_not
            );
            assert!(off < 1e-12 * (1.0 + largest), "{name}: {off:e}");
            let impacts = reference["impacts"].as_array().unwrap();
            let snaps: Vec<_> = orbit.rows.iter().filter(|row| row.kind == "snap").collect();
            assert_eq!(snaps.len(), impacts.len(), "{name}");
            for (snap, known) in snaps.iter().zip(impacts) {
                assert_eq!(snap.surface as f64 + 1.0, number(&known["cable"]));
                assert!((snap.t - number(&known["t"])).abs() < 1e-11 * (1.0 + largest));
                assert!(relative(snap.speed, number(&known["v_n"])) < 1e-10);
            }
            if let Some(gap) = reference["largest_gap_between_impacts"].as_str() {
                let gap: f64 = gap.parse().unwrap();
                assert!(
                    (orbit.largest_gap.unwrap() - gap).abs() < 1e-3,
                    "{name}: {:?} {gap}",
                    orbit.largest_gap
                );
                assert!(orbit.largest_gap.unwrap() > gap - 1e-10);
            }
            if reference["y_max"].is_number() {
                let y_max = number(&reference["y_max"]);
                assert!(
                    (orbit.survey.y_max - y_max).abs() < 1e-9,
                    "{name}: {}",
                    orbit.survey.y_max
                );
            }
            assert_eq!(
                orbit.is_admissible(),
                reference["admissible"] == Json::Bool(true),
                "{name}"
            );
        }
    }
}

#[test]
fn multipliers_are_those_of_the_reference() {
    for reference in orbits() {
        let orbit = found(&reference, 1e-4);
        let name = reference["name"].as_str().unwrap();
        let known: Vec<_> = reference["multipliers"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect();
        let largest = orbit.multipliers.largest();
        let mut left = orbit.multipliers.values.clone();
        for value in &known {
            let off = |[re, im]: &[f64; 2]| (re - value[0]).hypot(im - value[1]);
            let (place, nearest) = left
                .iter()
                .enumerate()
                .min_by(|a, b| off(a.1).total_cmp(&off(b.1)))
                .unwrap();
            let size = value[0].hypot(value[1]);
            if size == 0.0 {
                assert_eq!(*nearest, [0.0, 0.0], "{name}");
            } else {
                let allowed = if size < 1e-3 * largest { 1e-6 } else { 1e-9 };
                assert!(
                    off(nearest) / size < allowed,
                    "{name}: {nearest:?} {value:?}"
                );
            }
            left.remove(place);
        }
        assert!(left.is_empty(), "{name}");
        if let Some(rule) = orbit.rule {
            assert!(relative(orbit.multipliers.product, rule) < 1e-11, "{name}");
            assert!(
                relative(rule, number(&reference["multiplier_product"])) < 1e-14,
                "{name}"
            );
        }
    }
}

#[test]
fn the_orbit_whose_cable_would_have_to_push_is_refused() {
    let all = orbits();
    let one = |name: &str| found(all.iter().find(|o| o["name"] == name).unwrap(), 1e-4);
    let refused = one("slide_partner_inadmissible");
    assert!(!refused.is_admissible());
    let tension = refused.survey.least_tension.unwrap();
    // By the Runge-Kutta method with 20,000 steps; the reference's own -0.0529 is the least of
    // coarse samples.
    assert!((tension.value + 0.053713013).abs() < 1e-8, "{tension:?}");
    assert!((tension.t - 0.99410).abs() < 1e-4, "{tension:?}");
    assert_eq!(tension.surface, 1);
    assert!(
        refused
            .why_not
            .iter()
            .any(|why| why.contains("tension of cable 2 is negative"))
    );
    let real = one("slide_stable");
    assert!((real.survey.least_tension.unwrap().value - 0.179937371).abs() < 1e-8);
    assert_eq!(real.multipliers.zeros_from_contact, 2);
}

#[test]
fn kinds_of_stability_are_reported() {
    let all = orbits();
    let one = |name: &str| found(all.iter().find(|o| o["name"] == name).unwrap(), 1e-4).stability();
    assert_eq!(one("volley"), Stability::Stable);
    assert_eq!(one("square_six"), Stability::Unstable);
    assert_eq!(one("rock_circle"), Stability::Neutral);
    assert_eq!(one("corner_rest_e0"), Stability::Superstable);
}

/// The stable orbit of the snaps 2, 1, and a start beside it.
pub fn volley() -> (Moored, Parameters, Point) {
    let all = orbits();
    let volley = all.iter().find(|orbit| orbit["name"] == "volley").unwrap();
    let case = parameters(&volley["case"]);
    let family = Moored::case(case, [None; 2]);
    (family, case, point(&volley["section_point"]))
}

#[test]
fn requested_snaps_that_do_not_occur_are_named() {
    let (family, _, start) = volley();
    for (struck, words) in [(vec![0, 0], "1, 1"), (vec![], "none")] {
        let request = OrbitRequest {
            struck: Some(struck),
            ..OrbitRequest::default()
        };
        let why = Orbit::find(&family, [0.0; 2], &start, &request).unwrap_err();
        let expected = format!(
            "a lap closes with the events 2, 1, but the requested snaps are {words}; leave the symbol out"
        );
        assert!(why.to_string().contains(&expected), "{why}");
    }
}

/// Two laps of an orbit of one period are proved, but not as an orbit of two periods.
#[test]
fn two_laps_are_not_reported_as_an_orbit_that_takes_no_fewer_periods() {
    let (family, case, start) = volley();
    let exact = ExactCase::of(&case, |_| None).unwrap();
    for (periods, is_prime) in [(1, true), (2, false)] {
        let request = OrbitRequest {
            periods: Some(periods),
            ..OrbitRequest::default()
        };
        let mut orbit = Orbit::find(&family, [0.0; 2], &start, &request).unwrap();
        orbit.proof = Some(orbit.prove(&exact));
        let text = orbit_summary(&orbit);
        assert!(text.contains("Proved    to exist"), "{text}");
        assert!(
            text.contains("no other orbit of as many periods within"),
            "{text}"
        );
        assert_eq!(
            !text.contains("fewer periods are not ruled out"),
            is_prime,
            "{text}"
        );
    }
}

#[test]
fn a_point_mass_is_not_followed_along_its_size() {
    let (_, case, _) = volley();
    for key in ["a", "b", "inertia"] {
        let refused = followed_key("along", &case, key).unwrap_err().to_string();
        assert!(refused.contains("of this body"), "{refused}");
    }
    assert_eq!(followed_key("along", &case, "r").unwrap(), ("r", 1.7));
}

/// The default inertia is that of a ring at b = 0 and that of a rectangle above it.
#[test]
fn an_orbit_is_not_followed_through_the_jump_of_the_default_inertia() {
    let of = |case: &Parameters, low: f64| branch_options(case, "b", [low, 0.2], 0.01, 100);
    let refused = of(&Parameters::STANDARD, 0.0).unwrap_err().to_string();
    assert!(refused.contains("default inertia jumps") && refused.contains("inertia = 0.01000001"));
    let wide = Parameters {
        b: 0.1,
        inertia: snapload::natural_inertia(0.1, 0.1),
        ..Parameters::STANDARD
    };
    assert!(of(&wide, 0.0).is_err() && of(&wide, 0.05).is_ok());
    let own = Parameters {
        inertia: Some(0.01000001),
        ..Parameters::STANDARD
    };
    assert!(of(&own, 0.0).is_ok());
}

/// A cable that is taut during the whole lap has no event, and is named all the same.
#[test]
fn cables_that_are_always_taut_are_named() {
    for (name, line) in [
        ("slide_stable", Some("Taut      cable 2 all the time\n")),
        ("rock_circle", Some("Taut      cables 1, 2 all the time\n")),
        ("volley", None),
    ] {
        let reference = orbits().into_iter().find(|orbit| orbit["name"] == name);
        let text = orbit_summary(&found(&reference.unwrap(), 1e-4));
        assert_eq!(text.contains("Taut"), line.is_some(), "{text}");
        assert!(line.is_none_or(|line| text.contains(line)), "{text}");
    }
}

/// The section is away from the events, so that all residuals take part.
#[test]
fn durations_in_turn_and_all_unknowns_together_give_one_step() {
    let (family, ..) = volley();
    let z = [-0.27, 0.39, 0.0, 0.79, -0.43, 0.0];
    let simulated = family.simulate([0.0; 2], 0.0, &z, 4.0 * family.period([0.0; 2]));
    let timed = simulated.expect("a case can be run").lap;
    let lap = Lap {
        family: &family,
        at: [0.0; 2],
        sequence: &timed.sequence,
        phase: 0.0,
        periods: 4,
    };
    let durations: Vec<f64> = timed.durations.iter().map(|s| s + 1e-3).collect();
    let linear = lap.linearise(&z, &durations);
    assert!(linear.events() >= 8);
    let (size, step) = linear.step(&z, family.variables());
    let (same_size, in_turn) = linear.step_in_turn(&z, family.variables());
    let (step, in_turn) = (step.expect("a step"), in_turn.expect("a step"));
    assert_eq!(size, same_size);
    assert_eq!(step.len(), in_turn.len());
    assert!((&step - in_turn).amax() < 1e-11 * (1.0 + step.amax()));
}

/// The report on an orbit names its section and describes its events.
#[test]
fn the_summary_of_an_orbit_is_printed() {
    let (family, ..) = volley();
    let near = [-0.27, 0.38, 0.0, 0.81, -0.43, 0.0];
    let orbit = Orbit::find(&family, [0.0; 2], &near, &OrbitRequest::default()).unwrap();
    let summary = snapload_orbits::orbit_summary(&orbit);
    let first = "Orbit     stable, of one period of the forcing (t = 2.026834)\n\
                 Events    snap of cable 2, snap of cable 1\n\
                 Section   x = -0.268810219, y = 0.38";
    assert!(summary.starts_with(first), "{summary}");
}

/// A motion that comes to its orbit by 0.7 % a period takes 3000 periods. The multiplier is that of
/// an independent program with quadruple precision.
#[test]
fn an_orbit_that_is_approached_slowly_is_found() {
    let case = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.77,
        e: 0.37,
        f_o: 1.79,
        nu: 0.54,
        omega: 3.07,
        x: 0.0,
        y: 0.4,
        vx: 0.1,
        ..Parameters::STANDARD
    };
    let found = of_attractor(&case, &OrbitRequest::default(), &no_progress).unwrap();
    let orbit = found.unwrap();
    let slowest = orbit.multipliers.values[0];
    assert!((slowest[0] + 0.992_777).abs() < 1e-6, "{slowest:?}");
    assert_eq!(orbit.stability(), Stability::Stable);
}

/// An orbit of 18 periods and 36 snaps, whose multipliers are 15 orders of magnitude apart. Those
/// known are of one-period matrices by differences in 113 bits, multiplied in 60 digits. Their
/// product is the rule of volumes: each snap contracts by e².
#[test]
fn small_multipliers_have_digits_of_their_own() {
    let case = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.51398,
        e: 0.380582,
        nu: 1.01488,
        omega: 4.08176,
        f_o: 1.56653,
        ..Parameters::STANDARD
    };
    for phase in [0.0, 0.37] {
        let request = OrbitRequest {
            phase,
            ..OrbitRequest::default()
        };
        let orbit = of_attractor(&case, &request, &no_progress)
            .unwrap()
            .unwrap();
        let summary = orbit_summary(&orbit);
        assert!(summary.contains("i, 3.064659e-12, 1.5650"), "{summary}");
        let multipliers = &orbit.multipliers;
        let [_, _, third, last] = &multipliers.values[..4] else {
            panic!("{multipliers:?}");
        };
        assert_eq!([third[1], last[1]], [0.0; 2]);
        assert!(relative(third[0], 3.064_659_5e-12) < 1e-7, "{third:?}");
        assert!(relative(last[0], 1.565_05e-17) < 1e-5, "{last:?}");
        let volume = case.e.powi(2 * 36);
        assert!(
            relative(multipliers.product, volume) < 1e-9,
            "{multipliers:?} {volume:e}"
        );
    }
}
