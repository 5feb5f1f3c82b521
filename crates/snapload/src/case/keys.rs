//! The schema of the thesis's case.

use crate::case::error::CaseError;
use crate::case::key::Key;
use crate::case::parameters::KEYS;
use crate::case::schema::{Heading, Schema, Table};
use crate::case::value::Value;

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
