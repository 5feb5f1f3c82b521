//! The reference values.

use serde_json::Value as Json;
use snapload::{Parameters, Value};
use snapload_orbits::Point;

/// A point mass.
pub const POINT: Parameters = Parameters {
    inertia: None,
    a: 0.0,
    ..Parameters::STANDARD
};

/// The file of reference values.
pub fn reference() -> Json {
    serde_json::from_str(include_str!("../data/orbits.json")).unwrap()
}

/// A number, whether it is written as one or as text.
pub fn number(json: &Json) -> f64 {
    match json {
        Json::String(text) => text.parse().unwrap(),
        other => other.as_f64().unwrap(),
    }
}

pub fn numbers(json: &Json) -> Vec<f64> {
    json.as_array().unwrap().iter().map(number).collect()
}

pub fn point(json: &Json) -> Point {
    numbers(json).try_into().unwrap()
}

/// The case of a table of keys.
pub fn parameters(case: &Json) -> Parameters {
    let entries = case.as_object().unwrap().iter().map(|(key, value)| {
        let value = match (key.as_str(), value) {
            ("body", Json::String(word)) => Value::Text(word.clone()),
            (_, value) => Value::Number(number(value)),
        };
        (key.clone(), value)
    });
    Parameters::from_entries(entries).unwrap()
}

/// |a − b| as part of |b|.
pub fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / b.abs()
}

/// A point mass with a closed branch in ω, along which orbits become tori,
/// and the start of an orbit on it.
pub(crate) fn tori() -> (Parameters, [f64; 6]) {
    let case = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.7,
        e: 0.35,
        f_o: 1.4,
        nu: 0.8,
        omega: 3.1,
        ..Parameters::STANDARD
    };
    (case, [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0])
}

/// A point mass that may come to rest in the corner, or move on an orbit of three snaps.
pub(crate) fn two_attractors() -> Parameters {
    Parameters {
        inertia: None,
        a: 0.0,
        r: 1.3,
        e: 0.7,
        nu: 1.2,
        omega: 4.0,
        f_o: 0.67,
        ..Parameters::STANDARD
    }
}
