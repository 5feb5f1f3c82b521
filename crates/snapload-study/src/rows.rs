//! The one place where cases become rows.

use crate::{Drawn, NoCase};
use snapload::analysis::{
    Cancelled, Certainty, Counter, Made, on_all_threads_until, outcomes_on_one_thread,
};
use snapload::{Lanes, Outcome, Parameters};

/// A row of a study: a case and what its run comes to, or of a case that can not be run, why.
pub type Row = Result<(Parameters, Run), Box<NoCase>>;

/// What there is to tell of a case that could be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// What the run comes to.
    pub outcome: Outcome,
    /// How far the run can be trusted, if that was asked for.
    pub certainty: Option<Certainty>,
}

/// Runs cases, on the threads that there are, and returns their rows in order: those of the first
/// cases, as many as are begun until `no_more` says so. Each is counted.
///
/// A row depends on its case alone, so it is the same wherever and with whichever others it is
/// computed.
///
/// # Errors
/// [`Cancelled`] if the work is to end before.
pub fn rows(
    drawn: &Drawn,
    counter: &Counter,
    no_more: &(dyn Fn() -> bool + Sync),
) -> Result<Made<Row>, Cancelled> {
    on_all_threads_until(no_more, drawn.count(), |numbers| {
        side_by_side(drawn, numbers, counter)
    })
}

fn side_by_side(
    drawn: &Drawn,
    numbers: &mut dyn Iterator<Item = usize>,
    counter: &Counter,
) -> Result<Vec<Row>, Cancelled> {
    let mut made = Vec::with_capacity(numbers.size_hint().1.unwrap_or(0));
    let cases = numbers.filter_map(|k| match drawn.case(k) {
        Ok(case) => {
            made.push(Ok(*case.parameters()));
            Some(case)
        }
        Err(no_case) => {
            made.push(Err(no_case));
            // Whoever is told to end hears of it with the next case that can be run.
            let _ = counter.add(1);
            None
        }
    });
    if drawn.trust() {
        let told = Certainty::with_outcomes(Lanes::best(), cases, counter)?;
        let run = |(outcome, certainty)| Run {
            outcome,
            certainty: Some(certainty),
        };
        Ok(together(made, told.into_iter().map(run)))
    } else {
        let told = outcomes_on_one_thread(cases, counter)?;
        let run = |outcome| Run {
            outcome,
            certainty: None,
        };
        Ok(together(made, told.into_iter().map(run)))
    }
}

/// Cases and what their runs come to; of those that can not be run there is nothing told.
fn together(
    made: Vec<Result<Parameters, Box<NoCase>>>,
    mut told: impl Iterator<Item = Run>,
) -> Vec<Row> {
    let row = |made| match made {
        Ok(parameters) => Some(Ok((parameters, told.next()?))),
        Err(no_case) => Some(Err(no_case)),
    };
    made.into_iter().filter_map(row).collect()
}
