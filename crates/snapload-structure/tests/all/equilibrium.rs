//! Positions of rest: known ones, and the conditions of a minimum for random moorings.

use crate::verdicts::structure;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::analysis::no_progress;
use snapload_structure::{
    ModelAtRest, Structure, assess, compare_elastic, elastic_lines, equilibrium,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

fn case(position: [f64; 2], lines: &[([f64; 2], [f64; 2], f64)]) -> String {
    let mut text = format!(
        "[body]\nmass = 5000\ndisplaced_volume = 12\nwidth = 2\nposition = [{}, {}]\n\
         [site]\ndepth = 30\n[run]\nrestitution = 0.5\n",
        position[0], position[1]
    );
    for (anchor, fairlead, length) in lines {
        text += &format!(
            "[[line]]\nanchor = [{}, {}]\nfairlead = [{}, {}]\nlength = {length}\n",
            anchor[0], anchor[1], fairlead[0], fairlead[1]
        );
    }
    text
}

/// The example's fairleads are drawn 0.6 mm short of the lines' ends, so that it rests higher by
/// that, upright by symmetry, with half of the buoyancy carried by each line: T = F/(2 cos), the
/// lines 25 degrees from vertical.
#[test]
fn symmetric_pair_shares_the_buoyancy() {
    let structure = Structure::parse("cylinder.toml", EXAMPLE).unwrap();
    let rest = equilibrium(&structure).unwrap();
    let (run, rise) = (3.593 - 1.061, (36.0_f64 - 2.532 * 2.532).sqrt());
    assert!(rest.place_m[0].abs() < 1e-9 && rest.theta_rad.abs() < 1e-9);
    assert!(
        (rest.place_m[1] - (rise - 10.0 + 1.061)).abs() < 1e-9,
        "{rest:?} {run}"
    );
    let share = structure.net_buoyancy_n() / 2.0 / (rise / 6.0);
    assert!(
        rest.tension_n
            .iter()
            .all(|tension| (tension / share - 1.0).abs() < 1e-9)
    );
    assert!(!rest.indeterminate);
}

/// A single tether at the lowest point: the body stands above its anchor.
#[test]
fn single_tether_stands_upright() {
    let text = case([3.0, -12.0], &[([4.0, -30.0], [3.0, -13.0], 18.0)]);
    let structure = Structure::parse("tether", &text).unwrap();
    let rest = equilibrium(&structure).unwrap();
    assert!(
        (rest.place_m[0] - 4.0).abs() < 1e-6 && (rest.place_m[1] + 11.0).abs() < 1e-9,
        "{rest:?}"
    );
    assert!((rest.tension_n[0] / structure.net_buoyancy_n() - 1.0).abs() < 1e-9);
}

/// Four equal vertical tethers, two at each end: three degrees of freedom, four lines, and each
/// carries a quarter.
#[test]
fn statically_indeterminate_lines_share_evenly() {
    let tether = |x: f64| ([x, -30.0], [x, -12.0], 18.0);
    let text = case(
        [0.0, -12.0],
        &[tether(-1.0), tether(-0.5), tether(0.5), tether(1.0)],
    );
    let structure = Structure::parse("tethers", &text).unwrap();
    let rest = equilibrium(&structure).unwrap();
    assert!(rest.indeterminate && rest.taut.len() == 4);
    let quarter = structure.net_buoyancy_n() / 4.0;
    assert!(
        rest.tension_n
            .iter()
            .all(|tension| (tension / quarter - 1.0).abs() < 1e-6),
        "{rest:?}"
    );
}

#[test]
fn lines_too_long_to_hold_the_body_down_are_refused_with_a_reason() {
    let text = case(
        [0.0, -12.0],
        &[
            ([5.0, -30.0], [1.0, -12.0], 40.0),
            ([-5.0, -30.0], [-1.0, -12.0], 40.0),
        ],
    );
    let structure = Structure::parse("long", &text).unwrap();
    let error = equilibrium(&structure).unwrap_err().to_string();
    assert!(
        error.contains("above the still water") && error.contains("shorten the lines"),
        "{error}"
    );
}

/// A body on four soft lines from fairleads above its centre, which would turn over: upright it
/// is in balance, but not at rest.
const TOP_HEAVY: &str = "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\nmass = 20000\n\
     displaced_volume = 40\nadded_mass = [20000, 40000, 30000]\nmoment_of_inertia = 30000\n\
     position = [0, -5]\n[site]\ndepth = 15\n[run]\nrestitution = 0.5\nduration = 5\n";

fn top_heavy(limiting: bool) -> Structure {
    let mut text = TOP_HEAVY.to_owned();
    let mut lines = vec![
        (6.0, [0.2, -4.1], 12.3492914, 2e5),
        (1.0, [0.4, -4.1], 10.9165, 2e5),
    ];
    lines.extend(limiting.then_some((2.0, [2.0, -6.0], 9.8, 4e6)));
    for (anchor, [x, z], length, rate) in lines {
        for side in [1.0, -1.0] {
            text += &format!(
                "[[line]]\nanchor = [{}, -15]\nfairlead = [{}, {z}]\nlength = {length}\n\
                 spring_rate = {rate}\n",
                side * anchor,
                side * x
            );
        }
    }
    Structure::parse("top-heavy", &text).unwrap()
}

/// The potential energy of buoyancy and springs, by hand \[J\].
fn energy(structure: &Structure, [x, z, theta]: [f64; 3]) -> f64 {
    let (sine, cosine) = theta.sin_cos();
    let spring = |line: &snapload_structure::LineSi| {
        let [fx, fz] = [0, 1].map(|k| line.fairlead_m[k] - structure.body.position_m[k]);
        let place = [x + fx * cosine - fz * sine, z + fx * sine + fz * cosine];
        let apart = (place[0] - line.anchor_m[0]).hypot(place[1] - line.anchor_m[1]);
        let stretch = (apart - line.length_m).max(0.0);
        0.5 * line.spring_rate_n_m().unwrap() * stretch * stretch
    };
    structure.lines.iter().map(spring).sum::<f64>() - structure.net_buoyancy_n() * z
}

fn assert_least_energy(structure: &Structure, place: [f64; 3]) {
    let least = energy(structure, place);
    for step in 0..27 {
        let aside =
            [0, 1, 2].map(|k| place[k] + 1e-3 * f64::from(step / 3_i32.pow(k as u32) % 3 - 1));
        assert!(
            step == 13 || energy(structure, aside) > least,
            "{place:?} {aside:?}"
        );
    }
}

/// Two soft lines that cross hold a body upright where they are stretched, but not where they are
/// not: the place of rest is found although the energy decreases from there to a body turned over.
#[test]
fn a_place_of_rest_on_crossed_lines_is_found() {
    let mut text = "[body]\nshape = \"rectangle\"\nwidth = 3.128\nheight = 4.228\nmass = 78673.6\n\
        displaced_volume = 132.2476\nadded_mass = [10000, 20000, 30000]\nmoment_of_inertia = 182900\n\
        position = [0, -15]\n[site]\ndepth = 40\n[run]\nrestitution = 0.5\nduration = 1\n"
        .to_owned();
    for side in [1.0, -1.0] {
        text += &format!(
            "[[line]]\nanchor = [{}, -40]\nfairlead = [{}, -15.00479]\nlength = 25.304163\n\
             stiffness = 5275351\n",
            side * -3.424175,
            side * 0.2241548
        );
    }
    let structure = Structure::parse("crossed", &text).unwrap();
    let prepared = ModelAtRest::new(structure.clone()).unwrap();
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let rest = prepared.with_elastic_lines(&law).unwrap().rest;
    assert_least_energy(
        &structure,
        [rest.place_m[0], rest.place_m[1], rest.theta_rad],
    );
    assert!(rest.theta_rad.abs() < 1e-9 && !rest.either_side);
}

/// On elastic lines, too, a body rests where its energy is least in every direction: turned to
/// where a slack line holds it, counter-clockwise of the two places that mirror each other.
#[test]
fn an_unstable_balance_on_elastic_lines_is_no_place_of_rest() {
    let structure = top_heavy(true);
    let prepared = ModelAtRest::new(structure.clone()).unwrap();
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let rest = prepared.with_elastic_lines(&law).unwrap().rest;
    let place = [rest.place_m[0], rest.place_m[1], rest.theta_rad];
    let least = energy(&structure, place);
    assert_least_energy(&structure, place);
    assert!(rest.theta_rad > 0.1 && rest.either_side, "{place:?}");
    let mirrored = energy(&structure, [-place[0], place[1], -place[2]]);
    assert!((mirrored - least).abs() < 1e-6, "{mirrored} {least}");

    // Nothing stops this one: the more it turns, the lower its energy.
    let turning = top_heavy(false);
    let prepared = ModelAtRest::new(turning.clone()).unwrap();
    let error = prepared.with_elastic_lines(&elastic_lines(&prepared, 1.0).unwrap());
    let error = error.map(|_| ()).unwrap_err().to_string();
    assert!(
        error.contains("elastic lines that hold the body at rest"),
        "{error}"
    );
    let assessment = assess(turning, 0, &no_progress).unwrap();
    assert!(
        assessment
            .warnings
            .iter()
            .any(|w| w.rule == "rest on elastic lines")
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(1974),
        ..ProptestConfig::with_cases(60)
    })]

    /// For random moorings of two to four lines: the forces balance, slack lines have no tension
    /// and taut ones a positive one, and no position nearby that all lines reach lies higher.
    #[test]
    fn rest_is_a_minimum(
        lines in prop::collection::vec((-20.0..20.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.0..1.0f64), 2..5),
        probes in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 200),
    ) {
        let lines: Vec<_> = lines.iter().map(|&(x, fx, fz, more)| {
            let fairlead = [fx, -14.0 + fz];
            let reach = (x - fx).hypot(fairlead[1] + 30.0);
            ([x, -30.0], fairlead, reach + more)
        }).collect();
        let structure = Structure::parse("random", &case([0.0, -14.0], &lines)).unwrap();
        // Many moorings hold no body, but the test needs many that do.
        let rest = equilibrium(&structure);
        prop_assume!(rest.is_ok());
        let rest = rest.unwrap();
        let place = |[x, z]: [f64; 2], theta: f64, fairlead: [f64; 2]| {
            let (s, c) = theta.sin_cos();
            let arm = [fairlead[0], fairlead[1] + 14.0];
            [x + arm[0] * c - arm[1] * s, z + arm[0] * s + arm[1] * c]
        };
        let mut force = [0.0, structure.net_buoyancy_n()];
        let mut moment = 0.0;
        for ((anchor, fairlead, length), tension) in lines.iter().zip(&rest.tension_n) {
            let at = place(rest.place_m, rest.theta_rad, *fairlead);
            let span = [anchor[0] - at[0], anchor[1] - at[1]];
            let distance = span[0].hypot(span[1]);
            prop_assert!(distance <= length + 1e-6 && *tension >= 0.0);
            prop_assert!(*tension == 0.0 || (distance - length).abs() < 1e-6);
            let pull = [tension * span[0] / distance, tension * span[1] / distance];
            force = [force[0] + pull[0], force[1] + pull[1]];
            let arm = [at[0] - rest.place_m[0], at[1] - rest.place_m[1]];
            moment += arm[0] * pull[1] - arm[1] * pull[0];
        }
        let buoyancy = structure.net_buoyancy_n();
        prop_assert!(force[0].abs() < 1e-4 * buoyancy && force[1].abs() < 1e-4 * buoyancy && moment.abs() < 1e-4 * buoyancy);
        for size in [1e-3, 1e-2, 0.05] {
            for &(dx, dz, turn) in &probes {
                let near = [rest.place_m[0] + size * dx, rest.place_m[1] + size * dz];
                let theta = rest.theta_rad + size * turn;
                let reached = lines.iter().all(|(anchor, fairlead, length)| {
                    let at = place(near, theta, *fairlead);
                    (anchor[0] - at[0]).hypot(anchor[1] - at[1]) <= *length
                });
                prop_assert!(!reached || near[1] <= rest.place_m[1] + 1e-6);
            }
        }
    }
}

