//! The same code of the motion, in several arithmetics, gives the same results.

use crate::common::{exact, keys_of_oracle, oracle};
use serde_json::Value as Json;
use snapload::{
    Case, Dual, Impact, Parameters, Precise, Real, Simulation, State, Steps, named_cases,
};

type Digits = Precise<4>;

fn case(oracle: &Json) -> Case {
    Parameters::from_entries(keys_of_oracle(oracle))
        .and_then(Case::new)
        .expect("a legal case")
}

fn impacts<T: Steps>(mut simulation: Simulation<T>, most: usize) -> Vec<Impact<T>> {
    let mut all = Vec::new();
    while let Some(step) = simulation.step() {
        all.extend(step.impacts());
        if all.len() >= most {
            break;
        }
    }
    all
}

fn components<T: Real>(s: &State<T>) -> [T; 6] {
    [s.x, s.y, s.theta, s.vx, s.vy, s.vtheta]
}

/// The oracle lists 21 decimals, truncated and not rounded, computed by other code; our run with 76
/// digits reproduces every one.
#[test]
fn many_digits_reproduce_the_oracle() {
    for reference in oracle("cases.json") {
        let id = reference["id"].as_str().unwrap_or_default();
        let listed = reference["impacts"].as_array().expect("impacts");
        let simulation = case(&reference).simulation_over(|_, number| Digits::from_decimal(number));
        let ours = impacts(simulation.expect("a legal start"), listed.len());
        assert_eq!(ours.len(), listed.len(), "{id}");
        let mut worst = 0.0_f64;
        for (k, (ours, reference)) in ours.iter().zip(listed).enumerate() {
            let text = |value: &Json| value.as_str().expect("a decimal").to_owned();
            assert_eq!(
                ours.cable as u64 + 1,
                reference["cable"].as_u64().unwrap_or(0),
                "{id} {k}"
            );
            let mut differences = vec![
                ours.t - exact(&text(&reference["t"])),
                ours.v_n - exact(&text(&reference["vn"])),
            ];
            for (state, list) in [
                (&ours.before, &reference["before"]),
                (&ours.after, &reference["after"]),
            ] {
                let list = list.as_array().expect("six");
                differences.extend(
                    components(state)
                        .iter()
                        .zip(list)
                        .map(|(c, t)| *c - exact(&text(t))),
                );
            }
            for difference in differences {
                worst = worst.max(difference.to_f64().abs());
            }
        }
        println!("{id}: {} impacts, worst {worst:e}", ours.len());
        assert!(worst < 1.000001e-21, "{id}: {worst:e}");
    }
}

/// A motion over dual numbers takes the same branches with the same bits.
#[test]
fn dual_numbers_run_the_same_motion() {
    for named in named_cases() {
        let case = Parameters::from_entries(named.entries())
            .and_then(Case::new)
            .expect("a built-in case");
        let dual = case
            .simulation_over(|_, number| Dual::<f64, 1>::constant(number))
            .expect("a legal start");
        let (plain, dual) = (impacts(case.simulation(), 400), impacts(dual, 400));
        assert_eq!(plain.len(), dual.len(), "{}", named.code);
        for (plain, dual) in plain.iter().zip(&dual) {
            assert_eq!(plain.t.to_bits(), dual.t.value.to_bits(), "{}", named.code);
            assert_eq!(
                plain.v_n.to_bits(),
                dual.v_n.value.to_bits(),
                "{}",
                named.code
            );
        }
    }
}
