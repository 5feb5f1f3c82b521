//! The limits that end a run where they are reached: each against a closed form, and all of them in
//! random motions. The test of random motions covers a new limit without a change.

use crate::agrees_with_closed_forms::string;
use crate::floating_random::Random;
use snapload::analysis::TrustMonitor;
use snapload::{
    Body, Cable, Forcing, Harmonic, Limit, LimitBounds, Rules, Shape, Simulation, State, Stop,
    System, Trajectory, natural_inertia,
};
use std::f64::consts::FRAC_PI_2;

fn record(system: &System, rules: Rules, start: State) -> Trajectory {
    let simulation = Simulation::new(system.clone(), rules, 0.0, start);
    Trajectory::record(simulation.expect("a legal start"))
}

/// A mass released below its anchor falls by g until the string is taut, even if it first moves
/// towards a limit so slowly that it would take years to reach it at that speed: from half of the
/// length down in sqrt(L/g).
#[test]
fn a_limit_that_is_hardly_approached_hides_nothing() {
    let start = State {
        y: -0.5,
        ..State::default()
    };
    let (length, g) = (1.0, 2.0);
    for (rise, turn) in [(0.0, 0.0), (1e-17, 0.0), (1e-15, 0.0), (0.0, 1e-17)] {
        let rules = Rules {
            limits: LimitBounds::none()
                .with(Limit::UpperBound, -0.5 + 2e-16)
                .with(Limit::Rotation, 1.0),
            ..Rules::until(0.75)
        };
        let start = State {
            theta: 1.0 - 2e-16,
            vy: rise,
            vtheta: turn,
            ..start
        };
        let system = string(length, g, 0.5);
        let simulation = Simulation::new(system, rules, 0.0, start).expect("a legal start");
        let run = Trajectory::record(simulation);
        let snap = run.impacts().first().expect("it falls onto the string");
        assert!(
            (snap.t - (length / g).sqrt()).abs() < 1e-12,
            "{rise:e} {turn:e}"
        );
    }
}

/// Free flight without weight or forcing turns at constant rate: the rotation limit is met exactly.
#[test]
fn the_rotation_limit_of_a_free_spin() {
    let mut system = string(5.0, 0.0, 0.5);
    system.body = Body::rigid(Shape::Circle { radius: 0.1 }, 0.01);
    let rules = Rules {
        limits: LimitBounds::none().with(Limit::Rotation, FRAC_PI_2),
        v_stick: 1e-6,
        ..Rules::until(100.0)
    };
    for spin in [0.3, -2.0, 40.0] {
        let start = State {
            vtheta: spin,
            ..State::default()
        };
        let run = record(&system, rules, start);
        assert_eq!(run.end().reason, Stop::RotationLimit);
        assert!((run.end().t - FRAC_PI_2 / spin.abs()).abs() < 1e-14 / spin.abs());
    }
}

/// A rectangle thrown up against the weight g, tilted and without spin: its highest corner rises by
/// h in (v - sqrt(v² - 2 g h))/g.
#[test]
fn the_upper_bound_of_a_throw() {
    let (g, v, [a, b]) = (2.0, 3.0, [0.4_f64, 0.1]);
    let mut system = string(9.0, g, 0.5);
    let inertia = natural_inertia(a, b).expect("it has a size");
    system.body = Body::rigid(Shape::of_half_sizes(a, b), inertia);
    for (theta, h) in [(0.0_f64, 2.0), (0.3, 1.0), (-1.2, 2.249)] {
        let top = a * theta.sin().abs() + b * theta.cos();
        let rules = Rules {
            limits: LimitBounds::none().with(Limit::UpperBound, top + h),
            ..Rules::until(3.0)
        };
        let start = State {
            theta,
            vy: v,
            ..State::default()
        };
        let run = record(&system, rules, start);
        assert_eq!(run.end().reason, Stop::UpperBound);
        let root = f64::sqrt(v * v - 2.0 * g * h);
        let t = (v - root) / g;
        assert!((run.end().t - t).abs() < 1e-15 * (1.0 + 2.0 / root), "{t}");
    }
}

