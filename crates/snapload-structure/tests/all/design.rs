//! Natural periods against closed forms, and checks by the design rule against their formulas.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, Assessment, Criterion, Lines, ModelAtRest, NaturalPeriods, assess, compare_elastic,
    elastic_lines, seas,
};
use std::f64::consts::TAU;

const CYLINDER: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// A body of 800 kg with its water, straight above its anchor, on two lines of 15 m that lie on
/// each other and end `below` its centre.
fn tethered(below: f64) -> ModelAtRest {
    let (fairlead, anchor) = (-5.0 - below, -20.0 - below);
    let line = format!(
        "[[line]]\nanchor = [0, {anchor}]\nfairlead = [0, {fairlead}]\nlength = 15\nstiffness = 3e6\n"
    );
    let text = format!(
        "[body]\nmass = 500\nadded_mass = 300\ndisplaced_volume = 0.8\nwidth = 1\nmoment_of_inertia = 90\n\
         position = [0, -5]\n{line}{line}[site]\ndepth = 30\n[run]\nrestitution = 0.5\n"
    );
    ModelAtRest::new(structure(&text)).expect("a start")
}

fn periods_s(modes: &[snapload_structure::NaturalMode]) -> Vec<Option<f64>> {
    modes.iter().map(|mode| mode.period_s).collect()
}

/// Held at its centre the body is an inverted pendulum under buoyancy, ω² = F/(M r), and turns
/// freely; on springs it also heaves at ω² = 2k/M, and the pendulum is longer by their stretch.
#[test]
fn a_body_held_at_its_centre_is_a_pendulum() {
    let prepared = tethered(0.0);
    let force = prepared.structure.net_buoyancy_n();
    let found = NaturalPeriods::of(&prepared).expect("submerged");
    let close = |found: Option<f64>, known: f64| {
        assert!(
            (found.expect("a period") / known - 1.0).abs() < 1e-7,
            "{found:?} {known}"
        );
    };
    assert_eq!(found.inextensible.len(), 2);
    assert_eq!(found.inextensible[0].period_s, None);
    assert_eq!(found.inextensible[0].motion, "pitch");
    close(
        found.inextensible[1].period_s,
        TAU * (800.0 * 15.0 / force).sqrt(),
    );
    assert_eq!(found.inextensible[1].motion, "surge");
    let rate = 2.0 * 3e6 / 15.0;
    let elastic = found.elastic.expect("periods on springs");
    assert_eq!(elastic[0].period_s, None);
    close(
        elastic[1].period_s,
        TAU * (800.0 * (15.0 + force / rate) / force).sqrt(),
    );
    close(elastic[2].period_s, TAU * (800.0 / rate).sqrt());
    assert_eq!(elastic[2].motion, "heave");
}

/// Held below its centre it is a double pendulum: with the angles φ of the line and θ of the body,
///
/// M r² φ̈ + M r h θ̈ = −F r φ,    M r h φ̈ + (I + M h²) θ̈ = −F h θ
#[test]
fn a_body_held_below_its_centre_is_a_double_pendulum() {
    let (r, h, mass, inertia) = (15.0, 0.4, 800.0, 90.0);
    let prepared = tethered(h);
    let force = prepared.structure.net_buoyancy_n();
    // det(K − ω² M) = a ω⁴ − b ω² + c
    let a = mass * r * r * (inertia + mass * h * h) - (mass * r * h).powi(2);
    let b = force * r * (inertia + mass * h * h) + force * h * mass * r * r;
    let c = force * r * force * h;
    let root = (b * b - 4.0 * a * c).sqrt();
    let known = [-1.0, 1.0].map(|sign| TAU / ((b + sign * root) / (2.0 * a)).sqrt());
    let found = periods_s(
        &NaturalPeriods::of(&prepared)
            .expect("submerged")
            .inextensible,
    );
    assert_eq!(found.len(), 2);
    for (found, known) in found.iter().zip(known) {
        assert!(
            (found.expect("a period") / known - 1.0).abs() < 1e-7,
            "{found:?} {known}"
        );
    }
}

