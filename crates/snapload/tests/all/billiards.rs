//! Billiards, in which the growth of deviations is known exactly: a mass inside its cables'
//! circles, without weight and without loss. The formulas are derived beside each test.

use crate::common::{IDENTITY, Square, block, determinant, matrix, product, trace, unending};
use snapload::analysis::Frame;
use snapload::{Body, Cable, Forcing, State, System, Tangent};

/// A point mass on cables, each given by its anchor and its length, without forces.
fn billiard(cables: &[([f64; 2], f64)]) -> System {
    System {
        body: Body::point(),
        cables: cables
            .iter()
            .map(|&(anchor, length)| Cable::new(anchor, [0.0, 0.0], length))
            .collect(),
        forcing: Forcing::default(),
        drag: None,
        floating: None,
        restitution: 1.0,
    }
}

fn times(a: &Square, b: &Square) -> Square {
    a.map(|row| [0, 1].map(|j| row[0] * b[0][j] + row[1] * b[1][j]))
}

fn assert_close(found: &Square, known: &Square, allowed: f64) {
    for (found, known) in found.as_flattened().iter().zip(known.as_flattened()) {
        assert!((found - known).abs() < allowed, "{found} {known}");
    }
}

/// A mass that bounces at speed v along the axis between two circular mirrors of radii l0 and l1, a
/// distance d apart. Across the axis a flight of d/v is δy += (d/v) δẏ and a mirror is δẏ −= (2v/l)
/// δy, so the lap has the determinant 1 and the trace 4 g0 g1 − 2, g = 1 − d/l (the resonator of
/// optics). Two equal cables with anchors at ±c have g = 2c/l − 1 = γ: the trace 4γ² − 2 is never
/// beyond ±2. Unequal ones with l0 > D > l1, D the distance of the anchors, have g0 g1 < 0, and the
/// lap is unstable.
#[test]
fn the_lap_between_two_mirrors() {
    let equal = |c: f64, l: f64| ([c, -c], [l, l]);
    let lenses = [
        (equal(0.3, 1.0), 4.0 * 0.16 - 2.0),
        (equal(0.05, 1.0), 4.0 * 0.81 - 2.0),
        (equal(0.5, 1.0), -2.0),
        (equal(0.9, 1.0), 4.0 * 0.64 - 2.0),
        (equal(1.2, 1.5), 4.0 * 0.36 - 2.0),
        (equal(0.2, 2.5), 4.0 * 0.84 * 0.84 - 2.0),
        (
            ([0.5, -0.5], [1.2, 0.7]),
            4.0 * (0.3 / 1.2) * (-0.2 / 0.7) - 2.0,
        ),
        (
            ([1.0, -1.0], [2.9, 1.1]),
            4.0 * (0.9 / 2.9) * (-0.9 / 1.1) - 2.0,
        ),
        (
            ([0.4, -0.3], [0.3, 0.9]),
            4.0 * (-0.2 / 0.3) * (0.4 / 0.9) - 2.0,
        ),
    ];
    for ((anchors, lengths), known_trace) in lenses {
        for speed in [1.0, 0.37] {
            let system = billiard(&[
                ([anchors[0], 0.0], lengths[0]),
                ([anchors[1], 0.0], lengths[1]),
            ]);
            let tangent = Tangent::new(&system);
            let start = State {
                x: anchors[0] - lengths[0],
                vx: speed,
                ..State::default()
            };
            let mut simulation = unending(system, 0.0, start);
            let mut bounce = || {
                let step = simulation.step().expect("it goes on");
                assert_eq!((step.after.y, step.after.vy), (0.0, 0.0), "on the axis");
                assert_eq!(step.impacts().count(), 1);
                (tangent.of_step(&simulation, &step), step.t_end)
            };
            let (away, (back, period)) = (bounce(), bounce());
            let lap = product(&matrix(&back), &matrix(&away.0));

            let flight = (lengths[0] + lengths[1] - (anchors[0] - anchors[1])) / speed;
            assert!((period - 2.0 * flight).abs() < 1e-13 * period);
            let fly = [[1.0, flight], [0.0, 1.0]];
            let mirror = |l: f64| [[1.0, 0.0], [-2.0 * speed / l, 1.0]];
            let pass = |l: f64| times(&mirror(l), &fly);
            let known = times(&pass(lengths[0]), &pass(lengths[1]));
            let across = block(&lap, 1);
            assert_close(&across, &known, 1e-12);
            assert!(
                (trace(&across) - known_trace).abs() < 1e-13,
                "{known_trace}"
            );
            assert!((determinant(&across) - 1.0).abs() < 1e-13);
            // Along the axis a lap is a shear: a faster neighbour gets ahead.
            assert_close(&block(&lap, 0), &[[1.0, period], [0.0, 1.0]], 1e-12);

            // Many laps: the second direction of the frame begins across the axis and stays there.
            // Its growth is a power of the larger multiplier, apart from a term that decays like
            // the inverse square of it.
            let (laps, mut frame) = (60, Frame::new());
            let mut grown = [0.0; 3];
            for grown in &mut grown[1..] {
                for _ in 0..2 * laps {
                    frame.follow(&bounce().0);
                }
                *grown = frame.logs()[1];
            }
            let half = 0.5 * known_trace.abs();
            if half > 1.0 {
                let largest = (half + (half * half - 1.0).sqrt()).ln();
                let rate = (grown[2] - grown[1]) / f64::from(laps);
                assert!((rate - largest).abs() < 1e-12, "{rate} {largest}");
                let exponents = frame.exponents(2.0 * f64::from(laps) * period);
                assert!((exponents[0] - largest / period).abs() < 0.02 / period);
                assert!((exponents[0] + exponents[5]).abs() < 1e-2 * exponents[0]);
            } else {
                // A rotation, or a shear where the trace is exactly −2, grows at most linearly in
                // the number of laps.
                assert!(grown[2].abs() < (2.0 * f64::from(laps) * 10.0 * (1.0 + speed)).ln());
            }
        }
    }
}

