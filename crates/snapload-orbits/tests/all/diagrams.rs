//! Long motions: periods, snaps, exponents; basins of attraction.

use crate::common::{number, numbers, parameters, reference};
use snapload::Parameters;
use snapload::analysis::unwatched;
use snapload_orbits::{Attraction, Fate, Stretch, Window, diagram};

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
    let stretch = Stretch {
        phase: 0.0,
        skip: reference["transient"].as_u64().unwrap(),
        keep: reference["kept"].as_u64().unwrap(),
        exponents: true,
        impacts: false,
    };
    let found = diagram(&base, "f_o", &values, &stretch, &unwatched).unwrap();
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

/// Below f_c rest in the corner and an orbit of three snaps are both attractors.
#[test]
fn two_attractors_share_the_starts() {
    let base = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.3,
        e: 0.7,
        nu: 1.2,
        omega: 4.0,
        f_o: 0.67,
        ..Parameters::STANDARD
    };
    let window = Window {
        base,
        keys: ["x", "y"],
        values: [vec![-0.1, 0.0, 0.1], vec![0.2, 0.425, 0.65]],
    };
    let found = Attraction::of(window, 200, &unwatched).unwrap();
    let symbols: Vec<_> = found
        .attractors
        .iter()
        .map(|attractor| attractor.orbit.as_ref().unwrap().lap.sequence.symbol())
        .collect();
    println!("{symbols:?} {:?}", found.fates);
    assert!(symbols.contains(&Vec::new()));
    assert!(symbols.iter().any(|symbol| symbol.len() == 3));
    assert!(!found.fates.contains(&Fate::Aperiodic));
}
