"""Periodic orbits against numbers of 20 to 50 digits of an independent program, and the command's JSON."""

from __future__ import annotations

import copy
import json
import math
import pickle
import re

import numpy as np
import pytest
import snapload
from conftest import ROOT

REFERENCE = json.loads((ROOT / "crates/snapload-orbits/tests/data/orbits.json").read_text(encoding="utf-8"))
ORBITS = {orbit["name"]: orbit for orbit in REFERENCE["orbits"]}
STATE = ["x", "y", "theta", "vx", "vy", "vtheta"]
VOLLEY = dict(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)


def case_of(keys: dict) -> snapload.Case:
    return snapload.Case(**{key: value if key == "body" else float(value) for key, value in keys.items()})


def orbit_near(name: str, off: float = 1e-4, **options) -> snapload.Orbit:
    """The orbit of the reference from a start beside it."""
    orbit = ORBITS[name]
    rigid = orbit["case"].get("body") != "point"
    start = {
        key: float(value) + (off if rigid or key not in ("theta", "vtheta") else 0.0)
        for key, value in zip(STATE, orbit["section_point"], strict=True)
    }
    return case_of(orbit["case"]).orbit(start=start, **options)


@pytest.mark.parametrize("name", [name for name in ORBITS if "rest" not in name])
def test_an_orbit_is_that_of_the_reference(name):
    # One of a cable that would have to push has another one beside it, of many snaps of that cable.
    symbol = [1] if "partner" in name else None
    reference, orbit = ORBITS[name], orbit_near(name, symbol=symbol)
    exact = np.array([complex(float(re), float(im)) for re, im in reference["multipliers"]])
    if reference["admissible"]:
        largest = max(1.0, np.abs(exact).max())
        expected = np.array(reference["section_point"], dtype=float)
        np.testing.assert_allclose(orbit.state, expected, atol=1e-12 * (1 + largest))
    for multiplier in exact:
        if abs(multiplier) > 1e-12:
            distance = np.abs(orbit.multipliers - multiplier).min()
            assert distance < 1e-9 * max(1.0, np.abs(exact).max()), (multiplier, orbit.multipliers)
    assert orbit.admissible.yes == reference["admissible"] == bool(orbit.admissible)
    assert bool(orbit.admissible.why_not) != orbit.admissible.yes
    if reference["stable"] is not None:
        assert orbit.stable is reference["stable"] is orbit.attracts
    snaps = [(row["cable"], row["t"], row["v_n"]) for row in orbit.events if row["kind"] == "snap"]
    expected = [(row["cable"], float(row["t"]), float(row["v_n"])) for row in reference["impacts"]]
    np.testing.assert_allclose(snaps, expected, atol=1e-9)
    if orbit.product_rule is not None:
        assert orbit.product == pytest.approx(orbit.product_rule, rel=1e-10)
    assert orbit.period == pytest.approx(2 * math.pi / float(reference["case"]["omega"])) and orbit.periods == 1


def test_an_orbit_that_rests_in_the_corner_is_superstable():
    orbit = orbit_near("corner_rest_e0", 0.0)
    assert orbit.stable == "superstable" and orbit.attracts and orbit.admissible
    assert np.abs(orbit.multipliers).max() < 1e-9 and np.isneginf(orbit.exponents).all()
    # cos(Ωt − δ) = f_c/f_o, δ = atan2(ν, h).
    release = orbit.events["t"][orbit.events["kind"] == "release"]
    assert release[0] == pytest.approx(0.4148466702691638, abs=1e-12)


def test_an_inadmissible_orbit_reports_why():
    orbit = orbit_near("slide_partner_inadmissible", symbol=[1])
    assert not orbit.admissible and orbit.admissible.least_tension < 0
    assert any("tension" in why or "push" in why for why in orbit.admissible.why_not), orbit.admissible.why_not
    assert orbit.stable is True and "not admissible" in repr(orbit)


