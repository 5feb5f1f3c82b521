//! Certificates of motion with taut cables; the numbers in them are tested beside the proof itself.
use crate::common::case_of;
use serde_json::Value;
use snapload::{Case, Entries, Impact, Parameters, Trajectory};
use snapload_certificate::{Certification, Ended, ExactCase, Verdict, certify, check, check_with};
use std::ops::ControlFlow;

fn proved(exact: &ExactCase) -> Certification {
    let proof = certify(exact, true, &mut |_| ControlFlow::Continue(()));
    proof.expect("not cancelled").expect("a legal start")
}

fn taut(parameters: &Parameters) -> Certification {
    proved(&ExactCase::of(parameters, |_| None).expect("a legal case"))
}

/// A line of a certificate.
enum Line {
    Impact {
        cable: usize,
        t: f64,
        v_n: f64,
    },
    TautSegment {
        mode: Vec<u64>,
        from: f64,
        until: f64,
        event: String,
    },
}

fn lines(proof: &Certification) -> Vec<Line> {
    let number = |value: &Value| value.as_str().and_then(|text| text.parse().ok());
    let certificate: Value = serde_json::from_str(&proof.text()).expect("JSON");
    let lines = certificate["impacts"].as_array().expect("lines").iter();
    let line = |line: &Value| -> Option<Line> {
        Some(if line.is_array() {
            Line::Impact {
                cable: line[0].as_u64()? as usize - 1,
                t: number(&line[1])?,
                v_n: number(&line[2])?,
            }
        } else {
            let mode = line["mode"].as_array()?.iter();
            Line::TautSegment {
                mode: mode.filter_map(Value::as_u64).collect(),
                from: number(&line["from"])?,
                until: number(&line["until"])?,
                event: line["event"].as_str()?.to_owned(),
            }
        })
    };
    lines.map(|each| line(each).expect("a line")).collect()
}

/// The taut cables of each segment, from when to when, and what ends it.
fn taut_segments(lines: &[Line]) -> Vec<(&[u64], f64, f64, &str)> {
    let segments = lines.iter().filter_map(|line| match line {
        Line::TautSegment {
            mode,
            from,
            until,
            event,
        } => Some((mode.as_slice(), *from, *until, event.as_str())),
        Line::Impact { .. } => None,
    });
    segments.collect()
}

/// The changes at the end of each segment: the number of taut cables before, the event, and the
/// cables that are taut afterwards.
fn changes(lines: &[Line]) -> Vec<String> {
    let segments = taut_segments(lines);
    let pairs = segments.windows(2);
    let change = pairs.map(|pair| {
        let [(mode, _, until, event), (next, from, ..)] = [pair[0], pair[1]];
        let then = match next.len() {
            _ if from != until => "none",
            _ if next == mode => "the same",
            2 => "both",
            _ => "another",
        };
        let event = event.split(' ').next().unwrap_or_default();
        format!("{} taut, {event}, then {then}", mode.len())
    });
    change.collect()
}

