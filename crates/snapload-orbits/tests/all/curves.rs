//! Curves of special orbits in two keys, against closed forms and against branches in one key.

use crate::closed_forms::{bouncing, bouncing_from, table};
use crate::common::{parameters, reference, tori};
use snapload::analysis::no_progress;
use snapload_orbits::{
    Branch, BranchEvent, BranchOptions, Curve, CurveOptions, CurvePoint, Family, Kind, Moored,
    Orbit, OrbitRequest, Stability, distance,
};
use std::f64::consts::PI;

fn curve<F: Family>(family: &F, event: &BranchEvent, ranges: [[f64; 2]; 2], step: f64) -> Curve {
    let options = CurveOptions {
        ranges,
        step,
        most: 400,
    };
    let curve = Curve::of(family, event, &options, &no_progress)
        .unwrap()
        .unwrap();
    for end in &curve.ends {
        println!(
            "{} ends at {:?}: {}",
            curve.kind.name(),
            end.at,
            end.because
        );
    }
    println!("{} points", curve.points.len());
    curve
}

/// The Γ from which one bounce in each n periods exists, and at which it doubles its period (P. J.
/// Holmes, *J. Sound Vib.* 84 (1982) 173; J. M. Luck & A. Mehta, *Phys. Rev. E* 48 (1993) 3988).
fn of_the_table(e: f64, n: u32) -> [f64; 2] {
    let existence = f64::from(n) * PI * (1.0 - e) / (1.0 + e);
    [
        existence,
        existence.hypot(2.0 * (1.0 + e * e) / (1.0 + e).powi(2)),
    ]
}

#[test]
fn the_ball_on_a_table_has_its_curves() {
    let family = table(4000.0, 3.0);
    let (e, n) = (0.5, 1);
    let [existence, doubles] = of_the_table(e, n);
    let orbit = bouncing(&family, [0.5 * (existence + doubles), e], n);
    let options = BranchOptions {
        range: [0.5 * existence, 1.1 * doubles],
        step: 0.02,
        most: 400,
    };
    let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
    for (kind, which) in [(Kind::Fold, 0), (Kind::PeriodDoubling, 1)] {
        let event = branch.event(kind, None).unwrap();
        let found = curve(&family, event, [[0.0, 5.0], [0.2, 0.95]], 0.02);
        let off = found.points.iter().map(|point| {
            let [gamma, e] = point.orbit.at;
            (gamma - of_the_table(e, n)[which]).abs()
        });
        let worst = off.fold(0.0, f64::max);
        println!("{} off by {worst:e}", kind.name());
        assert!(worst < 1e-10);
        // It is followed to both ends of the range, and ends exactly there.
        let mut ends = found.ends.each_ref().map(|end| end.at[1]);
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [0.2, 0.95]);
        assert!(
            found
                .ends
                .iter()
                .all(|end| end.because == "the end of the range")
        );
        assert!(found.points.len() > 20);
    }
}

