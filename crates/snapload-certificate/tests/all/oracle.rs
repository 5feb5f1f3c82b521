//! Certificates against trajectories of 120 digits and more, computed by independent code
//! (`crates/snapload/tests/oracle`).
use crate::common::{case, proof};
use serde_json::Value;
use snapload_certificate::{Certification, Ended, Verdict, check};

fn read(name: &str) -> Value {
    let path = format!(
        "{}/../snapload/tests/oracle/{name}",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    serde_json::from_str(&text).expect("JSON")
}

/// The settings of a case of the oracle.
fn settings(case: &Value) -> Vec<String> {
    let named = |key: &str| match key {
        "f0" => "f_o".to_owned(),
        "Om" => "omega".to_owned(),
        other => other.to_owned(),
    };
    let text = |value: &Value| value.as_str().expect("a decimal").to_owned();
    let params = case["params"].as_object().expect("keys");
    let mut all: Vec<String> = params
        .iter()
        .map(|(key, value)| format!("{}={}", named(key), text(value)))
        .collect();
    let keys = ["x", "y", "theta", "vx", "vy", "vtheta"];
    let start = case["start"].as_array().expect("a start");
    all.extend(
        keys.iter()
            .zip(start)
            .map(|(key, value)| format!("{key}={}", text(value))),
    );
    all
}

/// Whether a printed number is the reference, which has 30 digits, rounded to its last place.
fn agrees(printed: &str, reference: &str) -> bool {
    let (digits, power) = printed.split_once('e').unwrap_or((printed, "0"));
    let places = digits
        .split_once('.')
        .map_or(0, |(_, fraction)| fraction.len());
    let unit = 10f64.powi(power.parse::<i32>().expect("a power") - places as i32);
    // Both agree in the leading digits; the rest is compared.
    let scaled = |text: &str| -> (i128, i32) {
        let (digits, power) = text.split_once('e').unwrap_or((text, "0"));
        let places = digits
            .split_once('.')
            .map_or(0, |(_, fraction)| fraction.len()) as i32;
        let integer = digits.replace('.', "").parse().expect("digits");
        (integer, power.parse::<i32>().expect("a power") - places)
    };
    let ((a, p), (b, q)) = (scaled(printed), scaled(reference));
    let low = p.min(q);
    let at = |n: i128, power: i32| n * 10i128.pow((power - low) as u32);
    let off = (at(a, p) - at(b, q)).abs() as f64 * 10f64.powi(low);
    // The reference itself is truncated after 30 digits.
    off <= 0.5 * unit * (1.0 + 1e-3)
}

fn compare(proof: &Certification, reference: &Value) {
    let certificate: Value = serde_json::from_str(&proof.text()).expect("JSON");
    let impacts = certificate["impacts"].as_array().expect("impacts");
    assert_eq!(
        impacts.len() as u64,
        reference["end"]["n_impacts"].as_u64().expect("a count")
    );
    for (ours, theirs) in impacts
        .iter()
        .zip(reference["impacts"].as_array().expect("impacts"))
    {
        let text = |value: &Value| value.as_str().expect("a decimal").to_owned();
        assert_eq!(ours[0], theirs["cable"]);
        assert!(
            agrees(&text(&ours[1]), &text(&theirs["t"])),
            "{ours} {theirs}"
        );
        assert!(
            agrees(&text(&ours[2]), &text(&theirs["vn"])),
            "{ours} {theirs}"
        );
    }
    let end = &certificate["end"];
    let t = reference["end"]["t"].as_str().expect("a time");
    assert!(agrees(end["t"].as_str().expect("a time"), t));
    let kind = reference["end"]["kind"].as_str().expect("a kind");
    let reason = end["reason"].as_str().expect("a reason");
    // Without stop_when_sliding a cable that sticks at a high position does not end the run.
    assert_eq!(
        reason,
        if kind == "sliding_start" {
            "sticks"
        } else {
            kind
        }
    );
}

/// Every case of the oracle is proved to its end; count, cables, times, velocities and end agree
/// with its digits.
#[test]
fn every_case_is_proved_to_its_end() {
    for reference in read("cases.json")["cases"].as_array().expect("cases") {
        let proof = proof(&case(&settings(reference)));
        assert!(
            matches!(proof.end, Ended::Proved(_)),
            "{}: {:?}",
            reference["id"],
            proof.end
        );
        compare(&proof, reference);
    }
}

/// Starts tuned so that a gap peaks at ±1e-4 to ±1e-13: each touch and each miss is proved.
#[test]
fn grazes_are_proved() {
    for reference in read("grazing.json")["cases"].as_array().expect("cases") {
        let proof = proof(&case(&settings(reference)));
        assert!(
            matches!(proof.end, Ended::Proved(_)),
            "{}: {:?}",
            reference["id"],
            proof.end
        );
        assert!(matches!(check(&proof.text()), Verdict::Proved { .. }));
        // One case ends by another rule: its first snap is below v_stick without tension and the
        // flight continues.
        if reference["end"]["kind"] != "sliding_start" {
            compare(&proof, reference);
        }
    }
}

/// The standard case, 290 impacts in less than 100 bytes each, and checked again.
#[test]
fn the_standard_case_is_small_and_checked() {
    let proof = proof(&case(&[]));
    assert_eq!(proof.impacts, 290);
    assert!(proof.text().len() < 290 * 100, "{}", proof.text().len());
    assert!(matches!(
        check(&proof.text()),
        Verdict::Proved { impacts: 290, .. }
    ));
}
