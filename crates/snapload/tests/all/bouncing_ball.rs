//! The ball on a vibrating table: multipliers, thresholds and exponents that are known exactly
//! (Holmes, *J. Sound Vib.* 84 (1982) 173; Luck & Mehta, *Phys. Rev. E* 48 (1993) 3988). The
//! table's motion is not approximated.

use crate::common::{Square, block, determinant, matrix, trace, unending};
use snapload::analysis::Frame;
use snapload::{
    Body, Cable, Deviation, Forcing, Harmonic, Simulation, State, Step, StepMap, System, Tangent,
};
use std::f64::consts::PI;

/// A ball on a table that moves as A sin ωt, seen from the table: the relative height y obeys
/// ÿ = −1 + Γ sin ωt, Γ = Aω², and the constraint y ≥ 0 is a cable of such length that it is never
/// taut at its other end.
#[derive(Clone, Copy, Debug)]
struct Table {
    e: f64,
    gamma: f64,
    omega: f64,
}

/// An impact: its time, and the velocity after it relative to the table.
type Bounce = [f64; 2];

impl Table {
    const CABLE: f64 = 100.0;

    fn system(&self) -> System {
        System {
            body: Body::point(),
            cables: vec![Cable::taut_at_rest(
                [0.0, -Self::CABLE],
                [0.0, 0.0],
                Self::CABLE,
            )],
            forcing: Forcing {
                constant: [0.0, -1.0].into(),
                harmonics: vec![Harmonic {
                    omega: self.omega,
                    cosine: [0.0, 0.0].into(),
                    sine: [0.0, self.gamma].into(),
                }],
            },
            drag: None,
            floating: None,
            restitution: self.e,
        }
    }

    fn begin(&self, [t, vy]: Bounce) -> Simulation {
        let start = State {
            vy,
            ..State::default()
        };
        unending(self.system(), t, start)
    }

    /// The table's velocity.
    fn velocity(&self, t: f64) -> f64 {
        self.gamma / self.omega * (self.omega * t).cos()
    }

    /// The table's acceleration.
    fn acceleration(&self, t: f64) -> f64 {
        -self.gamma * (self.omega * t).sin()
    }

    fn period(&self) -> f64 {
        2.0 * PI / self.omega
    }

    /// The stable orbit of one bounce each n periods: it leaves at V = nT/2 and comes back at −V,
    /// which V − ẇ = e (V + ẇ) holds up for Γ cos ωt = nπ(1 − e)/(1 + e).
    fn orbit(&self, n: f64) -> Bounce {
        let phase = (n * PI * (1.0 - self.e) / (1.0 + self.e) / self.gamma)
            .min(1.0)
            .acos();
        let t = phase / self.omega;
        [t, 0.5 * n * self.period() - self.velocity(t)]
    }

    /// The sum of that orbit's multipliers, 1 + e² − (1 + e)² Γ sin ωt; their product is e². From V
    /// and t of one bounce to the next, δt' = δt + (1 + e) δV and δV' = −(1 + e) Γ sin ωt δt' + e²
    /// δV.
    fn trace(&self, n: f64) -> f64 {
        let lower = n * PI * (1.0 - self.e) / (1.0 + self.e);
        let sine = (self.gamma * self.gamma - lower * lower).max(0.0).sqrt();
        1.0 + self.e * self.e - (1.0 + self.e).powi(2) * sine
    }

    /// The bounce after the given number of bounces, and its derivatives by the linearised motion.
    fn map(&self, from: Bounce, bounces: usize) -> (Bounce, Square) {
        let tangent = Tangent::new(&self.system());
        let mut simulation = self.begin(from);
        let mut later: Deviation = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let mut faster: Deviation = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        for _ in 0..bounces {
            let step = simulation.step().expect("it goes on");
            let map = tangent.of_step(&simulation, &step);
            for deviation in [&mut later, &mut faster] {
                *deviation = through_event(&map, deviation);
            }
        }
        let derivatives = [[later[6], faster[6]], [later[4], faster[4]]];
        ([simulation.time(), simulation.state().vy], derivatives)
    }