/// The example's periods on its chains, as a mooring engineer computed them with another program;
/// with lines a hundred thousand times as stiff, those on inextensible lines.
#[test]
fn the_cylinder_swings_as_others_found() {
    let prepared = ModelAtRest::new(structure(CYLINDER)).expect("a start");
    let found = NaturalPeriods::of(&prepared).expect("submerged");
    let elastic = periods_s(&found.elastic.expect("periods on springs"));
    assert!(
        (elastic[0].expect("a period") - 3.231).abs() < 5e-4,
        "{elastic:?}"
    );
    // In heave both lines act alike, each with k n_z² + (T/l) n_x².
    let elastic_lines = elastic_lines(&prepared, 1.0).expect("elastic lines");
    let elastic_case = prepared
        .with_elastic_lines(&elastic_lines)
        .expect("a place of rest");
    let line = &prepared.structure.lines[0];
    let centre = prepared.structure.body.position_m;
    let span = [0, 1]
        .map(|k| elastic_case.rest.place_m[k] + line.fairlead_m[k] - centre[k] - line.anchor_m[k]);
    let length = span[0].hypot(span[1]);
    let [n_x, n_z] = span.map(|component| component / length);
    let rate = line.spring_rate_n_m().expect("a rate");
    let stiffness = 2.0 * (rate * n_z * n_z + elastic_case.rest.tension_n[0] / length * n_x * n_x);
    let [_, moving] = prepared.structure.body.moving_mass_kg();
    let heave = TAU * (moving / stiffness).sqrt();
    assert!(
        (elastic[2].expect("a period") / heave - 1.0).abs() < 1e-6,
        "{elastic:?} {heave}"
    );
    let mut stiff = structure(CYLINDER);
    for line in &mut stiff.lines {
        line.stiffness_n = line.stiffness_n.map(|stiffness| 1e5 * stiffness);
    }
    let stiff = NaturalPeriods::of(&ModelAtRest::new(stiff).expect("a start")).expect("submerged");
    let [taut] = periods_s(&stiff.inextensible)[..] else {
        panic!("two lines leave one freedom: {stiff:?}");
    };
    let slowest = periods_s(&stiff.elastic.expect("periods on springs"))[0];
    assert!((taut.expect("a period") / slowest.expect("a period") - 1.0).abs() < 1e-5);
}

/// Where elastic lines share the load differently, the periods on inextensible lines are still
/// those of inextensible lines: N^T K N - ω² N^T M N with their tensions and their place of rest,
/// in NumPy, gives 8.178 s. They do not depend on the stiffness.
#[test]
fn periods_on_inextensible_lines_do_not_depend_on_their_stiffness() {
    let lines = "[[line]]\nanchor = [6, -20]\nfairlead = [1, -7]\nlength = 13.93\nstiffness = 6e6\n\
        [[line]]\nanchor = [-1, -20]\nfairlead = [-1, -7]\nlength = 13.2\nstiffness = 4e5\n\
        [site]\ndepth = 20\n[run]\nrestitution = 0.5\n";
    let (body, _) = CYLINDER.split_once("[[line]]").expect("lines");
    let text = body.replace("[0, -3.5]", "[0, -6]") + lines;
    let mut structure = structure(&text);
    let soft = ModelAtRest::new(structure.clone()).expect("a start");
    assert!(soft.rest.by_stiffness.is_some());
    for line in &mut structure.lines {
        line.stiffness_n = None;
    }
    let unknown = ModelAtRest::new(structure).expect("a start");
    for prepared in [&soft, &unknown] {
        let found = NaturalPeriods::of(prepared).expect("submerged");
        let [period] = periods_s(&found.inextensible)[..] else {
            panic!("two lines leave one freedom: {found:?}");
        };
        let period = period.expect("a period");
        assert!((period - 8.178).abs() < 5e-4, "{period}");
    }
}

fn assessed(design: &str) -> Assessment {
    let text = format!("{CYLINDER}\nduration = 120\n[design]\n{design}\n");
    assess(structure(&text), 2, &no_progress).expect("an answer")
}

