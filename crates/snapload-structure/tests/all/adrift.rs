//! Floating bodies that no line holds in surge, and what damps a body's rotation.

use crate::afloat::{by_hand, case, parsed, structure};
use snapload::analysis::no_progress;
use snapload_hydro::TermRow;
use snapload_structure::{ModelAtRest, assess, compare_elastic, warnings};

/// On lines that are slack where it floats a body rests as its weight and water have it, at the
/// surge of its start, whether lines stretch or not: heave by (ρV − m) g / C33, and pitch by
/// the arm of its weight over C55.
#[test]
fn without_tension_it_rests_as_it_floats() {
    let start = "duration = 20\nstart = [0.3, -0.2]";
    let at = |mass: f64, arm: f64| {
        let text = case(-0.2, 2.0, 11.0, "", start).replace("80000", &mass.to_string());
        let weight = format!("[float]\ncentre_of_gravity = [{arm}, -0.2]");
        ModelAtRest::for_elastic_lines(structure(&text.replace("[float]", &weight))).unwrap()
    };
    for (mass, arm) in [(98_400.0, 0.0), (90_000.0, 0.0), (98_400.0, 0.05)] {
        let prepared = at(mass, arm);
        let afloat = prepared.structure.afloat.as_ref().unwrap();
        let stiffness = &afloat.body.stiffness;
        let heave = (98_400.0 - mass) * 9.81 / stiffness[(1, 1)];
        let pitch = mass * 9.81 * arm / stiffness[(2, 2)];
        let rest = &prepared.rest;
        assert!(rest.rests && rest.tension_n == [0.0, 0.0]);
        assert!((rest.place_m[0] - 0.3).abs() < 1e-12);
        assert!((rest.place_m[1] + 0.2 - heave).abs() < 1e-9, "{rest:?}");
        assert!((rest.theta_rad + pitch).abs() < 1e-9, "{rest:?} {pitch}");
        let comparison =
            compare_elastic(prepared.clone(), 1.0, f64::INFINITY, &no_progress).unwrap();
        let elastic_case = &comparison.elastic_case.rest;
        assert!((elastic_case.place_m[1] - rest.place_m[1]).abs() < 1e-9);
        assert!((elastic_case.theta_rad - rest.theta_rad).abs() < 1e-9);
    }
}

/// How a body floats without lines follows from all constant loads of the case: a centre of gravity
/// to the left turns it counter-clockwise, and an opposite moment of the case balances it.
#[test]
fn the_loads_of_a_case_decide_whether_a_body_floats_upright() {
    let warned = |arm: f64, moment: f64| {
        let keys =
            format!("[float]\ncentre_of_gravity = [{arm}, -0.2]\nconstant_moment = {moment}");
        let text = case(-0.2, 2.0, 9.666, "", "duration = 2").replace("[float]", &keys);
        let prepared = ModelAtRest::new(structure(&text)).unwrap();
        let found = warnings(&prepared);
        let found = found.into_iter().find(|w| w.rule == "balance");
        found.map(|w| w.message)
    };
    // m g (BM - BG) of the box at the draft at which it floats.
    let draft = 80_000.0 / (1025.0 * 20.0 * 4.0);
    let stiffness = 80_000.0 * 9.81 * (16.0 / (12.0 * draft) + 0.5 * draft - 1.0);
    let moment = 80_000.0 * 9.81 * 0.05;
    for (arm, constant, turning) in [
        (-0.05, 0.0, moment),
        (0.05, 0.0, -moment),
        (0.0, moment, moment),
    ] {
        let message = warned(arm, constant);
        let turned = format!(
            "turned by {:.1} degrees",
            (turning / stiffness).to_degrees()
        );
        assert!(
            message
                .as_ref()
                .is_some_and(|found| found.contains(&turned)),
            "{turned} {message:?}"
        );
    }
    assert_eq!(warned(0.0, 0.0), None);
    assert_eq!(warned(-0.05, -moment), None);
    // An arm of 0.4 m would turn it by 27 degrees, where hydrostatics are no longer linear.
    let far = warned(-0.4, 0.0).unwrap();
    assert!(
        far.contains("turns by more than 15 degrees, if not over, but"),
        "{far}"
    );
}

