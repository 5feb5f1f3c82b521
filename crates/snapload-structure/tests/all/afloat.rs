//! Structures that float: the coefficients of a panel code under the same keys and answers.

use crate::verdicts::source;
use snapload::analysis::no_progress;
use snapload::{
    Body, Entries, Excitation, Exponential, Floating, FloatingUnits, Forcing, Playback, Rules,
    Simulation, State, System,
};
use snapload_hydro::{Given, Line, Report, Request, Weight, read, response_of_the_memory};
use snapload_structure::{
    Lines, ModelAtRest, Outcome, STRUCTURE, Structure, assess, elastic_lines, note, run_elastic,
    seas,
};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// Where `pontoon.nc` is, 20 × 4 m with 1.2 m of draft in deep water, its reference point in the
/// waterline.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples")
}

/// A pontoon of 80 t that displaces 98.4 t where it floats with its centre at `z`, on two lines.
pub(crate) fn case(z: f64, height: f64, length: f64, water: &str, run: &str) -> String {
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

pub(crate) fn parsed(text: &str) -> Result<Structure, snapload::CaseError> {
    Structure::from_entries_beside(&Entries::parse(&STRUCTURE, "case", text)?, &folder())
}

pub(crate) fn structure(text: &str) -> Structure {
    parsed(text).expect("a structure")
}

/// The same pontoon, built in this test about the file's own reference point.
pub(crate) fn by_hand() -> (Report, snapload_hydro::Body) {
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
/// system built in this test, in other units.
#[test]
fn a_structure_afloat_is_the_system_by_hand() {
    let wave = "[wave]\nheight = 1.2\nperiod = 5";
    let text = case(0.0, 2.4, 9.666, wave, "duration = 25\ntransient = 0");
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
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
    // Other units of length and mass than the structure's.
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

/// Without a taut line heave has the amplitude and phase of the frequency domain; on lines that
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
    let prepared = ModelAtRest::new(structure).unwrap();
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
            // Re 0.2 i ξ e^{−iωt}, about the height at which weight and buoyancy are in balance.
            let still = afloat.body.constant_force[1] / afloat.body.stiffness[(1, 1)];
            let heave = still + 0.2 * (xi[1].re * sine - xi[1].im * cosine);
            assert!((z - heave).abs() < 1e-6, "{t} {z} {heave}");
            compared += 1;
        }
    }
    assert!(compared > 50);
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let elastic = run_elastic(&prepared, &law, 0.5, &no_progress).unwrap();
    let stiff = snapload::Trajectory::record(prepared.begin(1.0).unwrap());
    let mut playback = Playback::new(&stiff);
    for sample in &elastic.samples {
        let state = playback.at(sample.t_s / prepared.model.scales.time_s).state;
        for (a, b) in state
            .components()
            .into_iter()
            .zip(sample.state.components())
        {
            // Between the steps the solution is only of the seventh order.
            assert!((a - b).abs() < 1e-6, "{} {a} {b}", sample.t_s);
        }
    }
    let end = playback.at(stiff.end().t).state.components();
    for (a, b) in end.into_iter().zip(elastic.end.components()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// On elastic lines the body rests where hydrostatics, weight and pulls are in balance.
#[test]
fn stretched_lines_share_the_load_with_the_water() {
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
    let prepared = ModelAtRest::new(structure(&text)).unwrap();
    let law = elastic_lines(&prepared, 1.0).unwrap();
    let elastic_case = prepared.with_elastic_lines(&law).unwrap();
    let rise = elastic_case.rest.place_m[1] + 0.2;
    // The surplus of buoyancy falls by ρ g A per metre of rise.
    let left = (98400.0 - 80000.0) * 9.81 - 804_420.0 * rise;
    let up: f64 = (0..2)
        .map(|line| {
            let [x, z] = [4.0, 8.8 + rise];
            elastic_case.rest.tension_n[line] * z / f64::hypot(x, z)
        })
        .sum();
    assert!((up / left - 1.0).abs() < 1e-4, "{up} {left}");
    let [stiff, soft] = [&prepared, &elastic_case].map(|p| p.rest.tension_n[0]);
    assert!(soft < stiff && soft > 0.5 * stiff, "{stiff} {soft}");
    // In still water it stays there, and so do neighbours without waves.
    let mut motion = prepared.begin(0.0).unwrap();
    while motion.step().is_some() {}
    let end = prepared
        .model
        .scales
        .to_si([motion.state().x, motion.state().y]);
    assert!((end[1] - prepared.rest.place_m[1]).abs() < 1e-9);
}

/// A mirrored sea mirrors the motion of a symmetric body.
#[test]
fn waves_from_either_side_are_mirror_images() {
    let peaks = |direction: &str| {
        let wave = format!("[wave]\nheight = 1\nperiod = 4.6\ndirection = \"{direction}\"");
        let text = case(-0.2, 2.0, 9.666, &wave, "duration = 9\ntransient = 0");
        let assessment = assess(structure(&text), 0, &no_progress).unwrap();
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
    let result = seas(structure(&text), 2, Lines::Inextensible, &no_progress);
    let result = result.unwrap();
    let summary = result.summary("case");
    assert!(
        summary.contains("periods")
            && summary.contains("heave")
            && summary.contains("while the lines stay taut"),
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
            "three numbers in N s/m, [surge, heave, pitch], each from 0 to 1e18",
        ),
        ("pairs = 6", "pairs = 6\nname = \"raft\"", "raft"),
        (
            "pairs = 6",
            "pairs = 6\nfile_centre_of_gravity = [0, -0.5]",
            "-0.2 in the file and -0.5 in the case",
        ),
        ("pairs = 6", "memory = \"pontoon.nc\"", "float.memory"),
        (
            "[run]",
            "[sea]\nhs = 1\ntp = 3\n[run]",
            "outside the file's",
        ),
        ("length = 9.666", "length = 20", "run.start"),
        (
            "[run]",
            "[design]\nforce_share = 0.9\n[run]",
            "nothing beside [float]",
        ),
    ] {
        let text = text.replace(from, to);
        let error = parsed(&text).and_then(ModelAtRest::new);
        let error = error.expect_err(to).to_string();
        assert!(error.contains(says), "{to}: {error}");
    }
}

/// The x of a file are those of the case: a case that has the body elsewhere is refused, whether
/// the file has the centre of buoyancy, or only the stiffness, as WAMIT's, whose origin the case
/// gives.
#[test]
fn a_file_with_the_body_elsewhere_is_refused() {
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5");
    let says = "= [1, -0.2] is not allowed; allowed: x = 0.000, where the file has the body";
    let error = parsed(&text.replace("position = [0,", "position = [1,")).expect_err("elsewhere");
    assert!(error.to_string().contains(says), "{error}");
    // A centimetre of four metres is within the accuracy of a mesh.
    parsed(&text.replace("position = [0,", "position = [0.01,")).expect("the same place");

    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../snapload-hydro/tests/data");
    let of_wamit = |x: f64| {
        let given = format!("\"pontoon-deep.1\"\nreference = [{x}, 0]\nunit_length = 1");
        let text = text
            .replace("\"pontoon.nc\"", &given)
            .replace("pairs = 6", "pairs = 6\nfile_centre_of_gravity = [0, -0.2]");
        Structure::from_entries_beside(&Entries::parse(&STRUCTURE, "case", &text).unwrap(), &folder)
    };
    of_wamit(0.0).expect("the same place");
    let error = of_wamit(-1.5).expect_err("elsewhere").to_string();
    assert!(
        error.contains("x = -1.500, where the file has the body"),
        "{error}"
    );
    assert!(error.contains("by -1.500 m in x"), "{error}");
}

/// Linear theory is left on elastic lines, too, and said to be.
#[test]
fn the_limits_are_reported_for_elastic_lines() {
    let sea = "[sea]\nhs = 1.6\ntp = 5.5\ncomponents = 60";
    let text = case(-0.2, 2.0, 9.666, sea, "duration = 90");
    let result = seas(structure(&text), 2, Lines::Elastic, &no_progress).unwrap();
    let seen = |rule: &str| result.warnings.iter().any(|warning| warning.rule == rule);
    let outcomes = || result.records.iter().map(|record| &record.outcome);
    let heave = |outcome: &Outcome| outcome.waterline.unwrap().heave_m;
    let least = outcomes()
        .map(|outcome| heave(outcome)[0])
        .fold(0.0, f64::min);
    assert!(least < -0.4, "{least}");
    assert!(seen("small heave"), "{:?}", result.warnings);
}

/// The pontoon of WAMIT's files with a centre of gravity 0.3 m beside that of buoyancy, which the
/// entry 4,6 of their stiffness says: C(4,6) = V (x_G − x_B) in units of ρ g. The body of the case
/// and its lines are symmetric, so that it rests upright. Without the entry buoyancy is taken to act
/// below that centre of gravity, and the lines must hold it.
#[test]
fn the_buoyancy_of_a_file_of_wamit_acts_where_its_stiffness_has_it() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../snapload-hydro/tests/data");
    let name = format!("snapload-buoyancy-{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for end in ["1", "3"] {
        let name = format!("pontoon-deep.{end}");
        std::fs::copy(data.join(&name), folder.join(&name)).unwrap();
    }
    let hst = std::fs::read_to_string(data.join("pontoon-deep.hst")).unwrap();
    let is_roll_yaw = |line: &&str| line.split_whitespace().take(2).eq(["4", "6"]);
    let without: Vec<&str> = hst.lines().filter(|line| !is_roll_yaw(line)).collect();
    let given = "\"pontoon-deep.1\"\nreference = [0, 0]\nunit_length = 1";
    let centres = "file_centre_of_gravity = [0.3, -0.2]\ncentre_of_gravity = [0, -0.2]";
    let text = case(-0.2, 2.0, 9.666, "", "duration = 5")
        .replace("\"pontoon.nc\"", given)
        .replace("pairs = 6", &format!("pairs = 6\n{centres}"));
    let angle = |entry: &str| {
        let hst = format!("{}\n{entry}\n", without.join("\n"));
        std::fs::write(folder.join("pontoon-deep.hst"), hst).unwrap();
        let entries = Entries::parse(&STRUCTURE, "case", &text).unwrap();
        let structure = Structure::from_entries_beside(&entries, &folder).unwrap();
        ModelAtRest::new(structure).unwrap().rest.theta_rad
    };
    let upright = angle(&format!("4 6 {}", 96.0 * 0.3));
    assert!(upright.abs() < 1e-9, "{upright}");
    let inclined = angle("");
    assert!(inclined.abs() > 1e-3, "{inclined}");
    std::fs::remove_dir_all(&folder).unwrap();
}
