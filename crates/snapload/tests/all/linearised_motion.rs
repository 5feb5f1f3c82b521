//! The effect of flight and impacts on small deviations, and on volumes and areas of phase space,
//! for random systems.

use crate::common::{Breakwater, IDENTITY, STANDARD, matrix, product, unending};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::analysis::Frame;
use snapload::{
    Body, Cable, Forcing, Harmonic, Matrix, Rules, Shape, Simulation, State, Step, System, Tangent,
    Vector2,
};

/// A rigid body within the reach of one cable or two, and its start.
fn systems(restitution: BoxedStrategy<f64>) -> impl Strategy<Value = (System, State)> {
    let anchor = (-1.5..1.5, 0.2..2.0, 0.05..0.8);
    let fairlead = (-0.4..0.4, -0.4..0.4);
    let cable = (anchor, fairlead);
    let cables = (cable.clone(), prop::option::of(cable));
    let wave = (0.2..4.0, -0.8..0.8, -0.8..0.8, -0.8..0.8, -0.8..0.8);
    let forces = (-1.0..1.0, -1.5..0.5, prop::option::of(wave));
    let velocity = (-1.0..1.0, -1.0..1.0, -2.0..2.0);
    (cables, forces, velocity, -1.0..1.0, 0.02..1.0, restitution).prop_map(
        move |((first, second), (fx, fy, wave), (vx, vy, vtheta), theta, inertia, e)| {
            let state = State {
                theta,
                vx,
                vy,
                vtheta,
                ..State::default()
            };
            let cable = |((x, y, slack), (a, b)): ((f64, f64, f64), (f64, f64))| {
                let shortest = Cable::new([x, y], [a, b], 1.0).span(&state);
                Cable::new([x, y], [a, b], shortest.x.hypot(shortest.y) + slack)
            };
            let harmonic = |(omega, cx, cy, sx, sy): (f64, f64, f64, f64, f64)| Harmonic {
                omega,
                cosine: [cx, cy].into(),
                sine: [sx, sy].into(),
            };
            let system = System {
                body: Body::rigid(Shape::Point, inertia),
                cables: std::iter::once(first).chain(second).map(cable).collect(),
                forcing: Forcing {
                    constant: [fx, fy].into(),
                    harmonics: wave.into_iter().map(harmonic).collect(),
                },
                drag: None,
                floating: None,
                restitution: e,
            };
            (system, state)
        },
    )
}

fn any_restitution() -> BoxedStrategy<f64> {
    prop_oneof![Just(1.0), Just(0.9), 0.1..1.0].boxed()
}

/// Follows a motion as long as it is slack and has its impacts one at a time.
fn follow(
    system: &System,
    state: State,
    most: usize,
    mut on_step: impl FnMut(&Simulation, &Step, &Matrix),
) {
    let tangent = Tangent::new(system);
    let rules = Rules::until(40.0);
    let mut simulation = Simulation::new(system.clone(), rules, 0.0, state).expect("a legal start");
    for _ in 0..most {
        let Some(step) = simulation.step() else { break };
        if !step.taut_after.is_empty() || step.impacts().count() > 1 {
            break;
        }
        let map = matrix(&tangent.of_step(&simulation, &step));
        on_step(&simulation, &step, &map);
    }
}

/// Gaussian elimination with pivoting.
fn determinant(mut a: Matrix) -> f64 {
    let mut determinant = 1.0;
    for k in 0..6 {
        let pivot = (k..6).fold(k, |p, i| if a[i][k].abs() > a[p][k].abs() { i } else { p });
        if pivot != k {
            a.swap(k, pivot);
            determinant = -determinant;
        }
        determinant *= a[k][k];
        let row = a[k];
        for below in &mut a[k + 1..] {
            let factor = below[k] / row[k];
            for (entry, above) in below.iter_mut().zip(row) {
                *entry -= factor * above;
            }
        }
    }
    determinant
}

fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length(row: &[f64; 6]) -> f64 {
    dot(row, row).sqrt()
}

/// The matrix with components scaled by the square roots of their masses, for which the mass matrix
/// is the identity.
fn weighted(a: &Matrix, inertia: f64) -> Matrix {
    let weights = [1.0, 1.0, inertia.sqrt(), 1.0, 1.0, inertia.sqrt()];
    let mut scaled = *a;
    for (row, by) in scaled.iter_mut().zip(weights) {
        for (entry, over) in row.iter_mut().zip(weights) {
            *entry *= by / over;
        }
    }
    scaled
}

/// Sᵀ J S, J of positions and their momenta where masses are 1.
fn symplectic_form(s: &Matrix) -> Matrix {
    let mut form = [[0.0; 6]; 6];
    for (i, row) in form.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = (0..3)
                .map(|k| s[k][i] * s[k + 3][j] - s[k + 3][i] * s[k][j])
                .sum();
        }
    }
    form
}

