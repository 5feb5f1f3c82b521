//! Where branches and curves end.

use crate::common::{POINT, parameters, reference};
use snapload::Parameters;
use snapload::analysis::no_progress;
use snapload_orbits::{
    Branch, BranchEvent, BranchOptions, Curve, CurveEnd, CurveOptions, Family, Hybrid, Kind, Lap,
    Moored, Orbit, OrbitRequest, of_attractor,
};
use std::f64::consts::TAU;

const STRETCHED: Parameters = Parameters {
    r: 2.053,
    e: 0.691,
    nu: 0.39,
    omega: 2.684,
    f_o: 1.513,
    ..POINT
};
const NEAR_STRETCHED: [f64; 6] = [-0.51252, 0.50233, 0.0, 0.23488, -0.24835, 0.0];
const TOO_LONG: &str = "a cable would have to be longer by 0.02";

fn near(family: &Moored, at: [f64; 2], start: [f64; 6]) -> Orbit {
    Orbit::find(family, at, &start, &OrbitRequest::default()).unwrap()
}

fn branch(family: &Moored, orbit: &Orbit, range: [f64; 2], step: f64) -> Branch {
    let options = BranchOptions {
        range,
        step,
        most: 4000,
    };
    Branch::of(family, orbit, &options, &no_progress).unwrap()
}

fn curve(family: &Moored, event: &BranchEvent, ranges: [[f64; 2]; 2], step: f64) -> Curve {
    let options = CurveOptions {
        ranges,
        step,
        most: 3000,
    };
    let curve = Curve::of(family, event, &options, &no_progress);
    curve.unwrap().unwrap()
}

fn gap(orbit: &Orbit) -> f64 {
    orbit.survey.largest_gap.map_or(0.0, |gap| gap.value)
}

/// A branch ends at the orbit whose gap is 0.02, whatever its steps and wherever it is started.
#[test]
fn a_branch_ends_where_a_cable_would_have_to_be_too_long() {
    let keys = [Some("f_o"), None];
    let family = Moored::case(STRETCHED, keys);
    let orbit = near(&family, Moored::values(&STRETCHED, keys), NEAR_STRETCHED);
    let range = [0.9078, 2.1282];
    let known = branch(&family, &orbit, range, 0.01);
    let place = known.ends[1].at;
    let lower = known.points.iter().find(|p| p.orbit.at[0] > 1.2).unwrap();
    for (orbit, step) in [(&orbit, 0.01), (&orbit, 0.002), (&lower.orbit, 0.03)] {
        let found = branch(&family, orbit, range, step);
        let end = &found.ends[1];
        assert_eq!(end.because, TOO_LONG);
        assert!((end.at - place).abs() < 1e-9, "{} {place}", end.at);
        let last = found.points.last().unwrap();
        assert_eq!(last.orbit.at[0], end.at);
        assert!((gap(&last.orbit) - 0.02).abs() < 1e-9);
        assert!(found.points.iter().all(|p| gap(&p.orbit) < 0.02 + 1e-9));
        assert!(found.events.iter().all(|event| event.value[0] <= end.at));
    }
}

/// The same for a curve.
#[test]
fn a_curve_ends_where_a_cable_would_have_to_be_too_long() {
    let base = parameters(&reference()["branches"][0]["base"]);
    let keys = [Some("f_o"), Some("omega")];
    let family = Moored::case(base, keys);
    let at = Moored::values(&base, keys);
    let orbit = near(&family, at, [-0.2688, 0.3830, 0.0, 0.8084, -0.4263, 0.0]);
    let first = branch(&family, &orbit, [0.7, 4.0], 0.02);
    let event = first.event(Kind::Fold, None).unwrap();
    let both = [0.01, 0.04].map(|step| {
        let found = curve(&family, event, [[0.7, 4.0], [1.55, 6.2]], step);
        let [low, high] = [found.points.first(), found.points.last()].map(Option::unwrap);
        let mut places = Vec::new();
        for (end, point) in found.ends.iter().zip([low, high]) {
            println!("{:?} {} {}", end.at, end.because, gap(&point.orbit));
            if end.because == TOO_LONG {
                assert!((gap(&point.orbit) - 0.02).abs() < 1e-8);
                places.push(point.orbit.at);
            }
        }
        assert!(!places.is_empty());
        places
    });
    for (one, other) in both[0].iter().zip(&both[1]) {
        assert!((one[0] - other[0]).abs() + (one[1] - other[1]).abs() < 1e-7);
    }
}

