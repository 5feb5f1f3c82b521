//! The keys of the thesis's case.

use crate::case::error::CaseError;
use crate::case::key::DefaultValue::{self, Count, Derived, Flag, Number, Word};
use crate::case::key::{Key, Kind};
use crate::case::parameters::{BODIES, Parameters};
use crate::case::schema::{Heading, Schema, Table};
use crate::case::value::Value;

/// Largest magnitude of a number in a case; all relevant quantities are of order 1 in its units.
pub(crate) const LARGEST: f64 = 1e3;
const ANY: Kind = Kind::number(-LARGEST, LARGEST);
const SIZE: Kind = Kind::number(0.0, LARGEST);
const POSITIVE: Kind = Kind::positive(LARGEST);
/// The upper bound is a^2 at the largest a, so that each derived value may also be given.
const INERTIA: Kind = Kind::number(1e-12, 1e6);

/// Short form of a row.
const fn key(
    group: &'static str,
    name: &'static str,
    unit: &'static str,
    kind: Kind,
    default: DefaultValue,
    meaning: &'static str,
) -> Key {
    let mut key = Key::new(name, unit, kind, default, meaning);
    key.group = group;
    key
}

const S: Parameters = Parameters::STANDARD;

/// Every key of a case, in the order in which they are listed.
#[rustfmt::skip] // one row a key
pub const KEYS: &[Key] = &[
    key("cables", "r", "L", POSITIVE, Number(S.r), "length of the cables")
        .also("and r > |1 - a|").usual(0.95, 3.0),
    key("cables", "e", "1", Kind::number(0.0, 1.0), Number(S.e),
        "coefficient of restitution of a snap: v_n after = -e v_n before").usual(0.0, 1.0),
    key("body", "a", "L", SIZE, Derived("0.1; 0 for a point mass"), "half-width of the body").usual(0.02, 0.5),
    key("body", "b", "L", SIZE, Derived("0"), "half-height of the body; 0 is the circle").usual(0.0, 0.5),
    key("body", "inertia", "m L^2", INERTIA, Derived("a^2 if b = 0 (ring), (a^2 + b^2)/3 if b > 0 (rectangle)"),
        "moment of inertia")
        .symbol("I").also("at least 1e-6 (a^2 + b^2); never given for a point mass").usual(1e-3, 0.2),
    key("forcing", "f_o", "F", ANY, Number(S.f_o), "force amplitude: f_x = f_o cos(omega t)").usual(0.0, 1.0),
    key("forcing", "nu", "1", ANY, Number(S.nu),
        "axis ratio of the forcing ellipse: f_y = nu f_o sin(omega t)").symbol("ν").usual(-1.0, 1.0),
    key("forcing", "omega", "rad/T", ANY, Number(S.omega), "frequency of the forcing").symbol("Ω").usual(0.1, 3.0),
    key("start", "x", "L", ANY, Number(S.x), "start: horizontal position of the centre").usual(-0.5, 0.5),
    key("start", "y", "L", ANY, Number(S.y),
        "start: vertical position, towards the anchors; 0 with both cables taut").usual(0.0, 1.0),
    key("start", "theta", "rad", ANY, Number(S.theta), "start: rotation")
        .symbol("θ").also("and |theta| <= pi/2; 0 for a point mass").usual(-1.5, 1.5),
    key("start", "vx", "L/T", ANY, Number(S.vx), "start: horizontal velocity").symbol("ẋ").usual(-1.0, 1.0),
    key("start", "vy", "L/T", ANY, Number(S.vy), "start: vertical velocity").symbol("ẏ").usual(-1.0, 1.0),
    key("start", "vtheta", "rad/T", ANY, Number(S.vtheta), "start: angular velocity")
        .symbol("θ̇").also("0 for a point mass").usual(-3.0, 3.0),
    key("stops", "t_end", "T", Kind::positive(1e6), Number(S.t_end), "the run ends here at the latest").usual(5.0, 200.0),
    key("cables", "v_stick", "L/T", Kind::number(1e-9, 1e-2), Number(S.v_stick),
        "a slower snap makes the cable stay taut if its tension would be positive"),
    key("stops", "stop_when_settled", "", Kind::Flag, Flag(S.stop_when_settled),
        "stop where a cable sticks, or both are taut, below y = 0.05"),
    key("stops", "stop_when_sliding", "", Kind::Flag, Flag(S.stop_when_sliding), "stop where a cable sticks at y = 0.05 or above"),
    key("stops", "max_impacts", "", Kind::Count(1, 10_000_000), Count(S.max_impacts as i64),
        "the run ends at more impacts than this"),
    key("body", "body", "", Kind::Choice(&BODIES), Word(BODIES[0]),
        "a rigid body that turns, or a point mass (a = b = 0) that does not"),
];

/// The keys of a case as a table without a heading.
pub const CASE_KEYS: Table = Table {
    follows: &[(
        "h",
        "no h at all; it is derived, h = sqrt(r^2 - (1 - a)^2)",
        "leave h out, and choose r and a instead",
    )],
    ..Table::new("case", Heading::None, "a case of the thesis", KEYS)
};

/// The case file of the thesis's breakwater.
pub static CASE: Schema = Schema {
    tables: &[CASE_KEYS],
    example: "f_o=0.5",
    form: "one `key = value` per line, such as `f_o = 0.5`",
};

/// The key of a name, or an error with the nearest one.
pub fn key_named(name: &str) -> Result<&'static Key, CaseError> {
    CASE_KEYS.key(name, name)
}

/// The key of a name, if it exists and can take the value.
pub fn check_entry(name: &str, value: &Value) -> Result<&'static Key, CaseError> {
    let key = key_named(name).map_err(|error| error.given(value))?;
    key.check(name, value)?;
    Ok(key)
}
