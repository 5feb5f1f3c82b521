//! Taut motion against references of 25 digits that were computed by other code in two other
//! formulations (`crates/snapload/tests/oracle`), and its parts against independent computations.
use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::radius::Radius;
use crate::arithmetic::scalar::{Jet, Scalar};
use crate::case::ExactCase;
use crate::model::Model;
use crate::slack::search::Path;
use crate::slack::set::Set;
use crate::taut::chart::Chart;
use crate::taut::free::Free;
use crate::taut::law::{Law, after};
use crate::taut::rocking::Rocking;
use crate::taut::run::{Event, StartData, enclose_taut_motion};
use crate::taut::sliding::Sliding;
use crate::taut::snap::Pair;
use crate::taut::start::{Started, hull_of, start_motion};
use crate::taut::step::{Equations, Step};
use serde_json::Value;
use snapload::{Parameters, Stop};

const LIMBS: usize = 3;

fn ball(text: &Value) -> Ball {
    let decimal = Decimal::parse(text.as_str().expect("a decimal")).expect("a decimal");
    decimal.ball(LIMBS)
}

/// The model of a case of the oracle.
fn model(params: &Value, inertia: &Value, t_end: f64) -> Model {
    let number = |key: &str| -> f64 {
        params[key]
            .as_str()
            .expect("text")
            .parse()
            .expect("a number")
    };
    let parameters = Parameters {
        r: number("r"),
        a: number("a"),
        b: number("b"),
        f_o: number("f0"),
        omega: number("Om"),
        nu: number("nu"),
        t_end,
        inertia: Some(inertia.as_str().expect("text").parse().expect("a number")),
        ..Parameters::STANDARD
    };
    let natural = snapload::natural_inertia(parameters.a, parameters.b).expect("a size");
    assert!((parameters.inertia.expect("given") / natural - 1.0).abs() < 1e-14);
    let parameters = Parameters {
        inertia: Some(natural),
        ..parameters
    };
    let case = ExactCase::of(&parameters, |_| None).expect("a legal case");
    Model::new(&case, 2).expect("a model")
}

/// The event that a reference's kind stands for.
fn event_of(kind: &str) -> Event {
    match kind {
        "rotation_limit" => Event::Stop(Stop::RotationLimit),
        "t_max" => Event::Stop(Stop::EndTime),
        "tension_lost_1" => Event::Released(0),
        "tension_lost_2" => Event::Released(1),
        "impact_1" => Event::Struck(0),
        other => panic!("{other}"),
    }
}

fn close(case: &Value, ours: &Ball, theirs: &Value) {
    let off = (ours - &ball(theirs)).upper().to_f64();
    assert!(off < 1e-19, "{}: {off:e}", case["id"]);
}

