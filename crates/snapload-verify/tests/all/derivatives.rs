//! Derivatives of the first impacts, by the two methods of the library, against difference
//! quotients of runs with many digits, which use neither method.

use snapload::analysis::{START_KEYS, UNCERTAIN_KEYS};
use snapload::{
    Body, Cable, Case, Deviation, Dual, Forcing, Impact, Normal, Parameters, Precise,
    PrescribedTaut, Real, Rules, Shape, Simulation, State, Step, Steps, System, Tangent, Value,
};

type Digits = Precise<4>;

/// The keys of the start, and then those of the system.
const KEYS: usize = START_KEYS.len() + UNCERTAIN_KEYS.len();

fn keys() -> impl Iterator<Item = &'static str> {
    START_KEYS.into_iter().chain(UNCERTAIN_KEYS)
}

/// The quantities of an impact: the state before it, its time, its normal velocity, the state after
/// it.
const QUANTITIES: usize = 14;

fn quantities<T: Real>(impact: &Impact<T>) -> [T; QUANTITIES] {
    let mut all = [T::ZERO; QUANTITIES];
    all[..6].copy_from_slice(&impact.before.components());
    (all[6], all[7]) = (impact.t, impact.v_n);
    all[8..].copy_from_slice(&impact.after.components());
    all
}

/// Differences of runs ± 1e-20 apart. Of seventy-six digits more than fifty are left, and the error
/// of the formula is 1e-40 of the third derivatives.
fn differences(run: impl Fn(Digits) -> Vec<Impact<Digits>>) -> Vec<[f64; QUANTITIES]> {
    let step = Digits::from_decimal(1e-20);
    let (ahead, behind) = (run(step), run(-step));
    let quotient = |ahead: &Impact<Digits>, behind: &Impact<Digits>| {
        let mut quotient = quantities(ahead);
        for (difference, behind) in quotient.iter_mut().zip(quantities(behind)) {
            *difference -= behind;
        }
        quotient.map(|difference| (difference / (step * 2.0)).to_f64())
    };
    ahead
        .iter()
        .zip(&behind)
        .map(|(a, b)| quotient(a, b))
        .collect()
}

fn first_impacts<T: Steps>(mut simulation: Simulation<T>, count: usize) -> Vec<Impact<T>> {
    let mut impacts = Vec::new();
    while impacts.len() < count {
        impacts.extend(simulation.step().expect("it goes on").impacts());
    }
    impacts
}

/// The same by the linearised motion: columns of the start, at the impacts, for all quantities
/// except the normal velocity.
fn by_the_linearised_motion(
    mut simulation: Simulation,
    count: usize,
) -> Vec<[[f64; QUANTITIES]; 6]> {
    let tangent = Tangent::new(simulation.system());
    let start = tangent.of_start(&simulation);
    let mut columns = [0, 1, 2, 3, 4, 5].map(|j| -> Deviation {
        let w = start.map(|row| row[j]);
        [w[0], w[1], w[2], w[3], w[4], w[5], 0.0]
    });
    let mut all = Vec::new();
    while all.len() < count {
        let step = simulation.step().expect("it goes on");
        let map = tangent.of_step(&simulation, &step);
        let quantities = columns.each_mut().map(|column| {
            let met = map.meet(&map.along(column));
            *column = map.through(&met);
            let mut quantities = [0.0; QUANTITIES];
            quantities[..7].copy_from_slice(&met);
            quantities[8..].copy_from_slice(&column[..6]);
            quantities
        });
        if map.has_impact() {
            all.push(quantities);
        }
    }
    all
}

/// The largest difference, relative to the largest derivative by the same key.
fn worst(found: &[f64], known: &[f64]) -> f64 {
    let size = known.iter().fold(0.0_f64, |m, k| m.max(k.abs()));
    let off = found
        .iter()
        .zip(known)
        .fold(0.0_f64, |m, (f, k)| m.max((f - k).abs()));
    if off > 0.0 { off / size } else { 0.0 }
}

