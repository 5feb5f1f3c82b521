"""Structures in Python are what the command says of them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import snapload

ROOT = Path(__file__).parents[2]
CYLINDER = ROOT / "docs" / "examples" / "cylinder.toml"


def test_answers_are_those_of_the_command(command_json: Callable[..., Any]) -> None:
    changes = {"run.duration": 90, "line.2.length": 6.05, "wave.direction": "-x", "run.start": [0.1, -3.9]}
    sets = [f"--set={key}={snapload._structure._toml_value(value)}" for key, value in changes.items()]
    structure = snapload.Structure.from_toml(CYLINDER, changes)
    expected = command_json("assess", str(CYLINDER), *sets, "--neighbours", "2")
    assert structure.assess(neighbours=2).data == expected
    expected = command_json("elastic", str(CYLINDER), *sets)
    data = structure.elastic().data
    for each in (expected, data):
        del each["took_s"], each["inextensible"]["took_s"]
    assert data == expected


def test_seas_are_those_of_the_command(command_json: Callable[..., Any]) -> None:
    sea = ROOT / "docs" / "examples" / "cylinder-sea.toml"
    expected = command_json("seas", str(sea), "--set", "run.duration=330", "--seeds", "3", "--elastic")
    data = snapload.Structure.from_toml(sea, {"run.duration": 330}).seas(seeds=3, elastic=True)
    assert data.data == expected
    assert data.largest_tensions_n.values.tolist() == expected["largest_tensions_n"]


def test_motion_and_snaps_have_units() -> None:
    answer = snapload.Structure.example().assess(neighbours=0)
    motion = answer.motion(np.linspace(0, 600, 2001))
    assert motion["x_m"].attrs["units"] == "m" and motion["tension_n"].attrs["units"] == "N"
    # A line carries at most what it is said to hold, after the transient.
    late = motion.sel(t_s=slice(60, None))["tension_n"].max("t_s")
    assert (late.values <= answer.lines["held_tension_n"].values * (1 + 1e-9)).all()
    snaps = answer.snaps
    assert snaps["peak_n"].attrs["units"] == "N" and set(np.unique(snaps["line"])) == {1, 2}
    pint = pytest.importorskip("cf_xarray.units").units
    for data in (motion, snaps, answer.lines):
        for variable in data.variables.values():
            pint.Unit(variable.attrs.get("units", "1"))


def test_what_is_not_judged_has_no_numbers() -> None:
    answer = snapload.Structure.example().replace({"wave.height": 12}).assess(neighbours=0)
    assert answer.standing == "exceeds" and "before 60 s, the start of the judged time" in answer.verdict
    for name in ("snaps", "fastest_snap_m_s", "held_tension_n", "slack_fraction", "utilisation"):
        assert np.isnan(answer.lines[name].values.astype(float)).all(), name


def test_moordyn_goes_both_ways(tmp_path: Path) -> None:
    structure = snapload.Structure.example()
    structure.to_moordyn(tmp_path / "lines.txt")
    back = snapload.Structure.from_moordyn(tmp_path / "lines.txt")
    assert back.assess(neighbours=0).standing == structure.assess(neighbours=0).standing


def test_errors_name_the_key() -> None:
    structure = snapload.Structure.example()
    with pytest.raises(ValueError, match=r"body\.mass"):
        structure.replace({"body.mass": 1e9})
    # Nobody has written --set here.
    with pytest.raises(ValueError, match=r"^there is no key \"wave.heigth\".*did you mean height\?"):
        structure.replace({"wave.heigth": 2})
    with pytest.raises(TypeError, match="a number, a text"):
        structure.replace({"body.mass": object()})
    message = "table = 'body' is not allowed; allowed: one of wave, sea, design, project"
    with pytest.raises(ValueError, match=message):
        structure.without("body")
    with pytest.raises(FileNotFoundError):
        snapload.Structure.from_toml("nothing.toml")