/// Where a line is too short for it to float without tension at its
/// start, no place of rest is told.
#[test]
fn a_start_is_not_reported_as_a_place_of_rest() {
    let line = |side: f64| {
        let (anchor, fairlead) = (60.0 * side, 5.0 * side);
        format!(
            "[[line]]\nanchor = [{anchor}, -50]\nfairlead = [{fairlead}, -3]\nlength = 72.4\n\
             stiffness = 3e8\nbreaking_load = 2e6\n"
        )
    };
    let text = |arm: f64| {
        format!(
            "[body]\nshape = \"rectangle\"\nwidth = 10\nheight = 5\ndisplaced_volume = 600\nmass = 615000\n\
             moment_of_inertia = 6.4e6\nposition = [0, -0.5]\n[float]\ncentre_of_gravity = [{arm}, -1]\n\
             [site]\ndepth = 50\n[run]\nrestitution = 0.4\nduration = 10\nstart = [0, -0.5]\n{}{}",
            line(1.0),
            line(-1.0)
        )
    };
    let assessment = assess(structure(&text(0.3)), 0, &no_progress).unwrap();
    assert!(!assessment.prepared.rest.rests);
    let summary = assessment.summary("case");
    assert!(
        summary.contains("at rest   not known, as no line holds the body"),
        "{summary}"
    );
    assert!(summary.contains("line 1    not known at rest"), "{summary}");
    let json = assessment.to_json("case");
    assert!(json["rest"]["z_m"].is_null() && json["lines"][0]["rest_tension_n"].is_null());
    // So far turned nothing rests on elastic lines either.
    let prepared = ModelAtRest::for_elastic_lines(structure(&text(1000.0))).unwrap();
    let refused = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap_err();
    let shown = refused.to_string();
    assert!(
        shown.contains("turned by") && shown.contains("line.stiffness"),
        "{shown}"
    );
}

/// Without a start such a body is refused in words that say how long the lines would
/// have to be, and what is too heavy.
#[test]
fn what_nothing_holds_is_refused_with_the_lengths_that_would() {
    let text = case(-0.2, 2.0, 9.8, "", "duration = 5");
    // Where it floats the ends are √(4² + 8.8²) apart, and as much nearer as it lies deeper.
    for (mass, says) in [
        (98_400.0, "shorten the lines"),
        (110_000.0, "weighs 110.0 t"),
    ] {
        let refused = parsed(&text.replace("80000", &mass.to_string()));
        let refused = refused.and_then(ModelAtRest::new).unwrap_err();
        let deeper = (mass - 98_400.0) * 9.81 / 804_420.0;
        let apart = 4.0_f64.hypot(8.8 - deeper);
        let shown = refused.to_string();
        assert!(
            shown.contains(&format!("[{apart:.3}, {apart:.3}] m apart")),
            "{shown}"
        );
        assert!(
            shown.contains(says) && shown.contains("line.length = [9.8, 9.8]"),
            "{shown}"
        );
    }
}

/// Waves of no height are still water: no rule of waves is broken by them, and each
/// that is broken in still water is.
#[test]
fn waves_of_no_height_break_no_rule() {
    let wave = "[wave]\nheight = 0\nperiod = 3";
    let text = case(-0.2, 2.0, 11.0, wave, "duration = 20\nstart = [0, 0.1]");
    let soft = text.replace("1.2e8", "1.2e6").replace("80000", "98400");
    let warnings = |text: &str| assess(structure(text), 0, &no_progress).unwrap().warnings;
    let found = warnings(&soft);
    assert_eq!(found, warnings(&soft.replace(wave, "")));
    assert!(found.iter().all(|warning| warning.rule != "phase"));
    let waves = warnings(&soft.replace("height = 0\nperiod", "height = 0.1\nperiod"));
    let of_waves = waves.iter().find(|warning| warning.rule == "instant snap");
    assert!(of_waves.is_some_and(|warning| !found.contains(warning)));
}

