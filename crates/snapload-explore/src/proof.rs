//! `/api/proof`: the proved part of a run, in words, and its certificate.
use crate::refusal::Refusal;
use crate::request::{OfCase, case};
use crate::run::follow;
use crate::work::Allowance;
use serde::Serialize;
use snapload::Case;
use snapload::analysis::Progress;
use snapload_certificate::{Cancelled, Ended, ExactCase, Reason, certify};
use snapload_report::{Certified, proved_in_words, shell_line};
use std::time::Duration;

/// The time budget of a proof.
const BUDGET: Duration = Duration::from_secs(20);

#[derive(Serialize)]
struct Answer {
    /// Whether the proof reaches the end of the run.
    proved: bool,
    /// The time up to which it is proved.
    t: String,
    impacts: usize,
    /// The row of the table of impacts from which the run of doubles differs, if it does.
    leaves: Option<usize>,
    /// What is proved, the end of the run, and where the run of doubles differs.
    words: String,
    /// The command that continues the proof, if there is one.
    further: Option<String>,
    /// The certificate, as by the command.
    certificate: String,
}

/// The answer, as JSON. Only slack flight is proved here, which takes a moment; motion with a taut
/// cable takes longer, and is left to the command.
pub(crate) fn answer(request: OfCase, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let case = case(request.values)?;
    let run = follow(&case, allowance)?.run;
    let exact = ExactCase::of(case.parameters(), |_| None).map_err(Refusal::values)?;
    let allowance = allowance.within(BUDGET);
    let t_end = case.parameters().t_end;
    let proof = certify(&exact, false, &mut |t| {
        allowance.check(Progress::new("proving", t, t_end))
    });
    let proof = proof
        .map_err(|Cancelled| too_long(&case))?
        .map_err(Refusal::values)?;
    let sticks = proof.end == Ended::Proved(Reason::Sticks);
    let certificate = proof.text() + "\n";
    let certified = Certified::new(proof, &run);
    let proof = &certified.proof;
    let answer = Answer {
        proved: matches!(proof.end, Ended::Proved(_)) && !sticks,
        t: proof.t.clone(),
        impacts: proof.impacts,
        leaves: certified
            .departure
            .filter(|_| !sticks)
            .map(|departure| departure.impact),
        words: match sticks {
            // The run continues, so that only what comes before can be compared.
            true => proved_in_words(proof),
            false => certified.in_words(),
        },
        further: sticks.then(|| proving(&case)),
        certificate,
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}

/// The command that proves the run of a case, also where a cable stays taut.
fn proving(case: &Case) -> String {
    shell_line(case.parameters()) + " --certify"
}

fn too_long(case: &Case) -> Refusal {
    Refusal::values(format!(
        "the proof takes more than {} s\nhint: {}",
        BUDGET.as_secs(),
        proving(case)
    ))
}
