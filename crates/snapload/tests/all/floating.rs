//! Floating bodies against independent results, and laws that hold for any water.

use serde_json::Value;
use snapload::{
    Body, Complex, Drag, Excitation, Exponential, Floating, FloatingUnits, Forcing, Harmonic,
    Impact, Matrix3, Playback, Rules, Shape, Simulation, State, System, Trajectory,
};
use std::sync::LazyLock;

static ORACLE: LazyLock<Value> = LazyLock::new(|| read("floating.json"));
/// Random bodies, water, lines and drag, by a program that was written for this test from the
/// equations alone; its results for the other file's runs agree to 1e-15.
static VARIED: LazyLock<Value> = LazyLock::new(|| read("floating_varied.json"));

fn read(name: &str) -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/oracle/");
    let text = std::fs::read_to_string(format!("{path}{name}")).expect(name);
    serde_json::from_str(&text).expect("JSON")
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list = value.as_array().expect("a list");
    assert_eq!(list.len(), N);
    std::array::from_fn(|i| list[i].as_f64().expect("a number"))
}

fn matrix(value: &Value) -> Matrix3 {
    let rows = value.as_array().expect("rows");
    std::array::from_fn(|i| numbers(&rows[i]))
}

/// One of the runs: a case in SI units, and the results of another program.
pub struct FloatingCase {
    pub units: FloatingUnits,
    pub system: System,
    pub start: State,
    pub v_stick: f64,
    reference: &'static Value,
}

impl FloatingCase {
    pub fn named(name: &str) -> Self {
        Self::of(&ORACLE["runs"][name])
    }

    fn of(reference: &'static Value) -> Self {
        let case = &reference["case"];
        let (rigid, added) = (
            matrix(&case["mass_matrix"]),
            matrix(&case["added_mass_inf"]),
        );
        let mass: Matrix3 =
            std::array::from_fn(|i| std::array::from_fn(|j| rigid[i][j] + added[i][j]));
        let lines = case["lines"].as_array().expect("lines");
        let length = |line: &Value| line["length"].as_f64().expect("a length");
        let anchors = lines.iter().map(|line| numbers::<2>(&line["anchor"])[0]);
        let outermost = anchors.fold(0.0, |most: f64, x| most.max(x.abs()));
        let unit = if lines.len() == 1 {
            length(&lines[0])
        } else {
            outermost
        };
        let gravity = case["gravity"].as_f64().expect("gravity");
        let units = FloatingUnits::new(unit, gravity, mass[1][1]);
        let origin: [f64; 2] = numbers(&case["reference_point"]);
        let cables = lines.iter().map(|line| {
            let [x, z] = numbers(&line["anchor"]);
            let anchor = [x - origin[0], z - origin[1]];
            units.cable(anchor, numbers(&line["fairlead_body"]), length(line))
        });
        let shape = Shape::Point;
        let body = Body::with_mass_matrix(shape, units.mass_matrix(&mass));
        let system = System {
            body: body.expect("positive definite"),
            cables: cables.collect(),
            forcing: Forcing::default(),
            drag: case.get("drag").map(|drag| drag_of(drag, &units)),
            floating: Some(units.floating(&water(case))),
            restitution: case["restitution"].as_f64().expect("e"),
        };
        let start = &case["start"];
        Self {
            start: units.state(numbers(&start["q"]), numbers(&start["v"])),
            v_stick: case["v_stick"].as_f64().expect("a speed") / units.speed_m_s(),
            units,
            system,
            reference,
        }
    }

    pub fn simulation(&self, t_end_s: f64) -> Simulation {
        let rules = Rules {
            v_stick: self.v_stick,
            ..Rules::until(t_end_s / self.units.time_s)
        };
        Simulation::new(self.system.clone(), rules, 0.0, self.start).expect("a legal start")
    }

    /// When the impacts are \[s\], one for each row.
    pub fn impact_times(&self) -> Vec<f64> {
        let times = self.rows().iter().map(|row| row["t"].as_f64());
        times.map(|t| t.expect("a time")).collect()
    }

