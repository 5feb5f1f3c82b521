//! Structures that float: the coefficients of a panel code under the same keys and answers.

use crate::verdicts::source;
use nalgebra::{Complex, Matrix3, Vector3};
use snapload::analysis::unwatched;
use snapload::{
    Body, Entries, Excitation, Exponential, Floating, FloatingUnits, Forcing, Playback, Rules,
    Simulation, State, System,
};
use snapload_hydro::{Given, Line, Report, Request, Weight, read, response_of_the_memory};
use snapload_structure::{
    Answer, Lines, Outcome, Prepared, STRUCTURE, Standing, Structure, assess, note, run_elastic,
    seas, springs,
};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// Where `pontoon.nc` is, 20 × 4 m with 1.2 m of draft in deep water, its reference point in the
/// waterline.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples")
}

/// A pontoon of 80 t that displaces 98.4 t where it floats with its centre at `z`, on two lines.
fn case(z: f64, height: f64, length: f64, water: &str, run: &str) -> String {
    let line = |side: f64| {
        format!(
            "[[line]]\nanchor = [{}, -10]\nfairlead = [{}, -1.2]\nlength = {length}\n\
             stiffness = 1.2e8\nmass_per_length = 20\nbreaking_load = 1.5e6\n",
            6.0 * side,
            2.0 * side
        )
    };
    format!(
        "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = {height}\nmass = 80000\n\
         displaced_volume = 96\nmoment_of_inertia = 150000\nposition = [0, {z}]\n\
         [float]\nfile = \"pontoon.nc\"\ndeep_water = true\npairs = 6\n\
         [site]\ndepth = 10\ngravity = 9.81\n{water}\n[run]\nrestitution = 0.3\n{run}\n{}{}",
        line(1.0),
        line(-1.0)
    )
}

fn parsed(text: &str) -> Result<Structure, snapload::CaseError> {
    Structure::from_entries_beside(&Entries::parse(&STRUCTURE, "case", text)?, &folder())
}

fn structure(text: &str) -> Structure {
    parsed(text).expect("a structure")
}

/// The same pontoon put together by hand about the file's own reference point.
fn by_hand() -> (Report, snapload_hydro::Body) {
    let reading = read(&folder().join("pontoon.nc"), &Given::default()).unwrap();
    let request = Request {
        weight: Weight {
            mass_kg: Some(80000.0),
            inertia_kg_m2: Some(150_000.0),
            ..Weight::default()
        },
        fit: snapload_hydro::FitOptions { pairs: Some(6) },
        ..Request::default()
    };
    let report = Report::new("pontoon.nc", reading, &request).unwrap();
    let body = report.floating.clone().unwrap().body;
    (report, body)
}