/// Short runs that slide, rock, snap beside a taut cable and fly again agree with those of the
/// simulator, which uses doubles and another formulation: multipliers in x, y and θ. Each snap has
/// the same cable, time and speed, and both runs end alike.
#[test]
fn taut_runs_are_those_of_the_simulator() {
    let common = "stop_when_settled=false";
    let mut seen = Vec::new();
    for settings in [
        // From rest with both cables closed: rocking, and flight.
        "x=0 y=0 theta=0 vx=0 vtheta=0 vy=0 f_o=0.5 t_end=3.2",
        "x=0 y=0 theta=0 vx=0 vtheta=0 f_o=0.9 nu=1.5 omega=3 vy=0 t_end=1",
        "x=0 y=0 theta=0 vx=0 vy=0.3 vtheta=0 f_o=0 t_end=0.5",
        // A cable that does not rebound, and alternating snaps of both that come to rest together.
        "r=1.2 e=0 a=0.3 b=0.2 f_o=0.6 nu=0 omega=3 x=0 y=0.15 theta=0.1 vx=0 vy=0 vtheta=0.3 v_stick=1e-3 t_end=1.2",
        // Snaps after which a cable that does not rebound carries no tension.
        "e=0 a=0.035710579 b=1.4237125 r=2.9720002 inertia=62.637087 f_o=1.7484259 nu=1 omega=7.0263136e-06 v_stick=0.01 x=-0.33727225 y=0.28457049 vx=-0.92461726 t_end=1.3",
        // A cable that snaps and sticks at the start.
        "body=point r=1.25 e=0 f_o=0.2 x=-0.2 y=0.4 vx=-0.5 t_end=1",
        "r=0.34 a=0.7 b=0.05 inertia=0.5 e=0 f_o=0.7 x=0.0264 y=0.0648 vx=0.4527 vy=0.7494 vtheta=0.973 t_end=0.06",
        // A snap that pulls on the taut cable, which stays so.
        "r=2 e=0.5 a=0.5 b=0.2 f_o=0.8 nu=0 omega=1.5 x=0 y=0.1 theta=0.1 vx=0 vy=0 vtheta=0 v_stick=1e-3 t_end=2.5",
        // Snaps that unload the taut cable, until both come to rest together after alternating
        // snaps.
        "r=2 e=0.2 a=0.3 b=0.4 f_o=0.4 nu=1 omega=3 x=-0.1 y=0.15 theta=-0.2 vx=0.2 vy=0 vtheta=0 v_stick=1e-2 t_end=2.7",
        // Rocking in which a tension is lost, and sliding in which it is.
        "r=1.2 e=0.2 a=0.1 b=0 f_o=1 nu=1 omega=3 x=0.05 y=0.15 theta=0.1 vx=0 vy=0 vtheta=0.3 v_stick=1e-2 t_end=4",
        // Slow snaps of both cables in turn that do not accumulate: a pendulum that passes the
        // corner of two nearly parallel cables, late or at once but quickly, and rows in which a
        // snap comes late.
        "body=point r=500 e=0.5 nu=0 f_o=0.1 omega=1 y=0.00001 t_end=20 v_stick=0.001",
        "body=point r=500 e=0.5 nu=0 f_o=3 omega=13 x=-0.01775 y=0.0001 v_stick=0.01 t_end=3",
        "body=point r=3.1974299 e=0.2012852 nu=-0.57216147 f_o=0.32562538 omega=4.9900259 y=1.1048667e-06 vx=0.017679876 v_stick=0.001679868 t_end=4.0607571",
    ] {
        let settings = format!("{settings} {common}");
        let proof = proved(&case_of(&settings));
        assert!(
            matches!(proof.end, Ended::Proved(_)),
            "{settings}: {:?}",
            proof.end
        );
        let mut entries = Entries::new(&snapload::CASE);
        for setting in settings.split_whitespace() {
            entries.set(setting).expect("a key");
        }
        let parameters = Parameters::from_entries(entries.values("case")).expect("a case");
        let run = Trajectory::record(Case::new(parameters).expect("a legal start").simulation());
        // Where a taut cable only passes an impulse on, the simulator lists it with v_n = 0.
        let snaps = run.impacts().iter().filter(|impact| impact.v_n > 0.0);
        let snaps: Vec<&Impact> = snaps.collect();
        let lines = lines(&proof);
        let ours = lines.iter().filter_map(|line| match line {
            Line::Impact { cable, t, v_n } => Some((*cable, *t, *v_n)),
            Line::TautSegment { .. } => None,
        });
        let ours: Vec<(usize, f64, f64)> = ours.collect();
        assert_eq!(ours.len(), snaps.len(), "{settings}");
        for ((cable, t, v_n), snap) in ours.into_iter().zip(snaps) {
            let off = (t - snap.t).abs().max((v_n - snap.v_n).abs());
            assert!(
                cable == snap.cable && off < 1e-8,
                "{settings}: {t} {v_n} {snap:?}"
            );
        }
        let end: f64 = proof.t.parse().expect("a number");
        assert!(
            (end - run.end().t).abs() < 1e-8,
            "{settings}: {end} {:?}",
            run.end()
        );
        seen.extend(changes(&lines));
    }
    for change in [
        "1 taut, impact, then none",
        "1 taut, impact, then the same",
        "1 taut, impact, then another",
        "1 taut, impact, then both",
        "1 taut, tension, then none",
        "2 taut, tension, then another",
    ] {
        assert!(
            seen.iter().any(|known| known == change),
            "{change}: {seen:?}"
        );
    }
}

