//! The cases of a plan.
use snapload::Value;
use snapload_study::{Axis, Grid, Plan, RandomRange, Study, StudyError};

fn even(key: &str, first: &str, last: &str, count: u64) -> Axis {
    Axis::even(key, Grid::new(first, last, count).unwrap()).unwrap()
}

/// The varied keys, case by case.
fn entries(plan: Plan) -> Vec<Vec<(&'static str, Value)>> {
    let study = Study::new([], plan, false).unwrap();
    let cases = study.cases(0..study.count()).unwrap();
    let entries = (0..cases.count()).map(|k| cases.given(k).unwrap());
    entries.collect()
}

#[test]
fn the_first_axis_is_the_slowest() {
    let flag = Axis::listed("stop_when_sliding", vec![false.into(), true.into()]).unwrap();
    let plan = Plan::grid(vec![even("e", "0.5", "0.7", 3), flag]).unwrap();
    let all = entries(plan);
    let e = |value: f64, flag: bool| vec![("e", value.into()), ("stop_when_sliding", flag.into())];
    assert_eq!(all[..3], [e(0.5, false), e(0.5, true), e(0.6, false)]);
    assert_eq!(all.len(), 6);
    assert_eq!(Plan::grid(Vec::new()).unwrap().count(), 1);
}

#[test]
fn random_points_stay_in_the_box() {
    let ranges = vec![
        RandomRange::new("f_o", 0.1, 0.6).unwrap(),
        RandomRange::new("x", -0.05, 0.05).unwrap(),
    ];
    let plan = Plan::random(ranges, 1000, 1).unwrap();
    for entries in entries(plan) {
        let (Value::Number(f_o), Value::Number(x)) = (&entries[0].1, &entries[1].1) else {
            panic!("{entries:?}");
        };
        assert!((0.1..=0.6).contains(f_o) && (-0.05..=0.05).contains(x));
    }
}

#[test]
fn invalid_axes_are_refused_with_reasons() {
    let words = |error: StudyError| error.to_string();
    let grid = |a: &str, b: &str, n| Grid::new(a, b, n).unwrap();
    let error = Axis::even("e", grid("0.5", "1.5", 3)).unwrap_err();
    assert!(words(error).contains("e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1"));
    let error = Axis::even("omgea", grid("0", "1", 2)).unwrap_err();
    assert!(words(error).contains("did you mean omega?"));
    let twice = Plan::grid(vec![even("e", "0", "1", 2), even("e", "0", "1", 2)]);
    assert!(words(twice.unwrap_err()).contains("e varies twice"));
    let many = ["x", "y", "vx"].map(|key| even(key, "0", "1", 1_000_000));
    assert!(words(Plan::grid(many.into()).unwrap_err()).contains("from 1 to 1e12"));
    let error = RandomRange::new("max_impacts", 10.0, 20.0).unwrap_err();
    assert!(words(error).contains("max_impacts can not be drawn at random"));
    let error = RandomRange::is_possible("body").unwrap_err();
    assert!(words(error).contains("body can not be drawn at random"));
    assert!(Plan::random(Vec::new(), 10, 0).is_err());
}
