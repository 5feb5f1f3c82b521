//! An altered certificate is refused, wherever it is altered.
use crate::common::{case_of, proof};
use serde_json::{Value, json};
use snapload::{Case, Parameters};
use snapload_certificate::{Verdict, check};

/// A decimal changed by `units` of the place `places` after the point.
fn moved(text: &Value, units: i128, places: usize) -> Value {
    let text = text.as_str().expect("a decimal");
    let (digits, power) = text.split_once('e').unwrap_or((text, ""));
    let own = digits
        .split_once('.')
        .map_or(0, |(_, fraction)| fraction.len());
    let longer = own.max(places);
    let mut integer: i128 = digits.replace('.', "").parse().expect("digits");
    integer =
        integer * 10i128.pow((longer - own) as u32) + units * 10i128.pow((longer - places) as u32);
    let sign = if integer < 0 { "-" } else { "" };
    let width = longer + 1;
    let digits = format!("{:0>width$}", integer.unsigned_abs());
    let (whole, fraction) = digits.split_at(digits.len() - longer);
    let point = if longer > 0 { "." } else { "" };
    let e = if power.is_empty() {
        String::new()
    } else {
        format!("e{power}")
    };
    json!(format!("{sign}{whole}{point}{fraction}{e}"))
}

fn last_digit(text: &Value) -> Value {
    let digits = text
        .as_str()
        .expect("a decimal")
        .split('e')
        .next()
        .expect("digits")
        .to_owned();
    moved(
        text,
        1,
        digits
            .split_once('.')
            .map_or(0, |(_, fraction)| fraction.len()),
    )
}

fn refused(certificate: &Value, what: &str) {
    let verdict = check(&certificate.to_string());
    let passed = matches!(
        verdict,
        Verdict::Proved { .. } | Verdict::ProvedInPart { .. }
    );
    assert!(!passed, "{what}: {verdict:?}");
}

/// Twenty-one impacts: e = 0.5.
fn certificate() -> Value {
    let proof = proof(&case_of("e=0.5"));
    assert!(matches!(check(&proof.text()), Verdict::Proved { .. }));
    serde_json::from_str(&proof.text()).expect("JSON")
}

#[test]
fn altered_numbers_are_refused() {
    let true_one = certificate();
    for k in [0, 7, 20] {
        for places in [3, 6, 9, 12] {
            for units in [1, -1] {
                let mut altered = true_one.clone();
                altered["impacts"][k][1] = moved(&altered["impacts"][k][1], units, places);
                refused(&altered, "a time");
            }
        }
        for field in [1, 2] {
            let mut altered = true_one.clone();
            altered["impacts"][k][field] = last_digit(&altered["impacts"][k][field]);
            refused(&altered, "a last digit");
        }
        let mut altered = true_one.clone();
        altered["impacts"][k][2] = moved(&altered["impacts"][k][2], 3, 9);
        refused(&altered, "v_n");
        let cable = altered["impacts"][k][0].as_u64().expect("a cable");
        let mut altered = true_one.clone();
        altered["impacts"][k][0] = json!(3 - cable);
        refused(&altered, "a cable");
    }
    for k in 0..6 {
        let mut altered = true_one.clone();
        altered["end"]["state"][k] = last_digit(&altered["end"]["state"][k]);
        refused(&altered, "the state at the end");
    }
    let mut altered = true_one.clone();
    altered["end"]["t"] = last_digit(&altered["end"]["t"]);
    refused(&altered, "the time of the end");
}

/// What is claimed and what is true are told with so many digits that one sees where they differ.
#[test]
fn a_refusal_shows_where_the_digits_differ() {
    let true_one = certificate();
    for [place, field] in [[7, 1], [20, 1]] {
        let mut altered = true_one.clone();
        let known = true_one["impacts"][place][field]
            .as_str()
            .expect("a decimal");
        altered["impacts"][place][field] = last_digit(&true_one["impacts"][place][field]);
        let claimed = altered["impacts"][place][field]
            .as_str()
            .expect("a decimal");
        let Verdict::Refused(message) = check(&altered.to_string()) else {
            panic!("passed");
        };
        let expected = format!("is {known}, but {claimed} is claimed");
        assert!(message.contains(&expected), "{message}");
    }
}

#[test]
fn altered_lists_are_refused() {
    let true_one = certificate();
    for k in [0, 9, 20] {
        let list = true_one["impacts"].as_array().expect("impacts");
        for what in ["dropped", "doubled", "exchanged", "added"] {
            let mut list = list.clone();
            match what {
                "dropped" => drop(list.remove(k)),
                "doubled" => list.insert(k, list[k].clone()),
                "exchanged" => list.swap(k, (k + 1) % 21),
                _ => list.insert(k, json!([1, "0.5", "1e-3"])),
            }
            let mut altered = true_one.clone();
            altered["impacts"] = Value::Array(list);
            refused(&altered, what);
        }
    }
}