/// The number of roundings allowed, relative to the size of the terms that a formula adds up: about
/// as many as it has operations.
const ROUNDINGS: f64 = 32.0;

/// S of an impact of one cable by the formula of the literature (Aizerman & Gantmakher 1958; Müller
/// 1995),
///
/// S = D_xR + (f⁺ − D_xR f⁻ − D_tR) D_xg/(D_t g + D_x g f⁻),
///
/// with neither R nor g dependent on time, and with all derivatives worked out by hand. The normal
/// is taken as d/|d| of the span d, whatever its length, where the engine divides by r: both are
/// the law where g = 0, and S must not depend on how it is continued.
fn saltation(system: &System, cable: &Cable, step: &Step) -> Matrix {
    let (q, e, inverse_inertia) = (
        &step.before,
        system.restitution,
        system.body.inverse_inertia(),
    );
    let (sine, cosine) = q.theta.sin_cos();
    let [[a, b], anchor] = [cable.fairlead(), cable.anchor()].map(Vector2::components);
    let lever = [a * cosine - b * sine, a * sine + b * cosine];
    let span = [q.x + lever[0] - anchor[0], q.y + lever[1] - anchor[1]];
    let r = span[0].hypot(span[1]);
    let n = [span[0] / r, span[1] / r];
    let arm = lever[0] * n[1] - lever[1] * n[0];
    let g = [n[0], n[1], arm];
    let mass = [1.0, 1.0, inverse_inertia];
    let velocity = [q.vx, q.vy, q.vtheta];
    let v_n: f64 = (0..3).map(|i| g[i] * velocity[i]).sum();
    let w: f64 = 1.0 + arm * arm * inverse_inertia;

    // By x, y, θ: the span, the lever, and with them the normal, its arm, v_n and w.
    let d_span = [[1.0, 0.0], [0.0, 1.0], [-lever[1], lever[0]]];
    let d_lever = [[0.0, 0.0], [0.0, 0.0], [-lever[1], lever[0]]];
    let (mut d_g, mut d_v_n, mut d_w) = ([[0.0; 3]; 3], [0.0; 3], [0.0; 3]);
    for k in 0..3 {
        let (d, rho) = (d_span[k], d_lever[k]);
        let stretch = d[0] * n[0] + d[1] * n[1];
        let d_n = [0, 1].map(|i| (d[i] - stretch * n[i]) / r);
        let d_arm = rho[0] * n[1] - rho[1] * n[0] + lever[0] * d_n[1] - lever[1] * d_n[0];
        d_g[k] = [d_n[0], d_n[1], d_arm];
        d_v_n[k] = (0..3).map(|i| d_g[k][i] * velocity[i]).sum();
        d_w[k] = 2.0 * arm * d_arm * inverse_inertia;
    }
    // R: q̇⁺ = q̇ − (1 + e) (v_n/w) M⁻¹ g.
    let mut d_r = IDENTITY;
    for i in 0..3 {
        for k in 0..3 {
            let by_place = (d_v_n[k] * g[i] + v_n * d_g[k][i]) / w - v_n * g[i] * d_w[k] / (w * w);
            d_r[i + 3][k] = -(1.0 + e) * mass[i] * by_place;
            d_r[i + 3][k + 3] -= (1.0 + e) * mass[i] * g[i] * g[k] / w;
        }
    }
    let force = system.forcing.at(step.t_end);
    let rate = |s: &State| [s.vx, s.vy, s.vtheta, force.x, force.y, 0.0];
    let (before, after) = (rate(&step.before), rate(&step.after));
    let mut s = d_r;
    for i in 0..6 {
        let jump = after[i] - dot(&d_r[i], &before);
        for k in 0..3 {
            s[i][k] += jump * g[k] / v_n;
        }
    }
    s
}