/// Along the branch through a fold the multiplier is 1 + 2aξ, where ξ is the distance of the orbit
/// from the fold; beyond a doubling the two laps are at distance η from the orbit with c η² = −1 −
/// μ, where μ is the multiplier of the orbit there. The section is half a period off, as the ball
/// strikes at a whole period where it folds.
#[test]
fn coefficients_are_those_of_the_branches() {
    let family = table(20.0, 3.0);
    let e = 0.5;
    let [existence, doubles] = of_the_table(e, 1);
    let orbit = bouncing_from(&family, [0.5 * (existence + doubles), e], 1, 0.5);
    let mut options = BranchOptions {
        range: [0.5 * existence, 1.1 * doubles],
        step: 0.002,
        most: 2000,
    };
    let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
    let first =
        |event| curve(&family, event, [[0.0, 5.0], [0.499, 0.501]], 0.002).points[0].clone();
    let fold = branch.event(Kind::Fold, None).unwrap();
    let point = first(fold);
    let beside = branch.points.iter().map(|beside| {
        let of_vertical = |[re, im]: &[f64; 2]| *im == 0.0 && (re - 1.0).abs() < 0.3;
        let values = beside.orbit.multipliers.values.iter();
        let mu = values
            .filter(|value| of_vertical(value))
            .map(|value| value[0]);
        let nearest = mu.min_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs()));
        let square = beside
            .orbit
            .z
            .iter()
            .zip(&fold.orbit.z)
            .map(|(a, b)| (a - b).powi(2));
        (square.sum::<f64>().sqrt(), nearest)
    });
    let near = beside.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let expected = (near.1.unwrap() - 1.0).abs() / (2.0 * near.0);
    let found = point.coefficient.unwrap().abs();
    println!("fold: {found} {expected}");
    assert!((found / expected - 1.0).abs() < 0.03);

    let doubling = branch.event(Kind::PeriodDoubling, None).unwrap();
    let found = first(doubling).coefficient.unwrap();
    assert!(found > 0.0);
    options.step = 0.001;
    options.most = 20;
    let twice = Branch::of_doubling(&family, doubling, &options, &no_progress)
        .unwrap()
        .unwrap();
    let apart = &twice.points[4].orbit;
    let parent = bouncing_from(&family, apart.at, 1, 0.5);
    let mu = parent.multipliers.values.iter().map(|value| value[0]);
    let mu = mu.fold(f64::INFINITY, f64::min);
    let square = apart.z.iter().zip(&parent.z).map(|(a, b)| (a - b).powi(2));
    let expected = (-1.0 - mu) / square.sum::<f64>();
    println!("doubling: {found} {expected} {mu}");
    assert!((found / expected - 1.0).abs() < 0.05);
    // No more than neutral, as the transverse motion is never damped.
    assert_eq!(apart.multipliers.stability().name(), "neutral");
}

/// The same point found with the second key held.
fn agrees(name: &str, key: &'static str, kind: Kind, point: &CurvePoint, range: f64) {
    let base = parameters(&reference()["branches"][usize::from(name == "B")]["base"]);
    let family = Moored::case(base, [Some("f_o"), Some(key)]);
    let [f_o, _] = point.orbit.at;
    let aside = [1.0 + range, 1.0 - range].into_iter().find_map(|by| {
        let at = [f_o * by, point.orbit.at[1]];
        let orbit = Orbit::find(&family, at, &point.orbit.z, &OrbitRequest::default()).ok()?;
        let same = orbit.lap.sequence.struck().len() == point.orbit.lap.sequence.struck().len();
        same.then_some(orbit)
    });
    let options = BranchOptions {
        range: [f_o * (1.0 - 1.5 * range), f_o * (1.0 + 1.5 * range)],
        step: 0.01,
        most: 500,
    };
    let branch = Branch::of(&family, &aside.unwrap(), &options, &no_progress).unwrap();
    let of_kind = branch.events.iter().filter(|event| event.kind == kind);
    let off = of_kind.map(|event| {
        (event.value[0] - f_o).abs() + distance(&event.orbit.z, &point.orbit.z) * 1e-3
    });
    let off = off.fold(f64::INFINITY, f64::min);
    println!("{name} {} {:?}: {off:e}", kind.name(), point.orbit.at);
    assert!(
        off < 1e-8,
        "{name} {} {:?}: off by {off:e}",
        kind.name(),
        point.orbit.at
    );
}