/// The components of a motion in the plane without rotation.
const PLANAR: [usize; 4] = [0, 1, 3, 4];

/// Inside a circle the angle α of the chords to the circle is constant. With t v/(2R sin α) chords
/// behind it, a neighbour with another speed and another angle is ahead by t δv/v along its path,
/// turned by 2 δα for each chord, and late by δ(2R sin α/v) for each:
///
/// δz = t ( (δv/v) ż + (v/(2R sin α)) δα (2 z_turned − (2R cos α/v) ż) ) + O(1).
///
/// This is δz/t by the deviation at the start, column by column, turned to the sense of the motion.
fn drift(radius: f64, start: &State, now: &State) -> [[f64; 4]; 4] {
    let (speed, spin) = (
        start.vx.hypot(start.vy),
        start.x * start.vy - start.y * start.vx,
    );
    let cosine = spin.abs() / (radius * speed);
    let sine = (1.0 - cosine * cosine).sqrt();
    let rate = [now.vx, now.vy, 0.0, 0.0];
    let turned = [-now.y, now.x, -now.vy, now.vx].map(|c| c * spin.signum());
    let faster = [0.0, 0.0, start.vx / speed, start.vy / speed];
    let more_spin = [start.vy, -start.vx, -start.y, start.x].map(|c| c * spin.signum());
    let columns = [0, 1, 2, 3];
    // Angular momentum is R v cos α.
    let steeper =
        columns.map(|j| (radius * cosine * faster[j] - more_spin[j]) / (radius * speed * sine));
    columns.map(|j| {
        columns.map(|i| {
            let by_angle = turned[i] - radius * cosine / speed * rate[i];
            faster[j] / speed * rate[i] + steeper[j] * speed / (radius * sine) * by_angle
        })
    })
}

/// Deviations in a circle grow like time and no faster, so the exponents vanish like ln t/t, and
/// the constant beside the logarithm is known, too.
#[test]
fn deviations_in_a_circle_grow_like_time() {
    for (radius, x, y, vx, vy) in [
        (1.0, 0.2, -0.1, 0.8, 0.5),
        (0.7, 0.3, 0.4, -0.2, 1.3),
        (2.5, -1.1, 0.6, 0.05, -0.9),
    ] {
        let start = State {
            x,
            y,
            vx,
            vy,
            ..State::default()
        };
        let system = billiard(&[([0.0, 0.0], radius)]);
        let tangent = Tangent::new(&system);
        let mut simulation = unending(system, 0.0, start);
        let mut frame = Frame::new();
        let mut whole = IDENTITY;
        let (mut chord, mut v_n) = (None, None);
        for bounce in 1..=4096_u32 {
            let step = simulation.step().expect("it goes on");
            let impact = step.impacts().next().expect("an impact");
            let angle = impact.v_n / *v_n.get_or_insert(impact.v_n);
            assert!((angle - 1.0).abs() < 1e-12, "the angle is constant");
            if bounce > 1 {
                let length = step.t_end - step.t_start;
                assert!((length / *chord.get_or_insert(length) - 1.0).abs() < 1e-9);
            }
            let map = tangent.of_step(&simulation, &step);
            frame.follow(&map);
            whole = product(&matrix(&map), &whole);
            if bounce < 64 || !bounce.is_power_of_two() {
                continue;
            }

            let t = step.t_end;
            let known = drift(radius, &start, &step.after);
            for (column, known) in PLANAR.into_iter().zip(known) {
                for (row, known) in PLANAR.into_iter().zip(known) {
                    let found = whole[row][column] / t;
                    assert!((found - known).abs() < 20.0 / t, "{found} {known} at {t}");
                }
            }
            // The frame's first direction is the first column, so its growth is known with its
            // constant.
            let length = known[0].iter().map(|g| g * g).sum::<f64>().sqrt();
            let excess = frame.logs()[0] - t.ln() - length.ln();
            assert!(excess.abs() < 20.0 / t, "{excess:e} at {t}");
            // Of every exponent: |λ| ≤ (ln t + C)/t with one C for all times.
            for exponent in frame.exponents(t) {
                assert!(exponent.abs() < (t.ln() + 3.0) / t, "{exponent} at {t}");
            }
            let sum: f64 = frame.logs().iter().sum();
            assert!(sum.abs() < 1e-9, "phase volume: {sum:e}");
        }
    }
}