/// A rectangle with a mass matrix, or one that a floating body has, is followed by series. Thrown
/// upwards with much spin and with its cables at its centre, where they show nothing of the
/// rotation, it reaches the upper bound where its highest corner does in closed form.
#[test]
fn the_upper_bound_of_a_throw_with_spin() {
    let (g, v, [a, b]) = (2.0, 3.0, [0.4_f64, 0.1]);
    let mut system = string(9.0, g, 0.5);
    let masses = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.06]];
    let shape = Shape::of_half_sizes(a, b);
    system.body = Body::with_mass_matrix(shape, masses).expect("positive definite");
    for (spin, bound) in [(3.0, 2.0), (-40.0, 1.9), (300.0, 2.3), (2000.0, 2.4)] {
        let highest = |t: f64| {
            let theta = spin * t;
            v * t - g * t * t / 2.0 + a * theta.sin().abs() + b * theta.cos().abs()
        };
        let width = 1e-2 / f64::abs(spin);
        let beyond = (0..)
            .map(|k| width * f64::from(k))
            .find(|&t| highest(t) >= bound);
        let mut after = beyond.expect("the bound is below the peak");
        let mut before = after - width;
        for _ in 0..60 {
            let middle = f64::midpoint(before, after);
            if highest(middle) < bound {
                before = middle;
            } else {
                after = middle;
            }
        }
        let rules = Rules {
            limits: LimitBounds::none().with(Limit::UpperBound, bound),
            ..Rules::until(3.0)
        };
        let start = State {
            vy: v,
            vtheta: spin,
            ..State::default()
        };
        let end = *record(&system, rules, start).end();
        assert_eq!(end.reason, Stop::UpperBound, "{spin}");
        assert!((end.t - after).abs() < 1e-13, "{spin}: {} {after}", end.t);
    }
}

/// The kinds of motion that are calculated in different ways.
const KINDS: [&str; 4] = ["two cables", "three cables", "full mass", "afloat"];

/// A body in motion.
fn body_of(kind: &str, random: &mut Random) -> (System, State) {
    if kind == "afloat" {
        return random.body(2);
    }
    let [a, b] = [random.between(0.05, 0.4), random.between(0.0, 0.3)];
    let shape = Shape::of_half_sizes(a, b);
    let inertia = natural_inertia(a, b).expect("it has a size");
    let body = match kind {
        "full mass" => Body::with_mass_matrix(shape, random.definite(0.3, 0.5)),
        _ => Some(Body::rigid(shape, inertia)),
    };
    let sides: &[f64] = match kind {
        "three cables" => &[-1.0, 0.3, 1.0],
        _ => &[-1.0, 1.0],
    };
    let cable = |side: &f64| {
        let (anchor, fairlead) = ([*side, 1.0], [side * a, 0.0]);
        let reach = f64::hypot(anchor[0] - fairlead[0], anchor[1]);
        Cable::new(anchor, fairlead, reach + random.between(0.02, 0.4))
    };
    let system = System {
        cables: sides.iter().map(cable).collect(),
        body: body.expect("positive definite"),
        forcing: Forcing {
            constant: [0.0, -1.0].into(),
            harmonics: vec![Harmonic::ellipse(
                random.between(0.1, 0.8),
                random.next(),
                random.between(0.3, 3.0),
            )],
        },
        drag: None,
        floating: None,
        restitution: random.between(0.2, 1.0),
    };
    let start = State {
        vx: random.between(-0.5, 0.5),
        vy: random.between(-0.5, 0.8),
        vtheta: random.between(-2.0, 2.0),
        ..State::default()
    };
    (system, start)
}

/// The time is short enough that few impacts occur and roundings stay small.
fn without_limits(t_end: f64) -> Rules {
    Rules {
        max_impacts: 12,
        v_stick: 1e-6,
        ..Rules::until(t_end)
    }
}

/// Whether a run is certain to its end if its start has an error of `size`, and how it ends.
fn followed(system: &System, rules: Rules, start: State, size: f64) -> (bool, Stop) {
    let simulation = Simulation::new(system.clone(), rules, 0.0, start);
    let mut simulation = simulation.expect("a legal start");
    let mut monitor = TrustMonitor::new(&simulation, &[size; 6], 1.0);
    let mut end = Stop::EndTime;
    while let Some(step) = simulation.step() {
        monitor.follow(&simulation, &step);
        end = step.stop.unwrap_or(end);
    }
    (monitor.verdict().horizon.is_none(), end)
}

