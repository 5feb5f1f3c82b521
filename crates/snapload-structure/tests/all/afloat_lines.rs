//! Lines under a floating body: how they share the load, and the response to small waves as they
//! stretch.

use crate::afloat::{by_hand, case, parsed, structure};
use nalgebra::{Complex, Matrix3, Vector3};
use serde_json::Value;
use snapload::analysis::no_progress;
use snapload_structure::{ModelAtRest, VerdictKind, assess, elastic_lines, run_elastic};
use std::f64::consts::PI;
use std::path::Path;

/// The row G and ∇G of a line to a fairlead of a body at its place of rest, pitch from z to x, by
/// hand: (n, n × r) and (JᵀJ − GᵀG)/l + diag(0, 0, −n·r) with J = [[1, 0, r_z], [0, 1, −r_x]].
fn by_its_line(anchor: [f64; 2], r: [f64; 2], centre: [f64; 2]) -> (Vector3<f64>, Matrix3<f64>) {
    let span = [0, 1].map(|i| centre[i] + r[i] - anchor[i]);
    let length = f64::hypot(span[0], span[1]);
    let n = span.map(|part| part / length);
    let row = Vector3::new(n[0], n[1], n[0] * r[1] - n[1] * r[0]);
    let j = nalgebra::Matrix2x3::new(1.0, 0.0, r[1], 0.0, 1.0, -r[0]);
    let mut hessian = (j.transpose() * j - row * row.transpose()) / length;
    hessian[(2, 2)] -= n[0] * r[0] + n[1] * r[1];
    (row, hessian)
}

/// On stretched lines that stay taut surge, heave and pitch are, for small waves, the linear answer
/// with the stiffness of the lines and their dampers beside the water's:
///
/// ```text
/// (C + K − ω² (M + A) − iω (B + D)) Z = F,    K = Σ k G Gᵀ + T ∇G,    D = Σ c G Gᵀ
/// ```
#[test]
fn taut_elastic_lines_answer_small_waves_as_the_frequency_domain_does() {
    let height = 0.01;
    let (hydro, omega, k) = {
        let (report, _) = by_hand();
        let hydro = report.reading.hydro.about([0.0, -0.2]);
        let k = hydro.omega_rad_s.iter().position(|omega| *omega > 1.3);
        let k = k.expect("a frequency above 1.3 rad/s");
        (hydro.clone(), hydro.omega_rad_s[k], k)
    };
    let wave = format!("[wave]\nheight = {height}\nperiod = {}", 2.0 * PI / omega);
    let text = case(-0.2, 2.0, 9.666, &wave, "duration = 300\ntransient = 0");
    // Surge is damped, so that its free oscillation has decayed at the end.
    let text = text.replace("pairs = 6", "pairs = 6\ndamping = [2e5, 1e4, 2e5]");
    let text = text.replacen("length = 9.666", "length = 9.6", 1);
    let structure = structure(&text.replace("stiffness = 1.2e8", "stiffness = 2e7"));
    let afloat = structure.afloat.clone().unwrap();
    let lines = structure.lines.clone();
    let prepared = ModelAtRest::new(structure).unwrap();
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let elastic_case = prepared.with_elastic_lines(&law).unwrap();

    let rest = &elastic_case.rest;
    assert!(rest.theta_rad.abs() > 1e-3 && rest.place_m[0].abs() > 1e-3);
    let scales = &elastic_case.model.scales;
    let (mut stiffness, mut damping) = (afloat.body.stiffness, afloat.body.damping);
    let (sine, cosine) = (-rest.theta_rad).sin_cos();
    for ((line, elastic_line), tension) in lines.iter().zip(&law).zip(&rest.tension_n) {
        let [x, z] = [line.fairlead_m[0], line.fairlead_m[1] + 0.2];
        let r = [x * cosine + z * sine, -x * sine + z * cosine];
        let (row, hessian) = by_its_line(line.anchor_m, r, rest.place_m);
        let c = elastic_line.damping * scales.force_n * scales.time_s / scales.length_m;
        stiffness += row * row.transpose() * (2e7 / line.length_m) + hessian * *tension;
        damping += row * row.transpose() * c;
    }
    let fit = &afloat.report.fit;
    let memory = fit.memory.transform(omega);
    let impedance = Matrix3::from_fn(|i, j| {
        let mass = afloat.body.mass[(i, j)] + fit.added_mass_inf[(i, j)];
        let mass = mass + memory[(i, j)].im / omega;
        Complex::new(
            stiffness[(i, j)] - omega * omega * mass,
            -omega * (damping[(i, j)] + memory[(i, j)].re),
        )
    });
    let force = hydro.excitation_to(1.0).unwrap().force[k] * Complex::new(height / 2.0, 0.0);
    let answer = impedance.lu().solve(&force).unwrap();

    // Terms of the second order in the waves have other frequencies, and are fitted together with
    // the linear response.
    let run = run_elastic(&elastic_case, &law, 0.2, &no_progress).unwrap();
    let samples: Vec<_> = run
        .samples
        .iter()
        .filter(|sample| sample.t_s > 240.0)
        .collect();
    let columns = nalgebra::DMatrix::from_fn(samples.len(), 5, |row, column| {
        let phase = omega * samples[row].t_s;
        let terms = [phase.cos(), phase.sin(), 1.0];
        let double = [(2.0 * phase).cos(), (2.0 * phase).sin()];
        *terms.iter().chain(&double).nth(column).unwrap()
    });
    let solver = columns.svd(true, true);
    let largest = answer.map(Complex::norm).max();
    for i in 0..3 {
        let motion = nalgebra::DVector::from_fn(samples.len(), |row, _| {
            let state = &samples[row].state;
            let [x, z] = scales.to_si([state.x, state.y]);
            // Pitch is minus the rotation of a case, which is minus that of the engine.
            [
                x - rest.place_m[0],
                z - rest.place_m[1],
                state.theta + rest.theta_rad,
            ][i]
        });
        let fitted = solver.solve(&motion, 1e-12).unwrap();
        // Re i Z e^{−iωt}.
        let off = (fitted[1] - answer[i].re).hypot(fitted[0] + answer[i].im);
        assert!(off < 5e-4 * largest, "{i}: {off} {fitted} {answer}");
    }
    assert!(answer.map(Complex::norm).min() > 1e-4, "{answer}");
    // No line goes slack.
    for line in 0..2 {
        let (least, held) = (run.least_n[line].unwrap(), rest.tension_n[line]);
        let most = run.peaks_n[line];
        assert!(
            least > 0.5 * held && most > 1.01 * held,
            "{least} {held} {most}"
        );
    }
}

