"""Systems of one's own: any body, cables and forces."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle

import numpy as np
import pytest
import snapload
from snapload._keys import LIMITS

WEIGHT = snapload.Forcing((0, -1))
STRING = snapload.Cable(anchor=(0, 0), length=1)
SWING = snapload.System(snapload.Body(), [STRING], WEIGHT, 0.5, y=-1, vx=1.8, t_end=5)


def breakwater(mass: float = 1.0, **keys) -> snapload.System:
    """The standard case with another force, by its parts."""
    r, a = 1.5, 0.1
    height = math.sqrt(r**2 - (1 - a) ** 2)
    cables = [snapload.Cable((side, height), r, (side * a, 0)) for side in (1, -1)]
    waves = snapload.Sinusoid((mass * 0.31, mass * 0.155), 0.9, phase=(0, -math.pi / 2))
    body = snapload.Body(mass, mass * a**2, radius=a)
    rules = dict(rotation_limit=math.pi / 2, upper_bound=height, settled_below=0.05)
    return snapload.System(body, cables, snapload.Forcing((0, -mass), [waves]), 0.9, **{"y": 0.1, **rules, **keys})


def many_cables() -> snapload.System:
    places = np.linspace(-1, 1, 5)
    cables = [snapload.Cable((x, 1.2), 1.1 * math.dist((x, 1.2), (0.2 * x, 0)), (0.2 * x, 0)) for x in places]
    waves = [snapload.Sinusoid((0.4, 0.1), 1.7, phase=0.3), snapload.Sinusoid((0.0, 0.2), 2.9)]
    body = snapload.Body(inertia=0.02, half_size=(0.2, 0.1))
    return snapload.System(body, cables, snapload.Forcing((0, -1), waves), 0.6, t_end=12)


def test_a_case_by_its_parts_moves_as_the_case():
    case, system = snapload.Case(f_o=0.31).run(), breakwater().run()
    assert system.end.reason == case.end.reason and len(system.impacts) == len(case.impacts) == 12
    assert system.impacts["cable"].tolist() == case.impacts["cable"].tolist()
    for name in ("t", "v_n", "impulse", "energy_lost", "after_vtheta"):
        np.testing.assert_allclose(system.impacts[name], case.impacts[name], rtol=1e-9)
    assert system.end.t == pytest.approx(case.end.t, rel=1e-9) and system.norms.rho1 == pytest.approx(case.norms.rho1)
    assert system.outcome == case.outcome and system.trust.t is None


def test_a_system_has_a_field_for_each_limit():
    assert set(LIMITS) <= {field.name for field in dataclasses.fields(snapload.System)}


def test_a_heavier_body_under_larger_forces_moves_alike():
    light, heavy = breakwater().run(), breakwater(3.0).run()
    assert heavy.end.reason == light.end.reason
    for name, factor in (("t", 1), ("v_n", 1), ("impulse", 3), ("energy_lost", 3)):
        np.testing.assert_allclose(heavy.impacts[name], factor * light.impacts[name], rtol=1e-8)
    point = snapload.System(snapload.Body(3.0), [STRING], snapload.Forcing((0, -3)), 0.5, y=-1, vx=1, t_end=3)
    # The tension of a pendulum at its lowest place: m (g + v²/l).
    assert point.run().at(0.0).T1 == pytest.approx(3 * 2.0)


def test_a_pendulum_goes_slack_and_snaps_where_it_has_to():
    run = snapload.System(snapload.Body(), [STRING], WEIGHT, 0.5, y=-1, vx=3.5**0.5, t_end=5).run()
    released = run.modes["t_start"][1]
    start = run.at(released)
    # cos φ = (2 g l − v₀²)/(3 g l) = −1/2.
    assert math.degrees(math.atan2(start.x, -start.y)) == pytest.approx(120, abs=1e-10)
    # |p + v s − g s²/2|² = 1 along the parabola.
    x, y = np.poly1d([start.vx, start.x]), np.poly1d([-0.5, start.vy, start.y])
    roots = (x * x + y * y - 1).roots
    snap = min(root.real for root in roots if abs(root.imag) < 1e-9 and root.real > 0.1)
    assert run.impacts["t"][0] - released == pytest.approx(snap, abs=1e-9)
    assert run.impacts["energy_lost"][0] == pytest.approx(0.75 * run.impacts["v_n"][0] ** 2 / 2)


def test_no_cable_of_many_is_ever_longer_than_it_is():
    system = many_cables()
    run = system.run(trust=False)
    motion = run.motion(0.001)
    turned = np.stack([np.cos(motion.theta), np.sin(motion.theta)])
    for number, cable in enumerate(system.cables, 1):
        fx, fy = cable.fairlead
        x = motion.x + fx * turned[0] - fy * turned[1] - cable.anchor[0]
        y = motion.y + fx * turned[1] + fy * turned[0] - cable.anchor[1]
        assert (np.hypot(x, y) - cable.length).max() < 1e-12
        assert (motion[f"T{number}"] >= 0).all()
    assert set(run.impacts["cable"]) == {1, 2, 3, 4, 5} and motion.dtype.names[-2:] == ("T5", "energy")


def test_systems_and_their_runs_compare_copy_and_pickle():
    system = many_cables()
    run, plain = system.run(uncertainty=1e-9), system.run(trust=False)
    for one in (system, run, plain):
        for other in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one)):
            assert other == one and repr(other) == repr(one)
    far = pickle.loads(pickle.dumps(run))
    assert far.at([0.1, 3.0]).tolist() == run.at([0.1, 3.0]).tolist()
    assert system != system.replace(x=1e-3) and run != plain and hash(system) == hash(copy.deepcopy(system))
    assert system.replace(length=2.0).cables[4].length == 2.0 and system.replace(omega_2=1.0) != system
    changed = system.replace(anchor_y_3=1.25, length_3=1.4, phase_x_1=0.5, force_y=-1.1, inertia=0.03)
    assert changed.cables[2].anchor == (0.0, 1.25) and changed.cables[2].length == 1.4
    assert changed.forcing.constant == (0.0, -1.1) and changed.forcing.sinusoids[0].phase == (0.5, 0.3)
    assert changed.body.inertia == 0.03 and changed.cables[1] == system.cables[1]


def test_trust_ends_where_neighbours_diverge():
    system = many_cables().replace(t_end=30)
    run = system.run(uncertainty={"x": 1e-8})
    assert run.trust.because is not None and run.trust.uncertainty == {"x": 1e-8} and not run.outcome.certain
    # Rounding alone leaves all of it known.
    assert system.run().trust.t is None and run.trust.t < run.end.t
    impacts = run.impacts["t"] < run.trust.t
    known = run.impacts["t"][impacts]
    for x in (-1e-8, 1e-8):
        other = system.replace(x=x).run(trust=False).impacts["t"][: len(known)]
        assert np.abs(other - known).max() < 1e-3
    assert "known to 1e-3 before impact" in str(run) and "Trust" in run._repr_html_()
    assert "digits" in run.impacts and "digits" not in system.run(trust=False).impacts


def test_a_study_is_its_runs():
    system = many_cables()
    study = system.sweep(restitution=[0.2, 0.6], omega_1=[1.5, 1.7, 2.1], progress=False)
    assert study.rho1.dims == ("restitution", "omega_1") and study.omega_1.values.tolist() == [1.5, 1.7, 2.1]
    run = system.replace(restitution=0.2, omega_1=2.1).run()
    cell = study.sel(restitution=0.2, omega_1=2.1)
    assert (cell.end.item(), cell.t.item(), cell.rho1.item()) == (run.end.reason, run.end.t, run.norms.rho1)
    snaps = [((run.impacts["cable"] == k) & (run.impacts["v_n"] > 0)).sum() for k in (1, 2, 3, 4, 5)]
    assert [cell[f"impacts_{k}"].item() for k in (1, 2, 3, 4, 5)] == snaps
    assert cell.certain.item() == run.outcome.certain and study.certain.dtype == bool
    plain = system.sweep(restitution=[0.2, 0.6], omega_1=[1.5, 1.7, 2.1], trust=False, threads=1, progress=False)
    assert "certain" not in plain and plain.rho1.equals(study.rho1)
    with pytest.warns(UserWarning, match=r"^threads=60000: this machine runs \d+ at a time.* are used$"):
        capped = system.sweep(restitution=[0.2, 0.6], omega_1=[1.5, 1.7, 2.1], threads=60_000, progress=False)
    assert capped.equals(study)


def test_words_count_impacts_without_impulses_passed_into_a_taut_cable():
    # A cable stays taut while the other one snaps ever faster.
    run = breakwater(settled_below=None).replace(amplitude_x=0.27, amplitude_y=0.135).run()
    snaps = [((run.impacts["cable"] == k) & (run.impacts["v_n"] > 0)).sum() for k in (1, 2)]
    passed = len(run.impacts) - sum(snaps)
    assert passed > 1 and f"Impacts   {sum(snaps)}: {snaps[0]} of cable 1, " in str(run)
    assert str(run).endswith(f"; {passed} impulses passed into a taut cable")
    assert f" {sum(snaps)} impacts>" in repr(run)


def test_a_pendulum_released_at_the_height_of_its_anchor_stays_taut():
    # Its tension 3 sin φ grows from zero.
    rope = snapload.Cable(anchor=(0, 0), length=1)
    run = snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1)), 0.5, x=1, t_end=20).run()
    assert len(run.impacts) == 0 and run.modes["mode"].tolist() == ["sliding"] and run.outcome.certain


def test_a_start_inside_a_short_cable_is_not_moved():
    rope, weight = snapload.Cable(anchor=(0, 0), length=3e-5), snapload.Forcing((0, -1))
    run = snapload.System(snapload.Body(), [rope], weight, 0.5, y=-3e-7, t_end=1e-9).run()
    assert run.at(0.0)["y"] == -3e-7
    with pytest.raises(ValueError, match="length_1 = .* allowed: cables of length 1e-16 or more"):
        snapload.System(snapload.Body(), [snapload.Cable((0, 0), 1e-300)], weight, 0.5, t_end=0.5)


def test_an_illegal_system_is_a_cell_without_a_run():
    study = many_cables().sweep(length_3=[1.0, 1.32], progress=False)
    assert study.error.values.tolist()[1] == "" and "cable 3 would have to be" in study.error.values[0]
    assert np.isnan(study.rho1[0]) and not study.certain[0] and study.end_code.values.tolist() == [-1, 4]
    with pytest.raises(ValueError, match="cable 3 would have to be"):
        many_cables().sweep(length_3=[1.0, 1.1])


@pytest.mark.parametrize("what", ["trajectory", "rotation", "velocities", "tensions"])
def test_runs_of_systems_are_drawn(what):
    run = many_cables().run()
    ax = run.plot(what)
    assert ax.lines and len(run.overview().axes) == 4 and "L" not in ax.get_xlabel()
    assert "<canvas" in run.animate(seconds=1)._repr_html_()
    still = snapload.System(snapload.Body(), [STRING], WEIGHT, 0.5, y=-1, t_end=1).run()
    still.plot(what)


def test_keys_that_change_different_numbers_go_together():
    system = breakwater().replace(length_1=1.6, length_2=1.7, anchor_x_1=1.1, omega_1=1.2, force_y=-0.9, mass=1.1, y=0)
    assert [cable.length for cable in system.cables] == [1.6, 1.7] and system.cables[0].anchor[0] == 1.1
    assert system.forcing.sinusoids[0].omega == 1.2 and system.forcing.constant == (0, -0.9)
    assert (system.body.mass, system.y) == (1.1, 0)


def test_cables_may_come_from_a_generator():
    longer = breakwater().replace(cables=(dataclasses.replace(cable, length=1.6) for cable in breakwater().cables))
    assert longer == breakwater().replace(length=1.6)


def test_a_range_of_a_count_has_whole_numbers():
    study = breakwater().sweep(max_impacts="3:5:2", progress=False)
    assert study.max_impacts.values.tolist() == [3, 5]
    # A run ends at the first impact beyond.
    assert (study.impacts_1 + study.impacts_2).values.tolist() == [4, 6]
    assert study.end.values.tolist() == ["impact_limit"] * 2


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda: snapload.Cable((0, 0), -1), ValueError, "length = -1 is not allowed; allowed: a number, 0 < length"),
        (lambda: snapload.Cable((0, 0, 0), 1), ValueError, r"anchor = \(0, 0, 0\) is not allowed; allowed: its x and"),
        (lambda: snapload.Cable((0, "a"), 1), ValueError, "anchor: y = 'a' is not allowed; allowed: a number"),
        (lambda: snapload.Cable((0, math.nan), 1), ValueError, "anchor: y = nan is not allowed"),
        (lambda: snapload.Body(radius=0.1), ValueError, "give its moment of inertia"),
        (lambda: snapload.Body(inertia=1, radius=1, half_size=(1, 1)), ValueError, "no radius beside"),
        (lambda: snapload.Forcing((0, -1), [3]), TypeError, "sinusoids: number 1, 3, is not allowed; allowed: a snap"),
        (
            lambda: snapload.System(1, [STRING], WEIGHT, 0.5),
            TypeError,
            "body = 1 is not allowed; allowed: a snapload.B",
        ),
        (lambda: snapload.System(snapload.Body(), [], WEIGHT, 0.5), ValueError, "cables: 0 of them are not allowed"),
        (lambda: snapload.System(snapload.Body(), [STRING], WEIGHT, 2), ValueError, "restitution = 2 is not allowed"),
        (lambda: breakwater(y=-1), ValueError, "x, y, theta = 0, -1, 0 is not allowed; allowed: a start within reach"),
        (lambda: breakwater(theta=2), ValueError, "rotation_limit = .* is not allowed; allowed: a bound beyond"),
        (lambda: breakwater(max_impacts=0), ValueError, "max_impacts = 0 is not allowed"),
        (lambda: breakwater().replace(lenght=1), ValueError, "there is no key 'lenght'; the keys are body, cables"),
        (lambda: breakwater().replace(length_3=1), ValueError, "there is no key 'length_3': there are 2 of them"),
        (lambda: many_cables().replace(length_6=1), ValueError, "there is no key 'length_6': there are 5 of them"),
        (lambda: SWING.replace(length_2=1), ValueError, "there is no key 'length_2': there is one of them"),
        (lambda: SWING.replace(omega=5), ValueError, "there is no key 'omega': the system has no sinusoids"),
        (lambda: SWING.sweep(omega=[1, 2]), ValueError, "there is no key 'omega': the system has no sinusoids"),
        (lambda: breakwater().sweep(length_1=[1.59], length=[1.6, 1.7]), ValueError, "length beside length_1 is not"),
        (lambda: breakwater().replace(length_2=1.7, cables=[STRING]), ValueError, "cables beside length_2 is not"),
        (lambda: breakwater().replace(cables=[STRING], anchor_x=1), ValueError, "anchor_x beside cables is not"),
        (lambda: breakwater().replace(mass=2, body=snapload.Body()), ValueError, "body beside mass is not allowed"),
        (lambda: breakwater().replace(forcing=WEIGHT, omega_1=2), ValueError, "omega_1 beside forcing is not allowed"),
        (lambda: breakwater().replace(force_y=-1, forcing=WEIGHT), ValueError, "forcing beside force_y is not"),
        (lambda: breakwater().sweep(vx="0:1"), ValueError, 'vx = "0:1": three numbers are needed; write first:last:n'),
        (lambda: breakwater().sweep(vx="a:b:3"), ValueError, 'vx = "a:b:3": "a" is not a number; write first:last:n'),
        (lambda: breakwater().sweep(vx="0:1:c"), ValueError, 'vx = "0:1:c": n must be a whole number, 1 or more'),
        (lambda: breakwater().sweep(vx="0:1:99999999999"), ValueError, "allowed: a range of at most 10000000 values"),
        (lambda: breakwater().sweep(length=np.ma.array([1.6, 1.7], mask=[0, 1])), ValueError, "1 masked value"),
        (lambda: breakwater().run(uncertainty={"r": 1}), ValueError, "uncertainty: r is not allowed; allowed: start"),
        (lambda: breakwater().run(uncertainty=-1), ValueError, "uncertainty = -1 is not allowed"),
        (lambda: breakwater().run(tolerance=0), ValueError, "tolerance = 0 is not allowed"),
        (lambda: breakwater().run(trust=False, uncertainty=1), ValueError, "follows no deviations"),
        (lambda: breakwater().sweep(x=[]), ValueError, "0 runs are not allowed"),
        (lambda: snapload.sweep(breakwater(), e=[1]), TypeError, "a System has its own sweep"),
        (
            lambda: snapload.System(snapload.Body(), [snapload.Cable((0, 0), 1, (0.1, 0))], WEIGHT, 1),
            ValueError,
            "fairlead = .* of cable 1 is not allowed; allowed: .0, 0. for a point mass",
        ),
        (
            lambda: snapload.System(snapload.Body(), [STRING], WEIGHT, 1, theta=1),
            ValueError,
            "theta = 1.0 is not allowed; allowed: 0 for a point mass",
        ),
    ],
)
def test_mistakes_are_reported(call, kind, message):
    with pytest.raises(kind, match=message):
        call()
