//! Closed forms: the linear oscillator against a wall, and the ball on a vibrating table, both by
//! the code for bodies on cables.

use crate::common::{number, reference, relative};
use crate::wall::{Wall, WallOver};
use snapload::analysis::no_progress;
use snapload::{Body, Cable, Forcing, Harmonic, Real, Rules, System, TautSet};
use snapload_orbits::{
    Branch, BranchOptions, Event, EventKind, Family, Hybrid, Kind, Lap, Moored, Orbit, Sequence,
    close,
};

/// One snap of surface 0 in slack flight.
pub fn one_snap() -> Sequence {
    let struck = TautSet::only(0);
    let kind = EventKind::Snap {
        struck,
        pulling: struck,
    };
    Sequence {
        start: TautSet::SLACK,
        events: vec![Event {
            kind,
            after: TautSet::SLACK,
        }],
    }
}

/// The trace of ∂P/∂z by central differences, P being flow to the wall, law, flow to the section.
fn trace_by_differences(system: &WallOver<f64>, place: f64, orbit: &Orbit) -> f64 {
    let map = |z: &[f64; 6]| {
        let mut s = orbit.lap.durations[0];
        for _ in 0..30 {
            let hit = system.flow(TautSet::SLACK, 0.0, z, s);
            s -= (hit[0] - place) / hit[3];
        }
        let hit = system.flow(TautSet::SLACK, 0.0, z, s);
        let (after, _) = system.law(TautSet::only(0), TautSet::only(0), &hit);
        system.flow(TautSet::SLACK, s, &after, orbit.length - s)
    };
    let step = 1e-6;
    let along = |i: usize| {
        let moved = |by: f64| {
            let mut z = orbit.z;
            z[i] += by;
            map(&z)[i]
        };
        (moved(step) - moved(-step)) / (2.0 * step)
    };
    along(0) + along(3)
}

#[test]
fn the_oscillator_against_a_wall_has_its_closed_orbits() {
    let known = &reference()["closed_forms"]["linear_impact_oscillator"];
    let mut compared = 0;
    for row in known.as_array().unwrap() {
        let value = |key: &str| number(&row[key]);
        let wall = Wall {
            zeta: value("zeta"),
            omega: value("omega"),
            place: value("wall"),
            restitution: value("e"),
        };
        let n = row["n"].as_u64().unwrap() as u32;
        for solution in row["solutions"].as_array().unwrap() {
            let at = [value("F"), 0.0];
            let phase = number(&solution["phase"]);
            let v = number(&solution["v_before"]);
            let sequence = one_snap();
            let lap = Lap {
                family: &wall,
                at,
                sequence: &sequence,
                phase: 0.0,
                periods: n,
            };
            // The state at t = 0 follows from that at the wall by the flow backwards; Newton's
            // method starts from it with an error of a thousandth.
            let hit = phase / wall.omega;
            let system = wall.plain(at);
            let struck = [wall.place, 0.0, 0.0, v, 0.0, 0.0];
            let z = Hybrid::flow(&system, TautSet::SLACK, hit, &struck, -hit);
            let closed = close(&lap, &z.map(|c| c * 1.001), &[hit + 1e-3]).unwrap();
            let orbit = Orbit::of(&lap, &closed);
            let [snap] = &orbit.rows[..] else {
                panic!("one snap")
            };
            assert!((snap.t * wall.omega - phase).abs() < 1e-10);
            assert!((snap.speed - v).abs() < 1e-10);
            let m = &orbit.multipliers.values;
            let trace = m[0][0] + m[1][0];
            // By difference quotients of the map: in the trace of the reference one term has the
            // wrong sign, which its own checks of return and determinant do not detect.
            let quotient = trace_by_differences(&system, wall.place, &orbit);
            assert!((trace - quotient).abs() < 1e-6, "{trace} {quotient}");
            assert!(relative(orbit.multipliers.product, number(&solution["det"])) < 1e-10);
            assert!(relative(orbit.rule.unwrap(), number(&solution["det"])) < 1e-12);
            assert_eq!(orbit.is_admissible(), solution["admissible"] == true);
            if v < 0.0 {
                assert!(
                    orbit.why_not[0].contains("negative velocity"),
                    "{:?}",
                    orbit.why_not
                );
            }
            compared += 1;
        }
    }
    assert!(compared >= 6);
}

