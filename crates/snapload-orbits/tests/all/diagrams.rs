//! Long motions: periods, snaps, exponents.

use crate::common::{number, numbers, parameters, reference};
use crate::orbits::volley;
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{
    Orbit, OrbitRequest, Section, SectionOptions, Stability, diagram, distance, of_attractor,
    section_summary,
};

#[test]
fn the_attractor_is_followed_as_in_the_reference() {
    let reference = &reference()["diagrams"][0];
    let start = numbers(&reference["start"]);
    let base = Parameters {
        x: start[0],
        y: start[1],
        vx: start[3],
        vy: start[4],
        ..parameters(&reference["base"])
    };
    let rows = reference["rows"].as_array().unwrap();
    let values: Vec<f64> = rows.iter().map(|row| number(&row["f_o"])).collect();
    let options = SectionOptions {
        phase: 0.0,
        skip: reference["transient"].as_u64().unwrap(),
        keep: reference["kept"].as_u64().unwrap(),
        exponents: true,
        impacts: false,
    };
    let found = diagram(&base, "f_o", &values, &options, &no_progress).unwrap();
    for (at, row) in found.iter().zip(rows) {
        assert_eq!(at.period.map(|n| n as u64), row["period"].as_u64());
        assert_eq!(at.snaps().unwrap(), number(&row["snaps_per_period"]));
        let [mean, error] = at.section.exponents[0];
        let off = (mean - number(&row["exponent"])).abs();
        println!("{}: {mean} +- {error}", at.value);
        assert!(off < 3.0 * (error + number(&row["exponent_se"])), "{off}");
        if at.period.is_some() {
            let xs = at.section.points.iter().map(|point| point[0]);
            let largest = xs.fold(f64::MIN, f64::max);
            assert!((largest - number(&row["x_max"])).abs() < 1e-9);
        }
    }
}

const KEPT: SectionOptions = SectionOptions {
    phase: 0.0,
    skip: 300,
    keep: 100,
    exponents: true,
    impacts: false,
};

fn section(parameters: &Parameters) -> Section {
    Section::of(parameters, &KEPT, &no_progress).unwrap()
}

/// The same start stops at two times if the searches for events take other steps, as they do when
/// the motion is to last longer: neither time is known. A stop after a short motion is.
#[test]
fn the_time_of_a_stop_that_rounding_decides_is_not_reported_as_known() {
    let chaotic = Parameters {
        inertia: None,
        a: 0.0,
        r: 2.09,
        e: 0.69,
        nu: 1.19,
        omega: 4.98,
        f_o: 1.74,
        x: 0.05,
        ..Parameters::STANDARD
    };
    let stopped = |case: &Parameters, periods: u64| {
        let options = SectionOptions {
            skip: 10,
            keep: periods - 10,
            ..KEPT
        };
        Section::of(case, &options, &no_progress).unwrap()
    };
    let both = [3000, 20_000].map(|periods| stopped(&chaotic, periods));
    assert!((both[0].end.1 - both[1].end.1).abs() > 1.0);
    for found in both {
        assert_eq!(found.stop_is_certain(), Some(false));
        let words = section_summary(&found);
        assert!(words.contains(" (not certain): ") && words.contains("rounding decides"));
    }
    let short = Parameters {
        f_o: 0.5,
        ..Parameters::STANDARD
    };
    let both = [20, 2000].map(|periods| stopped(&short, periods));
    assert!((both[0].end.1 - both[1].end.1).abs() < 1e-4);
    for found in both {
        assert_eq!(found.stop_is_certain(), Some(true));
        assert!(!section_summary(&found).contains("certain"));
    }
}

/// Two taut cables leave a point mass no deviation, and a rigid body those of its rocking, which
/// preserves areas.
#[test]
fn taut_cables_close_the_directions_across_them() {
    let point = Parameters {
        inertia: None,
        a: 0.0,
        f_o: 0.2,
        ..Parameters::STANDARD
    };
    let found = section(&point);
    assert_eq!(found.exponents, [[f64::NEG_INFINITY, 0.0]; 4]);
    assert!(section_summary(&found).contains(": 4 of -inf (directions closed by contact)\n"));
    let rocking = Parameters {
        f_o: 0.1,
        ..Parameters::STANDARD
    };
    let found = section(&rocking).exponents;
    println!("{found:?}");
    assert_eq!(found[2..], [[f64::NEG_INFINITY, 0.0]; 4]);
    for [mean, error] in &found[..2] {
        assert!(mean.abs() < 3.0 * error, "{mean} +- {error}");
    }
    let [sum, error] = [0, 1].map(|i| found[0][i] + found[1][i]);
    assert!(sum.abs() < 0.1 * error, "{sum} +- {error}");
}

