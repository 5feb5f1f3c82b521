"""Cases and results in SI units."""

from __future__ import annotations

import numpy as np
import pytest
import snapload
from cf_xarray.units import units as registry

SCALES = snapload.Scales(length=5.0, mass=800.0, force=1000.0)


def test_scales_agree_with_a_library_of_units():
    length, mass, force = 5.0 * registry.m, 800.0 * registry.kg, 1000.0 * registry.N
    time = ((mass * length / force) ** 0.5).to("s")
    known = {"L": length, "m": mass, "F": force, "T": time, "rad": registry.rad, "1": 1 * registry.dimensionless}
    from snapload._products import unit_of
    from snapload._schema import units

    assert "L^(1/2)/T" in units().values()
    for scale in set(units().values()) - {""}:
        over, _, under = scale.replace("(1/2)", "0.5").replace("^", "**").replace(" ", "*").partition("/")
        value = known["1"] * eval(over, {}, known) / (eval(under, {}, known) if under else 1)
        assert SCALES.factor(scale) == pytest.approx(value.to(registry.Unit(unit_of(scale))).magnitude), scale


def test_a_case_in_si_is_the_case_in_scales():
    case = SCALES.case(r=7.5, a=0.5, f_o=310.0, omega=0.45, y=0.5, t_end=60, e=0.9)
    assert case == snapload.Case(f_o=0.31, t_end=30)
    assert SCALES.case(inertia=800 * 0.5**2).inertia == pytest.approx(0.01)
    assert SCALES.case(snapload.Case(e=0.5), f_o=310.0) == snapload.Case(e=0.5, f_o=0.31)
    assert SCALES.case(body="point", a=0.0, inertia=None).inertia is None
    with pytest.raises(ValueError, match="e = 2 is not allowed"):
        SCALES.case(e=2)


def test_results_come_back_in_si():
    run = snapload.Case(f_o=0.31).run()
    impacts, motion = SCALES.si(run.impacts), SCALES.si(run.motion(0.1))
    np.testing.assert_allclose(impacts["v_n"], run.impacts["v_n"] * 2.5)
    np.testing.assert_allclose(impacts["impulse"], run.impacts["impulse"] * 800 * 2.5)
    assert impacts["cable"].tolist() == run.impacts["cable"].tolist() and impacts.columns == run.impacts.columns
    np.testing.assert_allclose(motion.T1, run.motion(0.1).T1 * 1000)
    np.testing.assert_allclose(motion.energy, run.motion(0.1).energy * 5000)
    assert motion.theta.tolist() == run.motion(0.1).theta.tolist()
    study = snapload.sweep(run.case, f_o=[0.3, 0.31], progress=False)
    brought = SCALES.si(study)
    np.testing.assert_allclose(brought.rho1, study.rho1 * 2.5)
    assert brought.f_o.values.tolist() == [300.0, 310.0] and brought.f_o.attrs["units"] == "N"
    assert brought.rho1.attrs["units"] == "m s-1" and "scale" not in brought.rho1.attrs
    assert brought.end.equals(study.end.assign_coords(f_o=brought.f_o)) and study.rho1.attrs["scale"] == "L/T"
    assert SCALES.si(study.rho1).identical(brought.rho1)


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda: snapload.Scales(0, 1, 1), ValueError, "length = 0 is not allowed; allowed: a number above 0"),
        (lambda: snapload.Scales(1, "x", 1), ValueError, "mass = 'x' is not allowed; allowed: a number"),
        (lambda: SCALES.factor("kg"), ValueError, "scale = 'kg' is not allowed; allowed: a product such as"),
        (lambda: SCALES.factor("L^(1/0)"), ValueError, "is not allowed; allowed: a product such as"),
        (lambda: SCALES.factor("L/"), ValueError, "scale = 'L/' is not allowed; allowed: a product such as"),
        (lambda: SCALES.factor("/T"), ValueError, "scale = '/T' is not allowed; allowed: a product such as"),
        (lambda: SCALES.factor("L^1000"), ValueError, "is not allowed; allowed: a product below 1e308"),
        (lambda: SCALES.factor("L^(1/2"), ValueError, "is not allowed; allowed: a product such as"),
        (lambda: SCALES.factor(None), TypeError, "scale = None is not allowed; allowed: a product such as"),
        (lambda: SCALES.case({"f_o": 300}), TypeError, "base = {'f_o': 300} is not allowed; allowed: a snapload.Case"),
        (lambda: SCALES.case(f_o=[1]), ValueError, r"f_o = \[1\] is not allowed; allowed: a number"),
        (lambda: SCALES.si(3.0), TypeError, "result, a float, is not allowed; allowed: a Table"),
        (
            lambda: SCALES.si(snapload.sensitivities(snapload.Case())),
            ValueError,
            "t is not allowed, as its scale, T over the unit of the key, is no single unit",
        ),
        (lambda: SCALES.case(omgea=1), ValueError, "omgea"),
    ],
)
def test_mistakes_are_reported(call, kind, message):
    with pytest.raises(kind, match=message):
        call()


def test_what_is_in_si_units_already_does_not_change():
    scales = snapload.Scales(5, 800, 1000)
    structure = snapload.Structure.example().replace({"run.duration": 70, "design.least_share": 0})
    answer, elastic = structure.assess(neighbours=1), structure.elastic()
    motion = answer.motion([0, 1])
    for result in (answer.lines, answer.snaps, answer.checks, elastic.lines, elastic.pulls, elastic.checks, motion):
        assert scales.si(result).identical(result)
    assert scales.si(answer.lines["safety_factor"]).identical(answer.lines["safety_factor"])
