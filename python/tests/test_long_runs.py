"""Sections, Lyapunov exponents and diagrams against an independent program, and the command's answers."""

from __future__ import annotations

import inspect
import json
import math
import re

import numpy as np
import pandas
import pyarrow.parquet as parquet
import pytest
import snapload
import xarray
from conftest import ROOT

REFERENCE = json.loads((ROOT / "crates/snapload-orbits/tests/data/orbits.json").read_text(encoding="utf-8"))
STATE = ["x", "y", "theta", "vx", "vy", "vtheta"]
TORUS = dict(body="point", r=1.976, e=0.71, nu=0.87, omega=4.847, f_o=1.6, x=0, y=0.4, vx=0.1)
VOLLEY = dict(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)


def set_options(case: dict) -> list[str]:
    return [f"--set={key}={value}" for key, value in case.items()]


def test_a_section_is_that_of_the_command(command_json, tmp_path):
    data = command_json("section", *set_options(TORUS), "--periods", "300", "--keep", "60", "--phase", "0.25")
    found = snapload.section(snapload.Case(**TORUS), periods=300, keep=60, phase=0.25)
    assert found.k.values.tolist() == [point["k"] for point in data["points"]] and found.sizes["k"] == 61
    assert np.column_stack([found[name] for name in STATE]).tolist() == [point["state"] for point in data["points"]]
    assert found.exponent.values.tolist() == [row["value"] for row in data["exponents"]]
    assert found.exponent_se.values.tolist() == [row["se"] for row in data["exponents"]]
    assert math.isnan(found.attrs["period"]) and data["period"] is None
    for key in ("snaps", "phase", "y_max", "theta_max"):
        assert found.attrs[key] == data[key]
    found.to_netcdf(tmp_path / "section.nc")
    with xarray.open_dataset(tmp_path / "section.nc") as read:
        assert (read.x.values == found.x.values).all()


def test_impacts_are_those_of_the_command(command, tmp_path):
    out = tmp_path / "impacts.csv"
    command("section", *set_options(TORUS), "--periods", "50", "--keep", "20", "--at", "impacts", "--out", str(out))
    found = snapload.section(snapload.Case(**TORUS), periods=50, keep=20, at="impacts")
    frame = pandas.read_csv(out)
    for name in frame.columns:
        if name != "impact":
            np.testing.assert_allclose(found[name].values, frame[name], rtol=0, atol=0, err_msg=name)
    assert {"vx_before", "vx_after", "cable", "phase"} <= set(frame.columns) <= {*found.variables, "impact"}
    assert found.impact.values.tolist() == list(range(1, 21))


def test_a_section_of_an_orbit_has_its_multipliers():
    case = snapload.Case(**VOLLEY)
    found, orbit = snapload.section(case, periods=1000, keep=500), case.orbit()
    assert found.attrs["period"] == orbit.periods == 1 and found.attrs["snaps"] == 2.0
    np.testing.assert_allclose(found.x, orbit.state[0], atol=1e-12)
    np.testing.assert_allclose(found.exponent, orbit.exponents, rtol=2e-2)
    assert float(found.exponent[0]) == pytest.approx(orbit.exponents[0], rel=1e-8)
    early = r"stops at t = 10\.0247, rotation limit, before the first point of the section, .* after 10 periods"
    with pytest.warns(UserWarning, match=early):
        stopped = snapload.section(snapload.Case(f_o=0.5), periods=20, keep=10)
    assert stopped.sizes["k"] == 0
    assert stopped.attrs["stop"] == "rotation_limit" and stopped.attrs["stop_t"] == pytest.approx(10.0247, abs=1e-4)
    assert stopped.attrs["stop_certain"] == 1


def test_directions_that_taut_cables_remove_have_no_exponent():
    rest, rocking = snapload.Case(body="point", f_o=0.2), snapload.Case(f_o=0.1)
    assert np.isneginf(snapload.section(rest).exponent).all()
    assert np.isneginf(snapload.lyapunov_spectrum(rest).values).tolist() == [True] * 4
    assert np.isneginf(snapload.lyapunov_spectrum(rocking, periods=100).values).tolist() == [False] * 2 + [True] * 4
    assert np.isneginf(snapload.orbit_diagram(rest, f_o=[0.2, 0.3], periods=50, keep=20).exponent).all()
    short = snapload.lyapunov_spectrum(rocking, periods=3, transient=100)
    assert np.isnan(short.standard_errors[:2]).all() and np.isfinite(short.values[:2]).all()


