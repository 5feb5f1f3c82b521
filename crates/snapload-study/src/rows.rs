//! The one place where cases become rows.

use crate::Drawn;
use snapload::analysis::{Cancelled, Certainty, Counter, on_all_threads, outcomes_on_one_thread};
use snapload::{Case, CaseError, KEYS, Lanes, Outcome, Parameters, Value};

/// A row of a study: the keys of a case and what its run comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its place in the study, from 0.
    pub index: u64,
    /// The values of all keys in the order of the schema; of a case that can not be run those
    /// given, and the defaults of the others.
    pub keys: Vec<Option<Value>>,
    /// What the run comes to, or why there is none.
    pub outcome: Result<Outcome, CaseError>,
    /// How far the run can be trusted, if that was asked for.
    pub certainty: Option<Certainty>,
}

/// Runs cases, on the threads that there are, and returns their rows in order. Each is counted.
///
/// A row depends on its case alone, so it is the same wherever and with whichever others it is
/// computed.
///
/// # Errors
/// [`Cancelled`] if the work is to end before.
pub fn rows(drawn: &[Drawn], trust: bool, counter: &Counter) -> Result<Vec<Row>, Cancelled> {
    on_all_threads(drawn, |drawn| side_by_side(drawn, trust, counter))
}

fn side_by_side(drawn: &[&Drawn], trust: bool, counter: &Counter) -> Result<Vec<Row>, Cancelled> {
    let mut cases = Vec::with_capacity(drawn.len());
    let mut make = |drawn: &Drawn| {
        cases.push(drawn.parameters.clone().and_then(Case::new)?);
        Ok(())
    };
    let made: Vec<Result<(), CaseError>> = drawn.iter().map(|drawn| make(drawn)).collect();
    let told: Vec<(Outcome, Option<Certainty>)> = if trust {
        let told = Certainty::with_outcomes(Lanes::best(), &cases, counter)?.into_iter();
        told.map(|(outcome, certainty)| (outcome, Some(certainty)))
            .collect()
    } else {
        let outcomes = outcomes_on_one_thread(cases.iter(), counter)?.into_iter();
        outcomes.map(|outcome| (outcome, None)).collect()
    };
    let mut told = told.into_iter();
    let row = |(drawn, made): (&&Drawn, Result<(), CaseError>)| {
        let (outcome, certainty) = match made {
            Ok(()) => {
                let (outcome, certainty) = told.next()?;
                (Ok(outcome), certainty)
            }
            Err(error) => (Err(error), None),
        };
        Some(Row {
            index: drawn.index,
            keys: match &drawn.parameters {
                Ok(parameters) => parameters.entries().map(|(_, value)| value).collect(),
                Err(_) => given(drawn),
            },
            outcome,
            certainty,
        })
    };
    let rows = drawn.iter().zip(made).filter_map(row).collect();
    counter.add(drawn.len() as u64)?;
    Ok(rows)
}

/// The keys of a case that is none, as far as they were given.
fn given(drawn: &Drawn) -> Vec<Option<Value>> {
    let last = |name: &str| drawn.given.iter().rfind(|(key, _)| *key == name);
    KEYS.iter()
        .map(|key| match last(key.name) {
            Some((_, value)) => Some(value.clone()),
            // What follows from other keys does not follow from wrong ones.
            None if key.name == "inertia" => None,
            None => Parameters::STANDARD.get(key.name),
        })
        .collect()
}
