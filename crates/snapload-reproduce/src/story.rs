//! A run told step by step, from its log of events.

use snapload::{TautSet, Trajectory};

/// Shorter stretches of a mode are told together as bouncing.
const SHORT: f64 = 0.02;

/// A sentence of the story.
#[derive(Clone, Debug)]
pub struct Step {
    /// Which of the run's modes it begins with.
    pub mode: usize,
    /// When it begins.
    pub t: f64,
    /// What happens.
    pub what: String,
}

/// Bouncing in short stretches: the first of them, when, and how often a cable was taut.
type Bouncing = (usize, f64, usize);

/// The story.
pub fn story(run: &Trajectory) -> Vec<Step> {
    let mut told: Vec<Step> = Vec::new();
    let mut bouncing: Option<Bouncing> = None;
    for (k, mode) in run.modes().iter().enumerate() {
        let long = mode.t_end - mode.t_start >= SHORT;
        let began = mode.t_start;
        if !long {
            let (first, since, times) = bouncing.unwrap_or((k, began, 0));
            bouncing = Some((first, since, times + usize::from(!mode.taut.is_empty())));
            continue;
        }
        told.extend(bouncing.take().map(|bouncing| bounces(bouncing, began)));
        told.push(Step {
            mode: k,
            t: began,
            what: begins(run, mode.taut, began, mode.t_end),
        });
    }
    told.extend(bouncing.map(|bouncing| bounces(bouncing, run.end().t)));
    told
}

fn bounces((mode, t, times): Bouncing, until: f64) -> Step {
    let taut = match times {
        0 => String::new(),
        1 => ", once with a cable taut for a moment".to_owned(),
        _ => format!(", {times} times with a cable taut for a moment"),
    };
    let lasts = match until - t {
        short if short < 1e-3 => "less than 0.001".to_owned(),
        long => format!("{long:.3}"),
    };
    Step {
        mode,
        t,
        what: format!("bounces in short flights for {lasts}{taut}"),
    }
}

fn begins(run: &Trajectory, taut: TautSet, from: f64, to: f64) -> String {
    let snaps = run
        .impacts()
        .iter()
        .filter(|impact| impact.t > from && impact.t <= to && impact.v_n > 0.0)
        .count();
    let y = run.at(from).state.y;
    let names: Vec<&str> = taut
        .iter()
        .map(|cable| if cable == 0 { "right" } else { "left" })
        .collect();
    let what = match taut.len() {
        0 => format!("flies free of both cables, with {snaps} snaps"),
        1 => {
            let until = match run.impacts().iter().find(|i| i.t == to && i.v_n > 0.0) {
                Some(hit) if !taut.contains(hit.cable) => {
                    ", until it strikes the other boundary and leaves this one"
                }
                _ => "",
            };
            format!("slides with the {} cable taut{until}", names[0])
        }
        _ => "rocks with both cables taut".to_owned(),
    };
    let end = if to == run.end().t {
        ", to the end of the run"
    } else {
        ""
    };
    format!(
        "at height y = {y:.4}, {what}; this lasts {:.3}{end}",
        to - from
    )
}
