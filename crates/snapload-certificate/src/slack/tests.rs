//! The parts of the proof against results from other methods.
use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::case::ExactCase;
use crate::model::{EventValue, Model, State};
use crate::slack::flight::Flight;
use crate::slack::impact::Impact;
use crate::slack::search::{Path, stays_below};
use proptest::prelude::*;
use snapload::Parameters;

const LIMBS: usize = 16;

fn model(parameters: &Parameters) -> Model {
    let case = ExactCase::of(parameters, |_| None).expect("a legal case");
    Model::new(&case, LIMBS).expect("a model")
}

fn rectangle() -> Parameters {
    Parameters {
        a: 0.2,
        b: 0.1,
        inertia: snapload::natural_inertia(0.2, 0.1),
        ..Parameters::STANDARD
    }
}

/// The time at which a gap vanishes along a flight, by Newton's method.
fn root(flight: &Flight<'_>, cable: usize, guess: f64) -> Ball {
    let mut tau = Ball::double(guess).with_limbs(LIMBS);
    for _ in 0..14 {
        let event_value = flight.model.event_value(cable, &flight.at(&tau).0);
        let step = event_value
            .value
            .over(&event_value.rate)
            .expect("it crosses");
        tau = (&tau - &step).centre();
    }
    tau
}

/// The state at time `end` after a flight from `state`, its impact and the flight that follows.
fn mapped(model: &Model, state: &State, cable: usize, guess: f64, end: f64) -> State {
    let flight = Flight::new(model, Ball::zero(), state.clone());
    let tau = root(&flight, cable, guess);
    let (struck, _) = flight.at(&tau);
    let impact = Impact::new(model, cable, &struck).expect("an impact");
    let share = Ball::integer(1) + &model.e;
    let [vx, vy, spin] = impact.velocity(&struck, &share);
    let [x, y, theta, ..] = struck;
    let after = Flight::new(model, tau.clone(), [x, y, theta, vx, vy, spin]);
    after.at(&(Ball::double(end) - tau)).0
}

/// Central differences of the map with steps of 2⁻²⁰⁰ are its Jacobian to 2⁻¹⁷⁰.
#[test]
fn the_jacobian_agrees_with_differences() {
    for (parameters, guess) in [(Parameters::STANDARD, 0.4067), (rectangle(), 0.4)] {
        let model = model(&parameters);
        let start: State =
            [0.0, 0.1, 0.03, 0.02, -0.01, 0.05].map(|x| Ball::double(x).with_limbs(LIMBS));
        let end = 0.5;
        let flight = Flight::new(&model, Ball::zero(), start.clone());
        let cable = 1;
        let tau = root(&flight, cable, guess);
        let (struck, force) = flight.at(&tau);
        let impact = Impact::new(&model, cable, &struck).expect("an impact");
        let after = Ball::double(end) - &tau;
        let jacobian = impact
            .jacobian(&model, &struck, &force, &tau, &after)
            .expect("closing");
        for j in 0..6 {
            let moved = |sign: i64| {
                let mut state = start.clone();
                state[j] = &state[j] + &Ball::integer(sign).scaled(-200).with_limbs(LIMBS);
                mapped(&model, &state, cable, guess, end)
            };
            let (up, down) = (moved(1), moved(-1));
            for i in 0..6 {
                let slope = (&up[i].centre() - &down[i].centre()).scaled(199);
                let off = (slope - &jacobian[i][j]).to_f64().abs();
                assert!(off < 2f64.powi(-170), "{i} {j}: {off:e}");
            }
        }
    }
}

/// Second differences over a stretch lie within the second derivatives that are given for the
/// stretch: each is the second derivative somewhere in it.
#[test]
fn second_derivatives_enclose_second_differences() {
    for parameters in [
        Parameters::STANDARD,
        rectangle(),
        Parameters {
            omega: 0.0,
            ..rectangle()
        },
    ] {
        let model = model(&parameters);
        let state = [0.05, 0.2, 0.3, 0.4, -0.2, -1.5].map(|x| Ball::double(x).with_limbs(LIMBS));
        let flight = Flight::new(&model, Ball::double(0.75), state);
        for (middle, half) in [(0.5, -3), (0.25, -6), (1.0, -1)] {
            let second_derivatives =
                flight.second_derivatives(&Ball::double(middle), Radius::power_of_two(half));
            for k in -7..=7 {
                let at = |shift: i64| {
                    let step = Ball::integer(shift).scaled(half - 7);
                    let place = Ball::integer(k).scaled(half - 3);
                    flight.event_values(&(Ball::double(middle).with_limbs(LIMBS) + place + step))
                };
                let (before, now, after) = (at(-1), at(0), at(1));
                for (i, second_derivative) in second_derivatives.iter().enumerate() {
                    let second = &before[i].value + &after[i].value - now[i].value.twice();
                    let second = second.scaled(-2 * (half - 7));
                    let off = &second - second_derivative;
                    assert!(
                        !off.is_positive() && !off.is_negative(),
                        "{i}: {second:?} {second_derivative:?}"
                    );
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// For f = p + q t + s t²/2 on [0, H], whose largest value is known: where the lemma says that
    /// f stays below zero, it does.
    #[test]
    fn the_lemma_holds_for_parabolas(
        p in -1.0f64..0.2, q in -2.0f64..2.0, s in -6.0f64..6.0, h in 0.05f64..2.0, known: bool,
    ) {
        let p = if known { 0.0 } else { p };
        let at = |t: f64| {
            let (t, half) = (Ball::double(t).with_limbs(4), Ball::double(s).half());
            EventValue {
                value: Ball::double(p) + (Ball::double(q) + half * &t) * &t,
                rate: Ball::double(q) + Ball::double(s) * &t,
            }
        };
        let half_square = Ball::double(h).with_limbs(4).squared().half();
        let certified = stays_below(&at(0.0), &at(h), known, &Ball::double(s), &half_square);
        // In the interior the largest value is at t = −q/s, for s < 0.
        let top = if s < 0.0 { (-q / s).clamp(0.0, h) } else { 0.0 };
        let largest = at(top).value.to_f64().max(at(h).value.to_f64());
        prop_assert!(!certified || largest < 0.0 || (known && top == 0.0 && at(h).value.to_f64() < 0.0));
        // The lemma is not vacuous: it holds wherever f is far below zero.
        let deep = p.max(at(h).value.to_f64()) + s.abs() * h * h / 2.0 < -1e-9;
        prop_assert!(certified || !deep || known);
    }
}
