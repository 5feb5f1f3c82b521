//! How far floating runs can be trusted: the linearised motion with the water's memory in it, and
//! the spread of neighbours.

use crate::floating::FloatingCase;
use crate::floating_random::Random;
use snapload::analysis::TrustMonitor;
use snapload::{Impact, Rules, Simulation, State, System, Tangent};

/// The state and the memory at the end of a motion.
fn end(system: &System, start: State, t: f64) -> Vec<f64> {
    let mut motion = Simulation::new(system.clone(), Rules::until(t), 0.0, start).expect("legal");
    while motion.step().is_some() {}
    let state = motion.state().components();
    let memory = motion.memory().as_flattened();
    state.iter().chain(memory).copied().collect()
}

/// ∂(state and memory)/∂(start), a little later than the third impact, by the linearised motion and
/// by neighbouring runs.
#[test]
fn the_linearised_motion_knows_the_memory() {
    let (mut compared, mut taut) = (0, 0);
    for seed in 0..12 {
        let (mut system, start) = Random(seed).body(2);
        if seed % 2 == 1 {
            system.restitution = 0.0;
        }
        let rules = Rules::until(1e3);
        let mut motion = Simulation::new(system.clone(), rules, 0.0, start).expect("legal");
        let tangent = Tangent::new(&system);
        let rows = 2 * motion.memory().len();
        let mut columns = [0, 1, 2, 3, 4, 5].map(|k| {
            let mut column = [0.0; 6];
            column[k] = 1.0;
            (column, vec![0.0; rows])
        });
        let mut impacts = 0;
        let last = loop {
            let step = motion.step().expect("it goes on");
            taut += usize::from(!step.taut.is_empty());
            let map = tangent.of_step(&motion, &step);
            for (column, memory) in &mut columns {
                *column = map.fundamental_with_memory(column, memory);
            }
            if impacts >= 3 {
                break step;
            }
            impacts += step.impacts().take(1).count();
        };
        // Neighbours have events at other times, so that states at one time can not be compared
        // there.
        if last.impacts().next().is_some() || last.taut != last.taut_after {
            continue;
        }
        let (h, t) = (1e-6, last.t_end);
        for (k, (column, memory)) in columns.iter().enumerate() {
            let moved = |side: f64| {
                let mut components = start.components();
                components[k] += side * h;
                end(&system, State::from_components(components), t)
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            for (i, ours) in column.iter().chain(memory).enumerate() {
                let known = (up[i] - down[i]) / (2.0 * h);
                let scale = 1.0 + known.abs();
                assert!(
                    (ours - known).abs() < 5e-4 * scale,
                    "{seed} {k} {i}: {ours} {known}"
                );
                compared += 1;
            }
        }
    }
    println!("{compared} derivatives, {taut} steps with taut cables");
    assert!(compared > 200);
}

/// The impacts of a run, one for each instant, and the predicted errors of them.
fn followed(system: &System, start: State, uncertainty: f64) -> (Vec<Impact>, Vec<f64>) {
    let rules = Rules {
        v_stick: 1e-6,
        max_impacts: 6,
        ..Rules::until(6.0)
    };
    let mut motion = Simulation::new(system.clone(), rules, 0.0, start).expect("legal");
    let mut monitor = TrustMonitor::new(&motion, &[uncertainty; 6], 1e-2);
    let mut impacts = Vec::new();
    while let Some(step) = motion.step() {
        monitor.follow(&motion, &step);
        impacts.extend(step.impacts());
    }
    (impacts, monitor.verdict().errors)
}

/// The standard deviation of neighbours at each impact, the largest of those of time and states, is
/// half of the predicted error.
#[test]
fn a_crowd_of_floating_neighbours_spreads_as_predicted() {
    const CROWD: usize = 200;
    const DOUBT: f64 = 1e-7;
    let mut compared = 0;
    for seed in 0..6 {
        let (system, start) = Random(seed).body(2);
        let (run, errors) = followed(&system, start, DOUBT);
        let mut random = Random(1000 + seed);
        let mut squares = vec![[0.0; 13]; run.len()];
        for _ in 0..CROWD {
            let near = start.components().map(|c| c + DOUBT * random.next());
            let (impacts, _) = followed(&system, State::from_components(near), 0.0);
            for (k, (ours, theirs)) in run.iter().zip(&impacts).enumerate() {
                let numbers = |impact: &Impact| {
                    let states = [impact.before, impact.after].map(State::components);
                    let mut all = [impact.t; 13];
                    all[1..].copy_from_slice(states.as_flattened());
                    all
                };
                for (i, (a, b)) in numbers(ours).iter().zip(numbers(theirs)).enumerate() {
                    squares[k][i] += ((a - b) / a.abs().max(1.0)).powi(2) / CROWD as f64;
                }
            }
        }
        for (row, error) in squares
            .iter()
            .zip(&errors)
            .filter(|(_, error)| error.is_finite())
        {
            // The states of each neighbour are those at its own events, as for the predicted
            // errors.
            let spread = row
                .iter()
                .fold(0.0_f64, |most, square| most.max(square.sqrt()));
            let ratio = error / (2.0 * spread);
            assert!(
                (0.7..1.4).contains(&ratio),
                "seed {seed}: {ratio} of {spread:e}"
            );
            compared += 1;
        }
    }
    println!("{compared} impacts");
    assert!(compared > 10);
}

/// Rounding alone: the errors of the four runs, against numbers with more digits than doubles have,
/// are as large as predicted or smaller until trust ends; lines that lose their tension do not end
/// trust.
#[test]
fn rounding_of_floating_runs_is_foreseen() {
    for (name, least) in [
        ("pontoon-regular", 20),
        ("pontoon-sea", 21),
        ("cylinder-regular", 20),
        ("sphere-one-line", 20),
    ] {
        let case = FloatingCase::named(name);
        let mut motion = case.simulation(40.0);
        let mut monitor = TrustMonitor::new(&motion, &[0.0; 6], 1e-3);
        let mut times = Vec::new();
        while let Some(step) = motion.step() {
            monitor.follow(&motion, &step);
            times.extend(step.impacts().map(|impact| impact.t));
        }
        let trust = monitor.verdict();
        let known = case.impact_times().into_iter();
        let known: Vec<f64> = known.map(|t| t / case.units.time_s).collect();
        let certain = trust.errors.iter().take_while(|error| error.is_finite());
        let certain = certain.count().min(known.len());
        for k in 0..certain {
            // The file has some fifteen digits.
            let allowed = (3.0 * trust.errors[k] * times[k].max(1.0)).max(4e-15 * times[k]);
            let off = (times[k] - known[k]).abs();
            assert!(
                off < allowed,
                "{name} {k}: {off:e}, foreseen {:e}",
                trust.errors[k]
            );
        }
        println!("{name}: {certain} impacts, {:?}", trust.horizon);
        assert!(
            certain >= least,
            "{name}: {certain} impacts, {:?}",
            trust.horizon
        );
    }
}