@pytest.mark.parametrize("start", ["", "x=-0.2689,y=0.3829,vx=0.8083,vy=-0.4262"])
def test_an_orbit_is_that_of_the_command(command, command_json, start):
    arguments = [f"--set={key}={value}" for key, value in VOLLEY.items()] + (["--start", start] if start else [])
    data = command_json("orbit", *arguments)
    case = snapload.Case(**VOLLEY)
    orbit = case.orbit({key: float(value) for key, value in (part.split("=") for part in start.split(",") if part)})
    if not start:
        orbit = case.orbit()
    assert orbit.state.tolist() == data["section"]["state"] and orbit.phase == data["section"]["phase"]
    assert [[m.real, m.imag] for m in orbit.multipliers] == data["multipliers"]
    assert list(orbit.symbol) == data["symbol"] and list(orbit.modes) == data["modes"]
    assert [dict(row) for row in orbit.events] == data["events"]
    assert orbit.exponents.tolist() == data["exponents"] and orbit.stable == data["stable"]
    assert (orbit.periods, orbit.period) == (data["period"]["forcing_periods"], data["period"]["t"])
    assert (orbit.product, orbit.product_rule) == (data["product"]["value"], data["product"]["rule"])
    assert orbit.zeros_from_contact == data["zeros_from_contact"] and orbit.return_error == data["return_error"]
    admissible = {**data["admissible"], "why_not": tuple(data["admissible"]["why_not"])}
    assert orbit.admissible == snapload.Admissible(**admissible)
    assert orbit.start_distance == data["start_distance"]
    shown = command("orbit", *arguments)
    assert str(orbit) in shown and str(orbit).startswith("Orbit     stable, of one period of the forcing")


def test_random_starts_lead_to_those_of_the_command(command_json):
    data = command_json("orbit", "--set", "omega=3", "--find", "600", "--seed", "2")["orbits"]
    orbits = snapload.find_orbits(snapload.Case(omega=3), 600, seed=2)
    assert len(orbits) > 0 and [orbit.state.tolist() for orbit in orbits] == [row["section"]["state"] for row in data]
    assert all(orbit.admissible and not orbit.attracts for orbit in orbits)
    # det M = e^(2N) for N snaps in slack flight.
    for orbit in orbits:
        assert orbit.product == pytest.approx(0.9 ** (2 * len(orbit.symbol)), rel=1e-9)


def test_an_orbit_runs_and_returns():
    case = snapload.Case(**VOLLEY)
    for phase in (0.0, 0.3):
        orbit = case.orbit(phase=phase)
        run = orbit.run(4)
        np.testing.assert_allclose(run.end.state, case.orbit().state, atol=1e-13)
        assert run.end.t == pytest.approx(4 * orbit.period) and len(run.impacts) == 8
    late = case.orbit(phase=0.3)
    there = case.orbit().run(trust=False).at(0.3 * late.period)
    np.testing.assert_allclose([there[name] for name in STATE], late.state, atol=1e-12)
    double = case.orbit(start=case.orbit().state, periods=2)
    assert (double.periods, double.smallest_periods) == (2, 1) and double.symbol == ("2", "1", "2", "1")
    np.testing.assert_allclose(double.multipliers[0], case.orbit().multipliers[0] ** 2, rtol=1e-10)


def test_a_lap_is_traced():
    orbit = snapload.Case(**VOLLEY).orbit()
    lap, motion = orbit.curve(100), orbit.run(trust=False)
    inside = lap[np.abs(lap.t[:, None] - orbit.events["t"]).min(axis=1) > 1e-6]
    played = motion.at(inside.t)
    for name in STATE:
        np.testing.assert_allclose(inside[name], played[name], atol=1e-12)
    assert np.bincount(lap.leg).tolist()[0] >= 9 and lap.taut.max() == 0


def test_orbits_compare_copy_and_pickle():
    orbit = snapload.Case(**VOLLEY).orbit()
    for other in (pickle.loads(pickle.dumps(orbit)), copy.deepcopy(orbit)):
        assert other == orbit and repr(other) == repr(orbit) == "<Orbit: stable, 1 period, 2, 1>"
        np.testing.assert_allclose(other.run(trust=False).end.state, orbit.state, atol=1e-13)
    assert orbit != snapload.Case(**{**VOLLEY, "f_o": 1.41}).orbit() and "stable, of one period" in orbit._repr_html_()