def test_exponents_add_up_to_the_contraction_of_the_snaps():
    """Their sum is 2 ln e times the snaps in unit time, whatever the motion does."""
    spectrum = snapload.lyapunov_spectrum(snapload.Case(**TORUS), periods=400, transient=100)
    period = math.tau / TORUS["omega"]
    snaps = snapload.section(snapload.Case(**TORUS), periods=501, keep=401, at="impacts")
    count = int((snaps.t < 500 * period).sum())
    rate = count / (400 * period)
    assert spectrum.values.sum() == pytest.approx(2 * math.log(TORUS["e"]) * rate, rel=1e-9)
    assert spectrum.values.tolist() == snaps.exponent.values.tolist() and spectrum.transient == 100
    values, errors = spectrum
    assert len(values) == len(errors) == 4 and (errors > 0).all() and (np.diff(values) <= 0).all()
    # A torus: nothing grows or shrinks along it.
    assert abs(values[0]) < 3 * errors[0]
    with pytest.raises(ValueError, match=r"stops at t = 10\.0247, rotation limit; use another start"):
        snapload.lyapunov_spectrum(snapload.Case(f_o=0.5))


def test_a_diagram_is_that_of_the_reference():
    (reference,) = REFERENCE["diagrams"]
    base = {key: value if key == "body" else float(value) for key, value in reference["base"].items()}
    case = snapload.Case(**base, **dict(zip(STATE, map(float, reference["start"]), strict=True)))
    values = [row["f_o"] for row in reference["rows"]]
    periods = reference["transient"] + reference["kept"]
    found = snapload.orbit_diagram(case, f_o=values, periods=periods, keep=reference["kept"])
    for place, row in enumerate(reference["rows"]):
        here = found.isel(f_o=place)
        assert np.isnan(here.period) if row["period"] is None else here.period == row["period"]
        assert float(here.snaps) == pytest.approx(row["snaps_per_period"])
        error = math.hypot(float(here.exponent_se), row["exponent_se"])
        assert abs(float(here.exponent) - row["exponent"]) < 3 * error
        assert float(here.x.max()) == pytest.approx(row["x_max"], abs=2e-3)
        assert float(here.x.min()) == pytest.approx(row["x_min"], abs=2e-3)


def test_a_diagram_is_that_of_the_command(command_json, tmp_path):
    out = tmp_path / "diagram.csv"
    base = [word for word in set_options(TORUS) if "f_o" not in word]
    options = ["--vary", "f_o=1.8:2.4:4", "--periods", "60", "--keep", "20", "--out", str(out)]
    for down in (False, True):
        data = command_json("diagram", *base, *options, *(["--down"] if down else []))["rows"]
        found = snapload.orbit_diagram(snapload.Case(**TORUS), f_o="1.8:2.4:4", periods=60, keep=20, down=down)
        assert found.f_o.values.tolist() == [row["value"] for row in data] and found.sizes["k"] == 21
        stops = [row["stop"] or {"reason": "", "t": np.nan, "certain": True} for row in data]
        assert found.stop.values.tolist() == [stop["reason"] for stop in stops] and "upper_bound" in found.stop.values
        np.testing.assert_array_equal(found.stop_t, [stop["t"] for stop in stops])
        assert found.stop_certain.values.tolist() == [stop["certain"] for stop in stops]
        assert found.restarted.values.tolist() == [row["restarted"] for row in data]
        for name in ("period", "snaps", "exponent", "exponent_se", "y_max"):
            expected = [np.nan if row[name] is None else row[name] for row in data]
            np.testing.assert_array_equal(found[name], expected)
        frame = pandas.read_csv(out)
        for name in STATE:
            points = found[name].values.ravel()
            assert points[~np.isnan(points)].tolist() == frame[name].dropna().tolist()
        # A value at which the motion stops before the first point has a row, too.
        assert frame.f_o.drop_duplicates().tolist() == found.f_o.values.tolist()
        assert set(frame.k.dropna()) <= set(found.k.values) == set(range(40, 61))
    assert snapload.plot_diagram(found, "vx").get_legend().get_texts()[0].get_text() == "stops at a limit"


