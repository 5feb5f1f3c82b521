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

/// A body that pulls at one chain with 711 kN: the net buoyancy, however the chain stretches. The
/// chain is too soft for the waves, but if it bears less than that at rest, it breaks in any waves.
#[test]
fn a_line_that_breaks_at_rest_breaks_in_waves() {
    let text = |part: f64, water: &str| {
        let buoyancy_n = (141.37 * 1025.0 - 72_452.0) * 9.80665;
        structure(&format!(
            "[body]\nwidth = 3\ndisplaced_volume = 141.37\nmass = 72452\nposition = [0, -4]\n\
             linear_damping = 1e4\nturning_damping = 1e5\n\
             [[line]]\nanchor = [0, -20]\nfairlead = [0, -5.5]\nlength = 14.5\n\
             type = \"studless chain\"\ndiameter = 0.02\nbreaking_load = {}\n\
             [site]\ndepth = 20\n[run]\nrestitution = 0.5\nduration = 120\n{water}",
            buoyancy_n / part
        ))
    };
    let wave = "[wave]\nheight = 0.05\nperiod = 9\n";
    for (part, standing) in [(0.9, VerdictKind::Open), (1.88, VerdictKind::Breaks)] {
        let found = assess(text(part, wave), 0, &no_progress).unwrap();
        let verdict = found.verdict();
        assert!(found.warnings.iter().any(|w| w.rule == "instant snap"));
        assert_eq!(verdict.standing, standing, "{}", verdict.words);
        let breaks = verdict.words.contains("line 1 (1.88, at rest)");
        assert_eq!(breaks, standing == VerdictKind::Breaks, "{}", verdict.words);
        let sea = text(part, "[sea]\nhs = 0.05\ntp = 9\n");
        let found = seas(sea, 2, Lines::Inextensible, &no_progress).unwrap();
        assert_eq!(found.standing(), standing, "{}", found.words());
        assert_eq!(found.words().contains("line 1 (1.88)"), breaks);
    }
}

/// A body straight above two lines side by side, with further keys of its run.
pub(crate) fn side_by_side([first, second]: [f64; 2], further: &str) -> String {
    let line = |length: f64| {
        format!(
            "[[line]]\nanchor = [0, -20]\nfairlead = [0, -5]\nlength = {length}\nstiffness = 3e6\n"
        )
    };
    format!(
        "[body]\nmass = 500\nadded_mass = 300\ndisplaced_volume = 0.8\nwidth = 1\nposition = [0, -5]\n\
         {}{}[site]\ndepth = 21\n[run]\nrestitution = 0.5\n{further}",
        line(first),
        line(second)
    )
}

/// Two lines side by side of which one is 5 mm longer: inextensible, it carries nothing, and its
/// row says what it carries at rest as both stretch, k₁ (s + 5 mm) + k₂ s = F.
#[test]
fn a_line_that_only_stretch_loads_is_not_said_to_be_unloaded() {
    let text = side_by_side([15.0, 15.005], "duration = 60\n[sea]\nhs = 0.001\ntp = 6\n");
    let records = seas(structure(&text), 1, Lines::Inextensible, &no_progress).unwrap();
    let force = records.prepared.structure.net_buoyancy_n();
    let (k1, k2) = (3e6 / 15.0, 3e6 / 15.005);
    let second_kn = k2 * (force - k1 * 0.005) / (k1 + k2) / 1e3;
    let row = format!("({second_kn:.2} kN at rest, where the lines stretch)");
    let summary = records.summary("case");
    let words: Vec<&str> = summary.split_whitespace().collect();
    assert!(words.join(" ").contains(&row), "{row}: {summary}");
}