/// A point mass above an anchor, on a vertical cable of length R; force 1 down, Γ sin Ωt. The
/// parameters are Γ and e.
pub fn table(r: f64, omega: f64) -> Moored {
    fn system<T: Real>([gamma, e]: [T; 2], [r, omega]: [f64; 2]) -> (System<T>, Rules<T>) {
        let [zero, one] = [T::ZERO, T::ONE];
        let wave = Harmonic {
            omega: T::from_f64(omega),
            cosine: [zero, zero].into(),
            sine: [zero, gamma].into(),
        };
        let r = T::from_f64(r);
        let system = System {
            body: Body::point(),
            cables: vec![Cable::new([zero, r], [zero, zero], r)],
            forcing: Forcing {
                constant: [zero, -one].into(),
                harmonics: vec![wave],
            },
            drag: None,
            floating: None,
            restitution: e,
        };
        (system, Rules::until(zero))
    }
    let numbers = [r, omega];
    Moored::new(
        false,
        move |at| system(at, numbers),
        move |at| system(at, numbers),
    )
}

/// The stable orbit of one snap each n periods, from a start that it attracts.
pub fn bouncing(family: &Moored, at: [f64; 2], n: u32) -> Orbit {
    bouncing_from(family, at, n, 0.0)
}

/// The same, with the section at a fraction of a period.
pub fn bouncing_from(family: &Moored, at: [f64; 2], n: u32, phase: f64) -> Orbit {
    let [gamma, e] = at;
    let length = f64::from(n) * family.period(at);
    let u = length / (1.0 + e);
    // v_y returns to its value after a lap: Γ cos Ωt = nπ (1 − e)/(1 + e) at the snap.
    let cosine = f64::from(n) * std::f64::consts::PI * (1.0 - e) / (1.0 + e) / gamma;
    let omega = std::f64::consts::TAU / family.period(at);
    // Of the two phases the one with falling force is stable.
    let phases = [cosine.acos(), -cosine.acos() + std::f64::consts::TAU];
    let mut found = phases.map(|angle| {
        let t = angle / omega;
        let system = family.plain(at);
        let before = [0.0, 0.0, 0.0, 0.0, -u, 0.0];
        let first = (t - phase * family.period(at)).rem_euclid(length);
        let z = Hybrid::flow(&system, TautSet::SLACK, t, &before, -first);
        let sequence = one_snap();
        let lap = Lap {
            family,
            at,
            sequence: &sequence,
            phase,
            periods: n,
        };
        close(&lap, &z, &[first]).map(|closed| Orbit::of(&lap, &closed))
    });
    let stable = |orbit: &Option<Orbit>| {
        let orbit = orbit.as_ref();
        orbit.map_or(f64::INFINITY, |orbit| vertical(orbit)[0].abs())
    };
    found.sort_by(|a, b| stable(a).total_cmp(&stable(b)));
    found.into_iter().flatten().next().unwrap()
}

/// Trace and determinant of the vertical part, which is told from the transverse one by its
/// determinant e² instead of 1.
fn vertical(orbit: &Orbit) -> [f64; 2] {
    let m = &orbit.multipliers.values;
    let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let mut best = [0.0; 2];
    let mut least = f64::INFINITY;
    for i in 0..4 {
        for j in i + 1..4 {
            let [re, im] = product(m[i], m[j]);
            let rest: Vec<usize> = (0..4).filter(|k| *k != i && *k != j).collect();
            let other = product(m[rest[0]], m[rest[1]]);
            let off = (other[0] - 1.0).hypot(other[1]) + im.abs();
            if off < least {
                (least, best) = (off, [m[i][0] + m[j][0], re]);
            }
        }
    }
    best
}