/// Three independent lines leave a floating body no motion while they
/// are taut, which the answers say.
#[test]
fn three_lines_hold_a_floating_body_fast() {
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
    let third = "[[line]]\nanchor = [-6, -10]\nfairlead = [2, -1.2]\nlength = 11.8\n\
                 stiffness = 1.2e8\n";
    let structure = structure(&format!("{text}{third}"));
    let prepared = ModelAtRest::new(structure.clone()).unwrap();
    assert_eq!(
        (prepared.rest.taut.len(), prepared.modes_on_taut_lines.len()),
        (3, 0)
    );
    let summary = assess(structure, 0, &no_progress).unwrap().summary("case");
    assert!(
        summary.contains("none, as the taut lines allow no motion"),
        "{summary}"
    );
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let elastic_case = prepared.with_elastic_lines(&law).unwrap();
    run_elastic(&elastic_case, &law, f64::INFINITY, &no_progress).unwrap();
    assert_eq!(prepared.modes_on_elastic_lines().len(), 3);
}

/// A body on one upright line at its centre, whose water forces are from textbook values.
fn of_its_section(more: &str, line: &str) -> String {
    format!(
        "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\nmass = 90000\ndisplaced_volume = 96\n\
         position = [0, -0.2]\n[float]\n{more}\n[site]\ndepth = 10\ngravity = 9.81\n[run]\n\
         restitution = 0.5\nduration = 20\n[[line]]\nanchor = [0, -10]\nfairlead = [0, -0.2]\n{line}\n"
    )
}

