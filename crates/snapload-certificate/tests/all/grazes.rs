//! Cables that are nearly touched: a hit and a miss are decided, an exact touch is not. Snaps after
//! which a cable has no velocity, and starts at the end of a cable.
use crate::common::{case_of, proof};
use serde_json::{Value, json};
use snapload::{Case, Entries, Parameters, Stop, Trajectory};
use snapload_certificate::{Certification, Ended, Reason, Verdict, certify, check};
use std::ops::ControlFlow;

/// With this start of decimals cable 1 is touched at t = ½ with ġ = 0: by hand, at t = ½ under the
/// force 1 and the weight the point is at (−1/5, 2/5)
/// with velocity (0.14, −0.48); there D = (−1.2, 0.4 − h), h = 3/4, |D| = 5/4, and
/// D·v = −0.168 + 0.168 = 0.
fn touching(y: &str) -> String {
    format!("body=point r=1.25 f_o=1 omega=0 x=-0.145 y={y} vx=-0.36 vy=0.02 t_end=0.6")
}

#[test]
fn a_touch_is_undecided() {
    let touch = proof(&case_of(&touching("0.515")));
    let Ended::Undecided { what, .. } = &touch.end else {
        panic!("{:?}", touch.end);
    };
    assert!(what.contains("length of cable 1"), "{what}");
    assert_eq!(touch.impacts, 0);
    assert!(matches!(
        check(&touch.text()),
        Verdict::ProvedInPart { impacts: 0, .. }
    ));
}

#[test]
fn ten_to_the_minus_38_decides_it() {
    let nines = "9".repeat(35);
    let zeros = "0".repeat(34);
    for (y, hits) in [
        (format!("0.515{zeros}1"), false),
        (format!("0.514{nines}"), true),
    ] {
        assert_eq!(y.len(), 40, "38 decimals");
        let proof = proof(&case_of(&touching(&y)));
        assert!(matches!(proof.end, Ended::Proved(_)), "{:?}", proof.end);
        assert_eq!(proof.impacts > 0, hits);
        if hits {
            assert!(
                proof.text().contains("[[1,\"0.49999999"),
                "{}",
                proof.text()
            );
        }
        assert!(matches!(check(&proof.text()), Verdict::Proved { .. }));
    }
}

/// A symmetric start makes both cables taut at one instant.
#[test]
fn two_at_one_instant_are_undecided() {
    let both = proof(&case_of("f_o=0"));
    assert!(matches!(both.end, Ended::Undecided { .. }));
    assert_eq!(both.impacts, 0);
}

/// Where the body rests within 1e-9 of a gap of zero it is moved by an iteration about
/// which nothing is proved; at x = y = θ = 0 both gaps are zero for every size, and two
/// taut cables so low are settled.
#[test]
fn a_start_next_to_a_cable_is_undecided() {
    let next_to_it = proof(&case_of("y=1e-12 f_o=0.1"));
    assert!(matches!(next_to_it.end, Ended::Undecided { .. }));
    // A cable that opens from there is in flight, with its gap of -8.2e-10.
    let opening = proof(&case_of(
        "body=point f_o=0 x=-0.1 y=0.09823008643133788 vy=0.0001 e=0.5 t_end=0.0003 \
         stop_when_settled=false",
    ));
    let end = Ended::Proved(Reason::Stop(Stop::EndTime));
    assert_eq!((opening.end, opening.impacts), (end, 1));
    let closed = proof(&case_of("y=0 f_o=0.1"));
    assert_eq!(closed.end, Ended::Proved(Reason::Stop(Stop::Settled)));
    assert_eq!(closed.t.parse(), Ok(0.0));
    assert!(matches!(check(&closed.text()), Verdict::Proved { .. }));
}

/// The lines of a certificate, and its state at the end as doubles.
fn statement(proof: &Certification) -> (Vec<Value>, Vec<f64>) {
    let certificate: Value = serde_json::from_str(&proof.text()).expect("JSON");
    let state = certificate["end"]["state"].as_array().expect("a state");
    let number = |text: &Value| text.as_str().expect("text").parse().expect("a number");
    let state = state.iter().map(number).collect();
    (
        certificate["impacts"].as_array().expect("lines").clone(),
        state,
    )
}