/// Without loss of energy, e = 1, the multipliers of every orbit come in pairs with the product 1,
/// so that no orbit is a Neimark-Sacker point by that: a curve ends before, at a point that does
/// not depend on its steps. A lap with n snaps in slack flight keeps e²ⁿ of phase space.
#[test]
fn a_curve_of_tori_ends_before_energy_is_kept() {
    let base = parameters(&reference()["branches"][1]["base"]);
    let keys = [Some("f_o"), Some("e")];
    let family = Moored::case(base, keys);
    let at = Moored::values(&base, keys);
    let orbit = near(&family, at, [-0.0086, 0.7632, 0.0, 1.0527, -0.7738, 0.0]);
    let range = [0.3, 4.0];
    let first = branch(&family, &orbit, range, 0.01);
    let event = first.event(Kind::NeimarkSacker, None).unwrap();
    let both = [0.01, 0.05].map(|step| {
        let found = curve(&family, event, [range, [0.3, 1.0]], step);
        let ends = || {
            found
                .ends
                .iter()
                .zip([found.points.first(), found.points.last()])
        };
        let (_, point) = ends()
            .find(|(end, _)| end.because.contains("hardly any energy is lost"))
            .unwrap_or_else(|| panic!("{:?}", found.ends));
        point.unwrap().orbit.clone()
    });
    for orbit in &both {
        let snaps = orbit.lap.sequence.struck().len() as i32;
        assert!((1.0 - orbit.at[1].powi(2 * snaps) - 1e-4).abs() < 1e-8);
        // f_o comes to its limit as (1 - e)², with the values 0.99504350915 at e = 0.999 and
        // 0.995039166096 at 0.9999, to which curves come in steps of any length.
        let bend = (0.995_043_509_15 - 0.995_039_166_096) / (1e-3_f64.powi(2) - 1e-4_f64.powi(2));
        let there = 0.995_039_166_096 + bend * ((1.0 - orbit.at[1]).powi(2) - 1e-8);
        assert!((orbit.at[0] - there).abs() < 1e-9, "{:?} {there}", orbit.at);
    }
    assert!((both[0].at[0] - both[1].at[0]).abs() < 1e-10);
}

/// From a start that keeps more than that a curve leads away from e = 1 only.
#[test]
fn a_curve_that_begins_where_energy_is_all_but_kept_goes_no_nearer() {
    let base = parameters(&reference()["branches"][1]["base"]);
    let case = Parameters {
        e: 0.99998,
        f_o: 0.995_039_125_006_562_9,
        ..base
    };
    let keys = [Some("f_o"), Some("e")];
    let family = Moored::case(case, keys);
    let start = [
        0.407_789_360_217_623_4,
        0.755_176_934_679_386_8,
        0.0,
        1.048_712_269_677_722,
        -0.777_515_071_207_684_9,
        0.0,
    ];
    let orbit = near(&family, Moored::values(&case, keys), start);
    let event = BranchEvent::here(Kind::NeimarkSacker, &orbit).unwrap();
    let found = curve(&family, &event, [[0.3, 4.0], [0.999, 1.0]], 0.001);
    let ends = found.ends.each_ref().map(|end| end.because.as_str());
    let nearest = ends
        .iter()
        .position(|why| why.starts_with("hardly any energy is lost"));
    let nearest = nearest.unwrap_or_else(|| panic!("{ends:?}"));
    let outermost = [found.points.first(), found.points.last()][nearest].unwrap();
    assert_eq!(found.ends[nearest].at, outermost.orbit.at);
    assert!((outermost.orbit.at[0] - event.value[0]).abs() < 1e-8);
    assert_eq!(found.ends[1 - nearest].at[1], 0.999);
    assert!(
        found
            .points
            .iter()
            .all(|point| point.orbit.at[1] <= 0.99998)
    );
}

