"""The JavaScript of `snapload explore`: what TypeScript and ESLint say of it."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools" / "page"


@pytest.fixture(scope="module")
def checkers() -> Path:
    """The folder of the checkers, at the versions of the lock file. They come from the network, once."""
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("there is no npm on the PATH, which brings the checkers")
    folder = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "page-tools"
    shutil.copytree(TOOLS, folder, dirs_exist_ok=True)
    if not (folder / "node_modules" / ".bin" / "tsc").exists():
        brought = subprocess.run([npm, "ci", "--silent"], cwd=folder, capture_output=True, text=True, timeout=300)
        if brought.returncode != 0:
            pytest.skip(f"npm brought no checkers: {brought.stderr.strip()[-200:]}")
    return folder


def quiet(command: list[str | Path]) -> None:
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout + result.stderr


def test_types_are_used_as_what_they_are(checkers):
    quiet([checkers / "node_modules" / ".bin" / "tsc", "--project", TOOLS / "tsconfig.json"])


def test_nothing_is_left_over(checkers):
    page = ROOT / "crates" / "snapload-explore" / "page"
    quiet([checkers / "node_modules" / ".bin" / "eslint", "--config", checkers / "eslint.config.mjs", page])