#[test]
fn curves_of_the_breakwater_are_those_of_branches() {
    for (name, key, kind, around, other) in [
        ("A", "omega", Kind::Fold, [1.0, 2.0], [2.9, 3.3]),
        ("A", "e", Kind::PeriodDoubling, [1.0, 2.5], [0.3, 0.4]),
        ("B", "e", Kind::NeimarkSacker, [0.8, 2.5], [0.5, 0.65]),
        ("B", "nu", Kind::Graze, [0.8, 2.5], [0.9, 1.1]),
        ("B", "r", Kind::PeriodDoubling, [0.8, 2.5], [1.55, 1.65]),
    ] {
        let base = parameters(&reference()["branches"][usize::from(name == "B")]["base"]);
        let start = match name {
            "A" => [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0],
            _ => [-0.0086, 0.7632, 0.0, 1.0527, -0.7738, 0.0],
        };
        let keys = [Some("f_o"), Some(key)];
        let family = Moored::case(base, keys);
        let at = Moored::values(&base, keys);
        let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
        let options = BranchOptions {
            range: around,
            step: 0.02,
            most: 2000,
        };
        let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
        let event = branch.event(kind, None).unwrap();
        let found = curve(&family, event, [around, other], 0.01);
        assert!(found.points.len() > 5);
        let last = found.points.len() - 1;
        for k in [0, last / 3, last] {
            let point = &found.points[k];
            if point.orbit.is_admissible() || kind != Kind::Graze {
                agrees(name, key, kind, point, 0.02);
            }
        }
        if kind == Kind::Graze {
            let a = found.points[0].normal_acceleration.unwrap();
            assert!(a > 0.0 && found.points[0].sqrt_coefficient.unwrap() > 0.0);
        }
    }
}

