//! Which cases are accepted, which values are filled in, and how errors are worded.
use proptest::prelude::*;
use snapload::{CaseError, Fault, KEYS, Parameters, Value};

fn given(entries: &[(&str, Value)]) -> Result<Parameters, CaseError> {
    Parameters::from_entries(entries.iter().cloned())
}
fn text(value: &str) -> Value {
    Value::Text(value.to_owned())
}

/// The error of some entries; it has to name the key, the value and what is allowed.
#[track_caller]
fn refused(entries: &[(&str, Value)], key: &str, value: &str, allowed: &str) -> String {
    let error = given(entries).expect_err("was accepted");
    assert_eq!(error.key, key);
    assert_eq!(error.value, value);
    assert!(error.allowed.contains(allowed), "{}", error.allowed);
    let shown = error.to_string();
    for part in [key, value, allowed] {
        assert!(shown.contains(part), "{part} is not in: {shown}");
    }
    shown
}

#[test]
fn nothing_given_is_the_standard_case() {
    assert_eq!(given(&[]).unwrap(), Parameters::STANDARD);
    assert_eq!(Parameters::default(), Parameters::STANDARD);
}

#[test]
fn what_differs_is_the_case() {
    assert_eq!(Parameters::STANDARD.differing(), []);
    let differing = |entries: &[_]| given(entries).unwrap().differing();
    let point = [("y", 0.2.into()), ("body", text("point"))];
    assert_eq!(differing(&point), point);
    // The inertia follows from the size, unless it is given.
    let sized = [("a", 0.2.into())];
    assert_eq!(differing(&sized), sized);
    let odd = [("a", 0.2.into()), ("inertia", 0.01.into())];
    assert_eq!(differing(&odd), odd);
    for case in snapload::named_cases() {
        assert_eq!(
            given(&case.parameters.differing()).unwrap(),
            case.parameters
        );
    }
}

#[test]
fn where_one_looks_first_is_allowed() {
    for key in KEYS {
        for end in key.usual.into_iter().flatten() {
            assert!(
                snapload::check_entry(key.name, &end.into()).is_ok(),
                "{}",
                key.name
            );
        }
    }
}

#[test]
fn inertia_follows_from_the_size_unless_given() {
    let inertia = |entries: &[_]| given(entries).unwrap().inertia.unwrap();
    assert_eq!(inertia(&[("a", 0.2.into())]), 0.2 * 0.2);
    assert_eq!(inertia(&[("b", 0.1.into())]), (0.1 * 0.1 + 0.1 * 0.1) / 3.0);
    assert_eq!(
        inertia(&[("a", 0.0.into()), ("b", 0.3.into())]),
        (0.3 * 0.3) / 3.0
    );
    assert_eq!(inertia(&[("inertia", 0.5.into()), ("a", 0.2.into())]), 0.5);
    assert_eq!(inertia(&[("a", 0.0.into()), ("inertia", 1.into())]), 1.0);
}

#[test]
fn a_body_without_inertia_is_refused() {
    let allowed = "a = 0 and b = 0 determine no inertia";
    refused(&[("a", 0.into())], "inertia", "(left out)", allowed);
    // The square of the value underflows to zero.
    refused(
        &[("a", 1e-200.into())],
        "inertia",
        "(left out)",
        "a = 1e-200",
    );
    refused(
        &[("inertia", 0.into())],
        "inertia",
        "0",
        "1e-12 <= inertia <= 1e6",
    );
}

#[test]
fn a_point_mass_has_no_size_and_no_rotation() {
    let point = ("body", text("point"));
    let p = given(std::slice::from_ref(&point)).unwrap();
    assert_eq!(
        (p.a, p.b, p.inertia, p.get("body")),
        (0.0, 0.0, None, Some(text("point")))
    );
    assert_eq!(p.get("inertia"), None);
    assert!(given(&[point.clone(), ("a", 0.into()), ("theta", 0.0.into())]).is_ok());
    for key in ["a", "b"] {
        refused(
            &[point.clone(), (key, 0.1.into())],
            key,
            "0.1",
            "a point mass",
        );
        refused(&[(key, 0.1.into()), point.clone()], key, "0.1", "no size");
    }
    for key in ["theta", "vtheta"] {
        refused(
            &[point.clone(), (key, 0.1.into())],
            key,
            "0.1",
            "no rotation",
        );
    }
    refused(
        &[point, ("inertia", 0.1.into())],
        "inertia",
        "0.1",
        "no inertia for a point mass",
    );
}

#[test]
fn the_cables_have_to_reach() {
    let shown = refused(
        &[("r", 0.5.into())],
        "r",
        "0.5",
        "r > |1 - a| = 0.9 (a = 0.1)",
    );
    assert!(shown.contains("choose r above 0.9"), "{shown}");
    refused(&[("r", 0.9.into())], "r", "0.9", "r > |1 - a|");
    refused(&[("a", 3.into())], "r", "1.5", "|1 - a| = 2");
    refused(
        &[("body", text("point")), ("r", 1.into())],
        "r",
        "1",
        "|1 - a| = 1",
    );
    assert!(given(&[("r", 0.9000001.into())]).is_ok());
}