proptest! {
    // A fixed seed: the same cases on every machine.
    #![proptest_config(ProptestConfig {
        cases: 1000,
        max_shrink_iters: 300,
        rng_seed: RngSeed::Fixed(1995),
        ..ProptestConfig::default()
    })]

    /// The determinant of the motion at one time is 1 in flight, and e² in an impact of one cable,
    /// forced or not: with v⁺ = P v⁻, P = 1 − (1 + e) M⁻¹ g gᵀ/w, a neighbour at δq has its impact
    /// later by −gᵀδq/v_n and has the velocity q̇⁻ instead of q̇⁺ = q̇⁻ − (1 + e) (v_n/w) M⁻¹ g
    /// meanwhile, so that δq⁺ = P δq⁻: the same P as in ∂v⁺/∂v⁻ = P. Positions do not depend on
    /// velocities, so that det S = (det P)², where det P = 1 − (1 + e) = −e as gᵀM⁻¹g = w. The
    /// forces are only in the block that does not enter the determinant. So the exponents of any
    /// run sum to 2 ln e/⟨time between impacts⟩.
    #[test]
    fn an_impact_contracts_phase_volume_by_e_squared((system, state) in systems(any_restitution())) {
        let e = system.restitution;
        let (tangent, mut frame) = (Tangent::new(&system), Frame::new());
        let (mut impacts, mut rounding) = (0.0, 0.0);
        let mut worst = 0.0_f64;
        follow(&system, state, 60, |simulation, step, map| {
            let struck = step.impacts().count() == 1;
            let map = weighted(map, system.body.inertia());
            // The terms of a determinant are bounded by the product of the lengths of its rows.
            let bound: f64 = map.iter().map(length).product();
            let known = if struck { e * e } else { 1.0 };
            worst = worst.max((determinant(map) - known).abs() / bound);
            frame.follow(&tangent.of_step(simulation, step));
            impacts += if struck { 1.0 } else { 0.0 };
            rounding += ROUNDINGS * f64::EPSILON * bound / known;
        });
        prop_assert!(worst < ROUNDINGS * f64::EPSILON, "{:e}", worst);
        let sum: f64 = frame.logs().iter().sum();
        prop_assert!((sum - 2.0 * impacts * e.ln()).abs() <= rounding, "{} impacts: {}", impacts, sum);
    }

    /// Flight and impacts without loss keep SᵀJS = J, also with forces that depend on time. So the
    /// eigenvalues of S come in pairs whose product is 1.
    #[test]
    fn motion_without_loss_is_symplectic((system, state) in systems(Just(1.0).boxed())) {
        let form = symplectic_form(&IDENTITY);
        let mut worst = 0.0_f64;
        follow(&system, state, 60, |_, _, map| {
            let map = weighted(map, system.body.inertia());
            let size: f64 = map.iter().map(|row| dot(row, row)).sum();
            let found = symplectic_form(&map);
            for (found, known) in found.as_flattened().iter().zip(form.as_flattened()) {
                worst = worst.max((found - known).abs() / size);
            }
        });
        prop_assert!(worst < ROUNDINGS * f64::EPSILON, "{:e}", worst);
    }

    /// One step of the linearised motion is flight and then the matrix of the literature.
    #[test]
    fn an_impact_is_its_saltation_matrix((system, state) in systems(any_restitution())) {
        let mut most = 0.0_f64;
        follow(&system, state, 60, |_, step, map| {
            let Some(impact) = step.impacts().next() else { return };
            let mut fly = IDENTITY;
            for i in 0..3 {
                fly[i][i + 3] = step.t_end - step.t_start;
            }
            let known = product(&saltation(&system, &system.cables[impact.cable], step), &fly);
            let size: f64 = known.iter().map(|row| dot(row, row)).sum::<f64>().sqrt();
            let worst = known.as_flattened().iter().zip(map.as_flattened())
                .fold(0.0_f64, |m, (known, found)| m.max((known - found).abs()));
            // Both divide by v_n, which is known to a rounding of the speeds that cancel in it.
            let speed = step.before.vx.hypot(step.before.vy) + step.before.vtheta.abs();
            let allowed = ROUNDINGS * f64::EPSILON * (1.0 + speed / impact.v_n);
            most = most.max(worst / size / allowed);
        });
        prop_assert!(most < 1.0, "{} times what rounding explains", most);
    }
}

/// Without forcing and without loss the breakwater is a chaotic billiard under gravity. From
/// whatever directions its exponents are computed, they cancel in pairs up to terms that vanish
/// like 1/t.
#[test]
fn exponents_come_in_pairs() {
    for (a, b, x, theta) in [
        (0.1, 0.0, 0.05, 0.2),
        (0.3, 0.0, 0.1, -0.1),
        (0.2, 0.2, -0.15, 0.1),
    ] {
        let it = Breakwater {
            a,
            b,
            e: 1.0,
            f_o: 0.0,
            ..STANDARD
        };
        let system = it.system();
        let state = State {
            x,
            y: 0.4,
            theta,
            ..State::default()
        };
        let tangent = Tangent::new(&system);
        let mut simulation = unending(system, 0.0, state);
        let mut frame = Frame::new();
        for bounce in 1..=4096_u32 {
            let step = simulation.step().expect("it goes on");
            assert_eq!(step.impacts().count(), 1);
            frame.follow(&tangent.of_step(&simulation, &step));
            if bounce < 256 || !bounce.is_power_of_two() {
                continue;
            }
            let exponents = frame.exponents(step.t_end);
            let t = step.t_end;
            for i in 0..3 {
                let sum = exponents[i] + exponents[5 - i];
                assert!(sum.abs() < 6.0 / t, "{exponents:?} at {t}");
            }
            assert!(exponents[0] > 0.4 && exponents[1] > 0.1, "chaotic");
            // Energy is conserved, so one pair vanishes as in a motion without chaos.
            assert!(exponents[2] < (t.ln() + 3.0) / t);
        }
    }
}
