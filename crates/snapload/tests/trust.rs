//! What the program says of its own results, against what many digits and the oracle show.

mod common;

use common::{number, oracle};
use serde_json::Value as Json;
use snapload::analysis::{Doubt, trusted_run, verify};
use snapload::{Case, Parameters, Value, named_cases};

fn case(oracle: &Json) -> Case {
    let keys = [
        ("r", "r"),
        ("e", "e"),
        ("a", "a"),
        ("b", "b"),
        ("f_o", "f0"),
        ("nu", "nu"),
        ("omega", "Om"),
    ];
    let given = keys.iter().filter_map(|(ours, theirs)| {
        Some((*ours, Value::Number(number(oracle["params"].get(theirs)?))))
    });
    Parameters::from_entries(given)
        .and_then(Case::new)
        .expect("a legal case")
}

#[test]
fn oracle_horizons() {
    for (truth, growth) in oracle("cases.json").iter().zip(oracle("growth.json")) {
        let id = truth["id"].as_str().unwrap_or_default();
        let case = case(truth);
        let v = verify(&case, 60, 1e-6, |_| {}).expect("legal");
        let none = v.run.impacts().len() + 1;
        let theirs = truth["horizon_double"]["first_impact_rel_gt_1e_6"].as_u64();
        let fromgrowth = growth["horizon_double_from_growth"].as_u64();
        println!(
            "{id}: predicted {:?} proven {:?} oracle {:?} growth {:?} of {} ({} exact) left {:.1} grazes {:?}",
            v.trust.horizon.map(|h| (h.impact, h.loss)),
            v.proven,
            theirs,
            fromgrowth,
            none - 1,
            v.impacts,
            v.digits_left,
            v.trust.grazes.len()
        );
    }
}
