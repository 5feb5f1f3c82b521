//! A warning of a condition outside the range of the theory. The texts are in
//! `templates/warnings.txt`.

use crate::text_layout::{decimals, digits, paragraph, tenths};
use askama::Template;
use serde::Serialize;

/// A rule of thumb that a case violates, although it can be computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Warning {
    /// The rule's name.
    pub rule: &'static str,
    /// The message, with the numbers.
    pub message: String,
    /// The command that decides, if the tensions of inextensible lines are not reliable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decided_by: Option<&'static str>,
    /// Whether they are not, so that the verdict is open.
    #[serde(skip)]
    pub leaves_open: bool,
}

impl Warning {
    /// Whether it applies to elastic lines, too, and not only to the tensions of inextensible ones.
    pub(crate) fn is_of_all_lines(&self) -> bool {
        self.decided_by.is_none() && self.rule != NO_ELASTIC_REST
    }
}

/// The rule on which the tensions of all lines of a floating body depend.
pub(super) const HYDROSTATICS: &str = "hydrostatics";
/// The rule on a submerged body that comes out of the water as it moves.
pub(super) const EMERGENCE: &str = "emergence";
/// The rule on the number of sinusoids of a sea.
pub(super) const COMPONENTS: &str = "few components";
/// The rule on a body that no elastic lines hold.
pub(super) const NO_ELASTIC_REST: &str = "rest on elastic lines";
/// The rule on the mean density of a body.
pub(super) const DENSITY: &str = "density";
/// The rule on its radius of gyration.
pub(super) const INERTIA: &str = "moment of inertia";

/// Whether a rule is violated on which tensions depend, and the command that decides, if one does.
fn decided_by(rule: &str) -> (bool, Option<&'static str>) {
    match rule {
        "instant snap" | "shared loads" => (true, Some("snapload elastic")),
        NO_ELASTIC_REST | HYDROSTATICS | COMPONENTS | DENSITY | INERTIA => (true, None),
        _ => (false, None),
    }
}

#[derive(Template)]
#[template(path = "warnings.txt")]
struct Message<'a> {
    rule: &'static str,
    a: f64,
    b: f64,
    words: &'a str,
}

/// The warning of a rule with its two numbers and its text, if it is violated.
pub(super) fn warning_if(
    is: bool,
    rule: &'static str,
    [a, b]: [f64; 2],
    words: &str,
) -> Option<Warning> {
    let message = Message { rule, a, b, words };
    let (leaves_open, decided_by) = decided_by(rule);
    is.then(|| Warning {
        rule,
        message: paragraph(&message),
        decided_by,
        leaves_open,
    })
}
