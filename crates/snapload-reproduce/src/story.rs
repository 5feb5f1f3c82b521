//! A run told step by step, from its log of events.

use snapload::{ModeInterval, Trajectory};

/// Shorter stretches of a mode are told together as bouncing.
const SHORT: f64 = 0.02;

/// A sentence of the story.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// Which of the run's modes it begins with.
    pub(crate) mode: usize,
    /// When it begins.
    pub(crate) t: f64,
    /// What happens.
    pub(crate) what: String,
}

/// The story.
pub(crate) fn story(run: &Trajectory) -> Vec<Step> {
    let long = |mode: &ModeInterval| mode.t_end - mode.t_start >= SHORT;
    let mut first = 0;
    let stretches = run.modes().chunk_by(|p, q| !long(p) && !long(q));
    stretches
        .map(|modes| {
            let step = Step {
                mode: first,
                t: modes[0].t_start,
                what: if long(&modes[0]) {
                    begins(run, &modes[0])
                } else {
                    let next = run.modes().get(first + modes.len());
                    bounces(modes, next.map_or(run.end().t, |mode| mode.t_start))
                },
            };
            first += modes.len();
            step
        })
        .collect()
}

/// Short stretches, up to the beginning of a long one.
fn bounces(modes: &[ModeInterval], until: f64) -> String {
    let taut = match modes.iter().filter(|mode| !mode.taut.is_empty()).count() {
        0 => String::new(),
        1 => ", once with a cable taut for a moment".to_owned(),
        times => format!(", {times} times with a cable taut for a moment"),
    };
    let lasts = match until - modes[0].t_start {
        short if short < 1e-3 => "less than 0.001".to_owned(),
        long => format!("{long:.3}"),
    };
    format!("bounces in short flights for {lasts}{taut}")
}

fn begins(run: &Trajectory, mode: &ModeInterval) -> String {
    let (from, to) = (mode.t_start, mode.t_end);
    let snaps = || run.impacts().iter().filter(|impact| impact.v_n > 0.0);
    let what = match (mode.taut.len(), mode.taut.iter().next()) {
        (1, Some(cable)) => {
            let name = ["right", "left"][cable.min(1)];
            let hit = snaps().find(|impact| impact.t == to);
            let until = match hit.filter(|hit| !mode.taut.contains(hit.cable)) {
                Some(_) => ", until it strikes the other boundary and leaves this one",
                None => "",
            };
            format!("slides with the {name} cable taut{until}")
        }
        (0, _) => {
            let count = snaps()
                .filter(|impact| impact.t > from && impact.t <= to)
                .count();
            format!("flies free of both cables, with {count} snaps")
        }
        _ => "rocks with both cables taut".to_owned(),
    };
    let (y, lasts) = (run.at(from).state.y, to - from);
    let end = if to == run.end().t {
        ", to the end of the run"
    } else {
        ""
    };
    format!("at height y = {y:.4}, {what}; this lasts {lasts:.3}{end}")
}