/// A body that turns far with nothing to damp it is warned of, by the key that would damp it; one
/// that its damping or the waves that it makes hold back is not.
#[test]
fn what_damps_a_rotation_is_known() {
    let seen = |text: &str| {
        let assessment = assess(parsed(text).unwrap(), 0, &no_progress).unwrap();
        let found = assessment.warnings.iter().find(|w| w.rule == "turning");
        (
            assessment.outcome.turned_rad,
            found.map(|w| w.message.clone()),
        )
    };
    // Let go upright, a body whose weight would hold it at 40 degrees turns about twice as far.
    let text = case(-0.2, 2.0, 13.0, "", "duration = 10\nstart = [0, -0.2]");
    let text = text.replace("80000", "98400");
    let by_waves = text.replace("[float]", "[float]\ncentre_of_gravity = [0.5, -0.2]");
    let undamped = by_waves.replace("file = \"pontoon.nc\"\ndeep_water = true\npairs = 6\n", "");
    let damped = undamped.replace("[float]", "[float]\ndamping = [0, 0, 1]");
    // The memory of heave alone damps no rotation.
    let (report, _) = by_hand();
    let mut heave: Vec<TermRow> = report.fit.memory.rows();
    for row in &mut heave {
        for (i, residues) in row.residue.iter_mut().enumerate() {
            for (j, residue) in residues.iter_mut().enumerate() {
                if (i, j) != (1, 1) {
                    *residue = [0.0; 2];
                }
            }
        }
    }
    heave.retain(|row| row.residue[1][1] != [0.0; 2]);
    let inf = report.fit.added_mass_inf;
    let rows: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| inf[(i, j)]));
    let memory = serde_json::json!({ "added_mass_inf": rows, "memory": heave });
    let file = std::env::temp_dir().join(format!("snapload-heave-{}.json", std::process::id()));
    std::fs::write(&file, memory.to_string()).unwrap();
    let of_heave = format!("memory = {:?}", file.display().to_string());
    let of_heave = by_waves.replace("pairs = 6", &of_heave);
    for (text, key) in [
        (by_waves, None),
        (of_heave, Some("give the third number of float.damping")),
        (undamped, Some("give the third number of float.damping")),
        (damped, None),
    ] {
        let (turned, warned) = seen(&text);
        assert!(turned > 1.1, "{turned}");
        let says = |key: &str| warned.as_ref().is_some_and(|words| words.ends_with(key));
        assert!(key.map_or(warned.is_none(), says), "{warned:?}");
    }
    std::fs::remove_file(file).unwrap();
}

/// Damping that was added to a memory acts in a run as damping of the body does.
#[test]
fn damping_of_a_memory_acts_in_a_run() {
    let (report, _) = by_hand();
    let mut json = serde_json::to_value(report.to_json()).unwrap();
    let name = format!("snapload-added-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let water = |json: &serde_json::Value, damping: &str| {
        std::fs::write(&path, json.to_string()).unwrap();
        let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
        let text = text.replace("pairs = 6", &format!("memory = {path:?}\n{damping}"));
        ModelAtRest::new(structure(&text))
            .unwrap()
            .model
            .system
            .floating
            .unwrap()
    };
    let without = water(&json, "");
    let own = water(&json, "damping = [0, 5e4, 0]");
    json["added_damping"][1][1] = 5e4.into();
    let added = water(&json, "");
    std::fs::remove_file(&path).unwrap();
    assert_eq!(added, own);
    assert_ne!(added, without);
}
