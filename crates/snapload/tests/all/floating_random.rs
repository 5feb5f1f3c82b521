//! Laws that hold for any floating body: whatever its mass, its water, its cables and its waves.

use crate::floating::energy_left_over;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::{
    Body, Cable, Excitation, Exponential, Floating, Forcing, Harmonic, Matrix3, Rules, Shape,
    Simulation, State, System, Trajectory,
};

/// Pseudo-random numbers, uniform between −1 and 1, the same for every run (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A random number between two bounds.
    pub fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * 0.5 * (self.next() + 1.0)
    }

    fn vector(&mut self, size: f64) -> [f64; 3] {
        std::array::from_fn(|_| size * self.next())
    }

    /// A positive semidefinite matrix A Aᵀ of entries up to three times `size` squared, and `least`
    /// of the identity.
    pub fn definite(&mut self, size: f64, least: f64) -> Matrix3 {
        let rows: Matrix3 = std::array::from_fn(|_| self.vector(size));
        let mut matrix = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..=i {
                let entry: f64 = (0..3).map(|k| rows[i][k] * rows[j][k]).sum();
                (matrix[i][j], matrix[j][i]) = (entry, entry);
            }
            matrix[i][i] += least;
        }
        matrix
    }

    /// R e^{pt} with K̂(0) = 0 and Re K̂(iω) positive semidefinite: with p = −α + iβ and
    /// R = A (1 + iα/β), K̂(s) = A s/((s + α)² + β²).
    fn passive_term(&mut self) -> Exponential {
        let (decay, swing) = (self.between(0.2, 2.0), self.between(0.3, 3.0));
        let shares = self.definite(0.7, 0.0);
        Exponential {
            pole: [-decay, swing],
            residue: shares.map(|row| row.map(|a| [a, a * decay / swing])),
        }
    }

    fn waves(&mut self, count: usize, size: f64) -> Vec<Excitation> {
        let wave = |random: &mut Self| Excitation {
            omega: random.between(0.3, 3.0),
            cosine: random.vector(size),
            sine: random.vector(size),
        };
        (0..count).map(|_| wave(self)).collect()
    }

    /// A floating body on two cables, moving, at a place where both are slack.
    pub fn body(&mut self, waves: usize) -> (System, State) {
        let mass = self.definite(0.5, 0.3);
        let mut stiffness = self.definite(0.8, 0.1);
        stiffness[0] = [0.0; 3];
        for row in &mut stiffness {
            row[0] = 0.0;
        }
        let water = Floating {
            stiffness,
            damping: self.definite(0.3, 0.0),
            constant: [
                0.2 * self.next(),
                self.between(-0.8, -0.2),
                0.1 * self.next(),
            ],
            memory: (0..3).map(|_| self.passive_term()).collect(),
            excitation: self.waves(waves, 0.4),
        };
        let cable = |random: &mut Self, side: f64| {
            let fairlead = [side * random.between(0.05, 0.3), 0.2 * random.next()];
            let anchor = [side * random.between(0.5, 1.0), random.between(0.8, 1.4)];
            let reach = (fairlead[0] - anchor[0]).hypot(fairlead[1] - anchor[1]);
            Cable::new(anchor, fairlead, reach + random.between(0.01, 0.3))
        };
        let system = System {
            body: Body::with_mass_matrix(Shape::Point, mass).expect("positive definite"),
            cables: vec![cable(self, 1.0), cable(self, -1.0)],
            forcing: Forcing::default(),
            drag: None,
            floating: Some(water),
            restitution: self.between(0.0, 1.0),
        };
        let [vx, vy, vtheta] = self.vector(0.5);
        let start = State {
            vx,
            vy,
            vtheta,
            ..State::default()
        };
        (system, start)
    }
}