/// Motion with one and with two taut cables from a given state to its event: the kind of event, its
/// time and the state agree with the reference to 19 digits.
#[test]
fn taut_motion_is_the_references() {
    let path = format!(
        "{}/../snapload/tests/oracle/constrained.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let mut seen = [0, 0];
    for case in all["cases"].as_array().expect("cases") {
        let kind = case["end"]["kind"].as_str().expect("a kind");
        let cables = case["taut"].as_array().expect("cables").iter();
        let cables = cables.map(|cable| cable.as_u64().expect("a cable") as usize - 1);
        let taut: Vec<usize> = cables.collect();
        if kind == "upper_bound" {
            // Those files stop where the centre passes the anchors' level, which is later than the
            // top does.
            continue;
        }
        let t_end = if kind == "t_max" { 2.0 } else { 10.0 };
        let model = model(&case["params"], &case["Ic"], t_end);
        let start = case["start"].as_array().expect("a start");
        let state = std::array::from_fn(|i| ball(&start[i]));
        let [x, y, theta, vx, vy, spin]: [Ball; 6] = state;
        let instants = Set::of_box(&[x, y, theta, vx, vy, spin, Ball::zero()]);
        let start = StartData {
            taut: &taut,
            instants: &instants,
            laws: &[],
            zeros: &Vec::new(),
        };
        let end = enclose_taut_motion(&model, &start, &mut |_| Ok(()));
        let end = end.unwrap_or_else(|why| panic!("{}: {why:?}", case["id"]));
        let (state, t) = hull_of(&end.instants);
        if end.event == Event::Stop(Stop::UpperBound) {
            // The top reaches the level before the reference ends, which follows the centre.
            let later = ball(&case["end"]["t"]);
            assert!(t.is_below(&later), "{}", case["id"]);
            continue;
        }
        seen[taut.len() - 1] += 1;
        assert_eq!(end.event, event_of(kind), "{}", case["id"]);
        // References that run to the end of their time are followed to a row of their tables.
        let end = if kind == "t_max" {
            let mut rows = case["rows"].as_array().expect("rows").iter();
            rows.find(|row| row["t"] == "2.0000").expect("a row")
        } else {
            &case["end"]
        };
        close(case, &t, &end["t"]);
        let theirs = end["state"].as_array().expect("a state");
        for (ours, theirs) in state.iter().zip(theirs) {
            close(case, ours, theirs);
        }
    }
    // All events: tension lost, the other cable closing, the rotation limit, the end of time.
    assert_eq!(seen, [4, 9]);
}

/// A model of a rectangle of these sizes, with so many limbs.
fn rectangle([r, a, b]: [f64; 3], limbs: usize) -> (Parameters, Model) {
    let parameters = Parameters {
        r,
        a,
        b,
        inertia: snapload::natural_inertia(a, b),
        ..Parameters::STANDARD
    };
    let case = ExactCase::of(&parameters, |_| None).expect("a legal case");
    (parameters, Model::new(&case, limbs).expect("a model"))
}

fn number(x: f64) -> Ball {
    Ball::double(x).with_limbs(LIMBS)
}

/// At x = y = θ = 0 both cables are closed, with D = (±(a − 1), −h) and the arms (±a, b). What an
/// The effect of an impact of one cable on the other, which is taut, against the problem that it
/// solves: impulses are not negative, the struck cable's velocity is reversed, and the taut one
/// opens or takes an impulse.
#[test]
fn an_impact_beside_a_taut_cable_is_complementary() {
    let (mut stayed, mut left) = (0, 0);
    let bodies = [
        [1.5, 0.1, 0.0],
        [1.05, 0.1, 0.0],
        [1.5, 0.3, 0.2],
        [1.2, 0.05, 0.4],
        [1.1, 0.8, 0.1],
        [2.5, 0.2, 0.2],
    ];
    for sizes in bodies {
        let (parameters, model) = rectangle(sizes, LIMBS);
        let [r, a, b] = sizes;
        let (e, i) = (parameters.e, parameters.inertia.expect("a size"));
        let h = (r * r - (1.0 - a) * (1.0 - a)).sqrt();
        // G of a cable, and the product with M⁻¹ of two.
        let normal = |cable: usize| {
            let side = if cable == 0 { 1.0 } else { -1.0 };
            let n = [side * (a - 1.0) / r, -h / r];
            [n[0], n[1], side * a * n[1] - b * n[0]]
        };
        let weighted = |g: [f64; 3], k: [f64; 3]| g[0] * k[0] + g[1] * k[1] + g[2] * k[2] / i;
        let speed = |g: [f64; 3], v: [f64; 3]| g[0] * v[0] + g[1] * v[1] + g[2] * v[2];
        for struck in 0..2 {
            let (g, t) = (normal(struck), normal(1 - struck));
            for direction in [[0.3, -0.7, 0.2], [-0.5, -0.4, 1.5], [0.1, 0.6, -2.0]] {
                // Without a normal velocity of the taut cable, and closing the other one.
                let off = speed(t, direction) / speed(t, t);
                let v: [f64; 3] = std::array::from_fn(|k| direction[k] - off * t[k]);
                let v = v.map(|x| x * speed(g, v).signum());
                let [vx, vy, spin] = v.map(number);
                let [x, y, theta] = [(); 3].map(|()| Ball::zero());
                let state = [x, y, theta, vx, vy, spin];
                let pair = Pair::new(&model, &state, &Ball::zero(), [struck, 1 - struck]);
                let snap = pair
                    .and_then(|pair| pair.after(false, false))
                    .expect("decided");
                let rebound = after(&snap.rebound, &model, &state).expect("a velocity");
                let [.., vx, vy, spin] = rebound.map(|ball| ball.to_f64());
                let after = [vx, vy, spin];
                // M (v⁻ − v⁺) = p g + q t: q from the component of the left side perpendicular to
                // g.
                let lost = [v[0] - after[0], v[1] - after[1], i * (v[2] - after[2])];
                let cross = g[0] * t[1] - g[1] * t[0];
                let p = (lost[0] * t[1] - lost[1] * t[0]) / cross;
                let q = (g[0] * lost[1] - g[1] * lost[0]) / cross;
                assert!((p * g[2] + q * t[2] - lost[2]).abs() < 1e-12);
                assert!(p > 0.0 && (speed(g, after) + e * speed(g, v)).abs() < 1e-12);
                if weighted(g, t) < 0.0 {
                    stayed += 1;
                    assert!(q > 0.0 && speed(t, after).abs() < 1e-12);
                } else {
                    left += 1;
                    assert!(q.abs() < 1e-12 && speed(t, after) < 0.0);
                }
            }
        }
    }
    assert!(stayed > 5 && left > 5, "{stayed} {left}");
}

/// The derivatives of a chart's series with respect to the initial state agree with central
/// differences with steps of 2⁻⁶⁰, whose error is about 2⁻¹²⁰ times a third derivative; the
/// derivatives in intervals are as wide as the rounding of doubles makes them.
fn slopes_are_differences<const N: usize>(chart: &impl Chart<N>, start: [f64; N]) {
    let (_, model) = rectangle([1.5, 0.2, 0.1], LIMBS);
    let terms = chart.terms(&model);
    let start = start.map(number);
    let time = number(0.75);
    let jets = std::array::from_fn(|i| Jet::coordinate(start[i].clone(), i, &number(1.0)));
    let at = Jet::constant(&time);
    let jets = terms
        .program
        .expand::<Jet<Ball, N>, N>(&jets, &at, 9, &model.functions);
    let jets = jets.expect("no division by zero");
    for j in 0..N {
        let moved = |sign: i64| {
            let mut at = start.clone();
            at[j] = &at[j] + &Ball::integer(sign).scaled(-60).with_limbs(LIMBS);
            let series = terms.program.expand(&at, &time, 9, &model.functions);
            series.expect("no division by zero")
        };
        let (up, down) = (moved(1), moved(-1));
        let rows = jets.state.iter().chain(&jets.outputs);
        let ups = up.state.iter().chain(&up.outputs);
        let downs = down.state.iter().chain(&down.outputs);
        for (i, (row, (up, down))) in rows.zip(ups.zip(downs)).enumerate() {
            for (k, (jet, (up, down))) in row.iter().zip(up.iter().zip(down)).enumerate() {
                let slope = (up - down).scaled(59);
                let off = (slope - &jet.slopes[j]).upper().to_f64();
                assert!(off < 2f64.powi(-80), "{i} {j} {k}: {off:e}");
            }
        }
    }
}

#[test]
fn derivatives_by_the_start_agree_with_differences() {
    slopes_are_differences(&Sliding(0), [0.3, -0.2, 0.7, -1.1]);
    slopes_are_differences(&Sliding(1), [0.3, -0.2, 0.7, -1.1]);
    slopes_are_differences(&Rocking::hanging(), [0.3, -1.1]);
}

/// The coordinates after `tau` by short steps of many digits.
fn followed<const N: usize>(
    equations: &Equations<'_>,
    start: &[Ball; N],
    time: f64,
    tau: f64,
) -> [Ball; N] {
    let (mut t, mut left) = (Ball::double(time), tau);
    let mut set = Set::of_box(start);
    loop {
        let step = Step::new(equations, &t, &set, left).expect("an enclosure");
        if step.length.to_f64() >= left {
            return step.at(&Ball::double(left));
        }
        set = step.end(&set).expect("a set");
        (t, left) = (&t + &step.length, left - step.length.to_f64());
    }
}

/// A step with few digits, where the remainder dominates, and a step from a wide box contain the
/// results of many digits for the box's middle and corners: coordinates and event functions.
fn steps_enclose_taut_motion<const N: usize>(chart: &impl Chart<N>, start: [f64; N]) {
    let [(_, fine), (_, few)] = [4, 2].map(|limbs| rectangle([1.5, 0.2, 0.1], limbs));
    let [exact, equations] = [&fine, &few].map(|model| Equations::of(chart, model));
    let time = 0.75;
    for (side, corners) in [(0.0, 1), (2f64.powi(-24), 2)] {
        let at = |corner: i32| -> [Ball; N] {
            std::array::from_fn(|i| {
                let sign = if corner == 0 || i % 2 == 0 { 1.0 } else { -1.0 };
                Ball::double(start[i] + sign * side).with_limbs(4)
            })
        };
        let whole = start.map(|x| {
            let centre = Ball::double(x).with_limbs(2);
            if side > 0.0 {
                centre.widened(Radius::power_of_two(-24))
            } else {
                centre
            }
        });
        let set = Set::of_box(&whole);
        let step = Step::new(&equations, &Ball::double(time), &set, 0.25).expect("an enclosure");
        let h = step.length.to_f64();
        for corner in 0..corners {
            for tau in [h / 4.0, h] {
                let reference = followed(&exact, &at(corner), time, tau);
                let tau = Ball::double(tau);
                let mut pairs: Vec<(Ball, Ball)> = step
                    .at(&tau)
                    .into_iter()
                    .zip(reference.iter().cloned())
                    .collect();
                if tau.to_f64() >= h {
                    let end = step.end(&set).expect("a set").hull();
                    pairs.extend(end.into_iter().zip(reference.iter().cloned()));
                }
                let when = Ball::double(time) + &tau;
                let now = exact.program.expand(&reference, &when, 1, &fine.functions);
                let now = now.expect("no division by zero").outputs;
                for (which, series) in now.iter().enumerate() {
                    let event_value = step.event_value(which, &tau);
                    pairs.push((event_value.value, series[0].clone()));
                    pairs.push((event_value.rate, series[1].clone()));
                }
                for (ours, reference) in pairs {
                    let off = (&ours.centre() - &reference).lower();
                    assert!(
                        off <= ours.radius(),
                        "{corner} {tau:?}: {ours:?} {reference:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn steps_hold_the_motion() {
    steps_enclose_taut_motion(&Sliding(0), [0.3, -0.2, 0.7, -1.1]);
    steps_enclose_taut_motion(&Sliding(1), [0.3, -0.2, 0.7, -1.1]);
    steps_enclose_taut_motion(&Rocking::hanging(), [0.3, -1.1]);
}

/// The states of a box, each at an instant of its own, are carried to the beginning of a motion:
/// the images of single states of the box are in the set. This is tested for all three kinds of
/// motion, after a law.
fn starts_enclose_taut_motion<const N: usize>(
    chart: &impl Chart<N>,
    laws: &[Law],
    state: [f64; 7],
) {
    let (_, model) = rectangle([1.5, 0.2, 0.1], LIMBS);
    let equations = Equations::of(chart, &model);
    let wide = state.map(|x| number(x).widened(Radius::power_of_two(-60)));
    let Started { set, t, .. } =
        start_motion(&equations, chart, laws, &Set::of_box(&wide)).expect("a start");
    let hull = set.hull();
    for corner in 0..128u32 {
        let one: [Ball; 7] = std::array::from_fn(|i| {
            let sign = if corner >> i & 1 == 0 { 1.0 } else { -1.0 };
            number(state[i] + sign * 2f64.powi(-61))
        });
        let [x, y, theta, vx, vy, spin, when] = one;
        let after = after(laws, &model, &[x, y, theta, vx, vy, spin]).expect("a state");
        let at = chart.coordinates(&model, &after).expect("coordinates");
        // Back to T by the Taylor polynomial of the third degree, over 2⁻⁵⁸ at most.
        let series = equations.program.expand(&at, &when, 3, &model.functions);
        let series = series.expect("no division by zero").state;
        let shift = &t - &when;
        for (i, (ours, series)) in hull.iter().zip(&series).enumerate() {
            let reference = series
                .iter()
                .rev()
                .fold(Ball::zero(), |sum, c| sum * &shift + c);
            let off = (&ours.centre() - &reference).lower();
            assert!(off <= ours.radius(), "{corner} {i}: {ours:?} {reference:?}");
        }
    }
}

#[test]
fn begins_hold_every_state() {
    // Near the place where both cables are closed, and both close or open.
    for velocity in [[0.3, -0.7, 0.2], [-0.2, 0.4, 1.1]] {
        let [vx, vy, spin] = velocity;
        let state = [0.0, 0.0, 0.0, vx, vy, spin, 0.75];
        let one = Law::One {
            cable: 0,
            share: number(1.0),
        };
        let both = Law::KeepingTaut {
            struck: 0,
            taut: 1,
            share: number(1.0),
        };
        starts_enclose_taut_motion(&Free, &[], state);
        starts_enclose_taut_motion(&Free, std::slice::from_ref(&both), state);
        starts_enclose_taut_motion(&Sliding(0), std::slice::from_ref(&one), state);
        starts_enclose_taut_motion(&Sliding(1), &[one, both.clone()], state);
        starts_enclose_taut_motion(&Rocking::hanging(), &[both], state);
    }
}