#[test]
fn ranges_are_kept() {
    for key in ["e", "a", "b", "r", "t_end"] {
        refused(&[(key, (-0.1).into())], key, "-0.1", &format!("{key} <= "));
    }
    refused(&[("e", 1.01.into())], "e", "1.01", "0 <= e <= 1");
    refused(&[("t_end", 0.into())], "t_end", "0", "0 < t_end <= 1e6");
    refused(
        &[("v_stick", 1e-10.into())],
        "v_stick",
        "1e-10",
        "1e-9 <= v_stick <= 0.01",
    );
    refused(
        &[("v_stick", 0.1.into())],
        "v_stick",
        "0.1",
        "1e-9 <= v_stick <= 0.01",
    );
    refused(
        &[("max_impacts", 0.into())],
        "max_impacts",
        "0",
        "a whole number, 1 <= max_impacts",
    );
    refused(
        &[("max_impacts", 2.5.into())],
        "max_impacts",
        "2.5",
        "a whole number",
    );
    refused(
        &[("max_impacts", (-1).into())],
        "max_impacts",
        "-1",
        "a whole number",
    );
    for key in [
        "f_o", "nu", "omega", "x", "y", "theta", "vx", "vy", "vtheta",
    ] {
        assert!(given(&[(key, (-0.01).into())]).is_ok());
        refused(
            &[(key, 1100.0.into())],
            key,
            "1100",
            &format!("-1000 <= {key} <= 1000"),
        );
    }
    for edge in [
        ("e", 0.0),
        ("e", 1.0),
        ("v_stick", 1e-9),
        ("v_stick", 1e-2),
        ("nu", -1e3),
    ] {
        assert!(given(&[(edge.0, edge.1.into())]).is_ok(), "{edge:?}");
    }
}

#[test]
fn numbers_are_finite() {
    for key in KEYS
        .iter()
        .filter(|key| matches!(key.kind, snapload::Kind::Number { .. }))
    {
        refused(&[(key.name, f64::NAN.into())], key.name, "NaN", "a number");
        refused(
            &[(key.name, f64::INFINITY.into())],
            key.name,
            "inf",
            "a number",
        );
        refused(
            &[(key.name, f64::NEG_INFINITY.into())],
            key.name,
            "-inf",
            "a number",
        );
    }
    refused(
        &[("max_impacts", f64::NAN.into())],
        "max_impacts",
        "NaN",
        "a whole number",
    );
}

#[test]
fn types_are_kept_but_whole_numbers_are_numbers() {
    assert_eq!(given(&[("e", 1.into())]).unwrap().e, 1.0);
    assert_eq!(
        given(&[("max_impacts", 1e6.into())]).unwrap().max_impacts,
        1_000_000
    );
    assert_eq!(given(&[("max_impacts", 7.into())]).unwrap().max_impacts, 7);
    let shown = refused(&[("e", text("0.5"))], "e", "\"0.5\"", "a number");
    assert!(shown.contains("write e = 0.5"), "{shown}");
    let shown = refused(&[("e", text("5,5"))], "e", "\"5,5\"", "a number");
    assert!(!shown.contains("write"), "{shown}");
    refused(&[("e", true.into())], "e", "true", "a number");
    let shown = refused(
        &[("stop_when_settled", 1.into())],
        "stop_when_settled",
        "1",
        "true or",
    );
    assert!(!shown.contains("number"), "{shown}");
    refused(
        &[("stop_when_sliding", text("no"))],
        "stop_when_sliding",
        "\"no\"",
        "false",
    );
    refused(
        &[("body", text("ball"))],
        "body",
        "\"ball\"",
        "\"rigid\" or \"point\"",
    );
    refused(&[("body", 1.into())], "body", "1", "\"rigid\" or \"point\"");
    let shown = refused(&[("body", text("Point"))], "body", "\"Point\"", "\"point\"");
    assert!(shown.contains("write body = \"point\""), "{shown}");
}

#[test]
fn h_is_derived_and_never_given() {
    let shown = refused(
        &[("h", 1.2.into())],
        "h",
        "1.2",
        "h = sqrt(r^2 - (1 - a)^2)",
    );
    assert!(shown.contains("leave h out"), "{shown}");
}

#[test]
fn misspelt_keys_get_the_nearest() {
    for (typo, meant) in [
        ("omgea", "omega"),
        ("Omega", "omega"),
        ("Ω", "omega"),
        ("E", "e"),
        ("I", "inertia"),
        ("f0", "f_o"),
        ("fo", "f_o"),
        ("tend", "t_end"),
        ("t-end", "t_end"),
        ("vy0", "vy"),
        ("max_impact", "max_impacts"),
        ("stop_when_slidng", "stop_when_sliding"),
        ("θ", "theta"),
    ] {
        let error = given(&[(typo, 0.5.into())]).unwrap_err();
        assert_eq!(
            error.fault,
            Fault::UnknownKey {
                nearest: Some(meant)
            },
            "{typo}"
        );
        let shown = error.to_string();
        let parts = [
            typo,
            "0.5",
            &format!("did you mean {meant}?"),
            "stop_when_settled",
        ];
        assert!(parts.iter().all(|part| shown.contains(part)), "{shown}");
    }
    for typo in ["", "zzz", "friction_coefficient", "__"] {
        let error = given(&[(typo, 0.5.into())]).unwrap_err();
        assert_eq!(error.fault, Fault::UnknownKey { nearest: None }, "{typo}");
    }
}