/// If a cable sticks in every lap, two exponents are −∞, and the others are those of the
/// multipliers, which are computed in the remaining directions.
#[test]
fn exponents_of_an_orbit_that_sticks_are_those_of_its_multipliers() {
    let parameters = Parameters {
        inertia: None,
        a: 0.0,
        e: 0.0,
        f_o: 1.4,
        nu: 0.8,
        omega: 3.1,
        ..Parameters::STANDARD
    };
    let orbit = of_attractor(&parameters, &OrbitRequest::default(), &no_progress);
    let orbit: Orbit = orbit.unwrap().unwrap();
    assert_eq!(orbit.multipliers.zeros_from_contact, 2);
    let found = section(&parameters).exponents;
    let known = orbit.multipliers.values.iter();
    for ([mean, _], [re, im]) in found.iter().zip(known) {
        let exponent = re.hypot(*im).ln() / orbit.length;
        println!("{mean} {exponent}");
        assert!(*mean == exponent || (mean - exponent).abs() < 1e-4);
    }
    assert!(
        found[2..]
            .iter()
            .all(|[mean, _]| *mean == f64::NEG_INFINITY)
    );
}

/// The orbit of an attractor is the one that the motion converges to, even if Newton's method first
/// finds an unstable orbit beside it: it attracts at the rate of the motion.
#[test]
fn the_orbit_of_an_attractor_is_where_the_motion_goes() {
    for f_o in [1.01, 1.02] {
        let parameters = Parameters {
            inertia: None,
            a: 0.0,
            r: 1.7,
            e: 0.35,
            f_o,
            nu: 0.8,
            omega: 3.1,
            ..Parameters::STANDARD
        };
        let orbit = of_attractor(&parameters, &OrbitRequest::default(), &no_progress);
        let orbit: Orbit = orbit.unwrap().unwrap();
        assert_eq!(orbit.stability(), Stability::Stable);
        let followed = section(&parameters);
        let last = followed.points.last().expect("a point");
        assert!(
            distance(&orbit.z, last) < 1e-7,
            "{f_o}: {last:?} {:?}",
            orbit.z
        );
        let rate = orbit.multipliers.largest().ln() / orbit.length;
        let [mean, _] = followed.exponents[0];
        assert!((mean - rate).abs() < 0.02, "{f_o}: {mean} {rate}");
    }
}

/// A cable that is taut only at the beginning closes no direction of the long motion.
#[test]
fn what_was_taut_in_the_beginning_does_not_count() {
    let (_, volley, _) = volley();
    let from_corner = Parameters {
        x: 0.0,
        y: 0.0,
        ..volley
    };
    let [there, here] = [volley, from_corner].map(|case| section(&case));
    assert_eq!([there.period(), here.period()], [Some(1); 2]);
    for ([a, _], [b, _]) in there.exponents.iter().zip(&here.exponents) {
        println!("{a} {b}");
        assert!((a - b).abs() < 0.05, "{a} {b}");
    }
}

/// A point mass whose cables snap many times in a period and stick.
const CHATTERING: Parameters = Parameters {
    inertia: None,
    a: 0.0,
    r: 1.7,
    e: 0.35,
    nu: 0.8,
    omega: 3.1,
    ..Parameters::STANDARD
};

/// A motion that approaches an orbit with a multiplier near -1 returns after two periods long
/// before it does so after one. It is a motion of one period, however early that is looked at.
#[test]
fn a_motion_that_alternates_ever_less_is_no_motion_of_two_periods() {
    let case = Parameters {
        f_o: 1.0,
        ..CHATTERING
    };
    let of = |periods: u64| {
        let options = SectionOptions {
            phase: 0.0,
            skip: periods - 100,
            keep: 100,
            exponents: false,
            impacts: false,
        };
        Section::of(&case, &options, &no_progress).unwrap().period()
    };
    for periods in [800, 900, 1000, 1200, 1600] {
        assert_eq!(of(periods), Some(1), "{periods}");
    }
}

