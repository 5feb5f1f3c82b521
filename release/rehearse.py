"""Rehearses a release, as far as one machine without a registry's password can.

    python3 release/rehearse.py --quick    what must agree: versions, metadata, licences, workflows
    python3 release/rehearse.py            the same, then the wheel: built, installed where there is no Rust, and tried

The second packages every crate, builds the wheel as it is published, which takes some ten minutes, and in a fresh
environment of Python runs the first page of the manual, the examples of the docstrings and the command.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MATURIN = "maturin>=1.15,<2"
#: A link that is right on the page of an index is a whole address.
LINK = re.compile(r"\]\((?!https?://|#)([^)]+)\)")


def main() -> None:
    problems = [
        problem for check in (versions, crates, package, metadata_texts, workflows, links) for problem in check()
    ]
    if problems:
        sys.exit("not ready to be released:\n  " + "\n  ".join(problems))
    run(sys.executable, "release/third_party.py", "--check")
    print("versions, metadata, licences and workflows agree")
    if "--quick" not in sys.argv:
        run(
            "cargo",
            "package",
            "--workspace",
            "--exclude",
            "snapload-python",
            "--no-verify",
            "--locked",
            "--allow-dirty",
        )
        run(sys.executable, "release/third_party.py")
        wheel()


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def run(*arguments: str | Path, **options: object) -> str:
    """Runs a command; what it says is shown if it fails."""
    options = {"cwd": ROOT, "text": True, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, **options}
    result = subprocess.run([str(word) for word in arguments], **options)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}\n{result.stdout}")
    return str(result.stdout)


def version() -> str:
    return tomllib.loads(read("Cargo.toml"))["workspace"]["package"]["version"]


def versions() -> Iterator[str]:
    """One version everywhere."""
    here = version()
    manifest = tomllib.loads(read("Cargo.toml"))
    for name, entry in manifest["workspace"]["dependencies"].items():
        if name.startswith("snapload") and entry.get("version") != here:
            yield f"Cargo.toml: {name} is required as {entry.get('version')}, but the version is {here}"
    places = {
        "CITATION.cff": rf"^version: {re.escape(here)}$",
        "docs/cite.md": rf"version = \{{{re.escape(here)}\}}",
        ".zenodo.json": rf'"version": "{re.escape(here)}"',
        "conda/recipe.yaml": rf'^  version: "{re.escape(here)}"$',
    }
    for name, pattern in places.items():
        if not re.search(pattern, read(name), re.MULTILINE):
            yield f"{name}: its version is not {here}"
    log = read("CHANGELOG.md")
    if "## [Unreleased]" not in log and f"## [{here}]" not in log:
        yield f"CHANGELOG.md: it has neither a section [Unreleased] nor one for {here}"
    dated = re.search(rf"^## \[{re.escape(here)}\] - (\d{{4}})-", log, re.MULTILINE)
    if dated and not re.search(rf"year    = \{{{dated[1]}\}}", read("docs/cite.md")):
        yield f"docs/cite.md: its year is not {dated[1]}, that of {here} in CHANGELOG.md"


def crates() -> Iterator[str]:
    """What the index of crates asks for."""
    about = json.loads(run("cargo", "metadata", "--format-version", "1", "--no-deps", "--locked", stderr=None))
    for crate in about["packages"]:
        if crate["publish"] == []:
            continue
        for key in ("description", "license", "keywords", "categories", "readme"):
            if not crate[key]:
                yield f"{crate['name']}: its Cargo.toml has no {key}"
        for text in ("LICENSE-MIT", "LICENSE-APACHE"):
            if not (Path(crate["manifest_path"]).parent / text).exists():
                yield f"{crate['name']}: {text} is not in its folder, so that its package would lack it"
        if len(crate["keywords"]) > 5:
            yield f"{crate['name']}: more than five keywords"


def package() -> Iterator[str]:
    """What the index of Python asks for."""
    project = tomllib.loads(read("pyproject.toml"))["project"]
    for key in ("description", "readme", "license", "license-files", "keywords", "classifiers", "scripts"):
        if not project.get(key):
            yield f"pyproject.toml: it has no {key}"


def metadata_texts() -> Iterator[str]:
    """Files that stand for the project in other places."""
    about = json.loads(read(".zenodo.json"))
    if about["title"] not in read("CITATION.cff"):
        yield ".zenodo.json and CITATION.cff have different titles"
    measured = {row.split("|")[3].strip() for row in read("README.md").splitlines() if row.count("|") == 8}
    for factor in re.findall(r"([\d.,]+) times", read("paper/paper.md")):
        if factor not in measured:
            yield f"paper/paper.md: {factor} times is not in the table in README.md"
    known = set(re.findall(r"^@\w+\{(.+?),", read("paper/paper.bib"), re.MULTILINE))
    for key in sorted(set(re.findall(r"@([a-z]+\d{4}[a-z]*)", read("paper/paper.md"))) - known):
        yield f"paper/paper.md: {key} is not in paper.bib"


def workflows() -> Iterator[str]:
    """That workflows run what is there."""
    for file in sorted((ROOT / ".github" / "workflows").glob("*.yml")):
        for path in re.findall(
            r"(?:python3?|bash) ((?:release|bench|python)/[\w/.-]+)", file.read_text(encoding="utf-8")
        ):
            if not (ROOT / path).exists():
                yield f"{file.name}: there is no {path}"


def links() -> Iterator[str]:
    """That the pages lead to files that are there."""
    for name in ("README.md", "RELEASING.md", "SECURITY.md", "CONTRIBUTING.md"):
        for link in LINK.findall(read(name)):
            if not (ROOT / link.split("#")[0]).exists():
                yield f"{name}: there is no {link}"


def wheel() -> None:
    """Builds the wheel and tries it where there is neither Rust nor these sources."""
    with tempfile.TemporaryDirectory(prefix="rehearsal-") as scratch:
        folder = Path(scratch)
        tools, venv = folder / "tools", folder / "fresh"
        run(sys.executable, "-m", "venv", tools)
        run(tools / "bin" / "python", "-m", "pip", "install", "--quiet", MATURIN)
        profile = os.environ.get("REHEARSAL_PROFILE", "dist")
        build = [tools / "bin" / "maturin", "build", "--locked", "--out", folder, "--profile", profile]
        print(run(*build).splitlines()[-1].strip())
        (built,) = folder.glob("*.whl")
        print(f"{built.name}, {built.stat().st_size / 1e6:.1f} MB")
        with zipfile.ZipFile(built) as contents:
            names = contents.namelist()
        for needed in ("LICENSE-THIRD-PARTY", "LICENSE-MIT", "entry_points.txt", "snapload/py.typed"):
            if not any(name.endswith(needed) for name in names):
                sys.exit(f"the wheel has no {needed}")
        if any("tests/" in name for name in names):
            sys.exit("the wheel contains the tests")
        run(sys.executable, "-m", "venv", venv)
        run(venv / "bin" / "python", "-m", "pip", "install", "--quiet", built, "pandas")
        environment = {"PATH": f"{venv / 'bin'}:/usr/bin:/bin", "HOME": scratch, "MPLBACKEND": "Agg"}
        if shutil.which("cargo", path=environment["PATH"]):
            print("cargo is in /usr/bin, so this does not show that the wheel works without it")
        test_wheel(folder, venv / "bin", environment)
    print("the wheel works")


def test_wheel(folder: Path, programs: Path, environment: dict[str, str]) -> None:
    """The first page of the manual, the examples, and the command, from the wheel."""
    work = folder / "work"
    work.mkdir()
    example = re.search(r"```python\n(import snapload\n.*?)```", read("docs/python.md"), re.DOTALL)
    assert example is not None
    (work / "first.py").write_text(example[1])
    run(programs / "python", "first.py", cwd=work, env=environment)
    examples = (
        "import doctest, importlib, pkgutil, snapload\n"
        "names = [m.name for m in pkgutil.iter_modules(snapload.__path__) if not m.name.startswith('__')]\n"
        "modules = [snapload, *(importlib.import_module(f'snapload.{name}') for name in names)]\n"
        "results = [doctest.testmod(module) for module in modules]\n"
        "assert not sum(result.failed for result in results)\n"
        "print(sum(result.attempted for result in results), 'examples pass')\n"
    )
    print(run(programs / "python", "-c", examples, cwd=work, env=environment).strip())
    for arguments in (["--version"], ["run"], ["critical"], ["sweep", "--vary", "e=0.5,0.9", "--out", "e.parquet"]):
        run(programs / "snapload", *arguments, cwd=work, env=environment)
    output = run(programs / "snapload", "run", cwd=work, env=environment)
    documented = re.search(r"```text\n(Case .*?)```", read("docs/start.md"), re.DOTALL)
    if documented is None or documented[1].split() != output.split():
        sys.exit(f"the command of the wheel does not print what docs/start.md shows:\n{output}")


if __name__ == "__main__":
    main()
