//! Constant loads: a current, mean drift.

use snapload::Playback;
use snapload::analysis::no_progress;
use snapload_structure::{ModelAtRest, Structure, assess, elastic_lines};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// A body on one line from its centre, which then points along the sum of all forces.
fn pendulum(body: &str, site: &str, run: &str) -> Structure {
    let text = format!(
        "[body]\nmass = 500\ndisplaced_volume = 0.8\nwidth = 1\nposition = [0, -5]\n{body}\n\
         [[line]]\nanchor = [0, -20]\nfairlead = [0, -5]\nlength = 15\nstiffness = 3e6\n\
         [site]\ndepth = 21\n{site}\n[run]\nrestitution = 0.5\n{run}\n"
    );
    Structure::parse("pendulum", &text).unwrap()
}

/// The line leans so that T sin α = ½ ρ C_d A U² + b U + F_x and T cos α = F + F_z, stiff or
/// elastic.
#[test]
fn a_current_leans_the_line() {
    for (current, push, lift) in [(0.8, 0.0, 0.0), (-1.1, 300.0, -150.0), (0.4, -90.0, 200.0)] {
        let body =
            format!("drag_area = 1.5\nlinear_damping = 40\nconstant_force = [{push}, {lift}]");
        let structure = pendulum(&body, &format!("current = {current}"), "duration = 5");
        let along = (0.5 * 1025.0 * 1.5 * f64::abs(current) + 40.0) * current + push;
        let up = structure.net_buoyancy_n() + lift;
        assert!((structure.drag_of_current_n() + push - along).abs() < 1e-9);
        let pull = along.hypot(up);
        let prepared = ModelAtRest::new(structure).unwrap();
        let law = elastic_lines(&prepared, 1.0).unwrap();
        let elastic_case = prepared.with_elastic_lines(&law).unwrap();
        for (rest, length) in [
            (&prepared.rest, 15.0),
            (&elastic_case.rest, 15.0 + pull / 2e5),
        ] {
            let [x, z] = rest.place_m;
            // |u| is rounded off below 1e-5 of a unit of speed.
            assert!(
                (x - length * along / pull).abs() < 1e-7 * length,
                "{rest:?}"
            );
            assert!((z + 20.0 - length * up / pull).abs() < 1e-7 * length);
            assert!((rest.tension_n[0] / pull - 1.0).abs() < 1e-7);
        }
        // The body stays there, and the neighbours of a run have the same current.
        let mut motion = prepared.begin(1.5).unwrap();
        while motion.step().is_some() {}
        let end = prepared
            .model
            .scales
            .to_si([motion.state().x, motion.state().y]);
        for (end, rest) in end.into_iter().zip(prepared.rest.place_m) {
            assert!((end - rest).abs() < 1e-6, "{end} {rest}");
        }
    }
}

/// A body that drifts with the current has no drag.
#[test]
fn only_the_water_past_the_body_drags() {
    let text = EXAMPLE
        .replace("[body]", "[body]\ndrag_area = 60\nlinear_damping = 5e3")
        .replace("[site]", "[site]\ncurrent = 0.7")
        .replace("[wave]\nheight = 2", "[wave]\nheight = 0");
    let prepared = ModelAtRest::new(Structure::parse("case", &text).unwrap()).unwrap();
    let drag = prepared.model.system.drag.as_ref().expect("it resists");
    let unit = prepared.model.scales.speed_m_s();
    let with_it = snapload::State {
        vx: 0.7 / unit,
        ..snapload::State::default()
    };
    assert!(
        drag.at(drag.velocity_of_water(1.3), &with_it)
            .iter()
            .all(|part| part.abs() < 1e-12)
    );
}

/// A mirrored current mirrors the run, and every answer names the current.
#[test]
fn a_current_is_reported_and_has_a_side() {
    let run = |side: f64| {
        let text = EXAMPLE
            .replace(
                "[body]",
                &format!(
                    "[body]\ndrag_area = 60\nconstant_force = [{}, 0]",
                    4e3 * side
                ),
            )
            .replace("[site]", &format!("[site]\ncurrent = {}", 0.5 * side))
            .replace("[run]", "[run]\nduration = 30\ntransient = 0")
            .replace(
                "[wave]",
                &format!(
                    "[wave]\ndirection = \"{}\"",
                    if side > 0.0 { "+x" } else { "-x" }
                ),
            );
        assess(Structure::parse("case", &text).unwrap(), 0, &no_progress).unwrap()
    };
    let (right, left) = (run(1.0), run(-1.0));
    assert!((right.prepared.rest.place_m[0] + left.prepared.rest.place_m[0]).abs() < 1e-9);
    assert!(right.prepared.rest.tension_n[1] > right.prepared.rest.tension_n[0]);
    let at = |run: &snapload_structure::Assessment| Playback::new(&run.run).at(4.0).state.x;
    assert!((at(&right) + at(&left)).abs() < 1e-6);
    let summary = right.summary("case");
    assert!(
        summary.contains(
            "a current of 0.5 m/s with a drag of 7.7 kN; a constant force of 4.0 kN in x"
        ),
        "{summary}"
    );
}

#[test]
fn loads_that_do_nothing_or_sink_the_body_are_refused() {
    for (from, to, says) in [
        ("[site]", "[site]\ncurrent = 0.5", "site.current = 0.5"),
        (
            "[body]",
            "[body]\nconstant_force = [0, -8e5]",
            "body.constant_force",
        ),
    ] {
        let text = EXAMPLE.replace(from, to);
        let error = Structure::parse("case", &text).expect_err(to).to_string();
        assert!(error.contains(says), "{error}");
    }
}