/// By all values of the start and all parameters, for circles, squares, rectangles and a point
/// mass. The given inertia does not follow from a size, so that it is a parameter of its own.
#[test]
fn derivatives_of_the_first_impacts_agree() {
    let standard = Parameters {
        inertia: Some(0.012),
        ..Parameters::STANDARD
    };
    let cases = [
        Parameters {
            theta: 0.1,
            vx: 0.05,
            ..standard
        },
        // As in the standard case, x, θ and their velocities are zero at first.
        Parameters {
            f_o: 0.5,
            omega: 2.0,
            ..standard
        },
        Parameters {
            a: 0.2,
            b: 0.2,
            inertia: Some(0.03),
            e: 0.6,
            x: 0.05,
            theta: -0.1,
            ..standard
        },
        // Its inertia follows from its size.
        Parameters {
            a: 0.1,
            b: 0.1,
            inertia: Some((0.1 * 0.1 + 0.1 * 0.1) / 3.0),
            y: 0.15,
            vtheta: 0.7,
            ..standard
        },
        Parameters {
            a: 0.3,
            b: 0.1,
            r: 1.8,
            e: 0.99,
            nu: -0.8,
            f_o: 0.2,
            omega: 1.3,
            y: 0.2,
            vy: 0.1,
            ..standard
        },
        Parameters {
            a: 0.0,
            inertia: None,
            e: 0.4,
            vx: -0.3,
            ..standard
        },
    ];
    for parameters in cases {
        let case = Case::new(parameters).expect("legal");
        let count = 5;
        let dual = case.simulation_over(|key, number| {
            let place = keys().position(|name| name == key);
            place.map_or(Dual::constant(number), |k| {
                Dual::<f64, KEYS>::variable(number, k)
            })
        });
        let dual = first_impacts(dual.expect("a legal start"), count);
        let linearised = by_the_linearised_motion(case.simulation(), count);
        let (mut of_dual, mut of_linearised) = (0.0_f64, 0.0_f64);
        for (k, name) in keys().enumerate() {
            if !parameters.moves_by(name) {
                continue;
            }
            let known = differences(|offset| {
                let simulation = case.simulation_over(|key, number| {
                    let number = Digits::from_f64(number);
                    if key == name { number + offset } else { number }
                });
                first_impacts(simulation.expect("a legal start"), count)
            });
            for (i, known) in known.iter().enumerate() {
                let found = quantities(&dual[i]).map(|q| q.slope[k]);
                of_dual = of_dual.max(worst(&found, known));
                if k < START_KEYS.len() {
                    let mut found = linearised[i][k];
                    // The linearised motion carries no normal velocity.
                    found[7] = known[7];
                    of_linearised = of_linearised.max(worst(&found, known));
                }
            }
        }
        println!("dual numbers {of_dual:e}, linearised {of_linearised:e}");
        assert!(of_dual < 1e-12, "{of_dual:e}: {parameters:?}");
        assert!(of_linearised < 1e-12, "{of_linearised:e}: {parameters:?}");
    }
}

/// A body on one cable that rises to the end of it and, but for `depth`, no further: with `depth` =
/// 0 it would touch the circle with no normal velocity a time 1/2 after its start and fall back.
fn towards_a_graze(depth: f64) -> (System, State) {
    let (length, arms, inertia, weight) = (1.0, [0.3, 0.1], 0.1, 1.0);
    let system = System {
        body: Body::rigid(Shape::Point, inertia),
        cables: vec![Cable::new([0.0, 0.0], arms, length)],
        forcing: Forcing {
            constant: [0.0, -weight].into(),
            harmonics: vec![],
        },
        drag: None,
        floating: None,
        restitution: 0.8,
    };
    let (angle, theta, along, spin, before): (f64, f64, f64, f64, f64) = (1.2, 0.4, 0.4, 0.7, 0.5);
    let n = [angle.cos(), angle.sin()];
    let (sine, cosine) = theta.sin_cos();
    let lever = system.cables[0].lever(sine, cosine).components();
    let centre = [0, 1].map(|i| n[i] * (length + depth) - lever[i]);
    // Ṗ = (ẋ, ẏ) + θ̇ (−ρ_y, ρ_x) is along the circle.
    let velocity = [
        -along * n[1] + spin * lever[1],
        along * n[0] - spin * lever[0],
    ];
    let start = State {
        x: centre[0] - velocity[0] * before,
        y: centre[1] - velocity[1] * before - 0.5 * weight * before * before,
        theta: theta - spin * before,
        vx: velocity[0],
        vy: velocity[1] + weight * before,
        vtheta: spin,
    };
    (system, start)
}