    /// Newton's method for the orbit that closes after the given number of bounces, n periods each.
    fn closed_orbit(&self, guess: Bounce, bounces: usize, n: f64) -> Option<(Bounce, Square)> {
        let (mut orbit, mut last) = (guess, f64::INFINITY);
        for _ in 0..40 {
            let (end, a) = self.map(orbit, bounces);
            let open = [
                end[0] - orbit[0] - bounces as f64 * n * self.period(),
                end[1] - orbit[1],
            ];
            // (A − 1) δ = −open.
            let b = [[a[0][0] - 1.0, a[0][1]], [a[1][0], a[1][1] - 1.0]];
            let scale = -1.0 / determinant(&b);
            let change = [
                scale * (b[1][1] * open[0] - b[0][1] * open[1]),
                scale * (b[0][0] * open[1] - b[1][0] * open[0]),
            ];
            let size = change[0].abs().max(change[1].abs());
            // Converged to rounding.
            if size < 1e-9 && size >= 0.5 * last {
                return Some((orbit, a));
            }
            last = size;
            orbit = [orbit[0] + change[0], orbit[1] + change[1]];
        }
        None
    }

    /// The bounce that is reached after the given number of bounces from a start near the orbit of
    /// one bounce.
    fn settled(&self, bounces: usize) -> Bounce {
        let [t, vy] = self.orbit(1.0);
        let mut simulation = self.begin([t, vy * 1.01]);
        for _ in 0..bounces {
            simulation.step();
        }
        let t = simulation.time();
        [t.rem_euclid(self.period()), simulation.state().vy]
    }

    /// The Γ at which a multiplier of the orbit of the given number of bounces is −1, by the secant
    /// rule from two guesses: with multipliers −1 and μ the characteristic polynomial at −1, 1 +
    /// trace + determinant, is zero.
    fn threshold(
        &self,
        guesses: [f64; 2],
        mut orbit: Bounce,
        bounces: usize,
        n: f64,
    ) -> Option<f64> {
        let mut at = |gamma: f64| {
            let (found, a) = Table { gamma, ..*self }.closed_orbit(orbit, bounces, n)?;
            orbit = found;
            Some(1.0 + trace(&a) + determinant(&a))
        };
        let [mut last, mut gamma] = guesses;
        let (mut f_last, mut f) = (at(last)?, at(gamma)?);
        for _ in 0..40 {
            let next = gamma - f * (gamma - last) / (f - f_last);
            (last, f_last) = (gamma, f);
            gamma = next;
            if (gamma - last).abs() < 1e-13 {
                return Some(gamma);
            }
            f = at(gamma)?;
        }
        None
    }
}

fn through_event(map: &StepMap, deviation: &Deviation) -> Deviation {
    map.through(&map.meet(&map.along(deviation)))
}

/// The multipliers of the orbit of one bounce each n periods are 1 and e² where it is born,
/// Γ = nπ(1 − e)/(1 + e), and −1 and −e² where it loses stability.
#[test]
fn the_bouncing_ball_has_its_multipliers() {
    for (e, n) in [
        (0.5, 1.0),
        (0.3, 1.0),
        (0.8, 1.0),
        (0.9, 1.0),
        (0.8, 2.0),
        (0.9, 3.0),
        (0.95, 4.0),
    ] {
        let lower = n * PI * (1.0 - e) / (1.0 + e);
        let upper = lower.hypot(2.0 * (1.0 + e * e) / (1.0_f64 + e).powi(2));
        for omega in [1.0, 2.0, 7.3] {
            for share in [0.0, 0.05, 0.3, 0.7, 0.95, 1.0, 1.1] {
                let gamma = lower + share * (upper - lower);
                let table = Table { e, gamma, omega };
                let orbit = table.orbit(n);
                let (end, a) = table.map(orbit, 1);
                let period = n * table.period();
                // At the lower end the phase is the root of a cosine of 1, so that only half of the
                // digits are correct.
                let blunt = if share == 0.0 { 1e-7 } else { 1e-11 };
                assert!(
                    (end[0] - orbit[0] - period).abs() < blunt * period,
                    "{table:?}"
                );
                assert!((end[1] - orbit[1]).abs() < blunt * period);
                let known = table.trace(n);
                assert!(
                    (trace(&a) - known).abs() < 1e-11 + blunt,
                    "{} {known} {table:?}",
                    trace(&a)
                );
                assert!((determinant(&a) - e * e).abs() < 1e-12);
                // The same at one time, as a deviation of height and velocity.
                let mut simulation = table.begin(orbit);
                let step = simulation.step().expect("it goes on");
                let map = Tangent::new(&table.system()).of_step(&simulation, &step);
                let at_one_time = block(&matrix(&map), 1);
                assert!((trace(&at_one_time) - trace(&a)).abs() < 1e-11);
                assert!((determinant(&at_one_time) - e * e).abs() < 1e-12);
                let multipliers = [1.0, -1.0].map(|m| m * m - trace(&a) * m + determinant(&a));
                assert!(
                    share != 0.0 || multipliers[0].abs() < 1e-6,
                    "one is 1 where it is born"
                );
                assert!(
                    share != 1.0 || multipliers[1].abs() < 1e-11,
                    "one is −1 at the upper end"
                );
            }
        }
    }
}