    fn rows(&self) -> &'static Vec<Value> {
        self.reference["impacts"].as_array().expect("impacts")
    }
}

/// The drag of a case. Its law is rounded off below 1e-5 of the engine's unit of velocity in both
/// programs.
fn drag_of(drag: &Value, units: &FloatingUnits) -> Drag {
    let number = |value: &Value| value.as_f64().expect("a number");
    let per_speed = 1.0 / units.speed_m_s();
    let wave = |wave: &Value| {
        let ([u, v], [w, x]) = (numbers(&wave["u"]), numbers(&wave["w"]));
        Harmonic {
            omega: number(&wave["omega"]) * units.time_s,
            cosine: [u * per_speed, -w * per_speed].into(),
            sine: [v * per_speed, -x * per_speed].into(),
        }
    };
    let current = Harmonic {
        omega: 0.0,
        cosine: [number(&drag["current"]) * per_speed, 0.0].into(),
        ..Harmonic::default()
    };
    let waves = drag["waves"].as_array().expect("waves").iter().map(wave);
    Drag {
        linear: number(&drag["linear"]) * units.time_s / units.mass_kg,
        quadratic: number(&drag["quadratic"]) * units.length_m / units.mass_kg,
        turning: 0.0,
        water: waves.chain([current]).collect(),
    }
}

/// The water of a case, in SI units.
fn water(case: &Value) -> Floating {
    let list = |key: &str| case[key].as_array().expect("a list").iter();
    let term = |term: &Value| Exponential {
        pole: numbers(&term["pole"]),
        residue: std::array::from_fn(|i| std::array::from_fn(|j| numbers(&term["residue"][i][j]))),
    };
    let wave = |wave: &Value| {
        let amplitudes: [Complex; 3] = std::array::from_fn(|i| numbers(&wave["force"][i]));
        Excitation::of_amplitudes(wave["omega"].as_f64().expect("a frequency"), amplitudes)
    };
    Floating {
        stiffness: matrix(&case["stiffness"]),
        damping: matrix(&case["damping"]),
        constant: numbers(&case["constant_force"]),
        memory: list("memory").map(term).collect(),
        excitation: list("waves").map(wave).collect(),
    }
}

const RUNS: [&str; 4] = [
    "pontoon-regular",
    "pontoon-sea",
    "cylinder-regular",
    "sphere-one-line",
];

/// The distance of two lists, relative to a scale.
fn apart<const N: usize>(ours: [f64; N], reference: [f64; N], scale: [f64; N]) -> f64 {
    (0..N)
        .map(|i| (ours[i] - reference[i]).abs() / scale[i])
        .fold(0.0, f64::max)
}

/// One row of a run: the largest difference, in s, m, rad, and relative to the body's weight and
/// that times a metre for forces and moments.
fn difference(case: &FloatingCase, ours: &Impact, pull: [f64; 3], reference: &Value) -> f64 {
    let units = &case.units;
    let weight = units.force_n;
    let momentum = units.mass_kg * units.speed_m_s();
    let number = |key: &str| reference[key].as_f64().expect("a number");
    let scalars = apart(
        [
            ours.t * units.time_s,
            ours.v_n * units.speed_m_s(),
            ours.impulse * momentum,
            ours.energy_lost * weight * units.length_m,
        ],
        ["t", "v_n", "impulse", "energy_lost"].map(number),
        [1.0, 1.0, momentum, weight],
    );
    let [place, before] = units.displacement_and_velocity(&ours.before);
    let force = units.generalised_force_si(pull);
    scalars
        .max(apart(place, numbers(&reference["q"]), [1.0; 3]))
        .max(apart(before, numbers(&reference["v_before"]), [1.0; 3]))
        .max(apart(
            force.map(|f| -f),
            numbers(&reference["memory_force"]),
            [weight; 3],
        ))
}

