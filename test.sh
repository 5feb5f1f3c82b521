#!/usr/bin/env bash
# Everything that must hold: formatting, lints, documentation and all tests.
# Needs a Rust toolchain (https://rustup.rs); adds its rustfmt and clippy where they are missing, and
# installs Chromium by apt-get, in which the report is opened, where there is none.
set -euo pipefail
cd "$(dirname "$0")"
if ! command -v cargo >/dev/null; then
  echo "test.sh: no cargo on the PATH; install Rust from https://rustup.rs first" >&2
  exit 1
fi
cargo fmt --version >/dev/null 2>&1 || rustup component add rustfmt
cargo clippy --version >/dev/null 2>&1 || rustup component add clippy

if ! command -v chromium >/dev/null; then
  echo "test.sh: installing chromium for the tests of the report"
  as_root=""
  [ "$(id -u)" -eq 0 ] || as_root="sudo"
  $as_root apt-get update -qq
  $as_root apt-get install -y -qq chromium >/dev/null
fi

cargo fmt --all --check
cargo clippy --workspace --all-targets --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --document-private-items --locked --quiet
cargo test --workspace --locked
