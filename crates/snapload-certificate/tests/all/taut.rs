//! Certificates of motion with a taut cable; its numbers are compared with references beside the
//! proof itself.
use serde_json::Value;
use snapload::Parameters;
use snapload_certificate::{Certification, Ended, ExactCase, Verdict, certify, check};
use std::ops::ControlFlow;

fn taut(parameters: &Parameters) -> Certification {
    let exact = ExactCase::of(parameters, |_| None).expect("a legal case");
    let proof = certify(&exact, true, &mut |_| ControlFlow::Continue(()));
    proof.expect("not cancelled").expect("a legal start")
}

/// A taut stretch is checked again, and refused where anything of it is altered.
#[test]
fn altered_stretches_are_refused() {
    let parameters = Parameters {
        e: 0.0,
        f_o: 0.8,
        stop_when_settled: false,
        t_end: 0.5,
        ..Parameters::STANDARD
    };
    let proof = taut(&parameters);
    assert!(matches!(proof.end, Ended::Proved(_)), "{:?}", proof.end);
    assert_eq!(proof.stretches, 1);
    let verdict = check(&proof.text());
    assert!(matches!(verdict, Verdict::Proved { .. }), "{verdict:?}");
    let certificate: Value = serde_json::from_str(&proof.text()).expect("JSON");
    for (key, value) in [
        ("mode", serde_json::json!([1])),
        ("mode", serde_json::json!([1, 2])),
        ("from", serde_json::json!("0.3558742393839676985425")),
        ("until", serde_json::json!("0.4999999999999999999999999")),
        ("event", serde_json::json!("tension 2")),
    ] {
        let mut altered = certificate.clone();
        altered["impacts"][1][key] = value.clone();
        let verdict = check(&altered.to_string());
        assert!(
            matches!(verdict, Verdict::Refused(_)),
            "{key} {value}: {verdict:?}"
        );
    }
    // Of format 1 there are no stretches.
    let mut altered = certificate;
    altered["format"] = serde_json::json!("snapload-certificate-1");
    assert!(matches!(check(&altered.to_string()), Verdict::Malformed(_)));
}