fn first_impact<T: Steps>(
    system: &System,
    start: State<T>,
    number: impl Fn(f64) -> T + Copy,
) -> Impact<T> {
    let rules = Rules::until(number(1.0));
    let simulation = Simulation::new(system.map(number), rules, T::ZERO, start);
    first_impacts(simulation.expect("a legal start"), 1)[0]
}

/// Towards a graze, v_n → 0 with the normal acceleration α < 0, derivatives grow like 1/v_n. With
/// G = (n, s) and ∂q⁻/∂z_j the flight's,
///
/// ```text
/// v_n ∂t/∂z_j   = −G ∂q⁻/∂z_j
/// v_n ∂v_n/∂z_j → |α| G ∂q⁻/∂z_j
/// v_n ∂q̇⁺/∂z_j  → −(f + (1 + e) |α| M⁻¹Gᵀ/w) G ∂q⁻/∂z_j
/// ```
///
/// the first by the implicit function theorem; v_n falls along the flight at |α|, and the rest of
/// the derivatives stays bounded.
#[test]
fn derivatives_grow_towards_a_graze() {
    for k in 0..6 {
        let (system, start) = towards_a_graze(1e-2 / 16_f64.powi(k));
        let lifted = |j: usize, offset: Digits| {
            let mut start = start.components().map(Digits::from_f64);
            start[j] += offset;
            vec![first_impact(
                &system,
                State::from_components(start),
                Digits::from_f64,
            )]
        };
        let known = [0, 1, 2, 3, 4, 5].map(|j| differences(|offset| lifted(j, offset))[0]);
        let mut j = 0;
        let dual = start.components().map(|component| {
            j += 1;
            Dual::<f64, 6>::variable(component, j - 1)
        });
        let dual = first_impact(&system, State::from_components(dual), Dual::constant);
        let rules = Rules::until(1.0);
        let simulation = Simulation::new(system.clone(), rules, 0.0, start);
        let linearised = by_the_linearised_motion(simulation.expect("a legal start"), 1);

        let exact = lifted(0, Digits::ZERO)[0];
        let before = State::from_components(exact.before.components().map(Digits::to_f64));
        let (v_n, t) = (exact.v_n.to_f64(), exact.t.to_f64());
        let Normal { n, arm } = system.cables[0].normal(&before);
        let free = system.free_acceleration(&system.surroundings(t), &before, [0.0; 3]);
        let alpha = -system.free_normal_acceleration(0, &before, free);
        assert!(alpha > 0.5 && v_n < 0.2, "it slows down where it snaps");
        let inverse_inertia = system.body.inverse_inertia();
        let w = 1.0 + arm * arm * inverse_inertia;
        let g = [n.x, n.y, arm];
        let recoil = (1.0 + system.restitution) * alpha / w;
        let kick = [
            free[0] + recoil * n.x,
            free[1] + recoil * n.y,
            recoil * arm * inverse_inertia,
        ];
        // In ordinary numbers v_n is the root of a depth that is known to some roundings.
        let allowed = 1e-14 + 8.0 * f64::EPSILON / (v_n * v_n);
        for (j, known) in known.iter().enumerate() {
            let found = quantities(&dual).map(|q| q.slope[j]);
            let off = worst(&found, known);
            assert!(off < allowed, "dual numbers: {off:e} at v_n = {v_n:e}");
            let mut found = linearised[0][j];
            found[7] = known[7];
            let off = worst(&found, known);
            assert!(off < allowed, "linearised: {off:e} at v_n = {v_n:e}");

            // Velocities at the start have moved the body for the time of the flight.
            let moved = g[j % 3] * if j < 3 { 1.0 } else { t };
            assert!((v_n * known[6] + moved).abs() < 1e-13, "{}", known[6]);
            assert!((v_n * known[7] - alpha * moved).abs() < 3.0 * v_n);
            for (known, kick) in known[11..].iter().zip(kick) {
                let off = v_n * known + kick * moved;
                assert!(off.abs() < 3.0 * v_n, "{off:e} at v_n = {v_n:e}");
            }
        }
    }
}