/// Without a file the water is that of the outline's section: on a line that stretches heave has
/// ω² = (C33 + k)/(m + A33).
#[test]
fn a_body_without_a_file_has_the_water_of_its_section() {
    let text = of_its_section("damping = [0, 3e4, 0]", "length = 9.8\nstiffness = 4.9e6");
    let prepared = ModelAtRest::new(structure(&text)).unwrap();
    let a33 = prepared.structure.body.added_mass.heave_kg;
    let b = 2.0;
    // Between the rows of the table, 2.1987 and 2.1421 b² at b/T of 5/3 and 2 (half of the double
    // body's).
    assert!((a33 / (1025.0 * 20.0 * b * b) - 2.1987).abs() < 1e-3);
    let c33 = 1025.0 * 9.81 * 2.0 * b * 20.0;
    let k = 4.9e6 / 9.8;
    let found = prepared.modes_on_elastic_lines();
    let heave = found.iter().find(|(natural, _)| natural.freedom == 1);
    let (natural, mode) = heave.unwrap();
    let omega = f64::sqrt((c33 + k) / (90000.0 + a33));
    assert!((natural.omega_rad_s / omega - 1.0).abs() < 1e-9);
    let ratio = 3e4 / (2.0 * f64::sqrt((c33 + k) * (90000.0 + a33)));
    assert!((mode.damping_ratio / ratio - 1.0).abs() < 1e-6);
    // At rest waterplane and line balance the surplus of buoyancy.
    let lift = (1025.0 * 96.0 - 90000.0) * 9.81;
    let elastic_case = prepared
        .with_elastic_lines(&elastic_lines(&prepared, 1.0).unwrap())
        .unwrap();
    let rise = lift / (c33 + k);
    assert!((elastic_case.rest.place_m[1] + 0.2 - rise).abs() < 1e-9);
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
    let rules: Vec<_> = assessment.warnings.iter().map(|w| w.rule).collect();
    assert!(
        rules.contains(&"textbook section") && rules.contains(&"ends"),
        "{rules:?}"
    );
    assert!(assessment.summary("case").contains("makes no waves"));
    for (from, to, says) in [
        ("[float]", "[float]\npairs = 4", "without float.file"),
        (
            "shape = \"rectangle\"\nwidth = 4\nheight = 2",
            "width = 4",
            "in the still water",
        ),
        ("width = 4", "width = 100", "float.file"),
        (
            "displaced_volume = 96",
            "displaced_volume = 96\nconstant_force = [0, -9e5]",
            "body.constant_force",
        ),
    ] {
        let text = text.replace(from, to);
        let error = parsed(&text)
            .and_then(ModelAtRest::new)
            .map(|_| ())
            .expect_err(to);
        assert!(error.to_string().contains(says), "{to}: {error}");
    }
}

/// A body that floats freely heels by M/C₅₅ counter-clockwise under a moment; on taut lines it
/// begins heeled and stays so. A moment that turns it over is refused, and the message names it.
#[test]
fn a_constant_moment_heels_the_body() {
    let with =
        |moment: f64| format!("pairs = 6\nconstant_moment = {moment}\ndamping = [1e6, 1e6, 3e6]");
    let run = "duration = 120\ntransient = 0";
    let free = case(0.0, 2.4, 14.0, "", &format!("{run}\nstart = [0, 0]"));
    let free = free.replace("mass = 80000", "mass = 98400");
    let structure_of = |moment| structure(&free.replace("pairs = 6", &with(moment)));
    let stiffness = structure_of(0.0).afloat.unwrap().body.stiffness;
    let end = |structure| {
        let prepared = ModelAtRest::new(structure).unwrap();
        let mut motion = prepared.begin(1.0).unwrap();
        while motion.step().is_some() {}
        // The engine's plane is a reflection of this one.
        (-motion.state().theta, prepared.rest.theta_rad)
    };
    let (heel, _) = end(structure_of(1e5));
    assert!((heel - 1e5 / stiffness[(2, 2)]).abs() < 1e-6, "{heel}");

    let taut = case(-0.2, 2.0, 9.6, "", run);
    let structure_of = |moment| structure(&taut.replace("pairs = 6", &with(moment)));
    let (heel, rest) = end(structure_of(1e5));
    assert!(rest > 1e-3 && (heel - rest).abs() < 1e-9, "{heel} {rest}");
    let (_, other) = end(structure_of(-1e5));
    assert!((other + rest).abs() < 1e-9, "{other} {rest}");
    let error = ModelAtRest::new(structure_of(1e12))
        .map(|_| ())
        .expect_err("it turns over");
    assert!(
        error.to_string().contains("float.constant_moment"),
        "{error}"
    );
}

