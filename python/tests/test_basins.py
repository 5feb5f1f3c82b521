"""Safe basins, erosion and basins of attraction against an independent program, and the command's files."""

from __future__ import annotations

import json
import math

import numpy as np
import pandas
import pytest
import snapload
import xarray
from conftest import ROOT

REFERENCE = json.loads((ROOT / "crates/snapload-orbits/tests/data/orbits.json").read_text(encoding="utf-8"))
#: What the reference writes for how a run ends.
ENDS = {"s": "settled", "t": "end_time", "R": "rotation_limit", "U": "upper_bound"}
STATE = ["x", "y", "theta", "vx", "vy", "vtheta"]
WINDOW = dict(x="-0.2:0.2:9", y="0.04:0.6:8")
POINT_MASS = dict(body="point", r=1.3, e=0.7, nu=1.2, omega=4, f_o=0.67)


def set_options(case: dict) -> list[str]:
    return [f"--set={key}={value}" for key, value in case.items()]


@pytest.mark.parametrize("name", ["circle_xy_f0.1", "circle_yvy_f0.3", "circle_f_omega"])
def test_a_basin_is_that_of_the_reference_cell_by_cell(name):
    grid = REFERENCE["grids"][name]
    case = snapload.Case(t_end=grid["t_end"], **{key: float(value) for key, value in grid["base"].items()})
    window = {key: snapload.evenly(first, last, count) for key, first, last, count in grid["axes"]}
    basin = snapload.safe_basin(case, progress=False, **window)
    outcomes, known = basin.outcome.values, np.array([list(row) for row in grid["rows"]])
    decided, ends = basin.decided.values, np.vectorize(lambda sign: ENDS.get(sign, ""))(known)
    safe = np.isin(known, ["s", "t"])
    assert (basin.safe.values == safe)[decided & (ends != "")].all()
    # How a decided cell ends may differ within rounding of the time at which it settles.
    assert (outcomes == ends)[decided & (ends != "")].mean() > 0.97
    # A start whose cable is exactly taut is legal here, and was not in the reference.
    edge = (known == ".") & basin.legal.values
    assert edge.sum() <= 4 and basin.attrs["legal"] - edge.sum() == grid["legal"]
    low, high = grid["wilson95"]
    assert low < basin.attrs["gim"] < high
    np.testing.assert_allclose(basin.attrs["interval95"], [low, high], atol=0.003)
    for ours, theirs in (("lim", "LIM"), ("if", "IF")):
        if grid[theirs] is not None:
            # Good to one cell.
            assert basin.attrs[ours] == pytest.approx(grid[theirs], abs=1.5 * basin.attrs["cell"].max()), ours
    cells = {"legal": basin.legal, "safe": basin.safe, "undecided": ~basin.decided & basin.legal}
    assert {name: int(which.sum()) for name, which in cells.items()} == {name: basin.attrs[name] for name in cells}


def test_the_cells_are_those_of_the_command(command_json, tmp_path):
    out = tmp_path / "basin.csv"
    vary_options = [f"--vary={key}={values}" for key, values in WINDOW.items()]
    data = command_json("basin", "--set", "t_end=30", *vary_options, "--out", str(out))
    basin = snapload.safe_basin(snapload.Case(t_end=30), **WINDOW)
    for key in ("legal", "safe", "fraction", "undecided", "past_horizon", "gim", "lim", "if"):
        assert basin.attrs[key] == data[key], key
    assert basin.attrs["interval95"].tolist() == data["interval95"] and math.isnan(basin.attrs["iim"])
    assert basin.attrs["cell"].tolist() == list(data["cell"].values())
    frame = pandas.read_csv(out)
    assert np.repeat(basin.x.values, 8).tolist() == frame.x.tolist()
    assert basin.outcome.values.ravel().tolist() == frame.outcome.fillna("").tolist()
    np.testing.assert_array_equal(basin.t.values.ravel(), frame.t)
    legal = basin.legal.values.ravel()
    assert basin.decided.values.ravel()[legal].tolist() == frame.decided[legal].tolist()
    assert frame.decided[~legal].isna().all()
    assert basin.trusted.values.ravel()[legal].tolist() == frame.trusted[legal].tolist()
    meanings = dict(zip(basin.outcome_code.flag_values, basin.outcome_code.flag_meanings.split(), strict=True))
    assert [meanings[code].replace("not_legal", "") for code in basin.outcome_code.values.ravel()] == (
        basin.outcome.values.ravel().tolist()
    )
    # The same as a study, where the start can be.
    study = snapload.sweep(snapload.Case(t_end=30), **WINDOW)
    assert (study.end.values == basin.outcome.values).all()


def test_a_basin_goes_to_a_file_and_back(tmp_path):
    basin = snapload.safe_basin(snapload.Case(t_end=20), trust=False, **WINDOW)
    assert "decided" not in basin and math.isnan(basin.attrs["undecided"])
    basin.to_netcdf(tmp_path / "basin.nc")
    with xarray.open_dataset(tmp_path / "basin.nc") as read:
        assert (read.outcome.values == basin.outcome.values).all() and read.attrs["if"] == basin.attrs["if"]


