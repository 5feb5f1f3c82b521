"""What a release takes is in order."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
import yaml
from conftest import ROOT

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def commands(jobs: dict) -> str:
    """Everything that the jobs run."""
    return "\n".join(step.get("run", "") for job in jobs.values() for step in job["steps"])


@pytest.mark.parametrize("file", WORKFLOWS, ids=lambda file: file.name)
def test_a_workflow_is_one(file: Path):
    workflow = yaml.safe_load(file.read_text(encoding="utf-8"))
    # YAML reads the key `on` as a flag.
    assert workflow["name"] and workflow[True] and workflow["permissions"]
    jobs = workflow["jobs"]
    for name, job in jobs.items():
        assert job["runs-on"] and job["steps"], name
        assert set(job.get("needs", [])) <= set(jobs) or job["needs"] in jobs, name
        for step in job["steps"]:
            assert ("uses" in step) != ("run" in step), (name, step)
            assert re.fullmatch(r"[\w.-]+/[\w./-]+@[\w./-]+", step.get("uses", "a/b@v1")), step
            for key in re.findall(r"\$\{\{ *matrix\.(\w+)", str(step)):
                matrix = job["strategy"]["matrix"]
                assert key in matrix or all(key in row for row in matrix["include"]), (name, key)


def test_workflows_run_existing_files():
    profiles = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["profile"]
    crates = {path.parent.name for path in ROOT.glob("crates/*/Cargo.toml")} | {"snapload-python"}
    for file in WORKFLOWS:
        run = commands(yaml.safe_load(file.read_text(encoding="utf-8"))["jobs"])
        for profile in re.findall(r"--profile (\S+)", run):
            assert profile in profiles
        for crate in re.findall(r"(?:-p|--exclude) (\S+)", run):
            assert crate in crates
        for script in re.findall(r"(?:\./|python3 )(\S+\.(?:sh|py))", run):
            assert (ROOT / script).is_file(), script


def test_recipe_and_site_are_read():
    recipe = yaml.safe_load((ROOT / "conda" / "recipe.yaml").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    required = {
        re.split(r"[ >=<]", line)[0].replace("matplotlib-base", "matplotlib") for line in recipe["requirements"]["run"]
    }
    assert required - {"python"} == {re.split(r"[ >=<]", line)[0] for line in project["dependencies"]}
    site = yaml.safe_load((ROOT / ".readthedocs.yaml").read_text(encoding="utf-8"))
    assert (ROOT / site["sphinx"]["configuration"]).is_file()
