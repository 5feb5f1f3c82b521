//! Cables that are nearly touched: a hit and a miss are decided, an exact touch is not.
use crate::common::{case_of, proof};
use snapload::Stop;
use snapload_certificate::{Ended, Reason, Verdict, check};

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