def test_erosion_is_that_of_the_reference_and_of_the_command(command_json):
    curve = REFERENCE["curves"]["circle_xy"]
    case = snapload.Case(t_end=curve["t_end"], **{key: float(value) for key, value in curve["base"].items()})
    window = {key: snapload.evenly(first, last, count) for key, first, last, count in curve["axes"]}
    values = [point["f_o"] for point in curve["points"]][::3]
    eroded = snapload.erosion(case, over={"f_o": values}, trust=False, progress=False, **window)
    assert "knee_between" not in eroded.attrs
    for place, point in enumerate(curve["points"][::3]):
        low, high = point["wilson95"]
        assert low <= float(eroded.gim[place]) <= high
        assert float(eroded.lim[place]) == pytest.approx(point["LIM"], abs=0.026)
        assert float(eroded["if"][place]) == pytest.approx(point["IF"], abs=0.026)
    axes = [f"--vary={key}={values}" for key, values in WINDOW.items()]
    data = command_json("erosion", "--set", "t_end=20", *axes, "--over", "f_o=0:0.6:4")
    eroded = snapload.erosion(snapload.Case(t_end=20), over={"f_o": "0:0.6:4"}, **WINDOW)
    for name in ("gim", "lim", "if", "legal", "safe", "undecided", "decided_fraction"):
        assert eroded[name].values.tolist() == [point[name] for point in data["points"]], name
    assert eroded.low.values.tolist() == [point["interval95"][0] for point in data["points"]]
    assert eroded.f_o.values.tolist() == [0.0, 0.2, 0.4, 0.6] and eroded.attrs["knee"] == data["knee"]
    assert eroded.attrs["knee_between"] == pytest.approx(
        [np.nan if knee is None else knee for knee in data["knee_between"]], nan_ok=True
    )
    assert np.isnan(eroded.iim).all()


def test_attractors_are_those_of_the_command(command_json):
    window = dict(x="-0.2:0.2:7", y="0.1:0.5:5")
    vary_options = [f"--vary={key}={values}" for key, values in window.items()]
    data = command_json("basin", *set_options(POINT_MASS), *vary_options, "--kind", "attractor", "--transient", "100")
    labels, attractors = snapload.basins_of_attraction(snapload.Case(**POINT_MASS), transient=100, **window)
    # Rest in the corner, as f_o is below f_c, and an orbit of three snaps: section 4.5 of the reference.
    assert attractors[1].stable == "superstable" and attractors[1].symbol == ()
    assert [orbit.symbol for orbit in attractors.values() if len(orbit.symbol) == 3] == [("2", "1", "1")]
    for row in data["attractors"]:
        number = row["attractor"]
        assert int((labels == number).sum()) == row["cells"] == labels.attrs["cells"][number - 1]
        assert attractors[number].state.tolist() == row["orbit"]["section"]["state"]
    assert int((labels != -1).sum()) == data["legal"] == labels.attrs["legal"]
    # A start comes to the orbit of its label.
    row, column = np.argwhere(labels.values == 2)[0]
    start = snapload.Case(**POINT_MASS).replace(x=float(labels.x[row]), y=float(labels.y[column]))
    last = snapload.section(start, periods=200, keep=1).isel(k=-1)
    np.testing.assert_allclose([float(last[name]) for name in STATE], attractors[2].state, atol=1e-6)
    assert labels.attrs["flag_meanings"].split()[-2:] == [
        f"attractor_{n}" for n in (len(attractors) - 1, len(attractors))
    ]
    tumbling, none = snapload.basins_of_attraction(snapload.Case(f_o=0.6), x="-0.1:0.1:3", y=[0.3], transient=20)
    stops = dict(zip(tumbling.flag_values, tumbling.flag_meanings.split(), strict=True))
    assert {stops[label] for label in tumbling.values.ravel()} == {"rotation_limit"} and none == {}


def test_a_map_of_attractors_does_not_say_that_a_motion_has_no_period():
    attrs = {"flag_values": np.array([-1, 0, 1]), "flag_meanings": "not_legal aperiodic attractor_1"}
    labels = xarray.DataArray([[0, 1], [1, -1]], {"x": [0.0, 0.1], "y": [0.2, 0.3]}, ("x", "y"), attrs=attrs)
    legend = snapload.plot_basin(labels).get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["attractor 1", "no period found"]


@pytest.mark.parametrize(
    ("window", "message"),
    [
        (dict(x="0:1:3"), "keys = x is not allowed; allowed: two keys with their values"),
        (dict(x="0:1", y="0:1:3"), "three numbers"),
        (dict(x="0:1:3", e="0:2:3"), "e = 2 is not allowed"),
        (dict(x="0:1:3", body=["rigid", "point"]), 'axis = "body" is not allowed; allowed: one of r, e, a, b'),
        (dict(x=[0, 0.1, 0.3], y="0:1:3"), r"x = \[0\.0, 0\.1, 0\.3\] is not allowed; allowed: evenly spaced"),
        (dict(x="0:1:100000", y="0:1:100000"), "at most 100000000 cells"),
        (dict(x="0:1:2000000", y="0:1:3"), "x: at most 1000000 values"),
    ],
)
def test_invalid_windows_are_refused(window, message):
    with pytest.raises(ValueError, match=message):
        snapload.safe_basin(snapload.Case(), **window)
    with pytest.raises(ValueError, match=message):
        snapload.basins_of_attraction(snapload.Case(), **window)