/// With the body's centre at the file's reference point the structure rests and moves as the same
/// system put together by hand does, unit by unit.
#[test]
fn a_structure_afloat_is_the_system_by_hand() {
    let wave = "[wave]\nheight = 1.2\nperiod = 5";
    let text = case(0.0, 2.4, 9.666, wave, "duration = 25\ntransient = 0");
    let assessment = assess(structure(&text), 0, &unwatched).unwrap();
    let (report, body) = by_hand();
    let lines = [1.0, -1.0].map(|side| Line {
        anchor_m: [6.0 * side, -10.0],
        fairlead_m: [2.0 * side, -1.2],
        length_m: 9.666,
    });
    let hydro = &report.reading.hydro;
    let rest = snapload_hydro::rest(hydro, &body, &lines).unwrap();
    let ours = &assessment.prepared.rest;
    for (ours, theirs) in [
        (ours.place_m[0], rest.q[0]),
        (ours.place_m[1], rest.q[1]),
        (ours.theta_rad, -rest.q[2]),
        (ours.tension_n[0] / 1e5, rest.tension_n[0] / 1e5),
    ] {
        assert!((ours - theirs).abs() < 1e-10, "{ours} {theirs}");
    }
    // Units of another length and mass than the structure takes.
    let fit = &report.fit;
    let units = FloatingUnits::new(8.0, 9.81, 2e5);
    let array =
        |m: &nalgebra::Matrix3<f64>| std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]));
    let omega = 2.0 * PI / 5.0;
    let force = hydro.excitation_curve(1.0).unwrap().at(omega).unwrap();
    // η = 0.6 sin ωt = Re 0.6 i e^{−iωt}.
    let amplitudes = [0, 1, 2].map(|i| [-0.6 * force[i].im, 0.6 * force[i].re]);
    let term = |term: &snapload_hydro::Term| Exponential {
        pole: [term.pole.re, term.pole.im],
        residue: std::array::from_fn(|i| {
            std::array::from_fn(|j| [term.residue[(i, j)].re, term.residue[(i, j)].im])
        }),
    };
    let water = Floating {
        stiffness: array(&body.stiffness),
        damping: array(&body.damping),
        constant: body.constant_force.into(),
        memory: fit.memory.terms.iter().map(term).collect(),
        excitation: vec![Excitation::of_amplitudes(omega, amplitudes)],
    };
    let mass = units.mass_matrix(&array(&(body.mass + fit.added_mass_inf)));
    let system = System {
        body: Body::with_mass_matrix(snapload::Shape::Point, mass).unwrap(),
        cables: lines
            .iter()
            .map(|line| units.cable(line.anchor_m, line.fairlead_m, line.length_m))
            .collect(),
        forcing: Forcing::default(),
        drag: None,
        floating: Some(units.floating(&water)),
        restitution: 0.3,
    };
    let start: State = units.state([rest.q[0], rest.q[1], rest.q[2]], [0.0; 3]);
    let rules = Rules {
        v_stick: 1e-6,
        ..Rules::until(25.0 / units.time_s)
    };
    let mut motion = Simulation::new(system, rules, 0.0, start).unwrap();
    let mut theirs = Vec::new();
    while let Some(step) = motion.step() {
        theirs.extend(step.impacts().map(|impact| {
            (
                impact.cable,
                impact.t * units.time_s,
                impact.v_n * units.speed_m_s(),
            )
        }));
    }
    let hard = |speed: f64| speed > 0.05;
    let ours = assessment.snaps.iter().filter(|snap| hard(snap.speed_m_s));
    let theirs = theirs.into_iter().filter(|(.., speed)| hard(*speed));
    let mut compared = 0;
    for (ours, (line, t_s, speed)) in ours.zip(theirs).take(6) {
        assert_eq!(ours.line, line);
        assert!((ours.t_s - t_s).abs() < 1e-7, "{} {t_s}", ours.t_s);
        assert!((ours.speed_m_s - speed).abs() < 1e-6, "{ours:?} {speed}");
        compared += 1;
    }
    assert_eq!(compared, 6);
}