/// The upper end, found as a root, has its known value: Γ² = (nπ(1 − e)/(1 + e))² + (2(1 + e²)/(1 +
/// e)²)².
#[test]
fn the_bouncing_ball_first_doubles_its_period_where_it_must() {
    for (e, n) in [
        (0.5, 1.0),
        (0.2, 1.0),
        (0.65, 1.0),
        (0.8, 2.0),
        (0.9, 1.0),
        (0.9, 4.0),
    ] {
        let lower = n * PI * (1.0 - e) / (1.0 + e);
        let upper = lower.hypot(2.0 * (1.0 + e * e) / (1.0_f64 + e).powi(2));
        let guesses = [0.5, 0.6].map(|share| lower + share * (upper - lower));
        let table = Table {
            e,
            gamma: guesses[0],
            omega: 2.0,
        };
        let [t, vy] = table.orbit(n);
        let found = table
            .threshold(guesses, [t + 1e-3, vy + 1e-3], 1, n)
            .expect("a threshold");
        assert!(
            (found - upper).abs() < 1e-11,
            "e = {e}, n = {n}: {found} {upper}"
        );
    }
}

/// The cascade at e = 0.5: orbits of 2, 4 and 8 bounces lose their stability at values that are
/// known to ten digits and more from the map of bounces in forty digits, computed independently.
/// Here each is found as a root in Γ, every orbit by Newton's method with the derivatives of the
/// linearised motion.
#[test]
fn the_bouncing_ball_goes_on_doubling_its_period() {
    let known = [
        1.667_130_660_769_543,
        1.696_780_745_805_092,
        1.703_180_525_646_008,
    ];
    let lower = PI / 3.0;
    let mut gamma = lower.hypot(10.0 / 9.0);
    assert!((gamma - 1.526_823_701).abs() < 5e-10);
    // Each window is narrower than the one before, in the end by the factor 4.669 of Feigenbaum.
    let mut width = (gamma - lower) / 3.4;
    for (bounces, known) in [2, 4, 8].into_iter().zip(known) {
        let guesses = [0.8, 0.9].map(|share| gamma + share * width);
        let table = Table {
            e: 0.5,
            gamma: guesses[0],
            omega: 2.0,
        };
        let found = table.threshold(guesses, table.settled(4096), bounces, 1.0);
        let found = found.expect("a threshold");
        println!("{bounces} bounces: {found:.14}");
        assert!((found - known).abs() < 1e-12, "{bounces}: {found} {known}");
        (width, gamma) = ((found - gamma) / 4.67, found);
    }
}

/// One bounce of any motion on the table, with s = A sin ωt, V the ball's velocity and Δ the time
/// of flight: s' = s + VΔ − Δ²/2 and V' = (1 + e) ṡ' − e (V − Δ), so (ṡ' − V + Δ) δt' = (ṡ − V + Δ)
/// δt + Δ δV and δV' = (1 + e) s̈' δt' − e δV + e (δt' − δt).
fn by_hand(table: &Table, step: &Step) -> Square {
    let (t, later) = (step.t_start, step.t_end);
    let flight = later - t;
    let v = step.start.vy + table.velocity(t);
    let closing = table.velocity(later) - v + flight;
    let delay = [(table.velocity(t) - v + flight) / closing, flight / closing];
    let a = (1.0 + table.e) * table.acceleration(later) + table.e;
    [delay, [a * delay[0] - table.e, a * delay[1] - table.e]]
}

