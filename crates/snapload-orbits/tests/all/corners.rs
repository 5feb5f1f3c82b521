//! Snaps without rebound that stop a point mass at both cables' ends.

use nalgebra::DMatrix;
use snapload::analysis::no_progress;
use snapload::{Parameters, Simulation, State};
use snapload_orbits::{
    Family, Moored, Orbit, OrbitRequest, Section, SectionOptions, of_attractor, section_summary,
};

/// A snap of cable 2 while cable 1 is taut stops the mass in the corner in every lap.
const CASE: Parameters = Parameters {
    inertia: None,
    a: 0.0,
    r: 1.341,
    e: 0.0,
    nu: 1.13,
    omega: 3.18,
    f_o: 1.83,
    x: 0.085,
    y: 0.37,
    ..Parameters::STANDARD
};

/// When the mass next stops in the corner, if it begins at rest there.
fn next_stop(t: f64) -> f64 {
    let mut rules = CASE.rules();
    rules.t_end = t + 10.0;
    let state = State::from_components([0.0; 6]);
    let mut run = Simulation::new(CASE.system(), rules, t, state).unwrap();
    let mut steps = std::iter::from_fn(|| run.step());
    let stop = steps.find(|step| step.impacts().count() == 2);
    stop.unwrap().t_end
}

/// Whatever the mass did before, it is at rest in the corner. Only the instant of that carries on:
/// three multipliers are zero, and the fourth is the derivative of one such instant by the one
/// before.
#[test]
fn only_the_instant_of_a_stop_in_the_corner_carries_on() {
    let orbit = of_attractor(&CASE, &OrbitRequest::default(), &no_progress);
    let orbit: Orbit = orbit.unwrap().unwrap();
    let stop = orbit
        .rows
        .iter()
        .find(|row| row.kind == "snap" && row.surface == 1);
    let at = stop.unwrap().t;
    assert!((next_stop(at) - at - orbit.length).abs() < 1e-9);
    let by = 1e-4;
    let known = (next_stop(at + by) - next_stop(at - by)) / (2.0 * by);
    let [[first, im], zeros @ ..] = &orbit.multipliers.values[..] else {
        panic!();
    };
    assert!(
        (first - known).abs() < 1e-6 && *im == 0.0,
        "{first} {known}"
    );
    assert_eq!(zeros, [[0.0; 2]; 3]);
    assert_eq!(orbit.multipliers.zeros_from_contact, 3);
    assert!((orbit.multipliers.product - known).abs() < 1e-6);
    let options = SectionOptions {
        phase: 0.0,
        skip: 100,
        keep: 400,
        exponents: true,
        impacts: false,
    };
    let section = Section::of(&CASE, &options, &no_progress).unwrap();
    let [[mean, error], closed @ ..] = &section.exponents[..] else {
        panic!();
    };
    let exponent = known.abs().ln() / orbit.length;
    assert!((mean - exponent).abs() < error + 1e-4, "{mean} {exponent}");
    assert_eq!(closed, [[f64::NEG_INFINITY, 0.0]; 3]);
    let text = section_summary(&section);
    assert!(
        text.contains(", 3 of -inf (directions closed by contact)\n"),
        "{text}"
    );
}

/// A snap without rebound that is not held stops the mass at the cable's end: one multiplier is
/// zero, and the rule for the product of all, which is zero then, does not apply.
#[test]
fn a_stop_of_an_instant_closes_the_gap() {
    let case = Parameters {
        r: 1.4995,
        nu: 1.1001,
        omega: 4.9935,
        f_o: 2.3934,
        x: -0.0404,
        y: 0.4859,
        ..CASE
    };
    let orbit = of_attractor(&case, &OrbitRequest::default(), &no_progress);
    let orbit: Orbit = orbit.unwrap().unwrap();
    assert_eq!(orbit.lap.sequence.symbol(), ["2", "1"]);
    assert_eq!(orbit.multipliers.zeros_from_contact, 1);
    assert_eq!(orbit.multipliers.values[3], [0.0; 2]);
    // The product of the other three is the sum of the minors of three rows, here of runs.
    let family = Moored::case(case, [None; 2]);
    let (t, by) = (orbit.phase * family.period([0.0; 2]), 1e-5);
    let after = |place: usize, by: f64| {
        let mut z = orbit.z;
        z[place] += by;
        let run = family.simulate([0.0; 2], t, &z, t + orbit.length);
        run.unwrap().end
    };
    let columns = [0, 1, 3, 4].map(|place| (after(place, by), after(place, -by)));
    let slopes = DMatrix::from_fn(4, 4, |i, j| {
        let row = [0, 1, 3, 4][i];
        (columns[j].0[row] - columns[j].1[row]) / (2.0 * by)
    });
    let minors = (0..4).map(|k| slopes.clone().remove_row(k).remove_column(k).determinant());
    let product: f64 = minors.sum();
    let off = orbit.multipliers.product - product;
    assert!(off.abs() < 1e-4 * product.abs(), "{off} {product}");
    assert_eq!(orbit.rule, None);
}
