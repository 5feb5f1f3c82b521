//! Tensions that reach zero where the forces on a mass cancel each other, and rise again.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{Trust, TrustMonitor, no_progress, record};
use snapload::{
    Cable, Forcing, Harmonic, Rules, Simulation, State, Stop, System, TautSet, Trajectory,
};
use std::f64::consts::{FRAC_PI_2, PI};

fn followed(system: System, t_end: f64, start: State) -> (Trajectory, Trust) {
    let simulation = Simulation::new(system, Rules::until(t_end), 0.0, start).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
    let run = record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    });
    (run.unwrap(), monitor.verdict())
}

/// A mass at the end of a cable that leads from the origin in the direction α, under forces along
/// it: a constant one and a sinusoid of this size and phase.
fn pulled(alpha: f64, constant: f64, size: f64, phase: f64) -> (System, State) {
    let (sine, cosine) = alpha.sin_cos();
    let system = System {
        forcing: Forcing {
            constant: [constant * cosine, constant * sine].into(),
            harmonics: vec![Harmonic::with_phases(
                1.0,
                [size * cosine, size * sine],
                [phase; 2],
            )],
        },
        ..string(1.0, 0.0, 0.5)
    };
    let start = State {
        x: cosine,
        y: sine,
        ..State::default()
    };
    (system, start)
}

fn stays_taut(about: &str, (system, start): (System, State), t_end: f64) {
    let all = system.all_cables();
    let (run, trust) = followed(system, t_end, start);
    assert!(run.impacts().is_empty(), "{about}: {:?}", run.impacts()[0]);
    assert_eq!(run.modes().len(), 1, "{about}: {:?}", run.modes());
    assert_eq!(run.modes()[0].taut, all, "{about}");
    assert!(trust.horizon.is_none(), "{about}: {:?}", trust.horizon);
    let end = run.end().state;
    let off = (end.x - start.x).hypot(end.y - start.y);
    assert!(off < 1e-11, "{about}: {off:e}");
}

/// T = W (1 − cos(t + φ)) is never negative: the mass stays where it is, through every touch.
#[test]
fn a_wave_as_large_as_the_weight_leaves_the_cable_taut() {
    for weight in [1.0, 9.81, 981.0, 1e-3] {
        for alpha in [-FRAC_PI_2, 0.0, 0.7, 2.5] {
            for phase in [0.0, 1.0, -FRAC_PI_2, PI, 4.0] {
                let about = format!("{weight}, {alpha}, {phase}");
                stays_taut(&about, pulled(alpha, weight, -weight, phase), 25.0);
            }
        }
    }
}

/// T = W sin t, with the sine written as a cosine with a phase, is positive up to t = π.
#[test]
fn a_tension_that_rises_as_the_time_is_taut_from_the_start() {
    for size in [0.3, 1.0, 40.0, 1e-4] {
        for alpha in [-FRAC_PI_2, 0.0, 0.7, 2.5] {
            for [sign, phase] in [[1.0, -FRAC_PI_2], [-1.0, FRAC_PI_2], [1.0, 1.5 * PI]] {
                let about = format!("{size}, {alpha}, {phase}");
                stays_taut(&about, pulled(alpha, 0.0, sign * size, phase), 3.0);
                // With the other sign it would be negative, and the cable is slack at once.
                let (system, start) = pulled(alpha, 0.0, -sign * size, phase);
                let (run, _) = followed(system, 0.1, start);
                let last = run.modes().last().unwrap();
                assert!(last.t_start < 1e-6, "{about}: {:?}", run.modes());
                assert_eq!(last.taut, TautSet::SLACK, "{about}");
                assert!(run.impacts().is_empty(), "{about}");
            }
        }
    }
}

/// A mass on a cable to the left and one to the top, with T₁ = W (1 − cos t) and T₂ the same, or T₂
/// = W sin t, or the other way round.
#[test]
fn two_tensions_may_rise_from_zero_together() {
    for weight in [1.0, 30.0] {
        let wave = |square: bool| match square {
            true => [weight, -weight, 0.0],
            false => [0.0, weight, -FRAC_PI_2],
        };
        for squares in [[true, true], [true, false], [false, true], [false, false]] {
            let [[right, along, early], [down, up, late]] = squares.map(wave);
            let system = System {
                cables: vec![
                    Cable::new([-1.0, 0.0], [0.0, 0.0], 1.0),
                    Cable::new([0.0, 1.0], [0.0, 0.0], 1.0),
                ],
                forcing: Forcing {
                    constant: [right, -down].into(),
                    harmonics: vec![Harmonic::with_phases(1.0, [along, -up], [early, late])],
                },
                ..string(1.0, 0.0, 0.5)
            };
            let about = format!("{weight}, {squares:?}");
            stays_taut(&about, (system, State::default()), 3.0);
        }
    }
}

/// A mass between a cable to the left, with T₁ = 0.3 cos(t + φ), and one to the top, with T₂ = 0.
/// When T₁ is lost the mass is pushed to the left, by 0.3 (τ − sin τ) at first, and swings on the
/// other cable. Impacts by rounding may come before, but are not certain.
#[test]
fn a_cable_without_tension_takes_over_from_one_that_loses_it() {
    for [size, phase] in [
        [0.3, -FRAC_PI_2],
        [-0.3, FRAC_PI_2],
        [0.3, 0.0],
        [0.3, -0.7],
    ] {
        for first in [0, 1] {
            let mut cables = vec![
                Cable::new([-1.0, 0.0], [0.0, 0.0], 1.0),
                Cable::new([0.0, 1.0], [0.0, 0.0], 1.0),
            ];
            cables.rotate_left(first);
            let system = System {
                cables,
                forcing: Forcing {
                    constant: [0.0, 0.0].into(),
                    harmonics: vec![Harmonic::with_phases(1.0, [size, 0.0], [phase; 2])],
                },
                ..string(1.0, 0.0, 0.5)
            };
            let about = format!("{size}, {phase}, {first}");
            let lost = FRAC_PI_2 - phase.rem_euclid(PI);
            let lost = if lost < 1e-9 { lost + PI } else { lost };
            let (run, trust) = followed(system, lost + 0.5, State::default());
            assert_eq!(run.end().reason, Stop::EndTime, "{about}");
            let traces = run.impacts().iter().all(|snap| snap.v_n < 1e-15);
            assert!(traces && run.impacts().len() < 10, "{about}");
            let last = run.modes().last().unwrap();
            assert_eq!(last.taut, TautSet::only(1 - first), "{about}");
            assert!(
                (run.at(lost - 1e-3).tensions[first] - 3e-4).abs() < 1e-9,
                "{about}"
            );
            let end = run.end().state;
            assert!(end.x < -0.005, "{about}: {end:?}");
            assert!((end.x.hypot(end.y - 1.0) - 1.0).abs() < 1e-12, "{about}");
            assert!(
                trust.horizon.is_some() || run.impacts().is_empty(),
                "{about}"
            );
        }
    }
}
