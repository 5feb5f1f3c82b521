//! The added mass of a body: along each axis, and in rotation.

use crate::verdicts::source;
use snapload::analysis::no_progress;
use snapload::{Playback, Stop};
use snapload_structure::{
    ElasticRun, ModelAtRest, Structure, assess, compare_elastic, elastic_lines, note, run_elastic,
};
use std::f64::consts::PI;

/// A pontoon of 4 × 2 × 20 m in still water on two upright lines, its centre 4 m down.
fn upright(more: &str, run: &str) -> Structure {
    let line = |x: f64| {
        format!(
            "[[line]]\nanchor = [{x}, -20]\nfairlead = [{x}, -5]\nlength = 15\nstiffness = 6e8\n"
        )
    };
    let text = format!(
        "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\nmass = 90000\ndisplaced_volume = 160\n\
         position = [0, -4]\n{more}\n{}{}[site]\ndepth = 21\n[run]\n{run}\n",
        line(1.5),
        line(-1.5)
    );
    Structure::parse("pontoon", &text).unwrap()
}

/// What table D-1 of DNV-RP-C205 prints for b/T = 2: C_A = 1.70 of π ρ T² in x, 1.36 of π ρ b² in
/// z, and 0.15 of π ρ b⁴ in rotation.
#[test]
fn a_rectangle_has_its_added_mass_from_the_table() {
    let structure = upright("", "restitution = 0.5");
    let added = structure.body.added_mass;
    let unit = PI * 1025.0 * 20.0;
    for (ours, printed, digits) in [
        (added.surge_kg, 1.70 * unit, 3e-3),
        (added.heave_kg, 1.36 * 4.0 * unit, 3e-3),
        (added.pitch_kg_m2, 0.15 * 16.0 * unit, 0.03),
    ] {
        assert!((ours / printed - 1.0).abs() < digits, "{ours} {printed}");
    }
    let words = structure.default_text().expect("it is a default");
    assert!(
        words.contains("added mass 109.2 t in x and 351.3 t in z") && words.contains("DNV-RP-C205"),
        "{words}"
    );
    let assessment = assess(structure, 0, &no_progress).unwrap();
    assert!(assessment.summary("pontoon").contains("DNV-RP-C205"));
    let json = assessment.to_json("pontoon");
    assert_eq!(json["body"]["added_mass_kg"][0], added.surge_kg);
    let page = note::page(source("pontoon"), &assessment, None).unwrap();
    assert!(page.contains("DNV-RP-C205"));
}

/// A single number is the added mass along both axes, and the moment of inertia given with it
/// includes that of the water; three numbers give the same structure, to the last bit.
#[test]
fn one_number_serves_both_axes() {
    let system = |more: &str| {
        let structure = upright(more, "restitution = 0.5");
        assert_eq!(structure.default_text(), None);
        ModelAtRest::new(structure).unwrap().model.system
    };
    let one = system("added_mass = 2e5\nmoment_of_inertia = 4e5");
    let three = system("added_mass = [2e5, 2e5, 1e5]\nmoment_of_inertia = 3e5");
    assert_eq!(one, three);
    // If left out, the moment of inertia is that of the body plus that of the water.
    let structure = upright("added_mass = 2e5", "restitution = 0.5");
    let body = &structure.body;
    let own = 90000.0 * 20.0 / 12.0;
    assert_eq!(body.moment_of_inertia_kg_m2, own);
    assert!((body.turning_inertia_kg_m2() - own - 151.2e3).abs() < 100.0);
    assert!(structure.default_text().is_some());
}

/// Natural period of a coordinate: twice the mean time between its zeros.
fn period(run: &ElasticRun, coordinate: impl Fn(&snapload::State) -> f64) -> f64 {
    let mut zeros = Vec::new();
    for pair in run.samples.windows(2) {
        let [a, b] = [0, 1].map(|i| coordinate(&pair[i].state));
        if a * b < 0.0 {
            let part = a / (a - b);
            zeros.push(pair[0].t_s + part * (pair[1].t_s - pair[0].t_s));
        }
    }
    assert!(zeros.len() > 4, "{zeros:?}");
    2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64
}