/// Every impact of every run, row by row: times, speeds, impulses, energies, places and velocities,
/// and the force of the memory; and the sets of taut lines between them.
#[test]
fn runs_agree_with_the_independent_ones() {
    let varied = VARIED["runs"].as_object().expect("runs").iter();
    let varied = varied.map(|(name, reference)| (name.as_str(), FloatingCase::of(reference)));
    let runs = RUNS.map(|name| (name, FloatingCase::named(name)));
    for (name, case) in runs.into_iter().chain(varied) {
        let rows = case.rows();
        let last = rows.last().expect("a row")["t"].as_f64().expect("a time");
        let mut simulation = case.simulation(last + 1e-3);
        let (mut compared, mut worst) = (0, 0.0_f64);
        let mut modes = vec![(0.0, simulation.taut())];
        while let Some(step) = simulation.step() {
            let mut impacts = 0;
            for impact in step.impacts() {
                let Some(row) = rows.get(compared) else {
                    break;
                };
                assert_eq!(
                    impact.cable as u64 + 1,
                    row["line"].as_u64().expect("a line")
                );
                let off = difference(&case, &impact, simulation.memory_force(), row);
                let v_n = impact.v_n * case.units.speed_m_s();
                assert!(off < 1e-9, "{name}, row {compared} (v_n {v_n:e}): {off:e}");
                worst = worst.max(off);
                compared += 1;
                impacts += 1;
            }
            if impacts > 0 {
                let after = case.units.displacement_and_velocity(&step.after)[1];
                let reference = numbers(&rows[compared - 1]["v_after"]);
                assert!(
                    apart(after, reference, [1.0; 3]) < 1e-9,
                    "{name}: {after:?} {reference:?}"
                );
            }
            if impacts > 0 || step.taut != step.taut_after {
                modes.push((step.t_end * case.units.time_s, step.taut_after));
            }
        }
        println!("{name}: {compared} rows within {worst:.1e}");
        assert_eq!(compared, rows.len(), "{name}");
        for (ours, reference) in modes
            .iter()
            .zip(case.reference["modes"].as_array().expect("modes"))
        {
            let lines = reference[1].as_array().expect("lines").iter();
            let taut = lines.map(|line| line.as_u64().expect("a line") as usize - 1);
            assert_eq!(ours.1, taut.collect(), "{name} at {}", ours.0);
            assert!(
                (ours.0 - reference[0].as_f64().expect("a time")).abs() < 1e-9,
                "{name}"
            );
        }
        assert!(modes.len() >= case.reference["modes"].as_array().expect("modes").len());
    }
}

/// ρV of a half-immersed sphere of 5 m, in water of 1000 kg/m³.
const DISPLACED_KG: f64 = 261_799.387_799_1;

/// The sphere, as heavy as the water that it displaces, is released from 1 m without a line: a
/// linear motion, which is known by another method.
#[test]
fn a_sphere_let_go_decays_as_known() {
    let mut case = FloatingCase::named("sphere-one-line");
    let added = case.reference["case"]["added_mass_inf"][1][1]
        .as_f64()
        .expect("kg");
    let mass = (DISPLACED_KG + added) / case.units.mass_kg;
    let matrix = [[1.0, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, 1.0]];
    case.system.body = Body::with_mass_matrix(Shape::Point, matrix).expect("positive definite");
    let floating = case.system.floating.as_mut().expect("afloat");
    floating.excitation.clear();
    floating.constant = [0.0; 3];
    case.system.cables.clear();
    case.start = case.units.state([0.0, 1.0, 0.0], [0.0; 3]);
    let decay = &ORACLE["decay"];
    let times = decay["t"].as_array().expect("times");
    let heave = decay["heave"].as_array().expect("heave");
    let last = times.last().and_then(Value::as_f64).expect("a time");
    let run = Trajectory::record(case.simulation(last));
    let mut playback = Playback::new(&run);
    for (t, reference) in times.iter().zip(heave) {
        let (t, reference) = (t.as_f64().expect("s"), reference.as_f64().expect("m"));
        let state = playback.at(t / case.units.time_s).state;
        let ours = case.units.displacement_and_velocity(&state)[0][1];
        assert!((ours - reference).abs() < 1e-10, "{t}: {ours} {reference}");
    }
    assert!(times.len() > 100);
}