/// Snaps per period are those of whole periods, and of whole laps: in a lap of n periods their
/// number is whole. A period that a stop cuts short does not count, as the table of impacts has it.
#[test]
fn snaps_are_those_of_whole_laps() {
    let of = |case: &Parameters, skip: u64, keep: u64| {
        let options = SectionOptions {
            phase: 0.0,
            skip,
            keep,
            exponents: false,
            impacts: true,
        };
        Section::of(case, &options, &no_progress).unwrap()
    };
    let six = of(
        &Parameters {
            f_o: 0.97,
            ..CHATTERING
        },
        900,
        100,
    );
    assert_eq!(six.period(), Some(6));
    let snaps = six.snaps_per_period(Some(6)).unwrap() * 6.0;
    assert!((snaps - snaps.round()).abs() < 1e-9, "{snaps}");
    let standard = Parameters {
        f_o: 0.5,
        ..Parameters::STANDARD
    };
    let fast = Parameters {
        f_o: 3.2,
        y: 0.3,
        ..CHATTERING
    };
    for case in [standard, fast] {
        let cut = of(&case, 0, 40);
        assert!(cut.stop.is_some());
        let whole = cut.points.len() - 1;
        let end = std::f64::consts::TAU / case.omega * whole as f64;
        let impacts = cut.impacts.as_ref().unwrap().points.iter();
        let within = impacts.filter(|impact| impact.t <= end).count();
        assert_eq!(
            cut.snaps_per_period(None),
            Some(within as f64 / whole as f64)
        );
    }
}

/// A chaotic motion whose cables are both taut once in the kept periods has no finite exponent. The
/// text says how often that was, as the steps of the run have it.
#[test]
fn how_often_contact_closed_the_directions_is_said() {
    let case = Parameters {
        f_o: 1.06,
        ..CHATTERING
    };
    let (skip, keep) = (100, 900);
    let options = SectionOptions {
        phase: 0.0,
        skip,
        keep,
        exponents: true,
        impacts: false,
    };
    let found = Section::of(&case, &options, &no_progress).unwrap();
    let mut rules = case.rules();
    (rules.settled_below, rules.sliding_above) = (None, None);
    let period = std::f64::consts::TAU / case.omega;
    rules.t_end = period * (skip + keep) as f64;
    rules.max_impacts = u64::MAX;
    let state = snapload::State::from_components(snapload_orbits::start_of(&case));
    let mut run = snapload::Simulation::new(case.system(), rules, 0.0, state).unwrap();
    let (mut rests, mut taut) = (0, 0);
    while let Some(step) = run.step() {
        let both = step.taut_after.len();
        rests += u64::from(both == 2 && taut < 2 && step.t_end > period * skip as f64);
        taut = both;
    }
    let text = section_summary(&found);
    println!("{rests} {text}");
    assert_eq!(
        (found.period(), found.contacts.get(1)),
        (None, Some(&rests))
    );
    assert!(
        text.contains(&format!(
            "4 of -inf (directions closed by contact, {rests} times)"
        )),
        "{text}"
    );
}

/// A key of the start would hold at the first value only, and one of the run's end not at all.
#[test]
fn a_diagram_is_along_a_key_on_which_orbits_depend() {
    let case = parameters(&reference()["diagrams"][0]["base"]);
    for key in ["x", "vy", "t_end", "max_impacts"] {
        let refused = diagram(&case, key, &[0.1, 0.2], &KEPT, &no_progress);
        let words = refused.unwrap_err().to_string();
        assert!(words.contains("a key on which orbits depend"), "{words}");
    }
}

/// The exponents of an orbit that slides are those of its multipliers, to within the stated error.
/// Difference quotients of motions over a period give ln|μ|/T = -0.33944684 for the largest.
#[test]
fn exponents_are_known_as_well_along_taut_motion_as_stated() {
    let case = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.363,
        e: 0.569,
        f_o: 1.485,
        nu: 0.0,
        omega: 3.549,
        ..Parameters::STANDARD
    };
    let options = SectionOptions { phase: 0.7, ..KEPT };
    let found = Section::of(&case, &options, &no_progress).unwrap();
    let request = OrbitRequest {
        phase: options.phase,
        ..OrbitRequest::default()
    };
    let orbit = of_attractor(&case, &request, &no_progress)
        .unwrap()
        .unwrap();
    let known = orbit.multipliers.values.iter();
    let known = known.map(|[re, im]| re.hypot(*im).ln() / orbit.length);
    for ([mean, error], known) in found.exponents.iter().zip(known) {
        println!("{mean} +- {error}, {known}");
        assert!(*mean == known || (mean - known).abs() < *error);
        assert!(*error < 1e-2);
    }
    let [mean, error] = found.exponents[0];
    assert!((mean + 0.339_446_84).abs() < error);
}
