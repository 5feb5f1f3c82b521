//! The one place where cases become rows.

use crate::Drawn;
use rayon::prelude::*;
use snapload::analysis::Account;
use snapload::{Case, CaseError, KEYS, Parameters, Value};

/// A row of a study: the keys of a case and what its run comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its place in the study, from 0.
    pub index: u64,
    /// The values of all keys in the order of the schema; of a case that can not be run those given, and the
    /// defaults of the others.
    pub keys: Vec<Option<Value>>,
    /// What the run comes to, or why there is none.
    pub account: Result<Account, CaseError>,
}

/// Runs cases, on the threads that there are, and returns their rows in order. `done` is called after each.
///
/// A row depends on its case alone, so it is the same wherever and with whichever others it is computed.
pub fn rows(drawn: Vec<Drawn>, trust: bool, done: &(dyn Fn() + Sync)) -> Vec<Row> {
    drawn
        .into_par_iter()
        .map(|drawn| {
            let row = row(drawn, trust);
            done();
            row
        })
        .collect()
}

fn row(drawn: Drawn, trust: bool) -> Row {
    let case = drawn.parameters.clone().and_then(Case::new);
    Row {
        index: drawn.index,
        keys: match &drawn.parameters {
            Ok(parameters) => parameters.entries().map(|(_, value)| value).collect(),
            Err(_) => given(&drawn),
        },
        account: case.map(|case| Account::of(&case, trust)),
    }
}

/// The keys of a case that is none, as far as they were given.
fn given(drawn: &Drawn) -> Vec<Option<Value>> {
    let last = |name: &str| drawn.given.iter().rfind(|(key, _)| *key == name);
    KEYS.iter()
        .map(|key| match last(key.name) {
            Some((_, value)) => Some(value.clone()),
            // What follows from other keys does not follow from wrong ones.
            None if key.name == "inertia" => None,
            None => key.get(&Parameters::STANDARD),
        })
        .collect()
}