/// Gauss's rule of eight points, on half of \[−1, 1\].
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_27],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// The work of the waves on a body in a time interval \[F L\], and the energy that damping and
/// memory take.
fn work(system: &System, run: &mut Playback, from: f64, to: f64) -> [f64; 3] {
    let water = system.floating.as_ref().expect("afloat");
    let mut sums = [0.0; 3];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let points = GAUSS.iter().rev().map(|[x, w]| (-x, w));
    for (x, weight) in points.chain(GAUSS.iter().map(|[x, w]| (*x, w))) {
        let now = run.at(middle + half * x);
        let velocity = [now.state.vx, now.state.vy, now.state.vtheta];
        for i in 0..3 {
            let waves: f64 = water
                .excitation
                .iter()
                .map(|wave| {
                    let (sine, cosine) = (wave.omega * now.t).sin_cos();
                    wave.cosine[i] * cosine + wave.sine[i] * sine
                })
                .sum();
            let damped: f64 = (0..3).map(|j| water.damping[i][j] * velocity[j]).sum();
            let share = weight * half * velocity[i];
            sums[0] += share * waves;
            sums[1] += share * damped;
            sums[2] += share * now.memory_force[i];
        }
    }
    sums
}

/// The energy balance of a run: E changes by the work of the waves minus the energy that damping
/// and memory take, and by the losses at impacts. Returns the largest imbalance, and the least
/// energy that the memory had taken at any time.
pub fn energy_left_over(system: &System, simulation: Simulation) -> (f64, f64) {
    let run = Trajectory::record(simulation);
    let mut playback = Playback::new(&run);
    let begin = playback.at(0.0).energy;
    let mut impacts = run.impacts().iter().peekable();
    let (mut gained, mut left_over, mut memory, mut least) = (0.0, 0.0_f64, 0.0, 0.0_f64);
    let mut modes: Vec<f64> = run.modes().iter().map(|mode| mode.t_end).collect();
    modes.extend(run.impacts().iter().map(|impact| impact.t));
    modes.sort_by(f64::total_cmp);
    let mut t = 0.0;
    for end in modes {
        let parts = ((end - t) / 0.1).ceil().max(1.0);
        let width = (end - t) / parts;
        for k in 0..parts as u32 {
            let from = t + width * f64::from(k);
            let [waves, damping, taken] = work(system, &mut playback, from, from + width);
            gained += waves - damping - taken;
            memory += taken;
            least = least.min(memory);
        }
        while let Some(impact) = impacts.next_if(|impact| impact.t <= end) {
            gained -= impact.energy_lost;
        }
        left_over = left_over.max((playback.at(end).energy - begin - gained).abs());
        t = end;
    }
    (left_over, least)
}

#[test]
fn energy_is_accounted_for_in_the_runs() {
    for name in RUNS {
        let case = FloatingCase::named(name);
        let last = case.rows().last().expect("a row")["t"]
            .as_f64()
            .expect("a time");
        let mut rules = case.simulation(last + 1.0);
        // The loss by sticking is not counted as the impact's loss.
        let system = case.system.clone();
        let bare = Rules {
            v_stick: 0.0,
            max_impacts: 60,
            ..*rules.rules()
        };
        rules = Simulation::new(system.clone(), bare, 0.0, case.start).expect("legal");
        let (left_over, least) = energy_left_over(&system, rules);
        println!("{name}: {left_over:.1e}, memory {least:.1e}");
        assert!(left_over < 1e-9, "{name}: {left_over:e}");
        assert!(least > -1e-12, "{name}: the memory gave {least:e}");
    }
}