#[test]
fn the_last_value_of_a_key_counts_and_each_is_checked() {
    assert_eq!(
        given(&[("e", 0.5.into()), ("e", 0.7.into())]).unwrap().e,
        0.7
    );
    refused(
        &[("e", 5.into()), ("e", 0.7.into())],
        "e",
        "5",
        "0 <= e <= 1",
    );
}

#[test]
fn a_struct_filled_in_by_hand_is_checked_too() {
    let bad = Parameters {
        e: 2.0,
        ..Parameters::STANDARD
    };
    assert_eq!(bad.check().unwrap_err().key, "e");
    let bad = Parameters {
        max_impacts: 0,
        ..Parameters::STANDARD
    };
    assert_eq!(bad.check().unwrap_err().key, "max_impacts");
    let bad = Parameters {
        max_impacts: u64::MAX,
        ..Parameters::STANDARD
    };
    assert_eq!(bad.check().unwrap_err().key, "max_impacts");
    let bad = Parameters {
        inertia: None,
        ..Parameters::STANDARD
    };
    // Without an inertia it is a point mass, which has no size.
    assert_eq!(bad.check().unwrap_err().key, "a");
}

#[test]
fn the_schema_is_complete_and_explains_its_keys() {
    let promised = "r e a b inertia f_o nu omega x y theta vx vy vtheta t_end v_stick \
                    stop_when_settled stop_when_sliding max_impacts body";
    let mut keys = KEYS.iter();
    for name in promised.split_whitespace() {
        assert!(keys.any(|key| key.name == name), "{name}, in this order");
    }
    for key in KEYS {
        assert!(!key.meaning.is_empty() && !key.default_words().is_empty());
        assert!(
            key.allowed().contains(key.name) || !matches!(key.kind, snapload::Kind::Number { .. })
        );
        let (name, default) = (key.name, key.default.value());
        let Some(value) = Parameters::STANDARD.get(name) else {
            assert!(default.is_none(), "{name}");
            continue;
        };
        assert!(default.is_none_or(|default| default == value), "{name}");
        assert!(given(&[(name, value)]).is_ok(), "{name}");
    }
}

fn value() -> impl Strategy<Value = Value> {
    prop_oneof![
        any::<f64>().prop_map(Value::Number),
        (-2.0..2.0).prop_map(Value::Number),
        any::<i64>().prop_map(Value::Integer),
        any::<bool>().prop_map(Value::Bool),
        any::<String>().prop_map(Value::Text),
    ]
}

fn known_or_not() -> impl Strategy<Value = String> {
    let known = prop::sample::select(
        KEYS.iter()
            .map(|key| key.name.to_owned())
            .collect::<Vec<_>>(),
    );
    prop_oneof![4 => known, 1 => any::<String>()]
}

proptest! {
    #[test]
    fn anything_is_accepted_or_refused_in_words(
        entries in prop::collection::vec((known_or_not(), value()), 0..6),
    ) {
        match Parameters::from_entries(entries) {
            Ok(p) => prop_assert!(p.check().is_ok()),
            Err(error) => {
                let shown = error.to_string();
                prop_assert!(shown.lines().count() <= 2, "{}", shown);
                prop_assert!(!shown.chars().any(|c| c.is_control() && c != '\n'), "{:?}", shown);
            }
        }
    }

    #[test]
    fn the_echo_of_a_case_gives_the_case_back(
        (a, b, slack) in (0.0..1e3_f64, 0.0..1e3_f64, 0.01..1.0_f64), point in any::<bool>(),
    ) {
        let mut entries = vec![];
        if point {
            entries.push(("body", text("point")));
            entries.push(("r", Value::Number(1.0 + slack)));
        } else {
            entries.extend([("a", a.into()), ("b", b.into()), ("r", ((1.0 - a).abs() + slack).min(1e3).into())]);
        }
        if let Ok(p) = Parameters::from_entries(entries) {
            let echo = p.entries().filter_map(|(key, value)| Some((key, value?)));
            prop_assert_eq!(Parameters::from_entries(echo).unwrap(), p);
            let differing = p.differing();
            prop_assert!(differing.len() <= 3, "{:?}", differing);
            prop_assert_eq!(Parameters::from_entries(differing).unwrap(), p);
        }
    }

    #[test]
    fn any_code_is_known_or_refused(code in any::<String>()) {
        if let Err(error) = snapload::named_case(&code) {
            prop_assert!(error.to_string().contains("1910001000-359") || error.to_string().contains("example")
                || error.to_string().contains("1000-"));
        }
    }
}