/// A short line holds the body 0.2 m below the height for which the textbook values of its section
/// hold.
#[test]
fn a_place_of_rest_below_the_given_one_is_reported_as_below() {
    let text = of_its_section("", "length = 9.6");
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
    let mut warnings = assessment.warnings.iter();
    let found = warnings.find(|w| w.rule == "place of rest");
    let words = &found.expect("a warning").message;
    assert!(
        words.starts_with("the body rests 0.200 m below the place for which its coefficients hold"),
        "{words}"
    );
    assert!(
        words.ends_with("give body.position and displaced_volume for the place of rest"),
        "{words}"
    );
}

/// An upright line of spring rate k carries k/(k + C33) of its load if it were inextensible, and
/// the water the rest: 92 % is a warning, and with 88 % the verdict is left to the elastic line.
#[test]
fn lines_that_leave_much_of_their_load_to_the_water_leave_the_verdict_open() {
    for (share, is_open) in [(0.92, false), (0.88, true)] {
        let stiffness = 1025.0 * 9.81 * 80.0 * share / (1.0 - share) * 9.6;
        let line = format!("length = 9.6\nstiffness = {stiffness}\nbreaking_load = 1e6");
        let assessment = assess(structure(&of_its_section("", &line)), 0, &no_progress);
        let assessment = assessment.unwrap();
        let rest = &assessment.prepared.rest;
        let on_spring = rest.elastic_tension_n.as_ref().expect("a warning")[0];
        assert!((on_spring / rest.tension_n[0] - share).abs() < 1e-9);
        let verdict = assessment.verdict();
        let kind = if is_open {
            VerdictKind::Open
        } else {
            VerdictKind::Holds
        };
        assert_eq!(verdict.standing, kind, "{}", verdict.words);
        let names = verdict
            .words
            .contains("see stretch at rest): snapload elastic decides");
        assert_eq!(names, is_open, "{}", verdict.words);
    }
}

/// Four lines, two on each side, of which one is 2 mm shorter than the other: with stiffnesses they
/// share the load as springs do, and without a stiffness the verdict is open.
#[test]
fn more_lines_than_hold_a_floating_body_share_by_stiffness() {
    let text = case(
        -0.2,
        2.0,
        9.666,
        "[wave]\nheight = 0.4\nperiod = 5",
        "duration = 60",
    );
    let (head, tail) = text.split_once("[[line]]").unwrap();
    let doubled = format!(
        "{head}[[line]]{tail}[[line]]{}",
        tail.replace("9.666", "9.668")
    );
    let prepared = ModelAtRest::new(structure(&doubled)).unwrap();
    let tensions = &prepared.rest.tension_n;
    // The rise h of the centre above −0.2 m, from k (d(h) − r) n_z and ρgS h.
    let pulls = |h: f64| {
        let (across, up) = (4.0, 8.8 + h);
        let distance = f64::hypot(across, up);
        let pull = |r: f64| 1.2e8 / r * (distance - r);
        ([9.666, 9.668].map(pull), up / distance)
    };
    let left = |h: f64| {
        let ([a, b], up) = pulls(h);
        (98400.0 - 80000.0) * 9.81 - 804_420.0 * h - 2.0 * (a.max(0.0) + b.max(0.0)) * up
    };
    let (mut low, mut high) = (0.0, 0.2);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if left(middle) > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    let ([short, long], _) = pulls(low);
    for (found, known) in tensions
        .iter()
        .zip([short, short, long.max(0.0), long.max(0.0)])
    {
        assert!(
            (found - known).abs() < 1e-3 * short,
            "{tensions:?} {short} {long}"
        );
    }
    let by_stiffness = prepared.rest.by_stiffness.as_ref();
    let same = doubled
        .replace("9.668", "9.666")
        .replace("stiffness = 1.2e8\n", "");
    let even = assess(structure(&same), 0, &no_progress).unwrap();
    let rest = &even.prepared.rest;
    assert!(rest.indeterminate && rest.taut.len() == 4);
    assert!(
        rest.tension_n
            .iter()
            .all(|pull| (pull / rest.tension_n[0] - 1.0).abs() < 1e-6)
    );
    let once = ModelAtRest::new(structure(&text)).unwrap();
    assert!((2.0 * rest.tension_n[0] / once.rest.tension_n[0] - 1.0).abs() < 1e-6);
    assert!(even.warnings.iter().any(|w| w.rule == "shared loads"));
    assert_eq!(even.verdict().standing, VerdictKind::Open);
    assert_eq!(by_stiffness.is_some(), long < 0.9 * short, "{short} {long}");
}