/// Without a taut line heave is what the frequency domain says, in size and phase; on lines that
/// stretch and stay slack the motion is the same.
#[test]
fn slack_lines_leave_the_response_of_the_frequency_domain() {
    let (report, body) = by_hand();
    let hydro = &report.reading.hydro;
    let k = hydro
        .omega_rad_s
        .iter()
        .position(|omega| *omega > 1.0)
        .unwrap();
    let omega = hydro.omega_rad_s[k];
    // A body as heavy as its water floats where the file has it.
    let wave = format!(
        "[wave]\nheight = 0.4\nperiod = {}\ndirection = \"-x\"",
        2.0 * PI / omega
    );
    let run = "duration = 160\ntransient = 0\nstart = [0, 0]";
    let text = case(0.0, 2.4, 14.0, &wave, run).replace("mass = 80000", "mass = 98400");
    let structure = structure(&text);
    let afloat = structure.afloat.clone().unwrap();
    let xi = response_of_the_memory(
        hydro,
        &afloat.body,
        &report.fit.memory,
        &report.fit.added_mass_inf,
        -1.0,
    );
    let xi = xi.unwrap().amplitude[k];
    assert!(afloat.body.constant_force.amax() < 1.0 && body.constant_force[1] > 1e5);
    let prepared = Prepared::new(structure).unwrap();
    let mut motion = prepared.begin(1.0).unwrap();
    let mut compared = 0;
    while let Some(step) = motion.step() {
        let t = motion.time() * prepared.model.scales.time_s;
        assert!(step.taut.is_empty());
        if t > 120.0 {
            let [_, z] = prepared
                .model
                .scales
                .to_si([motion.state().x, motion.state().y]);
            let (sine, cosine) = (omega * t).sin_cos();
            // Re 0.2 i ξ e^{−iωt}, about where weight and buoyancy, equal to a newton, are in balance.
            let still = afloat.body.constant_force[1] / afloat.body.stiffness[(1, 1)];
            let heave = still + 0.2 * (xi[1].re * sine - xi[1].im * cosine);
            assert!((z - heave).abs() < 1e-6, "{t} {z} {heave}");
            compared += 1;
        }
    }
    assert!(compared > 50);
    let law = springs(&prepared, 1.0).unwrap();
    let elastic = run_elastic(&prepared, &law, 0.5, &unwatched).unwrap();
    let stiff = snapload::Trajectory::record(prepared.begin(1.0).unwrap());
    let mut playback = Playback::new(&stiff);
    for look in &elastic.looks {
        let state = playback.at(look.t_s / prepared.model.scales.time_s).state;
        for (a, b) in state.components().into_iter().zip(look.state.components()) {
            // Between the steps to the seventh order only.
            assert!((a - b).abs() < 1e-6, "{} {a} {b}", look.t_s);
        }
    }
    let end = playback.at(stiff.end().t).state.components();
    for (a, b) in end.into_iter().zip(elastic.end.components()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// On lines that stretch the body rests where hydrostatics, weight and pulls are in balance.
#[test]
fn stretched_lines_share_the_load_with_the_water() {
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
    let prepared = Prepared::new(structure(&text)).unwrap();
    let law = springs(&prepared, 1.0).unwrap();
    let sprung = prepared.on_springs(&law).unwrap();
    let rise = sprung.rest.place_m[1] + 0.2;
    // Down from buoyancy's surplus by ρ g A per metre of rise.
    let left = (98400.0 - 80000.0) * 9.81 - 804_420.0 * rise;
    let up: f64 = (0..2)
        .map(|line| {
            let [x, z] = [4.0, 8.8 + rise];
            sprung.rest.tension_n[line] * z / f64::hypot(x, z)
        })
        .sum();
    assert!((up / left - 1.0).abs() < 1e-4, "{up} {left}");
    let [stiff, soft] = [&prepared, &sprung].map(|p| p.rest.tension_n[0]);
    assert!(soft < stiff && soft > 0.5 * stiff, "{stiff} {soft}");
    // In still water it stays there, and neighbours without waves do.
    let mut motion = prepared.begin(0.0).unwrap();
    while motion.step().is_some() {}
    let end = prepared
        .model
        .scales
        .to_si([motion.state().x, motion.state().y]);
    assert!((end[1] - prepared.rest.place_m[1]).abs() < 1e-9);
}

/// A mirrored sea mirrors the motion of a body that is its own mirror image.
#[test]
fn waves_from_either_side_are_mirror_images() {
    let peaks = |direction: &str| {
        let wave = format!("[wave]\nheight = 1\nperiod = 4.6\ndirection = \"{direction}\"");
        let text = case(-0.2, 2.0, 9.666, &wave, "duration = 9\ntransient = 0");
        let assessment = assess(structure(&text), 0, &unwatched).unwrap();
        let speed = |line: usize| {
            let of_line = assessment.snaps.iter().filter(|snap| snap.line == line);
            of_line.map(|snap| snap.speed_m_s).fold(0.0, f64::max)
        };
        [speed(0), speed(1)]
    };
    let ([a, b], [c, d]) = (peaks("+x"), peaks("-x"));
    assert!(
        a > 0.05 && (a - d).abs() < 1e-6 && (b - c).abs() < 1e-6,
        "{a} {b} {c} {d}"
    );
    assert!((a - b).abs() > 1e-3, "{a} {b}");
}

#[test]
fn a_sea_is_answered_with_periods_and_limits() {
    let sea = "[sea]\nhs = 1.6\ntp = 5.5\ncomponents = 60";
    let text = case(-0.2, 2.0, 9.666, sea, "duration = 90");
    let result = seas(structure(&text), 2, Lines::Inextensible, &unwatched);
    let result = result.unwrap();
    let summary = result.summary("case");
    assert!(
        summary.contains("periods") && summary.contains("heave") && summary.contains("held"),
        "{summary}"
    );
    let rules: Vec<&str> = result.warnings.iter().map(|w| w.rule).collect();
    assert!(rules.contains(&"deep water"), "{rules:?}");
    // Hs of 1.6 m lifts a draft of 1.2 m by more than half of it.
    assert!(rules.contains(&"small heave"), "{rules:?}");
    assert!(!rules.contains(&"submergence") && !rules.contains(&"free surface"));
    let json = result.to_json("case");
    let free = json["afloat"]["without_lines"].as_array().unwrap();
    let freedoms: Vec<_> = free
        .iter()
        .map(|motion| motion["freedom"].as_str())
        .collect();
    assert_eq!(freedoms, [Some("pitch"), Some("heave")]);
    let page = note::seas_page(source("case"), &result).unwrap();
    assert!(page.contains("The floating body"));
}

#[test]
fn what_a_floating_body_can_not_be_is_refused() {
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
    for (from, to, says) in [
        ("pontoon.nc", "pantoon.nc", "float.file = \"pantoon.nc\""),
        ("deep_water = true", "", "the depth of the water"),
        (
            "mass = 80000",
            "mass = 80000\nadded_mass = 1e5",
            "body.added_mass",
        ),
        (
            "displaced_volume = 96",
            "displaced_volume = 90",
            "96.000 m^3",
        ),
        ("[0, -0.2]", "[0, -1.2]", "body.position"),
        (
            "pairs = 6",
            "pairs = 6\nunit_length = 2",
            "float.unit_length",
        ),
        (
            "pairs = 6",
            "pairs = 6\ndamping = 3",
            "[surge, heave, pitch]",
        ),
        ("pairs = 6", "pairs = 6\nname = \"raft\"", "raft"),
        (
            "pairs = 6",
            "pairs = 6\nfile_centre_of_gravity = [0, -0.5]",
            "as the file has it",
        ),
        ("pairs = 6", "memory = \"pontoon.nc\"", "float.memory"),
        (
            "[run]",
            "[sea]\nhs = 1\ntp = 3\n[run]",
            "outside the file's",
        ),
        ("length = 9.666", "length = 20", "run.start"),
    ] {
        let text = text.replace(from, to);
        let error = parsed(&text).and_then(Prepared::new);
        let error = error.expect_err(to).to_string();
        assert!(error.contains(says), "{to}: {error}");
    }
}

/// Linear theory is left on lines that stretch, too, and said to be; the waves' vertical force on a
/// floating body is no part of its net buoyancy.
#[test]
fn the_limits_are_told_of_lines_that_stretch() {
    let sea = "[sea]\nhs = 1.6\ntp = 5.5\ncomponents = 60\n[design]\nforce_share = 0.9";
    let text = case(-0.2, 2.0, 9.666, sea, "duration = 90");
    let result = seas(structure(&text), 2, Lines::Elastic, &unwatched).unwrap();
    let seen = |rule: &str| result.warnings.iter().any(|warning| warning.rule == rule);
    let outcomes = || result.records.iter().map(|record| &record.outcome);
    let heave = |outcome: &Outcome| outcome.waterline.unwrap().heave_m;
    let least = outcomes()
        .map(|outcome| heave(outcome)[0])
        .fold(0.0, f64::min);
    assert!(least < -0.4, "{least}");
    assert!(seen("small heave"), "{:?}", result.warnings);
    let assessment = assess(structure(&text), 0, &unwatched).unwrap();
    let answers: Vec<Answer> = assessment
        .checks()
        .iter()
        .map(|(check, _)| check.answer)
        .collect();
    assert_eq!(answers, [Answer::Unknown]);
}

/// The row G and ∇G of a line to a fairlead of a body at its place of rest, pitch from z to x, by
/// hand: (n, n × r) and (JᵀJ − GᵀG)/l + diag(0, 0, −n·r) with J = [[1, 0, r_z], [0, 1, −r_x]].
fn by_its_line(anchor: [f64; 2], r: [f64; 2], centre: [f64; 2]) -> (Vector3<f64>, Matrix3<f64>) {
    let span = [0, 1].map(|i| centre[i] + r[i] - anchor[i]);
    let length = f64::hypot(span[0], span[1]);
    let n = span.map(|part| part / length);
    let row = Vector3::new(n[0], n[1], n[0] * r[1] - n[1] * r[0]);
    let j = nalgebra::Matrix2x3::new(1.0, 0.0, r[1], 0.0, 1.0, -r[0]);
    let mut bend = (j.transpose() * j - row * row.transpose()) / length;
    bend[(2, 2)] -= n[0] * r[0] + n[1] * r[1];
    (row, bend)
}

/// On stretched lines that stay taut surge, heave and pitch are, for small waves, the linear answer
/// with the stiffness of the lines and their dampers beside the water's:
///
/// ```text
/// (C + K − ω² (M + A) − iω (B + D)) Z = F,    K = Σ k G Gᵀ + T ∇G,    D = Σ c G Gᵀ
/// ```
#[test]
fn taut_springs_answer_small_waves_as_the_frequency_domain_does() {
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
    // Surge is damped, so that its free swing has died away at the end.
    let text = text.replace("pairs = 6", "pairs = 6\ndamping = [2e5, 1e4, 2e5]");
    let text = text.replacen("length = 9.666", "length = 9.6", 1);
    let structure = structure(&text.replace("stiffness = 1.2e8", "stiffness = 2e7"));
    let afloat = structure.afloat.clone().unwrap();
    let lines = structure.lines.clone();
    let prepared = Prepared::new(structure).unwrap();
    let law = springs(&prepared, 1.0).unwrap();
    let sprung = prepared.on_springs(&law).unwrap();

    let rest = &sprung.rest;
    assert!(rest.theta_rad.abs() > 1e-3 && rest.place_m[0].abs() > 1e-3);
    let scales = &sprung.model.scales;
    let (mut stiffness, mut damping) = (afloat.body.stiffness, afloat.body.damping);
    let (sine, cosine) = (-rest.theta_rad).sin_cos();
    for ((line, spring), tension) in lines.iter().zip(&law).zip(&rest.tension_n) {
        let [x, z] = [line.fairlead_m[0], line.fairlead_m[1] + 0.2];
        let r = [x * cosine + z * sine, -x * sine + z * cosine];
        let (row, bend) = by_its_line(line.anchor_m, r, rest.place_m);
        let c = spring.damping * scales.force_n * scales.time_s / scales.length_m;
        stiffness += row * row.transpose() * (2e7 / line.length_m) + bend * *tension;
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

    // What is of the second order in the waves has other frequencies, and is fitted beside the answer.
    let run = run_elastic(&sprung, &law, 0.2, &unwatched).unwrap();
    let looks: Vec<_> = run.looks.iter().filter(|look| look.t_s > 240.0).collect();
    let columns = nalgebra::DMatrix::from_fn(looks.len(), 5, |row, column| {
        let phase = omega * looks[row].t_s;
        let terms = [phase.cos(), phase.sin(), 1.0];
        let double = [(2.0 * phase).cos(), (2.0 * phase).sin()];
        *terms.iter().chain(&double).nth(column).unwrap()
    });
    let solver = columns.svd(true, true);
    let largest = answer.map(Complex::norm).max();
    for i in 0..3 {
        let motion = nalgebra::DVector::from_fn(looks.len(), |row, _| {
            let state = &looks[row].state;
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

/// A body whose water the textbook has, on one upright line at its centre.
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
    let prepared = Prepared::new(structure(&text)).unwrap();
    let a33 = prepared.structure.body.added_mass.heave_kg;
    let b = 2.0;
    // Between the rows of the table, 2.1987 and 2.1421 b² at b/T of 5/3 and 2 (half of the double body's).
    assert!((a33 / (1025.0 * 20.0 * b * b) - 2.1987).abs() < 1e-3);
    let c33 = 1025.0 * 9.81 * 2.0 * b * 20.0;
    let k = 4.9e6 / 9.8;
    let found = prepared.on_lines_that_stretch();
    let heave = found.iter().find(|(natural, _)| natural.freedom == 1);
    let (natural, mode) = heave.unwrap();
    let omega = f64::sqrt((c33 + k) / (90000.0 + a33));
    assert!((natural.omega_rad_s / omega - 1.0).abs() < 1e-9);
    let ratio = 3e4 / (2.0 * f64::sqrt((c33 + k) * (90000.0 + a33)));
    assert!((mode.damping_ratio / ratio - 1.0).abs() < 1e-6);
    // It rests where waterplane and line balance the lift of what it displaces too much.
    let lift = (1025.0 * 96.0 - 90000.0) * 9.81;
    let sprung = prepared
        .on_springs(&springs(&prepared, 1.0).unwrap())
        .unwrap();
    let rise = lift / (c33 + k);
    assert!((sprung.rest.place_m[1] + 0.2 - rise).abs() < 1e-9);
    let assessment = assess(structure(&text), 0, &unwatched).unwrap();
    let rules: Vec<_> = assessment.warnings.iter().map(|w| w.rule).collect();
    assert!(
        rules.contains(&"textbook section") && rules.contains(&"ends"),
        "{rules:?}"
    );
    assert!(assessment.summary("case").contains("no waves are made"));
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
            .and_then(Prepared::new)
            .map(|_| ())
            .expect_err(to);
        assert!(error.to_string().contains(says), "{to}: {error}");
    }
}

/// Four lines, two on each side of which one is 2 mm shorter than the other: by their stiffness they
/// share what the water leaves them as springs do, and without a stiffness the verdict is open.
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
    let prepared = Prepared::new(structure(&doubled)).unwrap();
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
    let shared = prepared.rest.shared.as_ref();
    let same = doubled
        .replace("9.668", "9.666")
        .replace("stiffness = 1.2e8\n", "");
    let even = assess(structure(&same), 0, &unwatched).unwrap();
    let rest = &even.prepared.rest;
    assert!(rest.indeterminate && rest.taut.len() == 4);
    assert!(
        rest.tension_n
            .iter()
            .all(|pull| (pull / rest.tension_n[0] - 1.0).abs() < 1e-6)
    );
    let once = Prepared::new(structure(&text)).unwrap();
    assert!((2.0 * rest.tension_n[0] / once.rest.tension_n[0] - 1.0).abs() < 1e-6);
    assert!(even.warnings.iter().any(|w| w.rule == "shared loads"));
    assert_eq!(even.verdict().standing, Standing::Open);
    assert_eq!(shared.is_some(), long < 0.9 * short, "{short} {long}");
}
