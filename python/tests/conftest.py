"""Fixtures that several tests share."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib
import pytest

pytest.register_assert_rewrite("explore")
from explore import (  # noqa: E402, F401  (fixtures)
    browser,
    code,
    open_at,
    open_page,
    open_structure,
    serve,
    structure_url,
    url,
    windows,
)

ROOT = Path(__file__).resolve().parents[2]

matplotlib.use("Agg")


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """The command line, built by `cargo test`: takes arguments, returns standard output."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    program = target / "debug" / "snapload"
    assert program.is_file(), f"{program} is not there; run cargo build -p snapload-cli first"

    def run(*args: str, fails: bool = False) -> str:
        result = subprocess.run([program, *args], capture_output=True, text=True)
        assert (result.returncode != 0) == fails, result.stderr
        return result.stderr if fails else result.stdout

    return run


@pytest.fixture(scope="session")
def command_json(command: Callable[..., str]) -> Callable[..., Any]:
    """The same, with its JSON output."""
    return lambda *args: json.loads(command(*args, "--json", "-"))


@pytest.fixture(autouse=True)
def no_figures_left() -> Iterator[None]:
    """Closes the figures of a test."""
    yield
    from matplotlib import pyplot

    pyplot.close("all")
