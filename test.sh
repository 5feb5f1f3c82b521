#!/usr/bin/env bash
# Everything that must hold: formatting, lints, documentation and all tests, those of the Python package and the
# manual among them. Needs a Rust toolchain (https://rustup.rs) and Python 3.11 or later; adds rustfmt and clippy where
# they are missing, and by apt-get Chromium, in which pages are opened, and Python's venv, where there are none.
set -euo pipefail
cd "$(dirname "$0")"
if ! command -v cargo >/dev/null; then
  echo "test.sh: no cargo on the PATH; install Rust from https://rustup.rs first" >&2
  exit 1
fi
if ! python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
  echo "test.sh: no python3 on the PATH, or one before 3.11; install it first" >&2
  exit 1
fi
cargo fmt --version >/dev/null 2>&1 || rustup component add rustfmt
cargo clippy --version >/dev/null 2>&1 || rustup component add clippy

missing=()
# Its headless shell is Chromium without windows of its own, and quicker; not every system has it as a package.
browser=chromium-headless-shell
command -v $browser >/dev/null || command -v chromium >/dev/null || missing+=("$browser")
python3 -c 'import ensurepip' 2>/dev/null || missing+=(python3-venv)
if [ ${#missing[@]} -gt 0 ]; then
  as_root=""
  [ "$(id -u)" -eq 0 ] || as_root="sudo"
  $as_root apt-get update -qq
  apt-cache show $browser >/dev/null 2>&1 || missing=("${missing[@]/#$browser/chromium}")
  echo "test.sh: installing ${missing[*]}"
  $as_root apt-get install -y -qq "${missing[@]}" >/dev/null
fi

# Python's packages come while Rust is compiled; the exact versions are pinned.
target=${CARGO_TARGET_DIR:-target}
python=$target/venv/bin/python
mkdir -p "$target"
(
  [ -x "$python" ] || python3 -m venv "$target/venv"
  cmp -s python/requirements.txt "$target/venv/installed.txt" || {
    "$python" -m pip install --quiet --disable-pip-version-check --requirement python/requirements.txt
    cp python/requirements.txt "$target/venv/installed.txt"
  }
) &
installing=$!
trap 'kill "$installing" 2>/dev/null || true' EXIT

cargo fmt --all --check
cargo clippy --workspace --all-targets --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --document-private-items --locked --quiet
# The extension module is built along with the tests, so that it shares what they compile.
cargo build --workspace --lib --bins --tests --locked
python3 release/rehearse.py --quick

wait "$installing"
cp -f "$target/debug/lib_engine.so" python/snapload/_engine.abi3.so
export PYTHONPATH=$PWD/python PYTHONDONTWRITEBYTECODE=1
"$python" -m ruff check python docs/conf.py release
"$python" -m ruff format --check python docs/conf.py release
# The manual runs its notebooks beside the tests; what it says, it says at the end.
"$python" -m sphinx -E -W --keep-going -q -b html docs "$target/manual" -d "$target/manual-doctrees" \
  >"$target/manual.log" 2>&1 &
manual=$!
trap 'kill "$manual" 2>/dev/null || true' EXIT
cargo test --workspace --locked
"$python" -m pytest --numprocesses 2 --dist loadfile
wait "$manual" || {
  cat "$target/manual.log"
  exit 1
}