/// With a bound close to the largest value that the quantity reaches, neighbours may meet the limit
/// or not: then the end is not certain; and if it is reported as certain, all of them end in the
/// same way.
#[test]
fn a_limit_that_neighbours_may_meet_ends_trust() {
    const SIZE: f64 = 1e-6;
    for limit in Limit::ALL {
        for kind in KINDS {
            let mut random = Random(1944);
            let mut counts = [0, 0];
            for case in 0..40 {
                let (system, start) = body_of(kind, &mut random);
                let rules = without_limits(random.between(0.5, 2.0));
                let free = Free::of(&system, rules, start, limit);
                let bound = free.largest() + 40.0 * SIZE * random.next().powi(3);
                if bound <= free.seen[0].1 + 100.0 * SIZE {
                    continue;
                }
                let rules = Rules {
                    limits: LimitBounds::none().with(limit, bound),
                    ..rules
                };
                let (certain, end) = followed(&system, rules, start, SIZE);
                counts[usize::from(certain)] += 1;
                for _ in 0..if certain { 12 } else { 0 } {
                    let near = start.components().map(|value| value + SIZE * random.next());
                    let near = record(&system, rules, State::from_components(near));
                    let about = format!("{limit:?}, {kind}, {case}");
                    assert_eq!(near.end().reason, end, "{about}: certain");
                }
            }
            assert!(
                counts.iter().all(|count| *count > 2),
                "{limit:?}, {kind}: {counts:?}"
            );
        }
    }
}

/// A motion without limits, and the quantity of a limit along it.
struct Free {
    run: Trajectory,
    /// Times, with the values of the quantity.
    seen: Vec<(f64, f64)>,
}

impl Free {
    fn of(system: &System, rules: Rules, start: State, limit: Limit) -> Self {
        let run = record(system, rules, start);
        let end = run.end().t;
        let value = |t: f64| (t, limit.quantity(system, &run.at(t).state));
        let seen = (0..=500).map(|k| value(end * f64::from(k) / 500.0));
        // A quantity that falls at an impact may be largest just before it.
        let struck = run.impacts().iter();
        let struck = struck.map(|impact| (impact.t, limit.quantity(system, &impact.before)));
        let mut seen: Vec<_> = seen.chain(struck).collect();
        seen.sort_by(|one, other| one.0.total_cmp(&other.0));
        Self { seen, run }
    }

    /// The largest recorded value.
    fn largest(&self) -> f64 {
        let values = self.seen.iter().map(|(_, value)| *value);
        values.fold(f64::MIN, f64::max)
    }

    fn value(&self, limit: Limit, t: f64) -> f64 {
        limit.quantity(self.run.system(), &self.run.at(t).state)
    }

    /// When the quantity first reaches a bound, by bisection between two samples.
    fn reaches(&self, limit: Limit, bound: f64) -> f64 {
        let beyond = self.seen.iter().position(|(_, value)| *value >= bound);
        let beyond = beyond.expect("the bound is below the largest value");
        let (mut before, mut after) = (self.seen[beyond - 1].0, self.seen[beyond].0);
        for _ in 0..80 {
            let middle = f64::midpoint(before, after);
            if self.value(limit, middle) < bound {
                before = middle;
            } else {
                after = middle;
            }
        }
        after
    }
}

/// In any motion a limit ends the run where a search in the motion without limits first finds the
/// quantity at its bound, and does not end it if the bound is above all values that the quantity
/// reaches.
#[test]
fn a_limit_is_met_where_its_quantity_first_reaches_the_bound() {
    for limit in Limit::ALL {
        for kind in KINDS {
            let mut random = Random(1999);
            let mut met = 0;
            for case in 0..60 {
                let (system, start) = body_of(kind, &mut random);
                let rules = without_limits(random.between(1.0, 6.0));
                let free = Free::of(&system, rules, start, limit);
                let (first, largest) = (free.seen[0].1, free.largest());
                let with = |bound: f64| Rules {
                    limits: LimitBounds::none().with(limit, bound),
                    ..rules
                };
                let about = format!("{limit:?}, {kind}, {case}");

                // Between two samples the quantity may be larger than at either.
                let never = record(&system, with(1.5 * largest.abs() + 0.5), start);
                assert_eq!(never.end().reason, free.run.end().reason, "{about}");
                assert!((never.end().t - free.run.end().t).abs() < 1e-8, "{about}");

                let bound = first + (largest - first) * random.between(0.1, 0.999);
                if bound < first + 1e-6 {
                    continue;
                }
                met += 1;
                let run = record(&system, with(bound), start);
                let end = run.end();
                assert_eq!(end.reason.limit(), Some(limit), "{about}");
                let reached = limit.quantity(&system, &end.state) - bound;
                assert!(reached.abs() < 1e-12, "{about}: {reached:e} off the bound");
                assert!((free.value(limit, end.t) - bound).abs() < 1e-9, "{about}");
                let searched = free.reaches(limit, bound);
                assert!(end.t < searched + 1e-8, "{about}: {} {searched}", end.t);
            }
            assert!(met > 30, "{limit:?}, {kind}: only {met} were met");
        }
    }
}
