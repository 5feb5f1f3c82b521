//! Elastic lines: known motions, and the limit of stiff lines.

use serde_json::Value;
use snapload::Limit;
use snapload::analysis::no_progress;
use snapload_structure::{
    ElasticLine, ElasticRun, ModelAtRest, STRUCTURE, Structure, VerdictKind, compare_elastic,
    damping_ratio, elastic_lines, run_elastic,
};

/// A body straight above its anchor on two equal lines that lie on each other, so that it moves up
/// and down.
pub(crate) fn vertical(restitution: f64, start_z: f64) -> ModelAtRest {
    let text = format!(
        "[body]\nmass = 500\nadded_mass = 300\ndisplaced_volume = 0.8\nwidth = 1\nposition = [0, -5]\n\
         [[line]]\nanchor = [0, -20]\nfairlead = [0, -5]\nlength = 15\nstiffness = 3e6\n\
         [[line]]\nanchor = [0, -20]\nfairlead = [0, -5]\nlength = 15\nstiffness = 3e6\n\
         [site]\ndepth = 21\n\
         [run]\nrestitution = {restitution}\nduration = 4\nstart = [0, {start_z}]\n"
    );
    prepared(&text, &[])
}

fn prepared(text: &str, set: &[&str]) -> ModelAtRest {
    ModelAtRest::new(structure(text, set)).expect("a start")
}

pub(crate) fn structure(text: &str, set: &[&str]) -> Structure {
    let mut entries = snapload::Entries::parse(&STRUCTURE, "test.toml", text).expect("a case");
    for set in set {
        entries.set(set).expect("a key");
    }
    Structure::from_entries(&entries).expect("a structure")
}

pub(crate) const CYLINDER: &str = include_str!("../../../../docs/examples/cylinder.toml");

pub(crate) fn run(prepared: &ModelAtRest, elastic_lines: &[ElasticLine]) -> ElasticRun {
    run_elastic(prepared, elastic_lines, 0.05, &no_progress).expect("a run")
}

/// Let go below, the body rises at F/M to speed v = sqrt(2 F h/M), and a spring k stops it with
/// k δ = F + sqrt(F² + k M v²), after a time known too; then it is thrown back at v.
#[test]
fn a_spring_stops_a_body_as_its_energy_requires() {
    let prepared = vertical(1.0, -6.0);
    let (rate, mass) = (2.0 * 3e6 / 15.0, 800.0);
    let force = prepared.structure.net_buoyancy_n();
    let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
    let motion = run(&prepared, &law);
    let speed = (2.0 * force * 1.0 / mass).sqrt();
    let rise = speed / (force / mass);
    let known = force + (force * force + rate * mass * speed * speed).sqrt();
    let omega = (rate / mass).sqrt();
    // δ = F/k (1 − cos ωt) + v/ω sin ωt, which is zero again after twice the time to the top.
    let contact = 2.0 * (std::f64::consts::PI - (speed * rate / (omega * force)).atan()) / omega;
    let [first, second, ..] = &motion.pulls[..] else {
        panic!("two lines pull: {:?}", motion.pulls);
    };
    assert!((first.from_s - rise).abs() < 1e-9 && (second.from_s - rise).abs() < 1e-9);
    assert!((first.speed_m_s - speed).abs() < 1e-9);
    assert!(
        (first.peak_n + second.peak_n - known).abs() < 2e-4 * known,
        "{first:?} {known}"
    );
    assert!(
        (first.to_s - rise - contact).abs() < 1e-8,
        "{first:?} {contact}"
    );
    assert!((first.rebound_m_s.expect("it lets go") - speed).abs() < 1e-8);
}

/// Dampers that are chosen for e throw the body back at e times its speed, more exactly if the
/// buoyancy changes the speed less during the contact. Here two lines stop it together.
#[test]
fn the_damper_gives_the_restitution() {
    for e in [0.9, 0.5, 0.2, 0.1] {
        let prepared = vertical(e, -6.0);
        let mut last = f64::INFINITY;
        for stiffer in [1e2, 1e4, 1e6] {
            let law = elastic_lines(&prepared, stiffer).expect("elastic lines");
            let mut short = prepared.clone();
            short.model.rules.t_end *= 0.3;
            let pull = run(&short, &law).pulls[0];
            let off = (pull.rebound_m_s.expect("it lets go") / pull.speed_m_s - e).abs();
            assert!(off < last.max(1e-9), "{e}: {off} after {last}");
            last = off;
        }
        assert!(last < 2e-3, "{e}: off by {last}");
    }
}