/// A point on a cable of the length 5/4, h = 3/4, reaches D = (−1.2, −0.35) of cable 1 at t = 1/10
/// with the velocity (−0.2, −1.1), v_n = 0.192 + 0.308 = 1/2. With e = 0 the velocity (0.28, −0.96)
/// remains, of magnitude 1. With f_o = 2 the cable carries no tension: 1 + D·f = 1 − 2.4 + 0.35 is
/// below zero. It opens with no velocity, and the point is on a parabola again: 0.01 later at
/// (−0.2 + 0.0028 + 0.0001, 0.4 − 0.0096 − 0.00005), with the velocity (0.28 + 0.02, −0.96 − 0.01).
#[test]
fn without_restitution_a_cable_leaves_by_its_acceleration() {
    for e in ["0", "0.0", "-0e5"] {
        let case = case_of(&format!(
            "body=point r=1.25 e={e} f_o=2 omega=0 x=-0.17 y=0.505 vx=-0.4 vy=-1 t_end=0.11"
        ));
        for taut in [false, true] {
            let proof = certify(&case, taut, &mut |_| ControlFlow::Continue(()));
            let proof = proof.expect("not cancelled").expect("a legal start");
            assert_eq!(proof.end, Ended::Proved(Reason::Stop(Stop::EndTime)));
            let (lines, state) = statement(&proof);
            let (t, v_n) = ("0.1000000000000000000000000", "5.0000000000000000e-1");
            assert_eq!(lines, [json!([1, t, v_n])]);
            assert_eq!(state, [-0.1971, 0.39035, 0.0, 0.3, -0.97, 0.0]);
            assert!(matches!(check(&proof.text()), Verdict::Proved { .. }));
        }
    }
}

/// With a = 1/10 and r = 3/2, h = 6/5. At (−0.3, 0.3) cable 1 has D = (−1.2, −0.9), of length 3/2,
/// and n = (−0.8, −0.6). With the velocity (−0.9, 0) it snaps at once, v_n = 0.72, and with (0.9, 0)
/// it opens. A point with r = 5/4, h = 3/4 has n = (−0.96, −0.28) at (−0.2, 0.4). What follows is
/// that of the simulator, in doubles.
#[test]
fn a_start_at_the_end_of_a_moving_cable_is_proved() {
    for (settings, at_once) in [
        ("x=-0.3 y=0.3 vx=-0.9", Some("7.2000000000000000e-1")),
        ("x=-0.3 y=0.3 vx=0.9", None),
        (
            "body=point r=1.25 x=-0.2 y=0.4 vx=-0.5 t_end=2",
            Some("4.8000000000000000e-1"),
        ),
    ] {
        let proof = proof(&case_of(settings));
        let (lines, state) = statement(&proof);
        let first = at_once.map(|v_n| json!([1, "0.0000000000000000000000000", v_n]));
        assert_eq!(
            first,
            first.is_some().then(|| lines[0].clone()),
            "{settings}"
        );
        assert!(matches!(check(&proof.text()), Verdict::Proved { .. }));

        let mut entries = Entries::new(&snapload::CASE);
        for setting in settings.split_whitespace() {
            entries.set(setting).expect("a key");
        }
        let parameters = Parameters::from_entries(entries.values("case")).expect("a case");
        let run = Trajectory::record(Case::new(parameters).expect("a start").simulation());
        assert_eq!(proof.end, Ended::Proved(Reason::Stop(run.end().reason)));
        assert_eq!(run.impacts().len(), lines.len());
        for (ours, theirs) in lines.iter().zip(run.impacts()) {
            let t: f64 = ours[1].as_str().expect("text").parse().expect("a time");
            assert_eq!(ours[0], json!(theirs.cable + 1));
            assert!((t - theirs.t).abs() < 1e-9, "{ours} {theirs:?}");
        }
        let end = run.end().state;
        assert!((state[0] - end.x).abs() < 1e-8 && (state[1] - end.y).abs() < 1e-8);
    }
}

/// A body at rest there is moved by a projection, and so is one that is beyond the cable's end by
/// less than 1e-9; two cables may snap together.
#[test]
fn other_starts_at_the_end_of_a_cable_are_not_covered() {
    for (settings, why) in [
        ("x=-0.3 y=0.3", "how the run starts, with cable 1 closed"),
        ("x=-0.3000000000000000000001 y=0.3 vx=-0.9", "the start: "),
        // With a = 1 the cables are parallel: D = (x, y − h) of both, h = r.
        (
            "a=1 b=0.1 r=1.25 x=0.75 y=0.25 vx=1",
            "how the run starts, with cable 1 closed",
        ),
    ] {
        let proof = proof(&case_of(settings));
        let Ended::Undecided { what, .. } = &proof.end else {
            panic!("{settings}: {:?}", proof.end);
        };
        assert!(what.starts_with(why), "{settings}: {what}");
        assert_eq!(proof.impacts, 0);
    }
    // At y = −0.3 the gap is 1.44, and 4 y² h² the same as at y = 0.3.
    let text = proof(&case_of("x=-0.3 y=0.3 vx=-0.9 t_end=1")).text();
    let below = text.replacen("\"y\":\"0.3\"", "\"y\":\"-0.3\"", 1);
    assert_ne!(below, text);
    let beyond = "the start is beyond the length of cable 1".to_owned();
    assert_eq!(check(&below), Verdict::Refused(beyond));
}
