//! Options that no search can use are refused where it begins.

use crate::closed_forms::{bouncing, table};
use crate::common::tori;
use snapload::analysis::{Unfinished, no_progress};
use snapload::{CaseError, Parameters, TautSet};
use snapload_orbits::{
    Basin, Branch, BranchOptions, Curve, CurveOptions, Kind, Moored, Orbit, OrbitRequest, Section,
    SectionOptions, Window, scan,
};
use std::f64::consts::PI;

const NEAR: [f64; 6] = [-0.27, 0.38, 0.0, 0.81, -0.43, 0.0];

fn key(result: Result<(), Unfinished>) -> String {
    match result {
        Err(Unfinished::Case(CaseError { key, .. })) => key,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_orbit_of_no_period_is_refused() {
    let family = Moored::case(tori().0, [None; 2]);
    let still = Moored::case(
        Parameters {
            omega: 0.0,
            ..tori().0
        },
        [None; 2],
    );
    let usual = OrbitRequest::default;
    let periods = OrbitRequest {
        periods: Some(0),
        ..usual()
    };
    let phase = |phase: f64| OrbitRequest { phase, ..usual() };
    for (family, start, request, key) in [
        (&family, NEAR, periods, "periods"),
        (&family, NEAR, phase(f64::NAN), "phase"),
        (&family, NEAR, phase(f64::INFINITY), "phase"),
        (&family, [f64::NAN; 6], usual(), "start"),
        (&still, NEAR, usual(), "period"),
    ] {
        let found = Orbit::find(family, [0.0; 2], &start, &request);
        let why = found.map(|orbit| orbit.z).expect_err(key).to_string();
        assert!(why.contains(key), "{key}: {why}");
    }
    let endless = scan(
        &family,
        [0.0; 2],
        TautSet::SLACK,
        (0.0, &NEAR),
        f64::INFINITY,
    );
    assert!(endless.is_none());
}

/// The ball that bounces once in a period of its table, on the way to its fold.
#[test]
fn a_branch_and_a_curve_that_lead_nowhere_are_refused() {
    let family = table(4000.0, 3.0);
    let (e, existence) = (0.5, PI / 3.0);
    let orbit = bouncing(&family, [1.2 * existence, e], 1);
    let follow = |range: [f64; 2], step: f64| {
        let options = BranchOptions {
            range,
            step,
            most: 100,
        };
        Branch::of(&family, &orbit, &options, &no_progress)
    };
    let wide = [0.5 * existence, 1.3 * existence];
    for step in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert_eq!(key(follow(wide, step).map(|_| ())), "step");
    }
    for range in [[f64::NAN; 2], [wide[1], wide[0]], [0.5, f64::INFINITY]] {
        assert_eq!(key(follow(range, 0.02).map(|_| ())), "range");
    }
    let branch = follow(wide, 0.02).expect("a branch");
    let fold = branch.event(Kind::Fold, None).expect("its fold");
    for (ranges, step, key) in [
        ([[0.0, 5.0], [0.2, 0.95]], f64::NAN, "step"),
        ([[0.0, 5.0], [0.2, f64::NAN]], 0.02, "range"),
    ] {
        let options = CurveOptions {
            ranges,
            step,
            most: 3,
        };
        let curve = Curve::of(&family, fold, &options, &no_progress).expect("not cancelled");
        let why = curve.map(|_| ()).expect_err(key).to_string();
        assert!(why.contains(key), "{why}");
    }
}

#[test]
fn a_section_of_more_periods_than_there_are_is_refused() {
    let options = SectionOptions {
        phase: 0.0,
        skip: 10,
        keep: 20,
        exponents: false,
        impacts: false,
    };
    let follow = |options: SectionOptions| Section::of(&tori().0, &options, &no_progress);
    let skip = u64::MAX;
    assert_eq!(
        key(follow(SectionOptions { skip, ..options }).map(|_| ())),
        "keep"
    );
    let phase = f64::NAN;
    assert_eq!(
        key(follow(SectionOptions { phase, ..options }).map(|_| ())),
        "phase"
    );
    let section = follow(options).expect("a section");
    assert_eq!(section.snaps_per_period(Some(0)), None);
    assert!(section.snaps_per_period(Some(1)).is_some());
}

#[test]
fn a_window_without_cells_is_refused() {
    let window = Window {
        base: tori().0,
        keys: ["x", "y"],
        values: [vec![0.0], vec![]],
    };
    assert_eq!(window.check().expect_err("no cells").key, "y");
    let basin = Basin::of(window, true, &no_progress).map(|_| ());
    assert_eq!(key(basin), "y");
}