#[test]
fn checks_agree_with_their_formulas() {
    let factors = "pretension_factor = 1.2\nenvironment_factor = 1.5\nstrength_factor = 0.95\n\
                   least_share = 0.1\nrest_factor = 1.3\ndynamic_factor = 1.1\nforce_share = 0.9";
    let assessment = assessed(factors);
    let checks = assessment.checks();
    assert_eq!(checks.len(), 7);
    for (check, _) in &checks {
        let value = check.value.expect("a value");
        let Some(line) = check.line else {
            // f_z is ν f_o in a regular wave.
            let [f_o, nu, _] = assessment.prepared.model.groups.wave.expect("a wave");
            assert!((value - f_o * nu).abs() < 1e-12 && check.answer == Answer::Passes);
            continue;
        };
        let outcome = &assessment.outcome.lines[line - 1];
        let rest = assessment.prepared.rest.tension_n[line - 1];
        // This line goes slack, so that its least tension is zero.
        assert!(outcome.slack_fraction > 0.0 && outcome.least_n == Some(0.0));
        let (known, passes) = match check.criterion {
            Criterion::Strength => {
                let largest = outcome.peak_n.expect("a peak").max(outcome.largest_taut_n);
                let u = (1.2 * rest + 1.5 * (largest - rest)) / (0.95 * 1_319_000.0);
                (u, u <= 1.0)
            }
            Criterion::NoSlack => (0.0, false),
            Criterion::FactoredLeast => (1.3 - 1.1, true),
            Criterion::WaveForce => panic!("a line has no such check"),
        };
        assert!(
            (value - known).abs() < 1e-3 * known.max(1.0),
            "{check:?} {known}"
        );
        assert_eq!(check.answer == Answer::Passes, passes, "{check:?}");
    }
}

/// Without factors no tension is checked; a slack line fails the check that it never goes slack.
#[test]
fn only_requested_checks_are_made() {
    let text = format!("{CYLINDER}\nduration = 60\n");
    let plain = assess(structure(&text), 0, &no_progress).expect("an answer");
    assert!(plain.checks().is_empty());
    let slack = assessed("least_share = 0");
    assert!(
        slack
            .checks()
            .iter()
            .all(|(check, _)| check.answer == Answer::Fails)
    );
    let still = CYLINDER.replace("[wave]\nheight = 2\nperiod = 6\n", "");
    let still = assess(
        structure(&format!(
            "{still}\n[design]\nleast_share = 0.9\nforce_share = 1\n"
        )),
        0,
        &no_progress,
    );
    let still = still.expect("an answer");
    let answers: Vec<Answer> = still
        .checks()
        .iter()
        .map(|(check, _)| check.answer)
        .collect();
    assert_eq!(answers, [Answer::Passes, Answer::Passes, Answer::Unknown]);
}

/// On lines that are too soft to be inextensible a check of tensions is left open.
#[test]
fn checks_of_soft_lines_are_open() {
    let soft = CYLINDER.replace("type = \"studless chain\"", "type = \"polyester\"");
    let text = format!("{soft}\nduration = 60\n[design]\nleast_share = 0\nforce_share = 0.1\n");
    let open = assess(structure(&text), 0, &no_progress).expect("an answer");
    let answers: Vec<Answer> = open
        .checks()
        .iter()
        .map(|(check, _)| check.answer)
        .collect();
    assert_eq!(answers, [Answer::Open, Answer::Open, Answer::Fails]);
}

#[test]
fn factors_that_go_together_are_given_together() {
    for (given, missing) in [
        ("pretension_factor = 1.2", "environment_factor"),
        (
            "environment_factor = 1.2\nstrength_factor = 1",
            "pretension_factor",
        ),
        ("dynamic_factor = 1.2", "rest_factor"),
    ] {
        let text = format!("{CYLINDER}\n[design]\n{given}\n");
        let error = snapload_structure::Structure::parse("case", &text).expect_err("a refusal");
        let error = error.to_string();
        assert!(
            error.contains(missing) && error.contains("given together"),
            "{error}"
        );
    }
}

