//! Branches along the length of a cable that is taut at the section: the state has to follow the
//! circle on which the cable holds it.

use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{Branch, BranchOptions, Moored, Orbit, OrbitRequest};

/// A case, the state of its orbit at the section, and the key that is followed within a range.
struct Taut {
    case: Parameters,
    start: [f64; 6],
    key: &'static str,
    range: [f64; 2],
}

/// A point mass that snaps cable 1 while cable 2 is taut all the time, and a body that rocks on
/// both cables.
fn taut_at_the_section() -> [Taut; 2] {
    let point = Parameters {
        inertia: None,
        a: 0.0,
        r: 1.4,
        e: 0.9,
        f_o: 0.3,
        nu: 0.0,
        omega: 3.0,
        ..Parameters::STANDARD
    };
    let [x, y] = [0.152_892_545_316_979_63, 0.185_542_298_473_305_3];
    let [vx, vy] = [0.358_909_657_629_449_5, 0.520_972_482_128_884_4];
    let rocking = Parameters {
        f_o: 0.1,
        ..Parameters::STANDARD
    };
    [
        Taut {
            case: point,
            start: [x, y, 0.0, vx, vy, 0.0],
            key: "r",
            range: [1.39, 1.41],
        },
        Taut {
            case: rocking,
            start: [
                0.023_388_602_074_676_135,
                0.001_528_867_902_463_645_9,
                -0.176_863_345_924_053_73,
                0.010_081_729_489_127_347,
                0.001_334_669_488_367_242_3,
                -0.077_511_890_796_405_98,
            ],
            key: "a",
            range: [0.09, 0.1005],
        },
    ]
}

/// Every point of such a branch is an orbit that the search finds at that length by itself, and
/// admissible: the gaps of its taut cables are closed to rounding.
#[test]
fn branches_follow_lengths_of_taut_cables() {
    for Taut {
        case,
        start,
        key,
        range,
    } in taut_at_the_section()
    {
        let keys = [Some(key), None];
        let family = Moored::case(case, keys);
        let at = Moored::values(&case, keys);
        let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).expect("an orbit");
        let options = BranchOptions {
            range,
            step: 0.02,
            most: 200,
        };
        let branch = Branch::of(&family, &orbit, &options, &no_progress).expect("a branch");
        let ends = branch.ends.each_ref().map(|end| end.because.as_str());
        assert_eq!(ends, ["the end of the range"; 2], "{key}");
        assert!(
            branch.points.len() < 60,
            "{} points along {key}",
            branch.points.len()
        );
        for point in &branch.points {
            let Orbit { at, z, .. } = &point.orbit;
            assert_eq!(
                point.orbit.why_not,
                Vec::<String>::new(),
                "{key} = {}",
                at[0]
            );
            let alone = Orbit::find(&family, *at, z, &OrbitRequest::default());
            let alone = alone.expect("an orbit");
            let apart = alone.z.iter().zip(z).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f64::max);
            assert!(apart < 1e-12, "{key} = {}: {apart:e}", at[0]);
        }
    }
}