/// A line that is slack at rest and never becomes taut does not go slack; the verdict says so.
#[test]
fn a_line_that_stays_slack_does_not_go_slack() {
    let third = "[[line]]\nanchor = [0, -10]\nfairlead = [1.061, -4.561]\nlength = 6\n\
                 type = \"studless chain\"\ndiameter = 0.038\n[site]";
    let text = EXAMPLE.replace("[site]", third);
    let text = text.replace("[run]", "[run]\nduration = 60\ntransient = 20");
    let calm = structure(&text.replace("height = 2\n", "height = 0.02\n"));
    let assessment = assess(calm.clone(), 0, &no_progress).unwrap();
    let loaded = |line: usize| assessment.outcome.lines[line].least_n.unwrap() > 0.0;
    assert_eq!([0, 1, 2].map(loaded), [true, true, false]);
    let calm = ModelAtRest::new(calm).unwrap();
    let on_elastic = compare_elastic(calm, 1.0, f64::INFINITY, &no_progress).unwrap();
    for words in [assessment.verdict().words, on_elastic.verdict().words] {
        let said = "No line goes slack. Line 3 is slack at rest and stays so in the judged time.";
        assert!(words.starts_with(said), "{words}");
    }
    // The others do in a higher wave.
    let words = assess(structure(&text), 0, &no_progress)
        .unwrap()
        .verdict()
        .words;
    assert!(words.starts_with("Lines go slack and snap"), "{words}");
}

