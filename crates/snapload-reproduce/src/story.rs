//! A run told step by step, from its log of events.

use snapload::{TautSet, Trajectory};

/// Shorter stretches of a mode are told together as bouncing.
const SHORT: f64 = 0.02;

/// The sentences of the story, each with its time.
pub fn story(run: &Trajectory) -> Vec<(f64, String)> {
    let mut told: Vec<(f64, String)> = Vec::new();
    let mut bouncing: Option<(f64, usize)> = None;
    for mode in run.modes() {
        let long = mode.t_end - mode.t_start >= SHORT;
        let began = mode.t_start;
        if !long {
            let (since, times) = bouncing.unwrap_or((began, 0));
            bouncing = Some((since, times + usize::from(!mode.taut.is_empty())));
            continue;
        }
        if let Some((since, times)) = bouncing.take() {
            told.push((since, bounces(since, began, times)));
        }
        told.push((began, begins(run, mode.taut, began, mode.t_end)));
    }
    if let Some((since, times)) = bouncing {
        told.push((since, bounces(since, run.end().t, times)));
    }
    told
}

fn bounces(since: f64, until: f64, times: usize) -> String {
    let sliding = match times {
        0 => String::new(),
        1 => ", once with a cable taut for a moment".to_owned(),
        _ => format!(", {times} times with a cable taut for a moment"),
    };
    format!(
        "bounces in short flights until t = {until:.3}, {:.3} in all{sliding}",
        until - since
    )
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
    format!("{what}, from y = {y:.4} for {:.3}", to - from)
}
