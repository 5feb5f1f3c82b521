//! Cases of decimals that lie exactly on a border: neither side may be proved. A change of 10⁻²⁰ to
//! one side decides each.
use snapload_certificate::{Certification, Decimal, Ended, ExactCase, Reason, certify};
use std::ops::ControlFlow;

/// A rigid body or a point under a constant force, in exact decimals; values that are not given are
/// zero.
struct Border {
    is_point: bool,
    keys: Vec<(&'static str, String)>,
}

impl Border {
    fn new(is_point: bool, keys: &[(&'static str, &str)]) -> Self {
        let keys = keys.iter().map(|(key, text)| (*key, (*text).to_owned()));
        Self {
            is_point,
            keys: keys.collect(),
        }
    }

    fn with(&self, key: &'static str, text: &str) -> Self {
        let mut keys = self.keys.clone();
        keys.push((key, text.to_owned()));
        Self {
            is_point: self.is_point,
            keys,
        }
    }

    fn proof(&self) -> Certification {
        let decimals = snapload_certificate::NUMBERS.map(|key| {
            let last = self.keys.iter().rev().find(|(name, _)| *name == key);
            Decimal::parse(last.map_or("0", |(_, text)| text)).expect("a decimal")
        });
        let case = ExactCase::new(decimals, None, self.is_point, [true, true], 9);
        let case = case.expect("a legal case");
        let proof = certify(&case, false, &mut |_| ControlFlow::Continue(()));
        proof.expect("not cancelled").expect("a legal start")
    }

    /// How the run ends; none if that is undecided.
    fn end(&self) -> Option<&'static str> {
        match self.proof().end {
            Ended::Proved(reason) => Some(reason.name()),
            Ended::Undecided { .. } => None,
        }
    }
}

/// A point on a cable of the length 5/4, h = 3/4, that reaches D = (−1.2, −0.35) of cable 1 at t =
/// 1/10 with the velocity (0.2752, −0.9614): with n = (−0.96, −0.28) this is v_n n + (0.28, −0.96),
/// v_n = 1/200. The remaining velocity is of magnitude 1, and with f_o = 1.125 the tension is zero:
/// 1 + D·f = 1 − 1.35 + 0.35 = 0.
fn point() -> Border {
    Border::new(
        true,
        &[
            ("r", "1.25"),
            ("e", "0.5"),
            ("f_o", "1.125"),
            ("x", "-0.221895"),
            ("y", "0.49114"),
            ("vx", "0.1627"),
            ("vy", "-0.8614"),
            ("t_end", "0.11"),
            ("v_stick", "0.001"),
        ],
    )
}

#[test]
fn an_end_at_the_instant_of_an_impact_is_undecided() {
    for (t_end, impacts) in [
        ("0.1", None),
        ("0.10000000000000000001", Some(1)),
        ("0.09999999999999999999", Some(0)),
    ] {
        let proof = point().with("t_end", t_end).proof();
        let ended = matches!(proof.end, Ended::Proved(reason) if reason.name() == "end_time");
        assert_eq!(ended.then_some(proof.impacts), impacts, "{t_end}");
    }
}

#[test]
fn a_tension_of_zero_is_undecided() {
    // v_stick is above v_n, so that the tension decides; a little less force makes it positive,
    // from a start that is moved so that place and velocity at t = 1/10 are the same.
    let slow = point().with("v_stick", "0.006");
    assert_eq!(slow.end(), None);
    assert_eq!(slow.with("e", "0").end(), None);
    let pulled = slow
        .with("f_o", "1.1249999999999999999")
        .with("vx", "0.16270000000000000001")
        .with("x", "-0.2218950000000000000005")
        .with("e", "0")
        .proof();
    assert!(
        matches!(pulled.end, Ended::Proved(Reason::Stop(_))),
        "{:?}",
        pulled.end
    );
}

#[test]
fn a_speed_of_v_stick_is_undecided() {
    // With less force there is tension; the start is moved so that the instant is the same.
    let pulled = point()
        .with("f_o", "1")
        .with("vx", "0.1752")
        .with("x", "-0.22252");
    assert_eq!(pulled.with("v_stick", "0.005").end(), None);
    let over = pulled.with("v_stick", "0.00500000000000000001");
    assert_eq!(over.end(), Some("sliding_start"));
    let under = pulled.with("v_stick", "0.00499999999999999999");
    assert_eq!(under.end(), Some("end_time"));
}

/// A rectangle with 1 − a = 0.15, h = 0.2 and r = 0.25 that reaches D = (−0.2, −0.15) of cable 1 at
/// t = 1/10 without rotation, the centre at y = 0.05.
#[test]
fn a_stick_at_the_settling_height_is_undecided() {
    let rectangle = Border::new(
        false,
        &[
            ("r", "0.25"),
            ("a", "0.85"),
            ("b", "0.1"),
            ("x", "-0.04"),
            ("y", "0.055"),
            ("vx", "-0.1"),
            ("t_end", "1"),
            ("v_stick", "1e-6"),
        ],
    );
    assert_eq!(rectangle.end(), None);
    // A smaller x makes the impact earlier and higher, a larger one later and lower.
    let high = rectangle.with("x", "-0.04000000000000000001");
    assert_eq!(high.end(), Some("sliding_start"));
    let low = rectangle.with("x", "-0.03999999999999999999");
    assert_eq!(low.end(), Some("settled"));
}

/// A point thrown up to the anchors' level h = 3/4, which it touches at t = 0.3.
#[test]
fn a_touch_of_the_upper_bound_is_undecided() {
    let thrown = Border::new(
        true,
        &[
            ("r", "1.25"),
            ("e", "0.5"),
            ("y", "0.705"),
            ("vy", "0.3"),
            ("t_end", "0.5"),
            ("v_stick", "1e-6"),
        ],
    );
    assert_eq!(thrown.end(), None);
    assert_eq!(
        thrown.with("y", "0.70500000000000000001").end(),
        Some("upper_bound")
    );
    assert_eq!(
        thrown.with("y", "0.70499999999999999999").end(),
        Some("end_time")
    );
}