/// A half that would leave the range at once ends on its border, even where no further orbit is
/// found beyond it.
#[test]
fn a_branch_that_starts_on_a_border_ends_there() {
    let case = Parameters {
        r: 1.797,
        e: 0.444,
        nu: 0.0,
        omega: 4.63,
        f_o: 0.722,
        ..POINT
    };
    let keys = [Some("nu"), None];
    let family = Moored::case(case, keys);
    let start = [
        0.000_396_635_943_142_495_8,
        0.001_956_831_007_770_575,
        0.0,
        0.033_422_018_997_052_55,
        0.133_017_185_296_872_5,
        0.0,
    ];
    let orbit = near(&family, Moored::values(&case, keys), start);
    let found = branch(&family, &orbit, [0.0, 0.1], 0.01);
    assert_eq!(found.ends[0].at, 0.0);
    assert_eq!(found.ends[0].because, "the end of the range");
}

/// The last snaps of an accumulation become too slow to count along this branch. Each orbit is that
/// of the simulated motion, which is what makes it admissible, whatever their number.
#[test]
fn a_snap_that_sticks_in_place_of_the_next_ends_no_branch() {
    let base = Parameters {
        r: 1.845,
        e: 0.3,
        nu: 0.25,
        omega: 1.38,
        f_o: 0.9376,
        ..POINT
    };
    let keys = [Some("f_o"), None];
    let family = Moored::case(base, keys);
    let start = [0.02357007, 0.03977678, 0.0, 0.29390353, 0.37374873, 0.0];
    let orbit = near(&family, Moored::values(&base, keys), start);
    let found = branch(&family, &orbit, [0.93, base.f_o], 0.0008);
    assert_eq!(found.ends[0].because, "the end of the range");
    assert!(found.events.iter().all(|event| event.kind != Kind::Graze));
    assert!(found.points.iter().all(|point| point.orbit.is_admissible()));
    let snaps = |k: usize| found.points[k].orbit.lap.sequence.snaps();
    assert!(snaps(0) < snaps(found.points.len() - 1));
}

fn point_mass([r, e, f_o, nu, omega]: [f64; 5]) -> Parameters {
    Parameters {
        r,
        e,
        f_o,
        nu,
        omega,
        ..POINT
    }
}

/// Where the instant of a graze comes to that of a snap of the other cable, both gaps are zero at
/// once, and the curve ends: beyond, the touch would come after the snap has changed the motion. In
/// each of its admissible points a slack cable is touched, or struck without velocity.
#[test]
fn a_curve_of_grazes_ends_where_a_graze_meets_a_snap() {
    let case = point_mass([1.4116, 0.236185, 1.70665, 1.0, 5.42625]);
    let keys = [Some("f_o"), Some("r")];
    let family = Moored::case(case, keys);
    let start = [-0.0041765, 0.0258545, 0.0, 0.4844652, -0.4544662, 0.0];
    let orbit = near(&family, Moored::values(&case, keys), start);
    let ranges = [[0.853325, 3.4133], [1.02, 2.8232]];
    let first = branch(&family, &orbit, ranges[0], 0.02);
    let event = first.event(Kind::Graze, None).unwrap();
    for step in [0.02, 0.004] {
        let found = curve(&family, event, ranges, step);
        let admissible = found.points.iter().filter(|p| p.orbit.why_not.is_empty());
        for point in admissible {
            let survey = &point.orbit.survey;
            let speed = survey.least_speed.map_or(1.0, |least| least.value);
            let off = gap(&point.orbit).abs().min(speed.abs());
            assert!(off < 1e-6, "{:?}: {off}", point.orbit.at);
        }
        let ends = found
            .ends
            .iter()
            .zip([found.points.first(), found.points.last()]);
        let meets = ends.filter(|(end, _)| end.because.starts_with("corner: the graze comes"));
        let both: Vec<_> = meets.map(|(_, point)| point.unwrap()).collect();
        assert_eq!(both.len(), 1, "{:?}", found.ends);
        let corner = both[0].orbit.survey.corner_gap.expect("a gap at a snap");
        assert!(corner.value.abs() < 1e-9, "{}", corner.value);
        let [f_o, r] = both[0].orbit.at;
        assert!(
            (f_o - 1.78).abs() < 0.01 && (r - 1.45).abs() < 0.01,
            "{f_o} {r}"
        );
    }
}