#[test]
fn altered_cases_are_refused() {
    let true_one = certificate();
    let keys = [
        "r", "e", "a", "f_o", "nu", "omega", "x", "y", "theta", "vx", "vy", "vtheta",
    ];
    for key in keys {
        for places in [4, 16] {
            let mut altered = true_one.clone();
            altered["case"][key] = moved(&altered["case"][key], 1, places);
            refused(&altered, key);
        }
    }
    for (key, value) in [
        ("inertia", json!("0.0100000000000001")),
        ("b", json!("0.001")),
        ("t_end", json!("0.8")),
        ("v_stick", json!("1e-4")),
        ("v_stick", json!("1e-7")),
        ("stop_when_settled", json!(false)),
        ("max_impacts", json!(19)),
        ("max_impacts", json!(-1)),
        ("body", json!("point")),
        ("e", json!("1.5")),
        ("r", json!("0.5")),
        ("r", json!(1.5)),
        ("r", json!("+1.5")),
        ("r", json!("nan")),
    ] {
        let mut altered = true_one.clone();
        altered["case"][key] = value.clone();
        refused(&altered, &format!("{key} = {value}"));
    }
}

/// Ranges of keys are those of a case; a number beyond one by less than a rounding is beyond it
/// where the model is not defined there.
#[test]
fn cases_that_are_not_legal_are_no_certificates() {
    let true_one = certificate();
    let with = |key: &str, value: Value| {
        let mut altered = true_one.clone();
        altered["case"][key] = value;
        check(&altered.to_string())
    };
    for (key, value) in [
        ("max_impacts", json!(10_000_001)),
        ("max_impacts", json!(0)),
        ("max_impacts", json!(u64::MAX)),
        ("t_end", json!("2e6")),
        ("t_end", json!("0")),
        ("omega", json!("1001")),
        ("vx", json!("1e300")),
        ("v_stick", json!("0.0101")),
        ("inertia", json!("1e-14")),
        // 1e-6 (a² + b²) is the least with a = 0.1 and b = 0.
        ("inertia", json!("9.9e-9")),
        ("e", json!("1.00000000000000000001")),
        ("e", json!("-1e-30")),
        ("b", json!("-1e-400")),
        ("r", json!("0.9")),
        ("body", json!("point")),
    ] {
        let verdict = with(key, value.clone());
        assert!(
            matches!(verdict, Verdict::Malformed(_)),
            "{key} = {value}: {verdict:?}"
        );
    }
    for (key, value) in [("max_impacts", json!(10_000_000)), ("t_end", json!("1e6"))] {
        let verdict = with(key, value.clone());
        assert!(
            matches!(verdict, Verdict::Proved { .. }),
            "{key} = {value}: {verdict:?}"
        );
    }
    let beyond = "the start is beyond the rotation limit".to_owned();
    assert_eq!(with("theta", json!("2")), Verdict::Refused(beyond));
}

#[test]
fn other_shapes_are_no_certificates() {
    let true_one = certificate();
    for (place, value) in [
        ("format", json!("snapload-certificate-3")),
        ("model", json!("another")),
        ("bits", json!(32)),
        ("bits", json!(1_000_000)),
        ("bits", json!("256")),
        ("more", json!(1)),
        ("impacts", json!({})),
        ("end", json!({"reason": "settled"})),
        ("case", json!({})),
    ] {
        let mut altered = true_one.clone();
        altered[place] = value;
        let verdict = check(&altered.to_string());
        assert!(
            matches!(verdict, Verdict::Malformed(_)),
            "{place}: {verdict:?}"
        );
    }
    for key in ["inertia", "r", "max_impacts"] {
        let mut altered = true_one.clone();
        altered["case"].as_object_mut().expect("keys").remove(key);
        let verdict = check(&altered.to_string());
        assert!(
            matches!(verdict, Verdict::Malformed(_)),
            "{key}: {verdict:?}"
        );
    }
    for reason in [
        "rotation_limit",
        "upper_bound",
        "end_time",
        "sticks",
        "sliding_start",
        "undecided",
        "x",
    ] {
        let mut altered = true_one.clone();
        altered["end"]["reason"] = json!(reason);
        refused(&altered, reason);
    }
    let twice = true_one
        .to_string()
        .replacen("\"bits\"", "\"bits\":256,\"bits\"", 1);
    for text in [&twice, "", "[]", "null"] {
        assert!(matches!(check(text), Verdict::Malformed(_)), "{text}");
    }
}

/// A message about long texts repeats no more than their beginnings.
#[test]
fn texts_of_a_megabyte_are_no_certificates() {
    let true_one = certificate();
    let long = "9".repeat(1_000_000);
    for (place, key) in [
        ("", "format"),
        ("", "model"),
        ("", &long),
        ("case", "body"),
        ("case", "r"),
        ("end", "reason"),
        ("end", "t"),
    ] {
        let mut altered = true_one.clone();
        let object = match place {
            "" => &mut altered,
            place => &mut altered[place],
        };
        object[key] = json!(long);
        match check(&altered.to_string()) {
            Verdict::Malformed(why) => assert!(why.len() < 500, "{place} {key}"),
            other => panic!("{place} {key}: {other:?}"),
        }
    }
}

