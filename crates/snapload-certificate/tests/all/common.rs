//! Cases and proofs for the tests.
use snapload::{CASE, Case, Entries, Parameters};
use snapload_certificate::{Certification, Decimal, ExactCase, certify};
use std::ops::ControlFlow;

/// A case of keys as they are written on a command line.
pub fn case(settings: &[String]) -> ExactCase {
    let mut entries = Entries::new(&CASE);
    for setting in settings {
        entries.set(setting).expect("a key");
    }
    let parameters = Parameters::from_entries(entries.values("case")).expect("a case");
    Case::new(parameters).expect("a legal start");
    let typed = |key: &str| entries.written(key).and_then(Decimal::typed);
    ExactCase::of(&parameters, typed).expect("a legal case")
}

/// The same from text, split at blanks.
pub fn case_of(settings: &str) -> ExactCase {
    case(
        &settings
            .split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>(),
    )
}

pub fn proof(case: &ExactCase) -> Certification {
    let proof = certify(case, false, &mut |_| ControlFlow::Continue(()));
    proof.expect("not cancelled").expect("a legal start")
}
