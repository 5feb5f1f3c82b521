//! How long an impact takes, alone and with company: `cargo bench -p snapload`.
//!
//! Throughput is counted in impacts where one run is timed and in cases where a sweep is; criterion
//! prints both as elements a second.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use rayon::ThreadPoolBuilder;
use snapload::analysis::{Certainty, Counter, Uncertainty, no_progress, outcomes, trusted_run};
use snapload::{Case, Lanes, Parameters, Trajectory, named_case};
use std::hint::black_box;
use std::thread::available_parallelism;
use std::time::Duration;

/// The standard sweep: force amplitudes 0.01 to 0.31, as many as here.
const SWEEP: u32 = 20_000;

fn case(parameters: Parameters) -> Case {
    Case::new(parameters).expect("the cases of the benchmark are legal")
}

/// A built-in case, as it is run.
fn named(code: &str) -> Case {
    case(named_case(code).expect("a built-in case").parameters)
}

fn sweep() -> Vec<Case> {
    let f_o = |k| 0.01 + 0.30 * f64::from(k) / f64::from(SWEEP - 1);
    (0..SWEEP)
        .map(|k| {
            case(Parameters {
                f_o: f_o(k),
                ..Parameters::STANDARD
            })
        })
        .collect()
}

/// A run to its end, as nothing but impacts and an end.
fn impacts_of(case: &Case) -> usize {
    let mut simulation = case.simulation();
    let mut impacts = 0;
    while let Some(step) = simulation.step() {
        impacts += step.impacts().count();
    }
    impacts
}

fn one_run(c: &mut Criterion) {
    let cases = [
        ("standard", named("1910001000-359")),
        ("rocking", named("rocking-example")),
    ];
    let mut group = c.benchmark_group("impact");
    for (name, case) in cases {
        let impacts = case.run().impacts().len() as u64;
        group.throughput(Throughput::Elements(impacts));
        group.bench_function(format!("{name}/stepped"), |b| {
            b.iter(|| impacts_of(black_box(&case)));
        });
        group.bench_function(format!("{name}/kept"), |b| {
            b.iter_batched(
                || case.simulation(),
                Trajectory::record,
                BatchSize::SmallInput,
            );
        });
        group.bench_function(format!("{name}/trusted"), |b| {
            b.iter(|| trusted_run(black_box(&case), &Uncertainty::default(), &no_progress));
        });
    }
    group.finish();
}

/// Cases a second, by lanes on one thread, and by the best lanes on all.
fn many_runs(c: &mut Criterion) {
    let cases = sweep();
    let mut group = c.benchmark_group("sweep");
    group.throughput(Throughput::Elements(u64::from(SWEEP)));
    group.sample_size(10);
    for lanes in Lanes::available() {
        group.bench_function(format!("{lanes:?}"), |b| {
            b.iter(|| lanes.outcomes(black_box(&cases)));
        });
    }
    let all = available_parallelism().map_or(1, usize::from);
    for threads in [1, all] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.expect("threads can be started");
        group.bench_function(format!("{:?}/threads-{threads}", Lanes::best()), |b| {
            b.iter(|| pool.install(|| outcomes(black_box(&cases), &no_progress)));
        });
    }
    for lanes in Lanes::available() {
        group.bench_function(format!("{lanes:?}/with-certainty"), |b| {
            let counter = Counter::new("running", 0, u64::from(SWEEP), &no_progress);
            b.iter(|| {
                let cases = black_box(&cases).iter().cloned();
                Certainty::with_outcomes(lanes, cases, &counter)
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().measurement_time(Duration::from_secs(3));
    targets = one_run, many_runs
}
criterion_main!(benches);
