//! Lines that are stiff one by one, and soft as the springs on which a body swings.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, Lines, ModelAtRest, Structure, VerdictKind, Water, assess, compare_elastic, seas,
    warnings,
};
use std::f64::consts::PI;

/// A flat pontoon under water, 6 x 0.6 x 20 m, with an added mass of 13 t in surge and of 661 t in
/// heave, on two chains 20 degrees above the horizontal.
const PLATE: &str = r#"
[body]
shape = "rectangle"
width = 6
height = 0.6
displaced_volume = 72
mass = 51660
position = [0, -5]
turning_damping = 1e5
[[line]]
anchor = [18.794, -11.8404]
fairlead = [0, -5]
length = 20
type = "studless chain"
diameter = 0.036
[[line]]
anchor = [-18.794, -11.8404]
fairlead = [0, -5]
length = 20
type = "studless chain"
diameter = 0.036
[site]
depth = 11.8404
[design]
pretension_factor = 1.2
environment_factor = 1.5
strength_factor = 0.95
[run]
restitution = 0.8
"#;

fn in_waves(height_m: f64, period_s: f64, duration_s: f64) -> Structure {
    let wave = format!("[wave]\nheight = {height_m}\nperiod = {period_s}\n");
    structure(&format!("{PLATE}duration = {duration_s}\n{wave}"))
}

/// Half a period of heave on both chains: each resists it by k sin²α.
fn half_a_period_s(case: &Structure) -> f64 {
    let [_, up_kg] = case.body.moving_mass_kg();
    let rate = case.lines[0].spring_rate_n_m().unwrap();
    let sine = (11.8404 - 5.0) / 20.0;
    PI * (up_kg / (2.0 * rate * sine * sine)).sqrt()
}

/// Along each chain the body swings within a quarter of a second, but in heave within 2.3 s: in
/// waves of 6 s the chains stretch by so much that they go slack, snap, and break, although
/// inextensible ones do neither. The verdict and the checks are then open.
#[test]
fn a_slow_heave_on_flat_lines_leaves_the_verdict_open() {
    let case = in_waves(0.5, 6.0, 120.0);
    let lasts = half_a_period_s(&case);
    let found = assess(case.clone(), 2, &no_progress).unwrap();
    let rule = found.warnings.iter().find(|w| w.rule == "instant snap");
    let rule = rule.unwrap();
    let words = format!("= {lasts:.2} s in the lines that are taut at rest together");
    assert!(rule.message.contains(&words), "{} {words}", rule.message);
    assert_eq!(rule.decided_by, Some("snapload elastic"));
    assert_eq!(found.verdict().standing, VerdictKind::Open);
    assert!(found.verdict().words.contains("snapload elastic decides"));
    let checks = found.checks();
    assert!(!checks.is_empty());
    assert!(checks.iter().all(|(check, _)| check.answer == Answer::Open));

    let prepared = ModelAtRest::for_elastic_lines(case).unwrap();
    let elastic = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    assert_eq!(elastic.verdict().standing, VerdictKind::Breaks);
}

/// The rule of a snap along one line, a tenth of the waves' period, holds for this one, too.
#[test]
fn lines_are_stiff_together_in_waves_of_ten_times_their_snap() {
    let slow = |case: &Structure| {
        let prepared = ModelAtRest::new(case.clone()).unwrap();
        warnings(&prepared).iter().any(|w| w.rule == "instant snap")
    };
    let limit_s = 10.0 * half_a_period_s(&in_waves(0.5, 6.0, 120.0));
    assert!(slow(&in_waves(0.5, 0.999 * limit_s, 120.0)));
    assert!(!slow(&in_waves(0.5, 1.001 * limit_s, 120.0)));
}

#[test]
fn a_sea_on_such_lines_is_open() {
    let text = format!("{PLATE}duration = 120\n[sea]\nhs = 0.25\ntp = 5\n");
    let case = structure(&text);
    assert!(matches!(case.water, Water::Sea(_)));
    let found = seas(case, 2, Lines::Inextensible, &no_progress).unwrap();
    assert_eq!(found.standing(), VerdictKind::Open);
    assert!(found.words().contains("snapload seas --elastic decides"));
}