/// The special orbits of the point mass of the reference along f_o and another key, the curve of
/// which ends at a border of the key.
fn of_the_point_mass(kind: Kind, key: &'static str, range: [f64; 2]) -> Curve {
    let base = parameters(&reference()["branches"][0]["base"]);
    let keys = [Some("f_o"), Some(key)];
    let family = Moored::case(base, keys);
    let start = [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0];
    let at = Moored::values(&base, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let options = BranchOptions {
        range: [1.0, 2.0],
        step: 0.02,
        most: 2000,
    };
    let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
    let event = branch.event(kind, None).unwrap();
    curve(&family, event, [[1.0, 2.0], range], 0.01)
}

/// Computed in 40 and in 90 digits by other code, from differences of the composed map itself, at
/// the orbits where curves end at a border of the second key. The least singular value is between
/// 1e-17 and 1e-13 there, and the left vectors of a decomposition by nalgebra 0.35 may be wrong.
#[test]
fn coefficients_are_those_of_many_digits() {
    for (kind, key, border, known) in [
        (Kind::Fold, "omega", 2.6, 39.615_080_611_8),
        (Kind::Fold, "omega", 2.75, 4.963_066_448_09),
        (Kind::Fold, "omega", 2.85, 3.218_961_577_16),
        (Kind::Fold, "nu", 0.2, -2.814_004_159_28),
        (Kind::Fold, "nu", 0.3, -2.857_981_981_37),
        (Kind::Fold, "nu", 0.4, -2.912_835_697_72),
        (Kind::Fold, "nu", 0.5, -2.981_015_063_36),
        (Kind::PeriodDoubling, "omega", 2.9, 2.459_493_560_59),
        (Kind::PeriodDoubling, "omega", 3.0, 2.917_239_705_19),
    ] {
        let high = if key == "nu" { 2.0 } else { 3.5 };
        let found = of_the_point_mass(kind, key, [border, high]);
        let mut points = found.points.iter();
        let point = points.find(|point| point.orbit.at[1] == border).unwrap();
        let value = point.coefficient.unwrap();
        let off = (value.abs() / f64::abs(known) - 1.0).abs();
        println!("{} {key} = {border}: {value}, off by {off:e}", kind.name());
        let most = if kind == Kind::Fold { 1e-10 } else { 1e-8 };
        assert!(off < most, "{} {key} = {border}: {value}", kind.name());
    }
}

/// The coefficient of folds belongs to eigenvectors that point alike along the curve: between
/// points that are near each other it changes little, and its sign only through zero, at a
/// cusp, or through infinity, where a second multiplier is 1. Computed in 60 digits by other
/// code, with eigenvectors of positive x, it is 2.76588 and 5.1487 at two points of this
/// curve, and has no cusp between.
#[test]
fn coefficients_of_folds_have_a_sign_along_the_curve() {
    let found = of_the_point_mass(Kind::Fold, "omega", [2.5, 3.5]);
    let known: Vec<f64> = found
        .points
        .iter()
        .map(|point| point.coefficient.unwrap())
        .collect();
    let small = |a: &f64| a.abs() < 8.0;
    let pairs = known.windows(2).filter(|pair| pair.iter().all(small));
    for pair in pairs.clone() {
        assert!((pair[0] - pair[1]).abs() < 2.0, "{known:?}");
    }
    assert!(pairs.count() > 15, "{known:?}");
    let near = |value: f64| known.iter().any(|a| (a.abs() / value - 1.0).abs() < 0.1);
    assert!(near(2.76588) && near(5.1487), "{known:?}");
}

/// A Neimark-Sacker curve ends where both multipliers of its pair are 1 or -1. That is a point of
/// the curve, and the same one whatever its steps.
#[test]
fn a_curve_of_tori_ends_at_its_resonance() {
    let (case, start) = tori();
    let keys = [Some("omega"), Some("e")];
    let family = Moored::case(case, keys);
    let at = Moored::values(&case, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let options = BranchOptions {
        range: [1.5, 5.0],
        step: 0.01,
        most: 500,
    };
    let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
    let event = branch.event(Kind::NeimarkSacker, None).unwrap();
    let ends = [0.01, 0.03].map(|step| {
        let curve = curve(&family, event, [[1.5, 5.0], [0.1, 1.0]], step);
        let mut both = [curve.points.first(), curve.points.last()].map(|point| {
            let orbit = &point.unwrap().orbit;
            let sizes = orbit.multipliers.values.iter();
            let at = sizes.filter(|[re, im]| (re.abs() - 1.0).hypot(*im) < 1e-4);
            (orbit.at, at.map(|[re, _]| re.signum()).collect::<Vec<_>>())
        });
        for ((at, signs), end) in both.iter().zip(&curve.ends) {
            assert_eq!(*at, end.at);
            let name = if signs[0] > 0.0 { "1:1" } else { "1:2" };
            assert_eq!(signs.len(), 2, "{signs:?}");
            assert!(
                end.because.contains(&format!("resonance {name}")),
                "{}",
                end.because
            );
        }
        both.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        both.map(|(at, _)| at)
    });
    println!("{ends:?}");
    for (one, other) in ends[0].as_flattened().iter().zip(ends[1].as_flattened()) {
        assert!((one - other).abs() < 1e-7, "{ends:?}");
    }
}

/// Without losses multipliers come in pairs of z and 1/z (the map preserves the symplectic form), so
/// that two meet at −1. The four others are on the unit circle for ω above 2.36, as an independent
/// program in numbers of 113 bits confirms at eleven points, and below 2.32 two pairs have met and
/// left it.
#[test]
fn others_are_neutral_where_nothing_is_lost() {
    let case = snapload::Parameters {
        inertia: Some(0.06),
        a: 0.3,
        b: 0.3,
        e: 1.0,
        f_o: 0.4,
        omega: 2.5,
        ..snapload::Parameters::STANDARD
    };
    let start = [
        -0.085_021_085_399_728_98,
        0.248_344_611_674_763_85,
        -0.121_211_827_244_742_91,
        -0.148_744_113_643_007_82,
        -0.016_001_851_188_340_306,
        -1.999_062_447_438_237_7,
    ];
    let keys = [Some("f_o"), Some("omega")];
    let family = Moored::case(case, keys);
    let at = Moored::values(&case, keys);
    let orbit = Orbit::find(&family, at, &start, &OrbitRequest::default()).unwrap();
    let options = BranchOptions {
        range: [0.1, 0.8],
        step: 0.02,
        most: 400,
    };
    let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
    let event = branch.event(Kind::PeriodDoubling, None).unwrap();
    let options = CurveOptions {
        ranges: [[0.1, 0.8], [2.2, 2.8]],
        step: 0.02,
        most: 15,
    };
    let curve = Curve::of(&family, event, &options, &no_progress);
    let points = curve.unwrap().unwrap().points;
    assert!(points.len() > 20, "{}", points.len());
    for point in points {
        let omega = point.orbit.at[1];
        if !(2.32..=2.36).contains(&omega) {
            let expected = match omega > 2.36 {
                true => Stability::Neutral,
                false => Stability::Unstable,
            };
            assert_eq!(point.others, expected, "{:?}", point.orbit.at);
        }
    }
}
