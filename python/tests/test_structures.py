"""Structures in Python are what the command says of them."""

import copy
import pickle
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import snapload
import xarray
from snapload._structure_datasets import COLUMNS, rows_dataset

ROOT = Path(__file__).parents[2]
CYLINDER = ROOT / "docs" / "examples" / "cylinder.toml"
PONTOON = CYLINDER.with_name("pontoon.toml")
#: Quotation marks, backslashes, control characters, and characters of more than 16 bits.
AWKWARD = 'Pier "A" \\ east\tof\nthe a\\tb \x00\x07\x1b\x7f\x85 \u2028 \U0001f30a'


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
    assert data.standing == expected["standing"] in repr(data)


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


def test_results_without_rows_have_the_columns_of_those_with_rows() -> None:
    structure = snapload.Structure.example().replace({"run.duration": 70})
    sea = {"sea.hs": 2, "sea.tp": 6, "run.transient": 20}
    checked, still = structure.replace({"design.least_share": 0}), structure.without("wave")
    assert still.assess(neighbours=0).data["snaps"] == structure.assess(neighbours=0).data["checks"] == []
    seas = [each.without("wave").replace(sea).seas(seeds=2) for each in (checked, structure)]
    elastic = [each.elastic() for each in (checked, structure)]
    pairs = [
        (checked.assess(neighbours=2).snaps, still.assess(neighbours=0).snaps),
        (checked.assess(neighbours=2).checks, structure.assess(neighbours=2).checks),
        (seas[0].checks, seas[1].checks),
        (elastic[0].checks, elastic[1].checks),
        (elastic[0].pulls, rows_dataset([], "pull", COLUMNS["pulls"])),
    ]
    for some, none in pairs:
        (along,) = some.dims
        assert some.sizes[along] > 0 and none.sizes == {along: 0}
        assert {name: (values.dtype.kind, values.attrs) for name, values in none.items()} == {
            name: (values.dtype.kind, values.attrs) for name, values in some.items()
        }


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


def copies(thing: Any) -> list[Any]:
    return [pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing), copy.copy(thing)]


def test_files_lie_beside_the_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command_json: Callable[..., Any]
) -> None:
    # In the working directory lies another file of that name, of a body that radiates less.
    with xarray.open_dataset(PONTOON.with_name("pontoon-10m.nc")) as dataset:
        less = dataset.assign(radiation_damping=0.97 * dataset["radiation_damping"])
        less.to_netcdf(tmp_path / "pontoon-10m.nc")
    monkeypatch.chdir(tmp_path)
    short = {"run.duration": 90, "run.transient": 30}
    sets = [f"--set={key}={value}" for key, value in short.items()]
    structure = snapload.Structure.from_toml(PONTOON, short)
    expected = command_json("assess", str(PONTOON), *sets, "--neighbours", "0")
    answer = structure.assess(neighbours=0)
    assert answer.data == expected
    same = [*copies(structure), structure.replace({"run.duration": 90}), structure.without("project")]
    assert all(other == structure and hash(other) == hash(structure) for other in same)
    for one in (same[0], same[-1]):
        assert one.assess(neighbours=0).data == expected
    # A text has only the working directory.
    other = snapload.Structure.parse(PONTOON.read_text(), short, name=str(PONTOON))
    assert other != structure and other.assess(neighbours=0).data != expected
    # That of the time when it was parsed, and for a relative path, too.
    case = Path(shutil.copy(PONTOON, tmp_path / "case.toml")).name
    relative = snapload.Structure.from_toml(case, short)
    monkeypatch.chdir(ROOT)
    assert other.replace(short) == other == relative.replace(short) == copies(relative)[0]
    with pytest.raises(ValueError, match=r"float\.file"):
        snapload.Structure.parse(PONTOON.read_text())


def test_texts_are_written_as_they_are() -> None:
    example = snapload.Structure.example()
    for name in (AWKWARD, "true", "3", " [1, 2] ", "2026-05-04", "O'Brien", "'quoted'", '"quoted"', ""):
        named = example.replace({"project.name": name, "project.client": "a"})
        text = named.to_toml()
        assert tomllib.loads(text)["project"] == {"name": name, "client": "a"}
        assert snapload.Structure.parse(text) == named != example
        assert named.without("project") == example


def test_tables_are_removed_whole() -> None:
    # A text that looks like a heading does not end a table.
    example = snapload.Structure.example().replace({"project.name": "x\n[wave]\n[sea]\n"})
    still = tomllib.loads(example.without("wave").to_toml())
    assert "wave" not in still and still["project"]["name"] == "x\n[wave]\n[sea]\n"
    assert tomllib.loads(example.without("design").to_toml()) == tomllib.loads(example.to_toml())


def test_motion_is_only_that_of_the_run() -> None:
    answer = snapload.Structure.example().replace({"wave.height": 3}).assess(neighbours=0)
    end = answer.data["end"]["t_s"]
    assert end < 95
    assert answer.motion([0, 90, end])["t_s"].values.tolist() == [0, 90, end]
    for outside in (95, 600, -1, np.nextafter(end, 1e9)):
        with pytest.raises(ValueError, match=rf"times = .* is not allowed; allowed: 0 to {end} s, the end of the run"):
            answer.motion([90, outside])
    nothing = answer.motion([])
    assert dict(nothing.sizes) == {"t_s": 0, "line": 2} and nothing["line"].values.tolist() == [1, 2]
    with pytest.raises(ValueError, match="times = an array with 1 masked value is not allowed"):
        answer.motion(np.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0]))
    for wrong in ([np.nan], [np.inf], 1.0):
        with pytest.raises(ValueError, match="one row of finite numbers"):
            answer.motion(wrong)


def test_structures_and_results_compare_copy_and_pickle() -> None:
    structure = snapload.Structure.example().replace({"run.duration": 70})
    assert structure == snapload.Structure.example().replace({"run.duration": 70.0})
    assert structure != snapload.Structure.example() and structure != 1
    sea = structure.without("wave").replace({"sea.hs": 2, "sea.tp": 6, "run.duration": 90, "run.transient": 20})
    results = [structure.assess(neighbours=1), structure.elastic(every=0.1), sea.seas(seeds=2)]
    for thing in (structure, *results):
        for other in copies(thing):
            assert other == thing and not other != thing
            assert repr(other) == repr(thing) and str(other) == str(thing)
    assert structure.assess(neighbours=1) == results[0] != structure.assess(neighbours=0)
    # Only the time that it took differs.
    assert structure.elastic(every=0.1) == results[1] != structure.elastic(every=0.2)
    assert sea.seas(seeds=2) == results[2] != sea.seas(seeds=3)


def test_copies_of_results_have_motion_and_page(tmp_path: Path) -> None:
    structure = snapload.Structure.example().replace({"run.duration": 70})
    assessed, elastic = structure.assess(neighbours=1), structure.elastic(every=0.1)
    far_assessed, far_elastic = pickle.loads(pickle.dumps((assessed, elastic)))
    assert far_assessed.motion([1, 65]).identical(assessed.motion([1, 65]))
    assert far_elastic.motion.identical(elastic.motion)
    for name, answer in (("near", assessed), ("far", far_assessed)):
        answer.to_html(tmp_path / name)
    assert (tmp_path / "far").read_bytes() == (tmp_path / "near").read_bytes()
    # Data that are not those of the structure are not given another motion.
    altered = copy.deepcopy(assessed)
    altered.data["verdict"]["words"] = "holds"
    with pytest.raises(ValueError, match="run the structure again"):
        altered.motion([1])