def test_other_invalid_arguments_are_refused():
    with pytest.raises(ValueError, match='over = "x" is not allowed; allowed: a key not varied'):
        snapload.erosion(snapload.Case(), over={"x": [0.1]}, **WINDOW)
    with pytest.raises(ValueError, match="over = {} is not allowed; allowed: one key with its values"):
        snapload.erosion(snapload.Case(), over={}, **WINDOW)
    with pytest.raises(TypeError, match=r"allowed: what snapload\.safe_basin gives"):
        snapload.plot_basin(xarray.Dataset())
    with pytest.raises(TypeError, match=r"allowed: what snapload\.erosion gives"):
        snapload.plot_erosion(xarray.Dataset())


def test_pictures_show_every_cell_and_hatch_what_is_undecided():
    basin = snapload.safe_basin(snapload.Case(t_end=60), x="-0.1:0.1:9", y="0.06:0.2:8")
    ax = snapload.plot_basin(basin)
    mesh = ax.collections[0]
    drawn = mesh.get_array().reshape(8, 9).T
    safe, escapes = basin.safe.values, basin.legal.values & ~basin.safe.values
    assert ((drawn == 0) == ~basin.legal.values).all() and not set(drawn[safe]) & set(drawn[escapes])
    hatched = [c for c in ax.collections[1:] if c.get_hatch()]
    assert basin.attrs["undecided"] > 0 and len(hatched) == 1
    assert len(hatched[0].get_paths()) == basin.attrs["undecided"]
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[0] == "settled" and labels[-1] == "undecided"
    eroded = snapload.erosion(snapload.Case(t_end=20), over={"f_o": "0:0.6:4"}, trust=False, **WINDOW)
    line = snapload.plot_erosion(eroded).get_lines()[0]
    assert line.get_ydata().tolist() == eroded.gim.values.tolist()
    # With neighbours the picture has the part that the knee is measured by, too.
    eroded = snapload.erosion(snapload.Case(t_end=30), over={"f_o": "0:0.3:2"}, **WINDOW)
    assert (eroded.undecided > 0).any()
    line = snapload.plot_erosion(eroded).get_lines()[1]
    assert line.get_ydata().tolist() == eroded.decided_fraction.values.tolist()
    assert line.get_label() == "of decided cells"


def test_no_two_ends_look_alike_in_a_map():
    words = [word for column in snapload._engine.columns() if column["name"] == "end" for word in column["words"]]
    ends = np.array(words)[:, None]
    basin = xarray.Dataset({"outcome": (("x", "y"), ends)}, {"x": np.arange(len(words)) / 8, "y": [0.1]})
    handles = snapload.plot_basin(basin).get_legend().legend_handles
    labels = [handle.get_label() for handle in handles]
    assert len({handle.get_facecolor() for handle in handles}) == len(set(labels)) == len(labels)
    # The impact limit and a standstill both mean that the run was cut short.
    assert len(labels) == len(words) - 1


def test_the_curves_of_an_erosion_go_along_its_key():
    forces = [0.4, 0.0, 0.6, 0.2]
    case = snapload.Case(t_end=20)
    eroded = snapload.erosion(case, over={"f_o": forces}, trust=False, progress=False, **WINDOW)
    line = snapload.plot_erosion(eroded.sel(f_o=forces)).get_lines()[0]
    assert line.get_xdata().tolist() == sorted(forces)
    assert line.get_ydata().tolist() == [float(eroded.gim.sel(f_o=f_o)) for f_o in sorted(forces)]


def test_only_legal_starts_are_decided_and_trusted():
    basin = snapload.safe_basin(snapload.Case(t_end=20), x="-0.4:0.4:9", y="-0.3:0.6:7")
    illegal = ~basin.legal.values
    assert illegal.any() and basin.legal.any()
    assert not basin.decided.values[illegal].any() and not basin.trusted.values[illegal].any()
    assert int(basin.decided.sum()) == basin.attrs["legal"] - basin.attrs["undecided"]


def test_the_table_of_an_erosion_has_what_its_knee_is_computed_from(command_json, tmp_path):
    out = tmp_path / "erosion.csv"
    vary_options = [f"--vary={key}={values}" for key, values in WINDOW.items()]
    more = ["--set=t_end=20", "--set=max_impacts=40", "--over=f_o=0:0.6:4", "--out", str(out)]
    data = command_json("erosion", *vary_options, *more)
    frame, points = pandas.read_csv(out), data["points"]
    eroded = snapload.erosion(snapload.Case(t_end=20, max_impacts=40), over={"f_o": "0:0.6:4"}, **WINDOW)
    for name in ("decided_fraction", "cut_short"):
        expected = [point[name] for point in points]
        assert frame[name].tolist() == eroded[name].values.tolist() == expected
    assert frame.cut_short.any() and frame.decided_fraction.between(0, 1).all()