/// The checks of elastic lines, recomputed from their tensions, and those of many records,
/// each of which has the checks of its own run.
#[test]
fn elastic_lines_and_records_are_checked_by_the_same_rule() {
    let rule = "[design]\npretension_factor = 1.2\nenvironment_factor = 1.5\nstrength_factor = 0.95\n\
                least_share = 0.05\n";
    let case = structure(&format!("{CYLINDER}\nduration = 120\n{rule}"));
    let comparison = compare_elastic(
        ModelAtRest::for_elastic_lines(case).expect("a start"),
        1.0,
        f64::INFINITY,
        &no_progress,
    );
    let comparison = comparison.expect("an answer");
    let checks = comparison.checks();
    assert_eq!(checks.len(), 4);
    for (check, agreeing) in &checks {
        assert_eq!(*agreeing, 0, "no neighbours are run");
        let line = check.line.expect("a line") - 1;
        let (rest, peak) = (
            comparison.elastic_case.rest.tension_n[line],
            comparison.elastic.peaks_n[line],
        );
        let breaks = comparison.elastic_case.structure.lines[line]
            .breaking_load_n
            .expect("known");
        let known = match check.criterion {
            Criterion::Strength => (1.2 * rest + 1.5 * (peak - rest)) / (0.95 * breaks),
            _ => comparison.elastic.least_n[line].expect("judged") / rest,
        };
        assert!(
            (check.value.expect("a value") - known).abs() < 1e-12,
            "{check:?}"
        );
    }
    assert!(
        comparison
            .summary("case")
            .contains("factored tension over strength")
    );

    let sea = include_str!("../../../../docs/examples/cylinder-sea.toml");
    let sea = structure(&format!("{sea}\nduration = 200\n{rule}force_share = 0.2\n"));
    for lines in [Lines::Inextensible, Lines::Elastic] {
        let found = seas(sea.clone(), 5, lines, &no_progress).expect("an answer");
        let over_all = found.checks();
        assert_eq!(over_all.len(), 5);
        for (index, check) in over_all.iter().enumerate() {
            let each = found.records.iter().map(|record| &record.checks[index]);
            let values = each.clone().map(|check| check.value.expect("a value"));
            let worst = match check.worst.criterion {
                Criterion::Strength | Criterion::WaveForce => values.fold(0.0, f64::max),
                _ => values.fold(f64::INFINITY, f64::min),
            };
            assert_eq!(check.worst.value, Some(worst));
            let passing = each.filter(|check| check.answer == Answer::Passes).count();
            assert_eq!((check.passing, check.of), (passing, 5));
        }
        // The waves' forces differ from record to record.
        let forces = found.records.iter().map(|record| record.checks[4].value);
        assert!(
            forces
                .collect::<Vec<_>>()
                .windows(2)
                .all(|pair| pair[0] != pair[1])
        );
        let page = snapload_structure::note::seas_page(source("case"), &found).expect("a page");
        assert!(page.contains("Design checks") && found.summary("case").contains("of 5 records"));
    }
}

/// The duration of a snap is π sqrt(m/k) with the effective mass at the line, rotation included:
/// 1/m = n_x²/M_x + n_z²/M_z + s²/I.
#[test]
fn a_snap_lasts_as_long_as_its_effective_mass_requires() {
    let soft = CYLINDER.replace("type = \"studless chain\"", "type = \"polyester\"");
    let case = structure(&format!("{soft}\nduration = 60\n"));
    let (body, line) = (&case.body, &case.lines[0]);
    let prepared = ModelAtRest::new(case.clone()).expect("a start");
    let at = prepared.rest.place_m;
    let arm = [0, 1].map(|k| line.fairlead_m[k] - body.position_m[k]);
    let span = [0, 1].map(|k| at[k] + arm[k] - line.anchor_m[k]);
    let n = span.map(|part| part / span[0].hypot(span[1]));
    let turn = arm[0] * n[1] - arm[1] * n[0];
    let [along, up] = body.moving_mass_kg();
    let inverse =
        n[0] * n[0] / along + n[1] * n[1] / up + turn * turn / body.turning_inertia_kg_m2();
    let rate = line.spring_rate_n_m().expect("known");
    let lasts = std::f64::consts::PI / (inverse * rate).sqrt();
    let found = snapload_structure::warnings(&prepared);
    let warning = found
        .iter()
        .find(|warning| warning.rule == "instant snap")
        .expect("soft");
    let words = format!("{lasts:.2} s in line 1");
    assert!(
        warning.message.contains(&words),
        "{} {words}",
        warning.message
    );
}

/// If the lines can not hold the body against a load, the message names the load and not their
/// lengths.
#[test]
fn loads_that_push_it_away_are_named() {
    let pushed = CYLINDER.replace("position =", "constant_force = [4e6, -6e5]\nposition =");
    let error = ModelAtRest::new(structure(&pushed))
        .expect_err("pushed away")
        .to_string();
    assert!(
        error.contains("body.constant_force = [4000000, -600000]"),
        "{error}"
    );
}