/// A shorter flight belongs to bounces that accumulate: even chaotic motion reaches sooner or later
/// a phase of the table at which the ball is caught and stays on the table (Luck & Mehta). The
/// motion is followed until then.
const CHATTER: f64 = 1e-6;

/// The exponents of the one vertical degree of freedom sum to 2 ln e/⟨time between impacts⟩,
/// whatever the motion: a bounce contracts phase area by e², and flight preserves it (Müller 1995).
/// Each exponent is known where the motion ends in the orbit of one bounce: from the multipliers
/// above.
#[test]
fn exponents_of_the_bouncing_ball_obey_their_sum_rule() {
    let simple = |e: f64, gamma: f64| (e, gamma, Some(true));
    let doubled = |e: f64, gamma: f64| (e, gamma, Some(false));
    let chaotic = |e: f64, gamma: f64| (e, gamma, None);
    for (e, gamma, periodic) in [
        simple(0.5, 1.3),
        simple(0.8, 0.9),
        simple(0.3, 2.0),
        doubled(0.5, 1.6),
        doubled(0.8, 1.15),
        chaotic(0.5, 1.72),
        chaotic(0.8, 2.0),
        chaotic(0.9, 2.0),
        chaotic(0.9, 3.0),
    ] {
        let table = Table {
            e,
            gamma,
            omega: 2.0,
        };
        let [t, vy] = table.orbit(1.0);
        let mut simulation = table.begin([t, vy * 1.02]);
        let tangent = Tangent::new(&table.system());
        let mut frame = Frame::new();
        let (mut bounces, mut elapsed, mut worst) = (0_u32, 0.0, 0.0_f64);
        while bounces < 2000 {
            let step = simulation.step().expect("it goes on");
            if step.t_end - step.t_start < CHATTER {
                break;
            }
            assert!(step.taut_after.is_empty());
            let map = tangent.of_step(&simulation, &step);
            frame.follow(&map);
            worst = worst.max(worst_entry(&table, &step, &map));
            (bounces, elapsed) = (bounces + 1, step.t_end - t);
        }
        assert!(bounces > 300, "{bounces}");
        // Height and its velocity are decoupled from the rest, so that the two directions of the
        // frame along them stay so.
        let vertical = [frame.logs()[1] / elapsed, frame.logs()[4] / elapsed];
        let sum = vertical[0] + vertical[1];
        let known = 2.0 * e.ln() / (elapsed / f64::from(bounces));
        println!(
            "e = {e}, Γ = {gamma}: {vertical:?}, sum off by {:e}, a bounce by {worst:e}",
            sum - known
        );
        assert!((sum - known).abs() < 1e-13);
        assert!(worst < 1e-10, "{worst:e}");
        assert_eq!(vertical[0] > 0.01, periodic.is_none());
        if periodic == Some(true) {
            let half = 0.5 * table.trace(1.0);
            let largest = if half.abs() > e {
                half.abs() + (half * half - e * e).sqrt()
            } else {
                e
            };
            let known = largest.ln() / table.period();
            assert!((vertical[0] - known).abs() < 2.0 / elapsed, "{known}");
        }
    }
}

/// The largest difference of a bounce's map from the one derived above, relative to the latter's
/// size and to the velocity by which both divide.
fn worst_entry(table: &Table, step: &Step, map: &StepMap) -> f64 {
    // The map by hand takes V, this engine's the velocity relative to the table.
    let later = [
        0.0,
        0.0,
        0.0,
        0.0,
        -table.acceleration(step.t_start),
        0.0,
        1.0,
    ];
    let faster = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    let [later, faster] = [later, faster].map(|deviation| through_event(map, &deviation));
    let absolute = |d: &Deviation| d[4] + table.acceleration(step.t_end) * d[6];
    let found = [[later[6], faster[6]], [absolute(&later), absolute(&faster)]];
    let known = by_hand(table, step);
    let size = known
        .as_flattened()
        .iter()
        .fold(0.0_f64, |m, k| m.max(k.abs()));
    let pairs = found.as_flattened().iter().zip(known.as_flattened());
    let worst = pairs.fold(0.0_f64, |m, (found, known)| m.max((found - known).abs()));
    worst / size * -step.before.vy
}