/// e = exp(−2ζ arccos ζ/sqrt(1 − ζ²)): at ζ = 1 it is exp(−2), for small ζ nearly exp(−πζ).
#[test]
fn damping_ratios_of_known_restitutions() {
    assert!((damping_ratio((-2.0_f64).exp()) - 1.0).abs() < 1e-6);
    assert!((damping_ratio(1.0)).abs() < 1e-12);
    let small = 1e-4_f64;
    let e = (-std::f64::consts::PI * small + 2.0 * small * small).exp();
    assert!((damping_ratio(e) - small).abs() < 1e-10);
}

/// The same case on both kinds of lines: as the lines get stiffer, the times and speeds of the
/// snaps tend to those of inextensible lines, with an error proportional to the duration of
/// the contact, which is as 1/sqrt(k).
#[test]
fn stiff_lines_are_lines_that_do_not_stretch() {
    let mut prepared = prepared(
        CYLINDER,
        // A damper gives its e for one effective mass only; without dampers e is 1 for any.
        &[
            "run.restitution=1",
            "run.duration=9",
            "run.start=[0.2,-3.9]",
            "wave.height=1.5",
        ],
    );
    let mut simulation = prepared.begin(1.0).expect("a start");
    let time = prepared.model.scales.time_s;
    let speed = prepared.model.scales.speed_m_s();
    let mut snaps = Vec::new();
    while snaps.len() < 3
        && let Some(step) = simulation.step()
    {
        snaps.extend(step.impacts().map(|i| (i.cable, i.t * time, i.v_n * speed)));
    }
    prepared.model.rules.t_end = (snaps[2].1 + 1e-3) / time;
    let mut last = f64::INFINITY;
    for stiffer in [1e2, 1e4, 1e6] {
        let law = elastic_lines(&prepared, stiffer).expect("elastic lines");
        let motion = run(&prepared, &law);
        let mut worst = 0.0_f64;
        for (pull, (line, t, v)) in motion.pulls.iter().zip(&snaps) {
            assert_eq!(pull.line, *line, "{:?} {snaps:?}", motion.pulls);
            worst = worst
                .max((pull.from_s - t).abs())
                .max((pull.speed_m_s - v).abs());
        }
        assert!(worst < 0.25 * last, "{stiffer}: {worst} after {last}");
        last = worst;
    }
    assert!(last < 2e-3, "{last}");
}

/// Without waves and drag, springs conserve energy, and dampers only reduce it.
#[test]
fn energy_is_kept_or_lost() {
    for (e, lost) in [(1.0, false), (0.6, true)] {
        let set = ["wave.height=0", "run.start=[0.3,-4.2]", "run.duration=20"];
        let prepared = prepared(
            &CYLINDER.replace("restitution = 0.5", &format!("restitution = {e}")),
            &set,
        );
        let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
        let motion = run(&prepared, &law);
        let energy = |state: &snapload::State| {
            let stored = law
                .iter()
                .zip(&prepared.model.system.cables)
                .map(|(line, cable)| {
                    let [u, v] = cable.span(state).components();
                    let stretch = (u.hypot(v) - cable.length()).max(0.0);
                    0.5 * line.rate * stretch * stretch
                });
            prepared.model.system.energy(state) + stored.sum::<f64>()
        };
        let first = energy(&prepared.start());
        let mut now = first;
        for sample in &motion.samples {
            let next = energy(&sample.state);
            // Samples are from the dense output, which is less exact than the steps.
            assert!(next <= now + 1e-7, "{} at {}", next - now, sample.t_s);
            now = next;
        }
        let end = energy(&motion.end);
        assert!(end <= first + 1e-9, "{}", end - first);
        // To the end, or to the quarter turn at which the run stops.
        assert!(
            (motion.end_s - 20.0).abs() < 1e-9 || motion.end.theta.abs() >= 1.57,
            "{} s",
            motion.end_s
        );
        assert!(motion.pulls.len() > 6, "{}", motion.pulls.len());
        assert_eq!(first - end > 1e-6, lost, "{}", first - end);
    }
}

/// A line holds an undisturbed body at rest for any time: δ = T_0/k throughout, and the run ends
/// with its time.
#[test]
fn a_body_at_rest_stays() {
    let prepared = prepared(CYLINDER, &["wave.height=0", "run.duration=30"]);
    let motion = run(&prepared, &elastic_lines(&prepared, 1e3).expect("lines"));
    assert!((motion.end_s - 30.0).abs() < 1e-9, "{} s", motion.end_s);
    assert_eq!(motion.samples.len() / 100, 6, "{}", motion.samples.len());
    for (line, at_rest) in prepared.rest.tension_n.iter().enumerate() {
        let last = motion.samples.last().expect("looks").tension_n[line];
        assert!((last / at_rest - 1.0).abs() < 1e-3, "{last} {at_rest}");
    }
}

