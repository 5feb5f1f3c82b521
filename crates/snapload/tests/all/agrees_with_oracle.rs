//! Trajectories computed to 60 digits and more by independent code (`tests/oracle/README.md`).

use crate::common::{breakwater, distance, number, oracle, state};
use snapload::{Limit, Rules, Simulation, Stop, Trajectory};

/// How far a run in doubles may be from the truth at an impact: 1e-9 as long as the oracle's own
/// run in doubles is within 1e-10, after that a hundred times the largest error that the latter has
/// had.
fn allowed(running_maximum: f64) -> f64 {
    if running_maximum < 1e-10 {
        1e-9
    } else {
        f64::max(1e-9, 100.0 * running_maximum)
    }
}

#[test]
fn every_impact_agrees_up_to_the_horizon() {
    for case in oracle("cases.json") {
        let id = case["id"].as_str().unwrap_or_default();
        let run = breakwater(&case).run();
        let listed = case["impacts"].as_array().expect("impacts");
        let horizon = &case["horizon_double"];
        let first_wrong = horizon["first_impact_rel_gt_1e_6"].as_u64();
        let differences = horizon["rel_difference"].as_array().expect("differences");
        let mut worst = 0.0_f64;
        let mut running = 0.0_f64;
        let mut compared = 0;
        for (k, reference) in listed.iter().enumerate() {
            if first_wrong.is_some_and(|first| k as u64 + 1 >= first) {
                break;
            }
            running = running.max(differences.get(k).map_or(0.0, number));
            let limit = allowed(running);
            let ours = run
                .impacts()
                .get(k)
                .unwrap_or_else(|| panic!("{id}: no impact {k}"));
            assert_eq!(
                ours.cable + 1,
                reference["cable"].as_u64().unwrap_or(0) as usize,
                "{id} {k}"
            );
            let off = [
                (ours.t - number(&reference["t"])).abs(),
                (ours.v_n - number(&reference["vn"])).abs(),
                distance(&ours.before, &state(&reference["before"])),
                distance(&ours.after, &state(&reference["after"])),
            ]
            .into_iter()
            .fold(0.0, f64::max);
            assert!(
                off <= limit,
                "{id}: impact {} is off by {off:e} > {limit:e}",
                k + 1
            );
            worst = worst.max(off / limit);
            compared += 1;
        }
        println!("{id}: {compared} impacts compared, worst at {worst:.3} of what is allowed");
        assert!(compared > 0);
    }
}

#[test]
fn ends_agree() {
    for case in oracle("cases.json") {
        let id = case["id"].as_str().unwrap_or_default();
        let mut it = breakwater(&case);
        it.stop_when_sliding = true;
        let run = it.run();
        let kind = case["end"]["kind"].as_str().unwrap_or_default();
        let reason = run.end().reason.name();
        let decided = case["horizon_double"]["first_impact_rel_gt_1e_6"].is_null();
        println!("{id}: {kind} / {reason} (decided: {decided})");
        if decided {
            assert_eq!(reason, kind, "{id}");
            let t = number(&case["end"]["t"]);
            assert!((run.end().t - t).abs() < 1e-6, "{id}: {} {t}", run.end().t);
        }
    }
}

#[test]
fn grazes_are_neither_missed_nor_invented() {
    for case in oracle("grazing.json") {
        let id = case["id"].as_str().unwrap_or_default();
        let run = breakwater(&case).run();
        let reference = case["impacts"].as_array().expect("impacts");
        println!(
            "{id}: {:?} {:?}",
            run.impacts()
                .iter()
                .map(|i| (i.t, i.v_n))
                .collect::<Vec<_>>(),
            run.end()
        );
        assert_eq!(run.impacts().len(), reference.len(), "{id}");
        for (ours, reference) in run.impacts().iter().zip(reference) {
            let v_n = number(&reference["vn"]);
            let t_error = (ours.t - number(&reference["t"])).abs();
            assert!(
                t_error <= 1e-13 + 1e-15 / v_n,
                "{id}: {t_error:e} at v_n = {v_n:e}"
            );
        }
        // The touch at 1e-13 has v_n < 1e-6 without tension: the flight goes on (docs/model.md
        // section 6), where the file stops by the bare rule.
        assert_eq!(run.end().reason, Stop::RotationLimit, "{id}");
        if case["end"]["kind"] == "rotation_limit" {
            let t = number(&case["end"]["t"]);
            assert!((run.end().t - t).abs() < 1e-9, "{id}");
        }
    }
}

#[test]
fn taut_motion_agrees() {
    let mut worst = 0.0_f64;
    for case in oracle("constrained.json") {
        let id = case["id"].as_str().unwrap_or_default();
        // The oracle stops where the body's *centre* reaches the anchors' level, later than our
        // rule.
        let it = breakwater(&case);
        let rules = Rules {
            limits: it.rules().limits.with(Limit::UpperBound, None),
            settled_below: None,
            ..it.rules()
        };
        let simulation = Simulation::new(it.system(), rules, 0.0, it.start);
        let run = Trajectory::record(simulation.expect("a legal start"));
        let taut: Vec<u64> = case["taut"]
            .as_array()
            .expect("taut")
            .iter()
            .filter_map(|v| v.as_u64())
            .collect();
        assert_eq!(
            run.modes()[0]
                .taut
                .iter()
                .map(|c| c as u64 + 1)
                .collect::<Vec<_>>(),
            taut,
            "{id}"
        );
        let t_event = end_of_motion(&case, &run, id);
        let mut compared = 0;
        for row in case["rows"].as_array().expect("rows") {
            let t = number(&row["t"]);
            if t >= t_event {
                break;
            }
            let motion = run.at(t);
            let mut off = distance(&motion.state, &state(&row["state"]));
            for cable in 0..2 {
                let tension = &row[["T1", "T2"][cable]];
                let reference = if tension.is_null() {
                    0.0
                } else {
                    number(tension)
                };
                off = off.max((motion.tensions[cable] - reference).abs());
            }
            assert!(off < 1e-12, "{id}: off by {off:e} at t = {t}");
            worst = worst.max(off);
            compared += 1;
        }
        println!("{id}: {compared} rows to t = {t_event}");
        assert!(compared > 0, "{id}");
    }
    println!("worst {worst:e}");
}

/// The instant at which the oracle's motion ends: tension is lost, the other cable closes or a
/// limit is reached. Our own must be the same.
fn end_of_motion(case: &serde_json::Value, run: &Trajectory, id: &str) -> f64 {
    let end = number(&case["end"]["t"]);
    let kind = case["end"]["kind"].as_str().unwrap_or_default();
    let first = run.modes()[0].t_end;
    let ours = match kind {
        "t_max" => first.min(end),
        "impact_1" | "impact_2" => run.impacts()[0].t,
        "upper_bound" => return first.min(end),
        _ => first,
    };
    assert!(
        (ours - end).abs() < 1e-10,
        "{id}: {kind} at {ours}, oracle {end}"
    );
    ours
}
