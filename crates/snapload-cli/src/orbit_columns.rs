//! The columns of tables of orbits.
use crate::table::names;
use snapload::analysis::START_KEYS;
use snapload_orbits::Orbit;
use snapload_study::Values;

/// The numeric columns of an orbit.
pub(crate) const ORBIT_COLUMNS: [&str; 11] = [
    "arclength",
    "x",
    "y",
    "theta",
    "vx",
    "vy",
    "vtheta",
    "largest_multiplier",
    "least_v_n",
    "y_max",
    "theta_max",
];

pub(crate) fn of_orbit(column: &str, keys: [&str; 2], orbit: &Orbit, arclength: f64) -> f64 {
    let place = START_KEYS.iter().position(|name| *name == column);
    match (column, place) {
        _ if column == keys[0] => orbit.at[0],
        _ if column == keys[1] => orbit.at[1],
        (_, Some(place)) => orbit.z[place],
        ("arclength", _) => arclength,
        ("largest_multiplier", _) => orbit.multipliers.largest(),
        ("least_v_n", _) => orbit.survey.least_speed.map_or(f64::NAN, |snap| snap.value),
        ("y_max", _) => orbit.survey.y_max,
        ("theta_max", _) => orbit.survey.theta_max,
        _ => f64::NAN,
    }
}

/// The columns of orbits that are words or flags.
pub(crate) fn text_columns(orbits: &[&Orbit]) -> Vec<(&'static str, Values)> {
    let orbits = || orbits.iter();
    let symbols = orbits().map(|orbit| Some(orbit.lap.sequence.symbol().join(" ").into()));
    let stability = orbits().map(|orbit| Some(orbit.stability().name()));
    let real = orbits().map(|orbit| Some(orbit.is_admissible()));
    vec![
        ("symbol", Values::Words(symbols.collect())),
        ("stability", names(stability)),
        ("admissible", Values::Flags(real.collect())),
    ]
}