def test_a_ball_on_a_table_is_that_of_holmes():
    """Closed forms: Γ = 1.2, e = 0.5, Ω = 3, R = 5; the numbers of ORBITS.md, section 4.1."""
    rope, shaken = snapload.Cable((0, 5), 5), snapload.Sinusoid((0, 1.2), 3, phase=(0, -math.pi / 2))
    ball = snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1), [shaken]), 0.5)
    orbit = ball.orbit({"y": 0.2, "vy": -1.3}, symbol=[1])
    assert orbit.events["v_n"].tolist() == pytest.approx([1.396263401595463662], abs=1e-13)
    across = [m for m in orbit.multipliers if abs(abs(m) - 1) < 1e-9]
    along = [m for m in orbit.multipliers if abs(abs(m) - 0.5) < 1e-9]
    assert sum(across) == pytest.approx(1.122701831014279234, abs=1e-12)
    assert sum(along) == pytest.approx(-0.06846407777657551807, abs=1e-12)
    assert orbit.stable == "neutral" and not orbit.attracts
    other = pickle.loads(pickle.dumps(orbit))
    assert other == orbit and len(other.run(3, trust=False).impacts) == 3
    with pytest.raises(ValueError, match="with a sinusoid of a frequency other than 0"):
        snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1)), 0.5).orbit({"y": 0.2})
    with pytest.raises(ValueError, match="start = x, y, theta = 0, 1000, 0 is not allowed; allowed: a start within"):
        ball.orbit({"y": 1e3})
    twice = snapload.Forcing((0, -1), [shaken, snapload.Sinusoid((0.1, 0), 4)])
    with pytest.raises(ValueError, match=r"omega = 4\.0 is not allowed; allowed: whole multiples of the first"):
        snapload.System(snapload.Body(), [rope], twice, 0.5).orbit({"y": 0.2})


def test_a_missing_orbit_is_explained(command):
    with pytest.raises(snapload.NoOrbitError) as error:
        snapload.Case(f_o=0.5).orbit()
    message = str(error.value)
    assert message.startswith("no orbit was found: the motion from this start stops at t = 10.02")
    assert "start={...}" in message and "snapload.find_orbits" in message and "--" not in message
    by_command = command("orbit", "--set", "f_o=0.5", fails=True)
    assert re.sub(r";.*", "", message) in by_command
    with pytest.raises(snapload.NoOrbitError, match="but an orbit of 3 periods was requested"):
        snapload.Case(**VOLLEY).orbit(periods=3)
    assert issubclass(snapload.NoOrbitError, ValueError)


def test_orbits_are_proved():
    orbit = snapload.Case(**VOLLEY).orbit()
    assert orbit.proof is None and not orbit.proved
    proved = orbit.prove()
    assert proved.proved and 0 < proved.error_bound < 1e-14 and proved.proof["prime"]
    # 50 digits by an independent program, of which 30.
    assert proved.proof["state"][1] == "0.383046644264561321217849045988"
    assert pickle.loads(pickle.dumps(proved)).proof == proved.proof
    orbit_near = snapload.find_orbits(snapload.Case(a=0.3, b=0.3, f_o=0.5, omega=2.5), 150, seed=1, prove=True)
    assert orbit_near and all(one.proved for one in orbit_near)
    slides = snapload.Case(body="point", r=1.4, e=0.9, f_o=0.3, nu=0, omega=3)
    taut = slides.orbit({"x": 0.1529, "y": 0.1855, "vx": 0.3589, "vy": 0.521}).prove()
    assert not taut.proved and taut.error_bound is None and "taut" in taut.proof["why_not"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (dict(start={"z": 1}), 'there is no key "z"'),
        (dict(start={"e": 0.5}), "start = e is not allowed; allowed: values of the state, x, y, theta"),
        (dict(start={"theta": 0.1}), "theta = 0.1 is not allowed; allowed: 0, as a point mass"),
        (dict(start={"x": 1e4}), "x = 10000 is not allowed"),
        (dict(start={"x": 9}), "x, y, theta = 9, .* is not allowed; allowed: a start within reach of both cables"),
        (dict(start=[1, 2]), "some of x, y, theta, vx, vy, vtheta by their names"),
        (dict(symbol=[3]), "symbol = 3 is not allowed; allowed: a whole number, 1 <= symbol <= 2"),
        (dict(phase=1.5), "phase = 1.5 is not allowed; allowed: a part of the period, from 0 to below 1"),
        (dict(periods=0), "periods = 0 is not allowed; allowed: a whole number, 1 <= periods <= 1024"),
    ],
)
def test_invalid_options_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        snapload.Case(**VOLLEY).orbit(**options)


def test_other_invalid_arguments_are_refused():
    with pytest.raises(ValueError, match="omega = 0 is not allowed; allowed: a frequency of at least 6.286e-6"):
        snapload.Case(omega=0).orbit()
    with pytest.raises(ValueError, match="starts = 0 is not allowed"):
        snapload.find_orbits(snapload.Case(), 0)
    with pytest.raises(TypeError, match=r"allowed: a snapload\.Case"):
        snapload.find_orbits("case", 10)
    with pytest.raises(ValueError, match="x = 'z' is not allowed; allowed: 't', 'x'"):
        snapload.Case(**VOLLEY).orbit().plot("z")