/// In still water a body that begins at its position of rest on springs stays there, and the lines
/// balance the buoyancy: each of two equal lines carries half of it, over the cosine of their
/// slope.
#[test]
fn it_begins_where_it_rests_on_elastic_lines() {
    let still = CYLINDER
        .replace("height = 2 ", "height = 0 ")
        .replace("[wave]\nheight = 2\nperiod = 6\n", "");
    for stiffer in [0.1, 1.0, 100.0] {
        let prepared = prepared(&still, &["run.duration=20", "run.transient=0"]);
        let law = elastic_lines(&prepared, stiffer).expect("elastic lines");
        let elastic_case = prepared.with_elastic_lines(&law).expect("a place of rest");
        let motion = run(&elastic_case, &law);
        let (rest, scales) = (&elastic_case.rest, &elastic_case.model.scales);
        let line = &elastic_case.structure.lines[0];
        let fairlead = [0, 1].map(|k| {
            line.fairlead_m[k] - elastic_case.structure.body.position_m[k] + rest.place_m[k]
        });
        let along = [0, 1].map(|k| fairlead[k] - line.anchor_m[k]);
        let slope = along[1] / along[0].hypot(along[1]);
        let known = prepared.structure.net_buoyancy_n() / (2.0 * slope);
        for tension in &rest.tension_n {
            assert!((tension / known - 1.0).abs() < 1e-9, "{tension} {known}");
        }
        // The force determines its length.
        let stretched = line.length_m + known / (line.spring_rate_n_m().unwrap() * stiffer);
        assert!((along[0].hypot(along[1]) - stretched).abs() < 1e-9);
        for (line, peak) in motion.peaks_n.iter().enumerate() {
            assert!((peak / rest.tension_n[line] - 1.0).abs() < 1e-7, "{peak}");
        }
        let [x, z] = scales.to_si([motion.end.x, motion.end.y]);
        assert!((x - rest.place_m[0]).hypot(z - rest.place_m[1]) < 1e-8);
    }
}

/// Four lines of which two are slightly shorter: their shares of the load follow from their
/// stiffness, and hardly from the difference in length.
#[test]
fn lines_share_what_they_hold_by_their_stiffness() {
    let line = |side: f64, length: f64, rate: f64| {
        format!(
            "[[line]]\nanchor = [{}, -20]\nfairlead = [{}, -5]\nlength = {length}\nspring_rate = {rate}\n",
            2.0 * side,
            2.0 * side
        )
    };
    let case = |hair: f64| {
        let lines = [
            line(1.0, 15.0, 4e5),
            line(1.0, 15.0 - hair, 1e5),
            line(-1.0, 15.0, 4e5),
            line(-1.0, 15.0 - hair, 1e5),
        ];
        let text = format!(
            "[body]\nshape = \"rectangle\"\nheight = 1\nmass = 5000\nadded_mass = 3000\n\
             displaced_volume = 8\nwidth = 4\nposition = [0, -5]\n{}[site]\ndepth = 21\n\
             [run]\nrestitution = 0.5\nduration = 2\n",
            lines.concat()
        );
        let prepared = prepared(&text, &[]);
        let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
        prepared.with_elastic_lines(&law).expect("a place of rest")
    };
    let (even, short) = (case(0.0), case(3e-5));
    let buoyancy = even.structure.net_buoyancy_n();
    // Side by side they stretch equally, and share as 4 to 1.
    for (line, part) in [0.4, 0.1, 0.4, 0.1].into_iter().enumerate() {
        assert!((even.rest.tension_n[line] / (part * buoyancy) - 1.0).abs() < 1e-6);
        let hair = short.rest.tension_n[line] - even.rest.tension_n[line];
        // A difference of 0.03 mm on 1e5 N/m is 3 N, compared with some kN.
        assert!(hair.abs() < 3.0, "{hair}");
    }
}

/// A line that is slack where the body rests on inextensible lines has the damper of its own
/// effective mass, however long it is.
#[test]
fn a_slack_line_has_the_damper_of_its_mass() {
    let damping = |length: f64| {
        let prepared = prepared(
            CYLINDER,
            &[&format!("line.2.length={length}"), "line.1.length=6"],
        );
        let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
        let rest = prepared
            .model
            .at_rest(prepared.rest.place_m, prepared.rest.theta_rad);
        let cable = &prepared.model.system.cables[1];
        let span = cable.span(&rest).components();
        let n = span.map(|part| part / span[0].hypot(span[1]));
        let (sine, cosine) = rest.theta.sin_cos();
        let lever = cable.lever(sine, cosine).components();
        let arm = lever[0] * n[1] - lever[1] * n[0];
        let w = 1.0 + arm * arm * prepared.model.system.body.inverse_inertia();
        let known = 2.0 * damping_ratio(0.5) * (law[1].rate / w).sqrt();
        (law[1].damping / known - 1.0).abs()
    };
    for length in [6.0, 6.5, 8.0] {
        assert!(damping(length) < 1e-9, "{length}");
    }
}