fn case(entries: &[(&str, f64)], settles: bool) -> Case {
    let numbers = entries
        .iter()
        .map(|(key, value)| (*key, Value::Number(*value)));
    let stop = ("stop_when_settled", Value::Bool(settles));
    Parameters::from_entries(numbers.chain([stop]))
        .and_then(Case::new)
        .expect("a legal case")
}

/// ż after a step, of a body of unit mass: its taut cables pull it by T n and turn it by T s/I.
fn rates(prescribed: &PrescribedTaut, step: &Step) -> [f64; 6] {
    let (system, state) = (prescribed.system(), &step.after);
    let around = system.surroundings(step.t_end);
    let mut acceleration = system.free_acceleration(&around, state, [0.0; 3]);
    let tensions = prescribed.tensions(step.taut_after, step.t_end, state);
    for cable in step.taut_after.iter() {
        let Normal { n, arm } = system.cables[cable].normal(state);
        acceleration[0] -= tensions[cable] * n.x;
        acceleration[1] -= tensions[cable] * n.y;
        acceleration[2] -= tensions[cable] * arm * system.body.inverse_inertia();
    }
    let [x, y, theta] = acceleration;
    [state.vx, state.vy, state.vtheta, x, y, theta]
}

/// The whole motion over dual numbers, in which no saltation matrix is written down, against the
/// linearised one, at the end of each step; relative to the largest deviation there.
fn worst_difference(case: &Case) -> (f64, usize, usize) {
    let mut simulation = case.simulation();
    let keys = ["x", "y", "theta", "vx", "vy", "vtheta"];
    let dual = case.simulation_over(|key, number| {
        let place = keys.iter().position(|k| *k == key);
        place.map_or(Dual::constant(number), |i| {
            Dual::<f64, 6>::variable(number, i)
        })
    });
    let mut dual = dual.expect("a legal start");
    let tangent = Tangent::new(simulation.system());
    let prescribed = PrescribedTaut::new(simulation.system().clone());
    let start = tangent.of_start(&simulation);
    let mut columns: Vec<[f64; 6]> = (0..6).map(|j| start.map(|row| row[j])).collect();
    let (mut worst, mut steps, mut taut) = (0.0_f64, 0, 0);
    while let (Some(step), Some(over)) = (simulation.step(), dual.step()) {
        let map = tangent.of_step(&simulation, &step);
        for column in &mut columns {
            *column = map.fundamental(column);
        }
        let rates = rates(&prescribed, &step);
        let largest = columns
            .iter()
            .flatten()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        for (i, w) in over.after.components().iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                let there = w.slope[j] - rates[i] * over.t_end.slope[j];
                worst = worst.max((there - column[i]).abs() / largest);
            }
        }
        steps += 1;
        taut += usize::from(!step.taut.is_empty());
        if largest > 1e10 {
            break;
        }
    }
    (worst, steps, taut)
}

#[test]
fn agrees_with_the_motion_over_dual_numbers() {
    let cases = [
        (case(&[], true), 1e-8),
        (case(&[("a", 0.2), ("b", 0.2), ("e", 0.6)], true), 1e-9),
        (case(&[("f_o", 0.27), ("t_end", 12.0)], false), 1e-4),
        (
            case(&[("f_o", 0.1), ("t_end", 12.0), ("e", 0.5)], false),
            1e-4,
        ),
        // Both cables stick in turn, down to v_n = 1e-12, where n·δP/v_n keeps four digits.
        (case(&[("b", 0.1), ("e", 0.0), ("t_end", 9.0)], false), 1e-3),
    ];
    for (case, allowed) in cases {
        let (worst, steps, taut) = worst_difference(&case);
        println!("{steps} steps, {taut} of them taut: {worst:e}");
        assert!(worst < allowed, "{worst:e}");
        assert!(steps > 20 && (taut > 0) == (allowed > 1e-8));
    }
}
