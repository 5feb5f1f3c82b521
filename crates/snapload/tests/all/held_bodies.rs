//! Bodies on more lines than necessary, in any unit of force.

use std::f64::consts::{PI, TAU};

use snapload::analysis::{Trust, TrustMonitor, no_progress, record};
use snapload::{
    Body, Cable, Forcing, Harmonic, Rules, Shape, Simulation, State, Stop, System, Trajectory,
};

/// A line from an anchor to a fairlead, at full length where x = y = θ = 0.
type Line = ([f64; 2], [f64; 2]);

/// Units of force: powers of two, and others.
const UNITS: [f64; 6] = [1.0, 128.0, 1024.0, 1000.0, 1e6, 1e-3];

/// A body of this mass and inertia (none: a point) under its weight and a wave, both as
/// accelerations.
struct Hung {
    mass: f64,
    inertia: Option<f64>,
    wave: Harmonic,
    restitution: f64,
}

impl Hung {
    fn on(&self, lines: &[Line], unit: f64) -> System {
        let m = self.mass * unit;
        let turning = self.inertia.map_or(m, |inertia| inertia * unit);
        let matrix = [[m, 0.0, 0.0], [0.0, m, 0.0], [0.0, 0.0, turning]];
        let cable = |(anchor, fairlead): &Line| {
            let span: [f64; 2] = std::array::from_fn(|i| fairlead[i] - anchor[i]);
            Cable::new(*anchor, *fairlead, span[0].hypot(span[1]))
        };
        System {
            body: Body::with_mass_matrix(Shape::Circle { radius: 0.25 }, matrix).unwrap(),
            cables: lines.iter().map(cable).collect(),
            forcing: Forcing {
                constant: [0.0, -m].into(),
                harmonics: vec![Harmonic {
                    omega: self.wave.omega,
                    cosine: self.wave.cosine.map(|f| f * m),
                    sine: self.wave.sine.map(|f| f * m),
                }],
            },
            drag: None,
            floating: None,
            restitution: self.restitution,
        }
    }
}

fn followed(system: System, t_end: f64) -> (Trajectory, Trust) {
    let rules = Rules {
        max_impacts: 2000,
        ..Rules::until(t_end)
    };
    let simulation = Simulation::new(system, rules, 0.0, State::default()).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
    let run = record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    });
    (run.unwrap(), monitor.verdict())
}

/// A mass of weight 1 on two equal lines from (−1, 2) and one from (1, 1) is pulled to the right by
/// ½ cos t: the tension of the last is √2 (1 − cos t)/3, which touches zero, and the others' are
/// positive. It rests for ever.
#[test]
fn a_mass_on_equal_lines_rests_where_a_tension_touches_zero() {
    let hung = Hung {
        mass: 2.0,
        inertia: None,
        wave: Harmonic {
            omega: 1.0,
            cosine: [0.25, 0.0].into(),
            sine: [0.0, 0.0].into(),
        },
        restitution: 0.0,
    };
    let at_centre = |anchor: [f64; 2]| (anchor, [0.0, 0.0]);
    let left = at_centre([-1.0, 2.0]);
    let right = at_centre([1.0, 1.0]);
    for lines in [vec![left, right], vec![left, left, right]] {
        for unit in UNITS {
            let mut system = hung.on(&lines, unit);
            system.forcing.constant = [0.0, -unit].into();
            let (run, trust) = followed(system, 20.0);
            let about = format!("{} lines, {unit}: {:?}", lines.len(), run.end());
            assert_eq!(run.end().reason, Stop::EndTime, "{about}");
            assert!(run.impacts().is_empty(), "{about}: {:?}", run.impacts()[0]);
            assert!(run.end().state.centre().length() < 1e-14, "{about}");
            assert!(trust.horizon.is_none(), "{about}: {:?}", trust.horizon);
        }
    }
}

/// A weight that begins at rest on a line with a twin and one or two others moves in the same way
/// whatever the unit of force is.
#[test]
fn the_motion_does_not_depend_on_the_unit_of_force() {
    let mut compared = 0;
    for k in 0..16 {
        let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
        let point = k % 2 == 0;
        let fairlead = |x: f64| if point { [0.0, 0.0] } else { [x, 0.1] };
        let left = ([-1.0, 0.5 + at(2.0)], fairlead(-0.2));
        let mut lines = vec![left, left, ([1.0, 0.5 + at(3.0)], fairlead(0.2))];
        if k % 4 < 2 {
            lines.push(([at(5.0) - 0.5, 1.2], fairlead(0.0)));
        }
        let hung = Hung {
            mass: 1.0,
            inertia: (!point).then_some(0.02),
            wave: Harmonic {
                omega: 0.5 + 2.5 * at(7.0),
                cosine: [0.0, 0.0].into(),
                sine: [0.3 + 0.7 * at(11.0), 0.6 * at(13.0)].into(),
            },
            restitution: [0.0, 0.5, 0.8][k as usize % 3],
        };
        let (one, trust) = followed(hung.on(&lines, 1.0), 6.0);
        for unit in UNITS {
            let (run, _) = followed(hung.on(&lines, unit), 6.0);
            let about = format!("{k}, {unit}: {:?} {}", run.end(), run.impacts().len());
            assert_ne!(run.end().reason, Stop::Standstill, "{about}");
            let known = one.impacts().iter().zip(&trust.errors);
            for ((a, error), b) in known.zip(run.impacts()) {
                if *error > 1e-6 {
                    break;
                }
                let same = a.cable == b.cable && (a.t - b.t).abs() < 1e-6;
                assert!(same, "{about}: {a:?} {b:?}");
                compared += 1;
            }
            if trust.horizon.is_none() {
                assert_eq!(run.impacts().len(), one.impacts().len(), "{about}");
                assert_eq!(run.end().reason, one.end().reason, "{about}");
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

/// A point on lines all round, none of which is slack, can not move, whatever pulls at it: two of
/// them lead in nearly opposite directions, and the others to the side on which these leave more
/// than a half turn.
#[test]
fn a_point_on_lines_all_round_stays_where_it_is() {
    for k in 0..300 {
        let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
        let opening = 0.02 + 0.08 * at(2.0);
        let side = 0.2 + (PI - opening - 0.4) * at(3.0);
        let first = TAU * at(5.0);
        let mut angles = vec![first, first + PI - opening, first - side];
        angles.rotate_left(k as usize % 3);
        if k % 2 == 0 {
            angles.insert(1, angles[0]);
        }
        let line = |(j, angle): (usize, &f64)| {
            let length = 0.7 + 1.3 * at(7.0 + 4.0 * j as f64);
            ([length * angle.cos(), length * angle.sin()], [0.0, 0.0])
        };
        let lines: Vec<Line> = angles.iter().enumerate().map(line).collect();
        let hung = Hung {
            mass: [1.0, 0.5, 3.0][k as usize % 3],
            inertia: None,
            wave: Harmonic {
                omega: 0.5 + 3.0 * at(23.0),
                cosine: [2.0 * at(29.0), -at(31.0)].into(),
                sine: [at(37.0), 2.0 * at(41.0)].into(),
            },
            restitution: [0.0, 0.5, 1.0][k as usize % 3],
        };
        let (run, _) = followed(hung.on(&lines, 1.0), 5.0);
        let about = format!("{k}: {:?} {:?}", run.end(), run.modes());
        assert_eq!(run.end().reason, Stop::EndTime, "{about}");
        assert!(run.impacts().is_empty(), "{about}: {:?}", run.impacts()[0]);
        assert!(run.end().state.centre().length() < 1e-12, "{about}");
    }
}
