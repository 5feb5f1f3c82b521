//! Turns cases into rows.

use crate::{NoCase, StudyCases};
use snapload::analysis::{
    Cancelled, Certainty, Counter, ThreadResults, on_all_threads_until, outcomes_on_one_thread,
};
use snapload::{Lanes, Outcome, Parameters};

/// A row of a study: a case and the result of its run, or why the case can not be run.
pub type Row = Result<(Parameters, Run), Box<NoCase>>;

/// The result of a case that was run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// The outcome of the run.
    pub outcome: Outcome,
    /// How far the run can be trusted, if that was asked for.
    pub certainty: Option<Certainty>,
}

/// Runs cases, on all threads, and returns their rows in order: those of the first cases, as many
/// as are begun until `no_more` stops it. Each is counted.
///
/// A row depends on its case alone, so it is the same wherever and together with whichever cases it
/// is computed.
///
/// # Errors
/// [`Cancelled`] if the work is to end before.
pub fn rows(
    cases: &StudyCases,
    counter: &Counter,
    no_more: &(dyn Fn() -> bool + Sync),
) -> Result<ThreadResults<Row>, Cancelled> {
    on_all_threads_until(no_more, cases.count(), |numbers| {
        side_by_side(cases, numbers, counter)
    })
}

fn side_by_side(
    study_cases: &StudyCases,
    numbers: &mut dyn Iterator<Item = usize>,
    counter: &Counter,
) -> Result<Vec<Row>, Cancelled> {
    let mut made = Vec::with_capacity(numbers.size_hint().1.unwrap_or(0));
    let cases = numbers.filter_map(|k| match study_cases.case(k) {
        Ok(case) => {
            made.push(Ok(*case.parameters()));
            Some(case)
        }
        Err(no_case) => {
            made.push(Err(no_case));
            // Cancellation is noticed at the next case that can be run.
            let _ = counter.add(1);
            None
        }
    });
    if study_cases.trust() {
        let results = Certainty::with_outcomes(Lanes::best(), cases, counter)?;
        let run = |(outcome, certainty)| Run {
            outcome,
            certainty: Some(certainty),
        };
        Ok(together(made, results.into_iter().map(run)))
    } else {
        let results = outcomes_on_one_thread(cases, counter)?;
        let run = |outcome| Run {
            outcome,
            certainty: None,
        };
        Ok(together(made, results.into_iter().map(run)))
    }
}

/// Cases with the results of their runs; those that can not be run have none.
fn together(
    made: Vec<Result<Parameters, Box<NoCase>>>,
    mut results: impl Iterator<Item = Run>,
) -> Vec<Row> {
    let row = |made| match made {
        Ok(parameters) => Some(Ok((parameters, results.next()?))),
        Err(no_case) => Some(Err(no_case)),
    };
    made.into_iter().filter_map(row).collect()
}