/// A list of the values in the order of the keys does not replace an object with the keys.
#[test]
fn lists_in_place_of_keys_are_no_certificates() {
    let whole = certificate();
    let values =
        |all: &Value, keys: &[&str]| -> Value { keys.iter().map(|key| all[key].clone()).collect() };
    let top = values(
        &whole,
        &["format", "model", "bits", "case", "impacts", "end"],
    );
    let mut end = whole.clone();
    end["end"] = values(&whole["end"], &["reason", "t", "state"]);
    let mut case = whole.clone();
    let keys = [
        "r",
        "e",
        "a",
        "b",
        "inertia",
        "f_o",
        "nu",
        "omega",
        "x",
        "y",
        "theta",
        "vx",
        "vy",
        "vtheta",
        "t_end",
        "v_stick",
        "stop_when_settled",
        "stop_when_sliding",
        "max_impacts",
        "body",
    ];
    case["case"] = values(&whole["case"], &keys);
    let mut segment = whole;
    segment["format"] = json!("snapload-certificate-2");
    segment["impacts"][0] = json!([[2], "0.5", "0.6", "impact 1"]);
    for altered in [top, end, case, segment] {
        let verdict = check(&altered.to_string());
        assert!(matches!(verdict, Verdict::Malformed(_)), "{verdict:?}");
    }
}

/// Numbers that are true to half a unit of their last place, as 0e10 is of all up to 5e9, state
/// nothing: times and states need 20 decimals, and v_n 14 digits, wherever the point is.
#[test]
fn claims_of_few_digits_are_no_certificates() {
    let true_one = certificate();
    let cut = |text: &Value, digits: usize| {
        let text = text.as_str().expect("a decimal");
        let (number, power) = text.split_once('e').unwrap_or((text, ""));
        let number: f64 = number.parse().expect("a number");
        let e = if power.is_empty() { "" } else { "e" };
        json!(format!("{number:.digits$}{e}{power}"))
    };
    let places = [
        "/impacts/0/1",
        "/impacts/20/1",
        "/end/t",
        "/end/state/0",
        "/end/state/5",
    ];
    for (place, few) in places
        .map(|place| (place, 15))
        .into_iter()
        .chain([("/impacts/3/2", 12)])
    {
        let number = true_one.pointer(place).expect("a number");
        for claim in [
            json!("0e10"),
            json!("1e2"),
            json!("0"),
            cut(number, 3),
            cut(number, few),
        ] {
            let mut altered = true_one.clone();
            *altered.pointer_mut(place).expect("a number") = claim.clone();
            let verdict = check(&altered.to_string());
            assert!(
                matches!(verdict, Verdict::Malformed(_)),
                "{place} {claim}: {verdict:?}"
            );
        }
    }
    // A power of ten moves the point of a true number, and nothing else.
    let mut same = true_one.clone();
    let t = same["end"]["t"].as_str().expect("a decimal").to_owned();
    let digits = t.replace('.', "");
    same["end"]["t"] = json!(format!(
        "{digits}e-{}",
        t.len() - 1 - t.find('.').expect("a point")
    ));
    assert!(matches!(check(&same.to_string()), Verdict::Proved { .. }));
}

/// The impact times of a run in doubles, even with zeros after a few decimals, are not those of the
/// standard case.
#[test]
fn times_of_the_ordinary_run_are_refused() {
    let run = Case::new(Parameters::STANDARD).expect("a case").run();
    let true_one: Value = serde_json::from_str(&proof(&case_of("")).text()).expect("JSON");
    for places in [3, 5, 8, 12] {
        let mut altered = true_one.clone();
        for (line, impact) in altered["impacts"]
            .as_array_mut()
            .expect("impacts")
            .iter_mut()
            .zip(run.impacts())
        {
            let zeros = "0".repeat(25 - places);
            line[1] = json!(format!("{:.places$}{zeros}", impact.t));
        }
        let Verdict::Refused(why) = check(&altered.to_string()) else {
            panic!("{places} decimals");
        };
        assert!(why.contains("time of the impact"), "{why}");
    }
}

/// A typed inertia is kept as that decimal, even if its double is that of the size.
#[test]
fn a_typed_inertia_is_kept() {
    let typed = "0.010000000000000002";
    let natural = snapload::natural_inertia(0.1, 0.0);
    assert_eq!(Some(typed.parse().expect("a number")), natural);
    let proof = proof(&case_of(&format!("e=0.5 inertia={typed}")));
    let certificate: Value = serde_json::from_str(&proof.text()).expect("JSON");
    assert_eq!(certificate["case"]["inertia"], json!(typed));
    let untyped = self::certificate();
    assert_eq!(untyped["case"]["inertia"], Value::Null);
}
