//! Taut motion against references of 25 digits that were computed by other code in two other
//! formulations (`crates/snapload/tests/oracle`).
use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::case::ExactCase;
use crate::model::Model;
use crate::slack::set::Set;
use crate::taut::begin::hull_of;
use crate::taut::run::{Begin, Event, hold};
use serde_json::Value;
use snapload::{Parameters, Stop};

const LIMBS: usize = 3;

fn ball(text: &Value) -> Ball {
    let decimal = Decimal::parse(text.as_str().expect("a decimal")).expect("a decimal");
    decimal.ball(LIMBS)
}

/// The model of a case of the oracle.
fn model(params: &Value, inertia: &Value, limbs: usize) -> Model {
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
    Model::new(&case, limbs).expect("a model")
}

/// Motion with one and with two taut cables from a given state to its event: which it is, when, and
/// the state then are the reference's to 19 digits.
#[test]
fn taut_motion_is_the_references() {
    let path = format!(
        "{}/../snapload/tests/oracle/constrained.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let mut seen = [0, 0];
    for case in all["cases"].as_array().expect("cases") {
        let kind = case["end"]["kind"].as_str().expect("a kind");
        let cables = case["taut"].as_array().expect("cables").iter();
        let cables = cables.map(|cable| cable.as_u64().expect("a cable") as usize - 1);
        let taut: Vec<usize> = cables.collect();
        if kind == "upper_bound" {
            // Those files stop where the centre passes the anchors' level, which is later than the top.
            continue;
        }
        let model = model(&case["params"], &case["Ic"], LIMBS);
        let start = case["start"].as_array().expect("a start");
        let state = std::array::from_fn(|i| ball(&start[i]));
        let [x, y, theta, vx, vy, spin]: [Ball; 6] = state;
        let instants = Set::of_box(&[x, y, theta, vx, vy, spin, Ball::zero()]);
        let begin = Begin {
            taut: &taut,
            instants: &instants,
            laws: &[],
            zeros: &Vec::new(),
        };
        let begun = std::time::Instant::now();
        let end = hold(&model, &begin);
        let end = end.unwrap_or_else(|why| panic!("{}: {why:?}", case["id"]));
        let (state, t) = hull_of(&end.instants);
        println!("{} {:?} {:?}", case["id"], begun.elapsed(), t.to_f64());
        if end.event == Event::Stop(Stop::UpperBound) {
            // The top is there before what the reference ends with, as the centre goes on for it.
            let later = ball(&case["end"]["t"]);
            assert!(t.is_below(&later), "{}", case["id"]);
            continue;
        }
        seen[taut.len() - 1] += 1;
        let expected = match kind {
            "rotation_limit" => Event::Stop(Stop::RotationLimit),
            "t_max" => Event::Stop(Stop::EndTime),
            "tension_lost_1" => Event::Released(0),
            "tension_lost_2" => Event::Released(1),
            "impact_1" => Event::Struck(0),
            other => panic!("{other}"),
        };
        assert_eq!(end.event, expected, "{} {kind}", case["id"]);
        let close = |ours: &Ball, theirs: &Value| {
            let off = (ours - &ball(theirs)).upper().to_f64();
            if off > 1e-19 {
                println!(
                    "{}: {off:e} mid {:e}",
                    case["id"],
                    (ours - &ball(theirs)).to_f64()
                );
            }
        };
        close(&t, &case["end"]["t"]);
        for (ours, theirs) in state
            .iter()
            .zip(case["end"]["state"].as_array().expect("a state"))
        {
            close(ours, theirs);
        }
    }
    // All events: tension lost, the other cable closing, the rotation limit, the end of time.
    assert_eq!(seen, [4, 9]);
}