/// ẏ = L y, y = (q, q̇, z, sinusoids, 1), as one matrix: an independent formulation of slack
/// flight.
fn linear(system: &System, body: &Matrix3) -> DMatrix<f64> {
    let water = system.floating.as_ref().expect("afloat");
    let terms = water.memory.len();
    let (states, waves) = (6 * terms, water.excitation.len());
    let constant = 6 + states + 2 * waves;
    let mass = DMatrix::from_fn(3, 3, |i, j| body[i][j]);
    let inverse = mass.try_inverse().expect("positive definite");
    let mut force = DMatrix::zeros(3, constant + 1);
    let mut l = DMatrix::zeros(constant + 1, constant + 1);
    for i in 0..3 {
        l[(i, 3 + i)] = 1.0;
        for j in 0..3 {
            force[(i, j)] = -water.stiffness[i][j];
            force[(i, 3 + j)] = -water.damping[i][j];
        }
        force[(i, constant)] = water.constant[i];
        for (k, term) in water.memory.iter().enumerate() {
            for j in 0..3 {
                let [re, im] = term.residue[i][j];
                let at = 6 + 6 * k + 2 * j;
                (force[(i, at)], force[(i, at + 1)]) = (-re, im);
            }
        }
        for (k, wave) in water.excitation.iter().enumerate() {
            let at = 6 + states + 2 * k;
            (force[(i, at)], force[(i, at + 1)]) = (wave.cosine[i], wave.sine[i]);
        }
    }
    let accelerations = inverse * force;
    l.view_mut((3, 0), (3, constant + 1))
        .copy_from(&accelerations);
    for (k, term) in water.memory.iter().enumerate() {
        for j in 0..3 {
            let at = 6 + 6 * k + 2 * j;
            let [re, im] = term.pole;
            (l[(at, at)], l[(at, at + 1)]) = (re, -im);
            (l[(at + 1, at)], l[(at + 1, at + 1)]) = (im, re);
            l[(at, 3 + j)] = 1.0;
        }
    }
    for (k, wave) in water.excitation.iter().enumerate() {
        let at = 6 + states + 2 * k;
        (l[(at, at + 1)], l[(at + 1, at)]) = (-wave.omega, wave.omega);
    }
    l
}

/// e^A of a small matrix, by its series; that of nalgebra leaves errors of 1e-12.
fn exponential(small: &DMatrix<f64>) -> DMatrix<f64> {
    let mut term = DMatrix::identity(small.nrows(), small.nrows());
    let mut sum = term.clone();
    for k in 1..=16 {
        term = &term * small / f64::from(k);
        sum += &term;
    }
    sum
}

/// g = |P − A|² − r² of a cable, by its definition.
fn gap(cable: &Cable, y: &DVector<f64>) -> f64 {
    let (s, c) = y[2].sin_cos();
    let [px, py] = cable.fairlead().components();
    let [ax, ay] = cable.anchor().components();
    let (x, y) = (y[0] + px * c - py * s - ax, y[1] + px * s + py * c - ay);
    x * x + y * y - cable.length() * cable.length()
}

/// Computes the flight of one body until its first event, and in parallel by the exponential of its
/// linear system in steps of a hundredth. Returns whether there was an event.
fn compare_with_dense_search(seed: u64) -> bool {
    const STEP: f64 = 0.01;
    const END: f64 = 3.0;
    let mut random = Random(seed);
    let (system, start) = random.body(2);
    let mass = Random(seed).definite(0.5, 0.3);
    let Ok(mut simulation) = Simulation::new(system.clone(), Rules::until(END), 0.0, start) else {
        panic!("a start that is legal by construction");
    };
    let (mut event, mut before) = (END, start);
    while let Some(step) = simulation.step() {
        before = step.before;
        if step.taut_after.is_empty() && step.impacts().next().is_none() {
            continue;
        }
        event = step.t_end;
        break;
    }
    let once = exponential(&(linear(&system, &mass) * STEP));
    let water = system.floating.as_ref().expect("afloat");
    let size = once.nrows();
    let mut first = DVector::zeros(size);
    for (i, component) in start.components().into_iter().enumerate() {
        first[i] = component;
    }
    for k in 0..water.excitation.len() {
        first[6 + 6 * water.memory.len() + 2 * k] = 1.0;
    }
    first[size - 1] = 1.0;
    let (mut y, mut t) = (first.clone(), 0.0);
    while t + STEP < END {
        y = &once * &y;
        t += STEP;
        let closed = system.cables.iter().any(|cable| gap(cable, &y) > 1e-12);
        assert!(
            !closed || t >= event,
            "seed {seed}: a gap has closed at {t}, known at {event}"
        );
        if closed {
            break;
        }
    }
    // At the event the states agree, and one of the gaps is closed.
    let parts = (event / STEP).ceil().max(1.0);
    let part = exponential(&(linear(&system, &mass) * (event / parts)));
    let there = (0..parts as u32).fold(first, |y, _| &part * y);
    for (i, component) in before.components().into_iter().enumerate() {
        assert!(
            (component - there[i]).abs() < 1e-11,
            "seed {seed}: {component} {}",
            there[i]
        );
    }
    let widest = system.cables.iter().map(|cable| gap(cable, &there));
    let closed = widest.fold(f64::NEG_INFINITY, f64::max).abs() < 1e-10;
    assert!(
        closed || event == END,
        "seed {seed}: no gap is closed at {event}"
    );
    event < END
}

#[test]
fn no_event_is_missed_in_random_flights() {
    let events = (0..1500)
        .filter(|seed| compare_with_dense_search(*seed))
        .count();
    println!("{events} events in 1500 flights");
    assert!(events > 500);
}