@pytest.mark.parametrize(
    ("verb", "options"),
    [
        ("section", {"periods": "periods", "keep": "keep", "phase": "phase", "at": "at"}),
        ("diagram", {"periods": "periods", "keep": "keep", "phase": "phase"}),
        ("branch", {"step": "step", "points": "points"}),
        ("basin", {"transient": "transient"}),
        ("orbit", {"seed": "seed", "phase": "phase"}),
    ],
)
def test_defaults_are_those_of_the_command(command, verb, options):
    functions = {
        "section": snapload.section,
        "diagram": snapload.orbit_diagram,
        "branch": snapload.continuation,
        "basin": snapload.basins_of_attraction,
        "orbit": snapload.find_orbits,
    }
    help_text = command(verb, "--help")
    for option, parameter in options.items():
        (default,) = re.findall(rf"--{option} <.*?\[default:\s+(\S+)\]", help_text, re.DOTALL)[:1]
        assert str(inspect.signature(functions[verb]).parameters[parameter].default) in (default, f"{default}.0")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (dict(periods=5, keep=9), "keep = 9 is not allowed; allowed: at most periods = 5"),
        (dict(phase=1.0), "phase = 1 is not allowed; allowed: a part of the period"),
        (dict(periods=0), "periods = 0 is not allowed"),
        (dict(at="snaps"), "at = 'snaps' is not allowed; allowed: 'periods', 'impacts'"),
    ],
)
def test_options_are_checked(options, message):
    with pytest.raises(ValueError, match=message):
        snapload.section(snapload.Case(), **options)


def test_other_invalid_arguments_are_refused():
    with pytest.raises(ValueError, match="keys = none is not allowed; allowed: one key with its values"):
        snapload.orbit_diagram(snapload.Case())
    with pytest.raises(ValueError, match="keys = f_o, e is not allowed"):
        snapload.orbit_diagram(snapload.Case(), f_o=[0.1], e=[0.5])
    with pytest.raises(ValueError, match="three numbers"):
        snapload.orbit_diagram(snapload.Case(), f_o="0:1")
    with pytest.raises(ValueError, match="e = 2 is not allowed"):
        snapload.orbit_diagram(snapload.Case(), e=[2.0])
    with pytest.raises(TypeError, match=r"allowed: what snapload\.orbit_diagram gives"):
        snapload.plot_diagram(xarray.Dataset())


def test_a_dataset_has_the_case_it_is_of(tmp_path):
    case = snapload.Case(**TORUS, t_end=30)
    window = dict(x="-0.2:0.2:2", y="0.3:0.5:2")
    critical = snapload.critical_force(case, step=0.5, over=dict(e=[0.5, 0.7]), progress=False)
    for found in (
        snapload.section(case, periods=40, keep=20, progress=False),
        snapload.orbit_diagram(case, f_o=[1.5, 1.6], periods=40, keep=20, progress=False),
        snapload.safe_basin(case, progress=False, **window),
        snapload.basins_of_attraction(case, transient=20, progress=False, **window)[0],
        snapload.erosion(case, over=dict(e=[0.5, 0.7]), progress=False, **window),
        critical,
    ):
        path = tmp_path / "case.toml"
        path.write_text(found.attrs["case"], encoding="utf-8")
        assert snapload.Case.from_file(path) == case
        assert found.attrs["source"] == f"snapload {snapload.__version__}"
    critical.to_netcdf(tmp_path / "critical.nc", engine="h5netcdf")
    assert xarray.open_dataset(tmp_path / "critical.nc").attrs["case"] == critical.attrs["case"]


def test_a_parquet_table_has_its_case_and_version(command, tmp_path):
    out = tmp_path / "section.parquet"
    data = json.loads(
        command("section", "--set", "e=0.7", "--periods", "20", "--keep", "5", "--out", str(out), "--json", "-")
    )
    metadata = parquet.read_schema(out).metadata
    assert json.loads(metadata[b"snapload.case"]) == data["case"] and data["case"]["e"] == 0.7
    assert metadata[b"snapload.version"].decode() == snapload.__version__
