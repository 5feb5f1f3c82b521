//! The standard case in snapload; with the argument `truth`, the same with 76 digits.

use snapload::{Case, Impact, Parameters, Precise, Real};
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

const REPEATS: usize = 200;

fn row<T: Real>(impact: &Impact<T>) -> (f64, usize, f64) {
    (impact.t.to_f64(), impact.cable + 1, impact.v_n.to_f64())
}

fn main() -> Result<(), Box<dyn Error>> {
    let case = Case::new(Parameters::STANDARD)?;
    let (rows, kind, t, seconds) = if std::env::args().nth(1).as_deref() == Some("truth") {
        let exact = case.simulation_over(|_, number| Precise::<4>::from_decimal(number));
        let mut simulation = exact.map_err(|error| format!("{error:?}"))?;
        let mut rows = Vec::new();
        while let Some(step) = simulation.step() {
            rows.extend(step.impacts().map(|impact| row(&impact)));
        }
        let stop = simulation.stop().ok_or("the exact run does not stop")?;
        (rows, stop, simulation.time().to_f64(), None)
    } else {
        let run = case.run();
        let mut best = f64::INFINITY;
        for _ in 0..REPEATS {
            let begin = Instant::now();
            black_box(black_box(&case).run());
            best = best.min(begin.elapsed().as_secs_f64());
        }
        let rows = run.impacts().iter().map(row).collect();
        (rows, run.end().reason, run.end().t, Some(best))
    };
    let report = serde_json::json!({
        "version": "0.3.0",
        "impacts": rows,
        "end": { "kind": kind.name(), "t": t },
        "seconds": seconds,
    });
    println!("{report}");
    Ok(())
}