/// The sliding example, by its published account: cable 2 is taut from 7.907, cable 1 snaps at
/// 8.008, cable 2 sticks again from about 8.75, and after an accumulation of snaps beside it both
/// hold the body from 8.876 on.
#[test]
fn the_sliding_example_is_proved_into_rocking() {
    let named = snapload::named_case("sliding-example").expect("a built-in case");
    let proof = taut(&Parameters {
        t_end: 8.9,
        ..named.parameters
    });
    assert!(matches!(proof.end, Ended::Proved(_)), "{:?}", proof.end);
    let lines = lines(&proof);
    let segments = taut_segments(&lines);
    let (first, second) = (&segments[0], &segments[1]);
    assert_eq!((first.0, first.3), (&[2][..], "impact 1"));
    assert!((first.1 - 7.907).abs() < 1e-3 && (first.2 - 8.008).abs() < 1e-3);
    assert!(second.0 == [2] && (second.1 - 8.755).abs() < 1e-2);
    let last = segments.last().expect("a segment");
    assert!(
        last.0 == [1, 2] && (last.1 - 8.8765).abs() < 1e-3,
        "{}",
        last.1
    );
}

/// A taut segment is checked again, and is refused if any part of it is altered.
#[test]
fn altered_taut_segments_are_refused() {
    let parameters = Parameters {
        e: 0.0,
        f_o: 0.8,
        stop_when_settled: false,
        t_end: 0.5,
        ..Parameters::STANDARD
    };
    let proof = taut(&parameters);
    assert!(matches!(proof.end, Ended::Proved(_)), "{:?}", proof.end);
    assert_eq!(proof.taut_segments, 1);
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
    // Format 1 has no segments.
    let mut altered = certificate;
    altered["format"] = serde_json::json!("snapload-certificate-1");
    assert!(matches!(check(&altered.to_string()), Verdict::Malformed(_)));
}

/// Cables as far apart as their fairleads are parallel where both are taut, but for horizontal
/// ones: with θ ≠ 0 the distance from anchor to fairlead would differ by 2d between the cables, and
/// both are of one length. No number of bits makes them less parallel, so that none but the first
/// is tried.
#[test]
fn parallel_taut_cables_are_given_up_at_once() {
    let from_rest = Parameters {
        a: 1.0,
        y: 0.0,
        stop_when_settled: false,
        t_end: 1.0,
        ..Parameters::STANDARD
    };
    let snapped = Parameters {
        b: 0.1,
        e: 0.0,
        y: 0.1,
        theta: 0.05,
        ..from_rest
    };
    for (parameters, snaps) in [(from_rest, 0), (snapped, 2)] {
        let parameters = Parameters {
            inertia: snapload::natural_inertia(parameters.a, parameters.b),
            ..parameters
        };
        let proof = taut(&parameters);
        let Ended::Undecided { what, .. } = &proof.end else {
            panic!("{:?}", proof.end);
        };
        assert_eq!(what, "motion on two parallel taut cables");
        assert_eq!((proof.impacts, proof.bits), (snaps, 256));
    }
}

/// A check reports how far it is, and ends when its caller does not let it continue.
#[test]
fn a_check_reports_its_progress() {
    let short = Parameters {
        e: 0.0,
        f_o: 0.8,
        stop_when_settled: false,
        t_end: 0.5,
        ..Parameters::STANDARD
    };
    let text = taut(&short).text();
    let mut times = Vec::new();
    let verdict = check_with(&text, &mut |t, t_end| {
        assert_eq!(t_end, 0.5);
        times.push(t);
        ControlFlow::Continue(())
    });
    assert!(matches!(verdict, Verdict::Proved { .. }), "{verdict:?}");
    assert!(times.len() > 2 && times.is_sorted() && times.iter().all(|t| *t <= 0.5));
    let cancelled = check_with(&text, &mut |_, _| ControlFlow::Break(()));
    assert!(matches!(cancelled, Verdict::Undecided(_)), "{cancelled:?}");
}