/// On upright elastic lines the body heaves with 2k on m + A33, surges with F/r on m + A11, and
/// pitches with 2k s² on I + A55 (plus F times its short lever), each by itself.
#[test]
fn each_freedom_swings_with_its_own_mass() {
    let structure = upright("", "restitution = 1\nduration = 30");
    let body = &structure.body;
    let [along, up] = body.moving_mass_kg();
    let force = structure.net_buoyancy_n();
    let rate = 6e8 / 15.0;
    let stretched = 15.0 + force / (2.0 * rate);
    let rest_z = -4.0 + force / (2.0 * rate);
    let swing = |start: [f64; 2], seconds: f64, every_s: f64| {
        let structure = Structure {
            duration_s: seconds,
            transient_s: 0.0,
            ..structure.clone()
        };
        let mut prepared = ModelAtRest::new(structure).unwrap();
        let law = elastic_lines(&prepared, 1.0).unwrap();
        // Lines that stretch let it start higher than those that do not.
        prepared.structure.start_m = Some(start);
        let prepared = prepared.with_elastic_lines(&law).unwrap();
        run_elastic(&prepared, &law, every_s, &no_progress).unwrap()
    };
    let scale = ModelAtRest::new(structure.clone()).unwrap().model.scales;
    // In the engine's picture z points down from where the lines are just taut.
    let heave = swing([0.0, rest_z - 0.001], 4.0, 0.002);
    let middle = (-4.0 - rest_z) / scale.length_m;
    let known = 2.0 * PI * (up / (2.0 * rate)).sqrt();
    let found = period(&heave, |state| state.y - middle);
    assert!((found / known - 1.0).abs() < 1e-3, "{found} {known}");
    let surge = swing([0.05, rest_z - 0.05 * 0.05 / 2.0 / stretched], 40.0, 0.02);
    let known = 2.0 * PI * (along * stretched / force).sqrt();
    let found = period(&surge, |state| state.x);
    assert!((found / known - 1.0).abs() < 2e-3, "{found} {known}");
}

/// Inextensible lines: released one metre below, the body rises by F over m + A33, and each of two
/// upright lines stops half of that mass.
#[test]
fn a_snap_stops_the_mass_of_its_direction() {
    let structure = upright(
        "",
        "restitution = 0.3\nduration = 3\ntransient = 0\nstart = [0, -5]",
    );
    let [_, up] = structure.body.moving_mass_kg();
    let force = structure.net_buoyancy_n();
    let assessment = assess(structure, 0, &no_progress).unwrap();
    let speed = (2.0 * force / up).sqrt();
    for snap in &assessment.snaps[..2] {
        assert!((snap.speed_m_s / speed - 1.0).abs() < 1e-9, "{snap:?}");
        assert!((snap.t_s / (speed * up / force) - 1.0).abs() < 1e-9);
        assert!((snap.impulse_n_s / (0.5 * up * 1.3 * speed) - 1.0).abs() < 1e-9);
    }
    let lost: f64 = assessment.snaps[..2].iter().map(|s| s.energy_lost_j).sum();
    assert!((lost / (0.5 * up * speed * speed * (1.0 - 0.09)) - 1.0).abs() < 1e-9);
    let heights = Playback::new(&assessment.run).at(0.0).state.y;
    assert!(heights > 0.0);
}

/// The effect on a verdict: the pontoon in waves on polyester, with one number for both axes, that
/// of surge or that of heave, and with a number for each axis.
#[test]
fn one_number_misses_the_peak_of_a_pontoon() {
    let line = |side: f64| {
        format!(
            "[[line]]\nanchor = [{}, -10]\nfairlead = [{}, -4.2]\nlength = 6.5\ntype = \"polyester\"\n\
             diameter = 0.1\n",
            5.0 * side,
            2.0 * side
        )
    };
    let peak = |added: &str| {
        let text = format!(
            "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\nmass = 90000\n\
             displaced_volume = 160\nposition = [0, -3.2]\n{added}\n{}{}[site]\ndepth = 10\n\
             [wave]\nheight = 2\nperiod = 6\n[run]\nrestitution = 0.5\nduration = 120\n",
            line(1.0),
            line(-1.0)
        );
        let structure = Structure::parse("pontoon", &text).unwrap();
        let comparison =
            compare_elastic(ModelAtRest::new(structure).unwrap(), 1.0, 0.1, &no_progress).unwrap();
        let peak = comparison
            .elastic
            .peaks_n
            .iter()
            .copied()
            .fold(0.0, f64::max);
        (comparison.elastic.stop, peak)
    };
    let own_inertia = "moment_of_inertia = 150000";
    let of_surge = peak(&format!("added_mass = 109199\n{own_inertia}"));
    let of_heave = peak(&format!("added_mass = 351300\n{own_inertia}"));
    let each = peak("");
    // Polyester of 100 mm breaks at 1705 kN: one number for both axes changes whether it breaks.
    let breaks = 170_466e3 * 0.1 * 0.1;
    assert_eq!([of_surge.0, each.0], [None, None]);
    assert!(
        of_surge.1 < breaks && breaks < each.1,
        "{of_surge:?} {each:?}"
    );
    // With the number of heave for both axes the body is thrown onto the floor.
    assert_eq!(of_heave.0, Some(Stop::UpperBound));
}