/// A memory is about the reference point of its file, and is transformed to the body's centre: it
/// equals Jᵀ(·)J there, and the quality of the fit is the same.
#[test]
fn a_memory_is_carried_to_the_centre() {
    let (report, _) = by_hand();
    let name = format!("snapload-memory-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let json = serde_json::to_string(&report.to_json()).unwrap();
    std::fs::write(&path, json).unwrap();
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
    let text = text.replace("pairs = 6", &format!("memory = {path:?}"));
    let found = structure(&text).afloat.unwrap();
    std::fs::remove_file(&path).unwrap();
    let j = snapload_hydro::transport([0.0, -0.2]);
    let complex = j.map(|entry| Complex::new(entry, 0.0));
    for omega in [0.5, 1.3, 3.0] {
        let there = report.fit.memory.transform(omega);
        let known = complex.transpose() * there * complex;
        let here = found.report.fit.memory.transform(omega);
        assert!((here - known).map(Complex::norm).max() < 1e-9 * known.map(Complex::norm).max());
    }
    let known = j.transpose() * report.fit.added_mass_inf * j;
    assert!((found.report.fit.added_mass_inf - known).amax() < 1e-9 * known.amax());
    let warned = found.report.warnings.iter().find(|w| w.what == "fit");
    assert!(warned.is_none(), "{warned:?}");
}

/// In waves, with snaps on elastic lines and with the memory, the pontoon's lines pull at the
/// times and with the tensions that another program computed.
#[test]
fn snaps_on_elastic_lines_are_those_of_another_program() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let known = include_str!("../data/pontoon-pulls.json");
    let known: Value = serde_json::from_str(known).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let example = include_str!("../../../../docs/examples/pontoon.toml");
    let (head, tail) = example.split_once("[sea]").unwrap();
    let (_, tail) = tail.split_once("[run]").unwrap();
    let memory = folder.join("tests/data/pontoon-memory.json");
    let head = head.replace("[float]", &format!("[float]\nmemory = {memory:?}"));
    let text = format!(
        "{head}[wave]\nheight = {}\nperiod = {}\n[run]{tail}\nduration = 30\ntransient = 0\n",
        number(&known["height_m"]),
        2.0 * PI / number(&known["omega_rad_s"])
    );
    let prepared = ModelAtRest::new(structure(&text)).unwrap();
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let elastic_case = prepared.with_elastic_lines(&law).unwrap();
    let run = run_elastic(&elastic_case, &law, f64::INFINITY, &no_progress).unwrap();
    let known = known["pulls"].as_array().unwrap();
    assert_eq!(run.pulls.len(), known.len());
    for (pull, known) in run.pulls.iter().zip(known) {
        let [line, from, to, peak] =
            ["line", "from_s", "to_s", "peak_n"].map(|key| number(&known[key]));
        assert_eq!(pull.line + 1, line as usize);
        let off = (pull.from_s - from).abs().max((pull.to_s - to).abs());
        assert!(off < 1e-6, "{pull:?} {known}");
        // The largest tension is sampled sixteen times a step.
        assert!((pull.peak_n / peak - 1.0).abs() < 1e-5, "{pull:?} {known}");
    }
}

/// A top-heavy body on lines that mirror each other rests turned to one side as well as to the
/// other. Of whatever stiffness they are, the side is the same.
#[test]
fn a_body_turns_to_the_same_side_on_lines_of_any_stiffness() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let memory = folder.join("tests/data/pontoon-memory.json");
    let example = include_str!("../../../../docs/examples/pontoon.toml");
    let example = example.replace("[float]", &format!("[float]\nmemory = {memory:?}"));
    for (height_m, stiffness_n) in [
        (1.1, 8e5),
        (1.1, 2e6),
        (1.2, 1e6),
        (1.2, 1.05e6),
        (1.4, 2e6),
    ] {
        let centre = format!("centre_of_gravity = [0, {height_m}]");
        let text = example.replace("centre_of_gravity = [0, -0.2]", &centre);
        let stiffness = format!("[[line]]\nstiffness = {stiffness_n}");
        let prepared = ModelAtRest::new(structure(&text.replace("[[line]]", &stiffness))).unwrap();
        let law = elastic_lines(&prepared, 1.0).unwrap();
        let rest = prepared.with_elastic_lines(&law).unwrap().rest;
        assert!(
            rest.theta_rad > 0.1 && rest.either_side,
            "{height_m} {rest:?}"
        );
    }
}
