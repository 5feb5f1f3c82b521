//! Taut motion against references of 25 digits that were computed by other code in two other
//! formulations (`crates/snapload/tests/oracle`).
use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::case::ExactCase;
use crate::model::Model;
use crate::taut::run::{Begin, Event, slide};
use serde_json::Value;
use snapload::{Parameters, Stop};

const LIMBS: usize = 3;

fn ball(text: &Value) -> Ball {
    let decimal = Decimal::parse(text.as_str().expect("a decimal")).expect("a decimal");
    decimal.ball(LIMBS)
}

/// The model of a case of the oracle.
fn model(params: &Value, inertia: &Value) -> Model {
    let number = |key: &str| -> f64 {
        params[key]
            .as_str()
            .expect("text")
            .parse()
            .expect("a number")
    };
    let parameters = Parameters {
        r: number("r"),
        a: number("a"),
        b: number("b"),
        f_o: number("f0"),
        omega: number("Om"),
        nu: number("nu"),
        t_end: 10.0,
        inertia: Some(inertia.as_str().expect("text").parse().expect("a number")),
        ..Parameters::STANDARD
    };
    let natural = snapload::natural_inertia(parameters.a, parameters.b).expect("a size");
    assert!((parameters.inertia.expect("given") / natural - 1.0).abs() < 1e-14);
    let parameters = Parameters {
        inertia: Some(natural),
        ..parameters
    };
    let case = ExactCase::of(&parameters, |_| None).expect("a legal case");
    Model::new(&case, LIMBS).expect("a model")
}

/// Motion with one taut cable from a given state to its event: which it is, when, and the state then
/// are the reference's to 20 digits.
#[test]
fn sliding_is_the_references() {
    let path = format!(
        "{}/../snapload/tests/oracle/constrained.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let mut seen = 0;
    for case in all["cases"].as_array().expect("cases") {
        let kind = case["end"]["kind"].as_str().expect("a kind");
        let cable = case["taut"][0].as_u64().expect("a cable") as usize - 1;
        if case["mode"] != "sliding" || kind == "upper_bound" {
            // Those files stop where the centre passes the anchors' level, which is later than the top.
            continue;
        }
        let model = model(&case["params"], &case["Ic"]);
        let start = case["start"].as_array().expect("a start");
        let state = std::array::from_fn(|i| ball(&start[i]));
        let begin = Begin {
            cable,
            t: &Ball::zero(),
            state: &state,
            other_opens: false,
        };
        let end = slide(&model, &begin).unwrap_or_else(|why| panic!("{}: {why:?}", case["id"]));
        if end.event == Event::Stop(Stop::UpperBound) {
            // The top is there before what the reference ends with, as the centre goes on for it.
            let later = ball(&case["end"]["t"]);
            assert!(end.t.is_below(&later), "{}", case["id"]);
            continue;
        }
        seen += 1;
        let expected = match kind {
            "rotation_limit" => Event::Stop(Stop::RotationLimit),
            _ if kind.starts_with("tension_lost") => Event::Released,
            _ => Event::Struck,
        };
        assert_eq!(end.event, expected, "{} {kind}", case["id"]);
        let close = |ours: &Ball, theirs: &Value| {
            let off = (ours - &ball(theirs)).upper().to_f64();
            assert!(off < 1e-19, "{}: {off:e}", case["id"]);
        };
        close(&end.t, &case["end"]["t"]);
        for (ours, theirs) in end
            .state
            .iter()
            .zip(case["end"]["state"].as_array().expect("a state"))
        {
            close(ours, theirs);
        }
    }
    // All three events: tension lost, the other cable closing, the rotation limit.
    assert_eq!(seen, 4);
}