/// A body that goes down on its lines ends where it touches the floor, as it does on
/// inextensible lines.
#[test]
fn the_floor_ends_a_run() {
    let waves = [
        "wave.height=6",
        "wave.period=9",
        "site.depth=10",
        "run.duration=200",
    ];
    let prepared = prepared(
        &CYLINDER.replace("restitution = 0.5", "restitution = 1"),
        &waves,
    );
    let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
    let motion = run(&prepared, &law);
    let stop = motion.stop.expect("an end before the time");
    assert!(stop.exceeds() && motion.end_s < 200.0, "{stop:?}");
    let bound = prepared
        .model
        .rules
        .limits
        .of(Limit::UpperBound)
        .expect("a floor");
    let system = &prepared.model.system;
    let below = motion
        .samples
        .iter()
        .filter(|sample| system.top(&sample.state) > bound);
    let last = motion.end_s - prepared.model.scales.time_s;
    assert!(below.clone().all(|sample| sample.t_s > last), "{last}");
}

/// The position of rest on elastic lines may be out of reach of inextensible ones: it is a
/// legal start, from which the body does not move in still water, and there is nothing to compare
/// it with.
#[test]
fn it_may_start_where_the_lines_have_stretched() {
    let still = CYLINDER.replace("[wave]\nheight = 2\nperiod = 6\n", "");
    let at_rest = prepared(&still, &["run.duration=20"]);
    let law = elastic_lines(&at_rest, 1.0).expect("elastic lines");
    let [x, z] = at_rest.with_elastic_lines(&law).expect("rest").rest.place_m;
    let start = format!("run.start=[{x}, {z}]");
    let case = structure(&still, &["run.duration=20", &start]);
    let refused = ModelAtRest::new(case.clone()).expect_err("out of reach");
    assert!(refused.to_string().contains("too short"), "{refused}");
    let prepared = ModelAtRest::for_elastic_lines(case).expect("a start");
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).expect("a run");
    assert!(comparison.inextensible.is_none());
    for (peak, at_rest) in comparison
        .elastic
        .peaks_n
        .iter()
        .zip(&comparison.elastic_case.rest.tension_n)
    {
        assert!((peak / at_rest - 1.0).abs() < 1e-7, "{peak} {at_rest}");
    }
    assert_eq!(comparison.verdict().standing, VerdictKind::Holds);
    let summary = comparison.summary("case");
    assert!(
        summary.contains("with no inextensible lines, as the case starts beyond their reach"),
        "{summary}"
    );
    let under = structure(&still, &["run.start=[0, -9.5]"]);
    let floor = ModelAtRest::for_elastic_lines(under).expect_err("in the floor");
    assert!(floor.to_string().contains("above the floor"), "{floor}");
}

/// Each pull of the lines agrees with MoorDyn 2.7.2, with steps so small that its peaks do not
/// depend on them, to 0.1 % and to a few of its steps (bench/moordyn).
#[test]
fn the_pulls_are_those_of_moordyn() {
    let results = include_str!("../../../../bench/moordyn/results.json");
    let results: Value = serde_json::from_str(results).expect("JSON");
    let mut compared = 0;
    for case in results["cases"].as_array().expect("cases") {
        let alone = case["alone"].as_bool().expect("a flag");
        let name = case["name"].as_str().expect("a name");
        if !(alone || name.contains("a tenth of MoorDyn's step")) {
            continue;
        }
        let set = case["set"].as_array().expect("settings").iter();
        let set: Vec<&str> = set.map(|set| set.as_str().expect("text")).collect();
        let prepared = ModelAtRest::for_elastic_lines(structure(CYLINDER, &set)).expect("a start");
        let comparison =
            compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).expect("a run");
        let theirs = case["pulls"].as_array().expect("pulls");
        assert_eq!(comparison.elastic.pulls.len(), theirs.len(), "{name}");
        for (pull, row) in comparison.elastic.pulls.iter().zip(theirs) {
            let number = |k: usize| row["moordyn"][k].as_f64().expect("a number");
            let step = case["step_s"].as_f64().expect("a step");
            assert_eq!(pull.line + 1, number(0) as usize);
            for (ours, theirs) in [(pull.from_s, number(1)), (pull.to_s, number(2))] {
                assert!(
                    (ours - theirs).abs() < 3.0 * step,
                    "{name}: {pull:?} {theirs}"
                );
            }
            assert!(
                (pull.peak_n / number(3) - 1.0).abs() < 1e-3,
                "{name}: {pull:?}"
            );
            compared += 1;
        }
    }
    assert_eq!(compared, 14);
}