/// The tension at rest on one line is the length of all forces together, however stiff the line is,
/// or the line is too stiff for its stretch to be known: without tension the body does not rest.
#[test]
fn a_line_of_any_stiffness_carries_the_load() {
    let text = "[body]\nmass = 500\ndisplaced_volume = 0.8\nwidth = 1\nposition = [0, -5]\n\
                constant_force = [300, 0]\n[[line]]\nanchor = [0, -20]\nfairlead = [0, -5]\n\
                length = 15\nstiffness = 1e13\n[site]\ndepth = 21\n[run]\nrestitution = 0.5\n";
    let prepared = ModelAtRest::for_elastic_lines(structure(text)).unwrap();
    let pull_n = prepared.structure.net_buoyancy_n().hypot(300.0);
    for stiffer in [1.0, 1e2, 1e3, 1e4, 1e6, 1e9] {
        let lines = elastic_lines(&prepared, stiffer).unwrap();
        match prepared.with_elastic_lines(&lines) {
            Ok(elastic) => {
                let found_n = elastic.rest.tension_n[0];
                assert!(
                    (found_n / pull_n - 1.0).abs() < 2e-3,
                    "{stiffer}: {found_n}"
                );
            }
            Err(error) => {
                assert!(stiffer > 1e2, "{stiffer}: {error}");
                assert!(error.to_string().contains("line.stiffness"), "{error}");
            }
        }
    }
}