/// The same for a million bodies: `cargo test --release -p snapload --test all -- --ignored
/// a_million`.
#[test]
#[ignore = "some ten minutes"]
fn no_event_is_missed_in_a_million_random_flights() {
    let workers = 4;
    let counts = std::thread::scope(|scope| {
        let all: Vec<_> = (0..workers)
            .map(|worker| {
                scope.spawn(move || {
                    let seeds = (0..1_000_000u64).filter(|seed| seed % workers == worker);
                    seeds
                        .filter(|seed| compare_with_dense_search(*seed))
                        .count()
                })
            })
            .collect();
        all.into_iter()
            .map(|thread| thread.join().expect("no event is missed"))
            .sum::<usize>()
    });
    println!("{counts} events in 1,000,000 flights");
}

/// A full mass matrix and water without any force: the motion of docs/model.md. Errors grow from
/// impact to impact, so that only the first ones are compared.
#[test]
fn water_that_does_nothing_leaves_the_submerged_body() {
    let (a, b, inertia) = (0.2, 0.1, 0.02);
    let wave = Harmonic::ellipse(0.3, 0.5, 0.9);
    let shape = Shape::of_half_sizes(a, b);
    let plain = System::moored_breakwater(Body::rigid(shape, inertia), [a, b], 1.5, 0.9, wave);
    let mut afloat = plain.clone();
    let mass = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, inertia]];
    afloat.body = Body::with_mass_matrix(shape, mass).expect("positive definite");
    afloat.floating = Some(Floating::default());
    let mut heavy = afloat.clone();
    heavy.floating = None;
    let start = State {
        y: 0.1,
        theta: 0.05,
        ..State::default()
    };
    let rules = Rules {
        v_stick: 1e-6,
        ..Rules::until(6.0)
    };
    let [known, ours, other] = [plain, afloat, heavy].map(|system| {
        let simulation = Simulation::new(system, rules, 0.0, start).expect("legal");
        Trajectory::record(simulation)
    });
    assert!(known.impacts().len() > 20);
    for run in [ours, other] {
        for (ours, known) in run.impacts().iter().zip(known.impacts()).take(20) {
            assert_eq!(ours.cable, known.cable);
            assert!((ours.t - known.t).abs() < 1e-10 && (ours.v_n - known.v_n).abs() < 1e-10);
            assert!((ours.impulse - known.impulse).abs() < 1e-10);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 48,
        rng_seed: RngSeed::Fixed(1999),
        ..ProptestConfig::default()
    })]

    /// Energy is accounted for, and a passive memory never gives more than it has taken.
    #[test]
    fn energy_closes_and_the_memory_is_passive(seed in any::<u64>(), waves in 0..3_usize) {
        let (system, start) = Random(seed).body(waves);
        let rules = Rules { max_impacts: 40, ..Rules::until(5.0) };
        let simulation = Simulation::new(system.clone(), rules, 0.0, start).expect("legal");
        let (left_over, least) = energy_left_over(&system, simulation);
        prop_assert!(left_over < 1e-9, "left over {left_over:e}");
        prop_assert!(least > -1e-10, "the memory gave {least:e}");
    }

    /// W is the matrix of the impact law in the metric of the mass, impacts lose energy, and no
    /// cable is longer than its length.
    #[test]
    fn impacts_follow_the_law_in_the_metric_of_the_mass(seed in any::<u64>()) {
        let (system, start) = Random(seed).body(2);
        let rules = Rules { max_impacts: 30, ..Rules::until(6.0) };
        let mut simulation = Simulation::new(system.clone(), rules, 0.0, start).expect("legal");
        while let Some(step) = simulation.step() {
            for cable in &system.cables {
                prop_assert!(cable.gap(&step.after) < 1e-12);
            }
            let rows: Vec<_> = step.impacts().collect();
            let Some(first) = rows.first() else { continue };
            let (before, after) = (system.energy(&first.before), system.energy(&first.after));
            let lost: f64 = rows.iter().map(|row| row.energy_lost).sum();
            prop_assert!((before - after - lost).abs() < 1e-12 && lost > -1e-14);
            for row in &rows {
                let normal = system.cables[row.cable].normal(&row.before);
                let v_after = normal.velocity(&row.after);
                prop_assert!((v_after + system.restitution * row.v_n).abs() < 1e-12);
                if rows.len() == 1 {
                    let w = system.body.inverse_effective_mass(&normal);
                    let p = (1.0 + system.restitution) * normal.velocity(&row.before) / w;
                    prop_assert!((p - row.impulse).abs() < 1e-12 * (1.0 + p));
                }
            }
        }
    }
}
