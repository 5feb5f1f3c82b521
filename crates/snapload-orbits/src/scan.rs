//! A lap whose held surfaces stay held, whatever their tension: the first guess at an orbit that
//! may be inadmissible.

use crate::hybrid::{Family, Hybrid, Point};
use crate::lap::after;
use crate::roots::root;
use crate::sequence::{Event, EventKind, Sequence, Timed};
use snapload::TautSet;

/// Steps per period of the forcing.
const STEPS: usize = 400;
/// The most snaps in a lap.
const MOST_SNAPS: usize = 200;

/// The motion from `z` at time `t` over `length`, with the surfaces of `taut` held throughout, and
/// every other one struck where it closes. None if there are too many snaps, or the time or the
/// length is not finite.
pub fn scan<F: Family>(
    family: &F,
    at: [f64; 2],
    taut: TautSet,
    (t, z): (f64, &Point),
    length: f64,
) -> Option<Timed> {
    if !(t + length).is_finite() {
        return None;
    }
    let system = family.plain(at);
    let period = family.forcing_period(at).value;
    let mut lap = Timed {
        sequence: Sequence {
            start: taut,
            events: Vec::new(),
        },
        ..Timed::default()
    };
    let (end, width) = (t + length, period / STEPS as f64);
    let (mut t, mut z, mut since) = (t, system.placed(taut, taut, z), t);
    while t < end {
        let s = width.min(end - t);
        let next = system.flow(taut, t, &z, s);
        let free = system.surfaces().iter().filter(|&k| !taut.contains(k));
        let crossed = free.filter(|&k| system.gap(k, &next) > 0.0 && system.gap(k, &z) <= 1e-12);
        let first = crossed
            .map(|surface| {
                let gap = |s: f64| system.gap(surface, &system.flow(taut, t, &z, s));
                (
                    root(&gap, (0.0, gap(0.0).min(-1e-300)), (s, gap(s))),
                    surface,
                )
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((s, surface)) = first else {
            (t, z) = (t + s, next);
            continue;
        };
        if lap.durations.len() == MOST_SNAPS {
            return None;
        }
        let struck = TautSet::only(surface);
        let hit = system.flow(taut, t, &z, s);
        let (_, impulse) = system.law(struck, struck.union(taut), &hit);
        let pulling: TautSet = struck
            .union(taut)
            .iter()
            .filter(|&k| k == surface || impulse[k] > 0.0)
            .collect();
        let event = Event {
            kind: EventKind::Snap { struck, pulling },
            after: taut,
        };
        lap.durations.push(t + s - since);
        lap.speeds.push(system.speed(surface, &hit));
        lap.sequence.events.push(event);
        z = after(&system, &event, &hit);
        (t, since) = (t + s, t + s);
    }
    Some(lap)
}