#[test]
fn the_ball_on_a_table_has_its_multipliers() {
    let known = &reference()["closed_forms"]["one_cable_vertical"];
    let value = |key: &str| number(&known[key]);
    let family = table(value("R"), value("omega"));
    let orbit = bouncing(&family, [value("Gamma"), value("e")], 1);
    assert!((orbit.rows[0].speed - value("impact_speed")).abs() < 1e-11);
    let [trace, determinant] = vertical(&orbit);
    assert!((trace - value("vertical_trace")).abs() < 1e-10, "{trace}");
    assert!((determinant - value("vertical_det")).abs() < 1e-11);
    let all: f64 = orbit.multipliers.values.iter().map(|[re, _]| re).sum();
    assert!((all - trace - value("transverse_trace")).abs() < 1e-10);
    assert!(orbit.is_admissible(), "{:?}", orbit.why_not);
}

#[test]
fn the_ball_on_a_table_exists_and_doubles_where_expected() {
    for row in reference()["closed_forms"]["table"].as_array().unwrap() {
        let (e, n) = (number(&row["e"]), row["n"].as_u64().unwrap() as u32);
        let [existence, doubles] = ["existence", "period_doubling"].map(|key| number(&row[key]));
        // A cable so long that the transverse motion stays stable.
        let family = table(400.0, 3.0);
        let orbit = bouncing(&family, [0.5 * (existence + doubles), e], n);
        let options = BranchOptions {
            range: [0.5 * existence, 1.1 * doubles],
            step: 0.02,
            most: 400,
        };
        let branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
        let located = |kind: Kind, value: f64| {
            let of_kind = branch.events.iter().filter(|event| event.kind == kind);
            of_kind
                .map(|event| (event.value[0] - value).abs())
                .fold(f64::INFINITY, f64::min)
        };
        let off = [
            located(Kind::Fold, existence),
            located(Kind::PeriodDoubling, doubles),
        ];
        println!("e = {e}, n = {n}: {off:?}");
        assert!(
            off[0] < 1e-10 && off[1] < 1e-10,
            "e = {e}, n = {n}: {off:?}"
        );
    }
}

/// The intervals between the period doublings of the ball shrink by Feigenbaum's δ = 4.6692 each
/// time (M. J. Feigenbaum, *J. Stat. Phys.* 19 (1978) 25).
#[test]
fn the_ball_doubles_its_period_again_and_again() {
    let row = &reference()["closed_forms"]["table"][0];
    let (e, doubles) = (number(&row["e"]), number(&row["period_doubling"]));
    let family = table(4000.0, 3.0);
    let orbit = bouncing(&family, [0.98 * doubles, e], 1);
    let mut options = BranchOptions {
        range: [0.97 * doubles, 1.3 * doubles],
        step: 0.02,
        most: 60,
    };
    let mut branch = Branch::of(&family, &orbit, &options, &no_progress).unwrap();
    let mut values: Vec<f64> = Vec::new();
    let mut periods = 1;
    while let Some(event) = branch
        .events
        .iter()
        .find(|event| event.kind == Kind::PeriodDoubling)
        .filter(|_| periods < 64)
    {
        assert_eq!(event.orbit.periods, periods);
        values.push(event.value[0]);
        options.step *= 0.45;
        let event = event.clone();
        branch = Branch::of_doubling(&family, &event, &options, &no_progress)
            .unwrap()
            .unwrap();
        periods *= 2;
    }
    println!("{values:?}");
    assert_eq!(periods, 64);
    let gaps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let last = gaps.len() - 1;
    let ratio = gaps[last - 1] / gaps[last];
    assert!((ratio - 4.6692).abs() < 0.05, "{ratio}");
}
