"""Branches of orbits against numbers of 20 digits of an independent program, and the command's JSON."""

from __future__ import annotations

import json
import pickle

import numpy as np
import pytest
import snapload
from conftest import ROOT
from snapload._orbit_base import complex_array

REFERENCE = json.loads((ROOT / "crates/snapload-orbits/tests/data/orbits.json").read_text(encoding="utf-8"))
BRANCHES = {branch["name"]: branch for branch in REFERENCE["branches"]}
#: What the reference calls its special points.
KINDS = {"pd": "period_doubling", "ns": "neimark_sacker", "upper_bound_reached": "upper_bound"}
VOLLEY = dict(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
STATE = ["x", "y", "theta", "vx", "vy", "vtheta"]


def volley(**options) -> snapload.Branch:
    return snapload.continuation(snapload.Case(**VOLLEY).orbit(), "f_o", (1.2, 2), **options)


@pytest.mark.parametrize(("name", "between"), [("A", (1.0, 4.0)), ("B", (0.5, 6.0))])
def test_a_branch_has_the_events_of_the_reference(name, between):
    reference = BRANCHES[name]
    keys = {key: value if key == "body" else float(value) for key, value in reference["base"].items()}
    branch = snapload.continuation(snapload.Case(**keys).orbit(symbol=reference["sequence"]), "f_o", between)
    found = list(zip(branch.events["kind"], branch.events["value"], strict=True))
    for point in reference["points"]:
        kind = KINDS.get(point["kind"], point["kind"])
        # The corner by a root of a gap, grazes of the highest point between snaps: as ORBITS.md has it, section 5.
        tolerance = 1e-8 if kind in ("corner", "graze") else 1e-9
        nearest = min((abs(value - float(point["value"])) for k, value in found if k == kind), default=np.inf)
        assert nearest < tolerance * max(1.0, float(point["value"])), (point["kind"], point["value"], found)
    assert len(branch.ends) == 2 and all(end["because"] for end in branch.ends)


def test_a_branch_is_that_of_the_command(command, command_json):
    arguments = [f"--set={key}={value}" for key, value in VOLLEY.items()]
    start = "x=-0.2689,y=0.3829,vx=0.8083,vy=-0.4262"
    arguments += ["--start", start, "--along", "f_o=1.2:2", "--step", "0.02"]
    data = command_json("branch", *arguments)
    orbit = snapload.Case(**VOLLEY).orbit({k: float(v) for k, v in (part.split("=") for part in start.split(","))})
    branch = snapload.continuation(orbit, "f_o", "1.2:2", step=0.02)
    assert branch.along == data["along"] and list(branch.ends) == data["ends"]
    points = branch.points
    assert points.f_o.values.tolist() == [point["value"] for point in data["points"]]
    assert points.arclength.values.tolist() == [point["arclength"] for point in data["points"]]
    states = np.column_stack([points[name] for name in STATE])
    assert states.tolist() == [point["section"] for point in data["points"]]
    pairs = np.stack([points.multipliers.values.real, points.multipliers.values.imag], axis=-1)
    assert pairs.tolist() == [point["multipliers"] for point in data["points"]]
    assert points.stable.values.tolist() == [point["stable"] for point in data["points"]]
    assert points.admissible.values.tolist() == [point["admissible"] for point in data["points"]]
    assert [arguments.split() for arguments in points.symbol.values] == [point["symbol"] for point in data["points"]]
    for row, event in zip(branch.events, data["events"], strict=True):
        assert (row["kind"], row["value"], row["arclength"]) == (event["kind"], event["value"], event["arclength"])
        assert [row[name] for name in STATE] == event["state"] and row["cable"] == (event["cable"] or 0)
    assert str(branch) in command("branch", *arguments)


def test_a_point_of_a_branch_is_an_orbit_of_its_case():
    branch = volley()
    frame = branch.events.to_pandas()
    assert frame[frame.admissible].kind.tolist() == [row["kind"] for row in branch.events if row["admissible"] is True]
    words = {"long_name": "theta at the section", "units": "rad"}
    assert branch.events._table.parts()[5][:3] == ("theta", "float64", words)
    assert frame.kind.tolist() == ["corner", "period_doubling", "fold"] and len(branch) == branch.points.sizes["point"]
    for place in (3, -1):
        orbit, point = branch.orbit(place), branch.points.isel(point=place)
        assert orbit.case.f_o == point.f_o and orbit.state.tolist() == [float(point[name]) for name in STATE]
        assert orbit.case.replace(f_o=1.4) == snapload.Case(**VOLLEY)
        again = orbit.case.orbit(orbit.state)
        np.testing.assert_allclose(again.state, orbit.state, atol=1e-9)
    # 1 and -1 to what a multiplier moves by where the place is known to rounding.
    assert abs(branch.event(1).multipliers + 1).min() < 1e-8 and abs(branch.event(2).multipliers - 1).min() < 1e-5
    with pytest.raises(IndexError):
        branch.orbit(len(branch))


def test_the_branch_of_a_doubling_is_that_of_the_command(command_json):
    arguments = [f"--set={key}={value}" for key, value in VOLLEY.items()]
    data = command_json("branch", *arguments, "--along", "f_o=1.2:2", "--step", "0.002", "--switch", "period_doubling")
    branch = volley(step=0.002)
    switched = branch.switch("period_doubling")
    assert switched.points.f_o.values == pytest.approx([point["value"] for point in data["points"]], abs=1e-9)
    assert switched.orbit(0).periods == 2 and switched.origins["value"][0] == pytest.approx(1.680507876014799, abs=1e-9)
    assert switched.ends[0]["because"] == "the period doubling" and len(branch.origins) == 0
    # Born, one multiplier is 1; further on the two laps are apart.
    assert abs(switched.orbit(0).multipliers - 1).min() < 1e-6
    doubled = switched.orbit(4)
    halfway = doubled.run(trust=False).at(doubled.period / 2)
    assert abs(float(halfway.x) - doubled.state[0]) > 1e-3 and len(doubled.events) == 4


def test_impossible_switches_report_why():
    branch = volley()
    with pytest.raises(snapload.NoOrbitError, match=r"the branch has 1 in its range, at 1\.680508"):
        branch.switch("period_doubling", 2)
    with pytest.raises(ValueError, match="kind = 'fold' is not allowed; allowed: 'period_doubling'"):
        branch.switch("fold")
    with pytest.raises(snapload.NoOrbitError, match="no period doubling; it ends at 1.500000: the end of the range"):
        snapload.continuation(snapload.Case(**VOLLEY).orbit(), "f_o", (1.3, 1.5)).switch()


def test_branches_compare_and_pickle():
    branch = volley(step=0.02)
    for one in (branch, branch.switch()):
        other = pickle.loads(pickle.dumps(one))
        assert other == one and repr(other) == repr(one) and other.points.identical(one.points)
        np.testing.assert_allclose(other.orbit(1).state, one.orbit(1).state, atol=1e-10)
    assert repr(branch).startswith("<Branch along f_o from 1.3") and "3 events" in repr(branch)
    assert "fold" in branch._repr_html_() and branch != branch.switch()


@pytest.mark.parametrize(
    ("key", "between", "options", "message"),
    [
        ("f_q", (1, 2), {}, 'there is no key "f_q"'),
        ("f_o", (2, 3), {}, "f_o = 2:3 is not allowed; allowed: a range that holds the value of the case, f_o = 1.4"),
        ("f_o", (2, 1), {}, "f_o = 2:1 is not allowed; allowed: a range whose first value is below the last"),
        ("f_o", "1.2", {}, "two numbers are needed"),
        ("f_o", 3, {}, "its two ends"),
        ("e", (0.1, 2), {}, "e = 2 is not allowed; allowed: a number, 0 <= e <= 1"),
        ("f_o", (1, 2), dict(step=0), "step = 0 is not allowed; allowed: a number above 0, at most 1"),
        ("f_o", (1, 2), dict(points=0), "points = 0 is not allowed"),
    ],
)
def test_impossible_continuations_are_refused(key, between, options, message):
    with pytest.raises(ValueError, match=message):
        snapload.continuation(snapload.Case(**VOLLEY).orbit(), key, between, **options)


def test_pictures_tell_parts_of_a_branch_apart():
    branch = volley()
    ax = branch.plot("x")
    styles = {line.get_label(): (line.get_color(), line.get_linestyle()) for line in ax.get_lines()}
    assert styles["stable"] != styles["unstable"] and {"corner", "period doubling", "fold"} <= set(styles)
    # Every point is in the picture, in its place.
    drawn = np.concatenate([line.get_xydata() for line in ax.get_lines() if line.get_linestyle() != "None"])
    shown = {tuple(place) for place in drawn.tolist()}
    assert {tuple(place) for place in np.column_stack([branch.points.f_o, branch.points.x]).tolist()} <= shown
    assert branch.plot("largest_multiplier").get_ylabel() == "largest |multiplier|"
    with pytest.raises(ValueError, match="y = 'z' is not allowed"):
        branch.plot("z")
    with pytest.raises(TypeError, match=r"allowed: an orbit of a snapload\.Case"):
        snapload.continuation("orbit", "f_o", (0, 1))


def test_multipliers_that_are_infinite_are_no_numbers():
    # At a graze of its own snap an orbit's derivatives are infinite, and JSON has none.
    missing, real = complex_array([(None, None), (0.5, 0.0)])
    assert np.isnan(missing) and real == 0.5
