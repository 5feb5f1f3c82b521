//! The standard sweep: 20,000 cases, f_o = 0.01 to 0.31, otherwise standard, each to its end.
//!
//! `cargo bench -p snapload [-- CASES [ROUNDS]] [KIND]` tells cases a second and nanoseconds an impact for every kind
//! of lanes that the processor has, on one thread and on all. The best of several rounds is told, the kinds
//! taking turns, as others may use the machine.

use snapload::analysis::Outcome;
use snapload::{Case, CaseError, Lanes, Parameters, Usage};
use std::time::Instant;

fn main() -> Result<(), CaseError> {
    let mut numbers = std::env::args().filter_map(|argument| argument.parse::<u32>().ok());
    let count = numbers.next().unwrap_or(20_000).max(2);
    let rounds = numbers.next().unwrap_or(5);
    let force = |k: u32| 0.01 + 0.3 * f64::from(k) / f64::from(count - 1);
    let cases = (0..count).map(|k| {
        Case::new(Parameters {
            f_o: force(k),
            ..Parameters::STANDARD
        })
    });
    let cases: Vec<Case> = cases.collect::<Result<_, _>>()?;
    let impacts: u64 = Outcome::of_many(&cases).iter().map(|o| o.impacts).sum();
    println!("{count} cases, {impacts} impacts");

    let named = |lanes: &Lanes| std::env::args().any(|argument| argument == format!("{lanes:?}"));
    let mut kinds = Lanes::available();
    if kinds.iter().any(named) {
        kinds.retain(named);
    }
    let mut best = vec![(f64::INFINITY, Usage::default()); kinds.len() + 1];
    for _ in 0..rounds {
        for (k, &lanes) in kinds.iter().enumerate() {
            let start = Instant::now();
            let usage = Outcome::side_by_side(&cases, lanes).1;
            best[k].1 = usage;
            best[k].0 = best[k].0.min(start.elapsed().as_secs_f64());
        }
        let start = Instant::now();
        Outcome::of_many(&cases);
        let all = best.len() - 1;
        best[all].0 = best[all].0.min(start.elapsed().as_secs_f64());
    }
    let speed = |seconds: f64| {
        let cases = f64::from(count) / seconds;
        let nanoseconds = seconds * 1e9 / impacts as f64;
        format!("{cases:8.0} cases/s {nanoseconds:6.1} ns an impact")
    };
    for (lanes, (seconds, usage)) in kinds.iter().zip(&best) {
        let name = format!("{lanes:?}");
        let used = usage.bounces as f64 / (usage.rounds * usage.width as u64) as f64;
        let apart = usage.steps_apart as f64 / f64::from(count);
        println!(
            "{name:>12}: {} lanes used {used:.3}, steps apart a case {apart:.2}",
            speed(*seconds)
        );
    }
    println!("{:>12}: {}", "all threads", speed(best[kinds.len()].0));
    Ok(())
}