/// The section may lie anywhere in the lap: the same graze leads along the same curve to the same
/// corner, whichever events pass the section on the way, before the graze or after it.
#[test]
fn a_curve_of_grazes_does_not_depend_on_the_section() {
    let case = point_mass([1.4116, 0.236185, 1.70665, 1.0, 5.42625]);
    let keys = [Some("f_o"), Some("r")];
    let family = Moored::case(case, keys);
    let at = Moored::values(&case, keys);
    let start = [-0.0041765, 0.0258545, 0.0, 0.4844652, -0.4544662, 0.0];
    let orbit = near(&family, at, start);
    let ranges = [[0.853325, 3.4133], [1.02, 2.8232]];
    let system = family.plain(at);
    let lap = Lap {
        family: &family,
        at,
        sequence: &orbit.lap.sequence,
        phase: 0.0,
        periods: orbit.periods,
    };
    let legs = lap.legs(&system, &orbit.z, &orbit.lap.durations);
    let period = TAU / case.omega;
    let mut passed = 0;
    let mut corners = Vec::new();
    for part in 0..8 {
        let phase = f64::from(part) / 8.0;
        let t = phase * period;
        let leg = legs.iter().rfind(|leg| leg.t <= t).unwrap();
        let start = system.flow(leg.taut, leg.t, &leg.start, t - leg.t);
        let request = OrbitRequest {
            phase,
            ..OrbitRequest::default()
        };
        let orbit = Orbit::find(&family, at, &start, &request).unwrap();
        let first = branch(&family, &orbit, ranges[0], 0.02);
        let event = first.event(Kind::Graze, None).unwrap();
        let found = curve(&family, event, ranges, 0.02);
        let symbols = found.points.iter().map(|p| p.orbit.lap.sequence.symbol());
        let symbols: Vec<_> = symbols.collect();
        passed += usize::from(symbols.windows(2).any(|two| two[0] != two[1]));
        let meets = |end: &&CurveEnd| end.because.starts_with("corner: the graze comes");
        let corner = found.ends.iter().find(meets);
        corners.push(
            corner
                .unwrap_or_else(|| panic!("{phase}: {:?}", found.ends))
                .at,
        );
    }
    assert!(passed > 1, "{passed}");
    for [f_o, r] in &corners {
        let off = (f_o - corners[0][0]).abs() + (r - corners[0][1]).abs();
        assert!(off < 1e-7, "{corners:?}");
    }
}

/// Where a cable without restitution and the contact after it erase all deviations, the value of a
/// key changes with the square of the speed of a snap: the branch turns back at that snap's graze,
/// but no multiplier is 1, and it is no fold.
#[test]
fn a_branch_that_turns_back_at_a_graze_has_no_fold_there() {
    let case = point_mass([1.22399, 0.0, 2.62753, 0.234551, 1.61223]);
    let keys = [Some("f_o"), None];
    let family = Moored::case(case, keys);
    let attractor = of_attractor(&case, &OrbitRequest::default(), &no_progress);
    let start = attractor.unwrap().unwrap().z;
    let orbit = near(&family, Moored::values(&case, keys), start);
    let found = branch(&family, &orbit, [1.57652, 4.20405], 0.02);
    let grazes = found
        .events
        .iter()
        .filter(|event| event.kind == Kind::Graze);
    let turning = grazes.map(|event| (event.value[0] - 1.663823457406).abs());
    assert!(turning.fold(1.0, f64::min) < 1e-9);
    let multipliers = |event: &&BranchEvent| event.orbit.multipliers.values.clone();
    let folds = found.events.iter().filter(|event| event.kind == Kind::Fold);
    for fold in folds.collect::<Vec<_>>().iter().map(multipliers) {
        assert!(
            fold.iter().any(|[re, im]| (re - 1.0).hypot(*im) < 1e-4),
            "{fold:?}"
        );
    }
}
