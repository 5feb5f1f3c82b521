//! How long the command takes to start and print: `cargo bench -p snapload-cli`. The aim is 20 ms.

use criterion::{Criterion, criterion_group, criterion_main};
use std::process::{Command, Stdio};

fn start_up(c: &mut Criterion) {
    c.bench_function("start-up/keys", |b| {
        b.iter(|| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_snapload"));
            let status = command.arg("keys").stdout(Stdio::null()).status();
            assert!(status.is_ok_and(|status| status.success()));
        });
    });
}

criterion_group!(benches, start_up);
criterion_main!(benches);
