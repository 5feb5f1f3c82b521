"""Results are what Python's users expect: in other processes, in comparisons, in pandas, under CF, in errors."""

from __future__ import annotations

import copy
import importlib.util
import pickle
import subprocess
import sys
import time
import typing
from collections.abc import Mapping
from pathlib import Path

import cf_xarray  # noqa: F401  (adds `.cf`)
import numpy as np
import pandas
import pint
import polars
import pytest
import snapload
import xarray

#: Past the horizon of this one, so that it takes neighbours on all threads.
CHAOTIC = snapload.cases["1910001000-359"]

IN_A_POOL = """
import multiprocessing, snapload
def work(e):
    case = snapload.Case(e=e)
    return float(snapload.sweep(case, f_o=[0.2, 0.3]).rho1.sum()), case.run(members=20).end.t
if __name__ == "__main__":
    snapload.sweep(snapload.Case(), f_o=[0.1, 0.2])
    here = [work(e) for e in (0.5, 0.9)]
    with multiprocessing.get_context("{method}").Pool(2) as pool:
        assert pool.map_async(work, (0.5, 0.9)).get(timeout=60) == here
    print("done")
"""


@pytest.mark.parametrize("method", ["fork", "forkserver", "spawn"])
def test_a_pool_of_processes_works_after_a_sweep(method, tmp_path: Path):
    script = tmp_path / "work.py"
    script.write_text(IN_A_POOL.replace("{method}", method))
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=90)
    assert done.stdout == "done\n", done.stderr


def test_a_pool_of_joblib_returns_runs():
    import joblib

    cases = [snapload.Case(e=0.5), CHAOTIC]
    runs = joblib.Parallel(n_jobs=2)(joblib.delayed(snapload.Case.run)(case, members=20) for case in cases)
    here = [case.run(members=20) for case in cases]
    assert runs == here
    assert [run.motion(0.5).tolist() for run in runs] == [run.motion(0.5).tolist() for run in here]


IN_TESTS = """
import pytest, snapload
snapload.sweep(snapload.Case(), f_o=[0.1, 0.2])
@pytest.mark.parametrize("e", [0.5, 0.7, 0.8, 0.9])
def test_runs(e):
    case = snapload.Case(e=e)
    assert float(snapload.sweep(case, f_o=[0.2, 0.3]).rho1.sum()) > 0 and case.run(members=20).end.t > 0
"""


def test_tests_run_side_by_side(tmp_path: Path):
    (tmp_path / "test_work.py").write_text(IN_TESTS)
    command = [sys.executable, "-m", "pytest", "-q", "-n", "2", "-p", "no:cacheprovider", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=90, cwd=tmp_path)
    assert "4 passed" in done.stdout, done.stdout + done.stderr


def results():
    case = snapload.Case(f_o=0.31)
    yield CHAOTIC.run(members=20)
    yield case.run()
    yield case.run(trust=False)
    yield from (case.run().impacts, case.run().modes, case.run().exponents, snapload.sensitivities(case))
    yield from (case.run().trust, CHAOTIC.run(members=20).outcome, case.run().norms, case.run().end)
    yield snapload.critical_force(snapload.Case(), step=0.1)
    yield snapload.critical_force(snapload.Case(), step=0.1, members=10)
    yield from (snapload.ensemble(case, 10), snapload.verify(case))
    # With NaN: digits of a number that is not known, and errors of averages over few periods.
    yield snapload.Case().run().certify()
    point = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
    yield snapload.lyapunov_spectrum(point, periods=3)


def test_arrays_of_results_can_not_be_written_to():
    point = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
    points = snapload.continuation(point.orbit(), "f_o", (1.3, 1.5)).points
    spectrum = snapload.lyapunov_spectrum(point, periods=50)
    critical, proof = snapload.critical_force(CHAOTIC, step=0.1, members=10), snapload.verify(CHAOTIC)
    arrays = [*spectrum, critical.exceeding, critical.probability.part, proof.differences]
    for array in (*arrays, *points.variables.values()):
        with pytest.raises(ValueError, match="read-only|is a view"):
            array[0] = array[-1]
    copied = points.copy(deep=True)
    copied.x[0] = 99
    assert copied.x[0] == 99 != points.x[0]


def test_a_case_and_an_orbit_do_not_change():
    case = snapload.Case()
    for name in ("t_end", "t_End"):
        with pytest.raises(AttributeError, match=rf"a case does not change; case.replace\({name}=...\) gives another"):
            setattr(case, name, 5.0)
    orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
    for values in (orbit.state, orbit.multipliers, orbit.exponents, copy.copy(orbit).state):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 9


@pytest.mark.parametrize("result", list(results()), ids=lambda result: type(result).__name__)
def test_results_compare_copy_and_pickle(result):
    for other in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), copy.copy(result)):
        assert other == result and not other != result
        assert repr(other) == repr(result) and str(other) == str(result)
    assert result != 1
    assert len(repr(result)) < 400 or isinstance(result, snapload.Table)


def test_results_that_differ_are_not_equal():
    case = snapload.Case(f_o=0.31)
    assert case.run() != snapload.Case().run() and case.run() != case.run(trust=False)
    assert snapload.verify(case) != snapload.verify(case, 100)
    assert snapload.critical_force(case, step=0.1) != snapload.critical_force(case, step=0.05)
    assert case.run().impacts != case.run(trust=False).impacts


def test_a_pickled_run_has_its_motion():
    run = snapload.Case(f_o=0.31).run(uncertainty={"f_o": 1e-6})
    far = pickle.loads(pickle.dumps(run))
    assert far.at([0.1, 3.0]).tolist() == run.at([0.1, 3.0]).tolist() and far.to_json(0.5) == run.to_json(0.5)


def test_without_trust_a_run_is_the_same():
    full, plain = CHAOTIC.run(members=20), CHAOTIC.run(trust=False)
    assert plain.end == full.end and plain.norms == full.norms
    for name in plain.impacts.columns:
        assert plain.impacts[name].tolist() == full.impacts[name].tolist()
    assert "digits" not in plain.impacts and not hasattr(plain, "trust") and len(plain.exponents) == 0
    with pytest.raises(ValueError, match="trust=False"):
        plain.to_json()
    with pytest.raises(ValueError, match="trust=False runs no neighbours"):
        CHAOTIC.run(trust=False, members=3)
    plain.plot("velocities")


def test_units_are_of_cf(tmp_path: Path):
    study = snapload.sweep(snapload.Case(), f_o=[0.2, 0.3], e=[0.5, 0.9])
    registry = pint.UnitRegistry()
    for name, variable in study.variables.items():
        unit = variable.attrs.get("units", "1")
        assert registry.Unit(unit).dimensionless, (name, unit)
    assert study.rho1.attrs["scale"] == "L/T" and study.attrs["Conventions"].startswith("CF-")
    assert study.cf["end_code"].cf.is_flag_variable
    assert (study.cf["end_code"].cf == "settled").all()
    field = dict(polars.DataFrame(snapload.Case().run().impacts).schema)
    assert list(field)[:2] == ["t", "cable"]


def test_columns_keep_their_type_whatever_they_hold():
    legal = snapload.sweep(snapload.Case(), r=[1.4, 1.5])
    mixed = snapload.sweep(snapload.Case(), r=[0.5, 1.5])
    for name in legal:
        assert legal[name].dtype == mixed[name].dtype, name
    assert mixed.certain.dtype == bool and not mixed.certain.sel(r=0.5)
    assert legal.impacts_1.dtype == float and np.isnan(mixed.impacts_1.sel(r=0.5))


def test_a_table_reads_as_rows_everywhere():
    run = snapload.cases["sliding-example"].run(members=0)
    for table in (run.impacts, run.modes):
        assert len(list(table)) == len(table) == len(np.asarray(table)) == len(pandas.DataFrame(table))
        assert list(pandas.DataFrame(table).columns) == list(table.columns) == polars.DataFrame(table).columns
        pandas.testing.assert_frame_equal(pandas.DataFrame(table), table.to_pandas())
        assert dict(table).keys() == set(table.columns) and "t" in run.impacts
        assert table[0] == next(iter(table)) and table[-1] == list(table)[-1]
        for name in table.columns:
            assert np.asarray(table)[name].tolist() == table[name].tolist()
    with pytest.raises(IndexError, match="there is no row 1000000; there are "):
        run.impacts[10**6]
    with pytest.raises(KeyError, match="^there is no key 'q'; the keys are r, e, "):
        snapload.Case()["q"]


def test_a_flight_is_drawn_smoothly():
    """A curve is off by less than a thousandth of the picture between its points, however long the run."""
    run = snapload.Case(body="point", a=0.0, r=1.5, e=1.0, f_o=0.0, vx=0.3, t_end=400.0).run(trust=False)
    assert len(run.impacts) > 300
    ax = run.plot()
    drawn = np.concatenate([line.get_xydata() for line in ax.lines if len(line.get_xydata()) > 400])
    path = drawn[np.isfinite(drawn).all(axis=1)]
    from snapload._plot import curve_times

    times = curve_times(run, 0.0, run.end.t)
    middle = (times[1:] + times[:-1]) / 2
    exact, ends = run.at(middle), run.at(times)
    off = np.abs((ends.y[1:] + ends.y[:-1]) / 2 - exact.y).max()
    assert off < 1e-3 * np.ptp(path[:, 1])
    assert set(run.impacts["t"]) <= set(times)


def test_a_case_is_a_mapping(tmp_path: Path):
    case = snapload.Case(f_o=0.31, a=0.2, stop_when_sliding=True)
    assert snapload.Case(**case) == case and dict(case) == case.keys() and case["a"] == 0.2
    assert isinstance(case, Mapping) and dict(case.items()) == dict(case) and "a" in case and "depth" not in case
    assert list(case.values()) == [case[key] for key in case]
    assert case.get("a") == 0.2 and case.get("depth") is None and case.get("depth", 8.0) == 8.0
    point = snapload.Case(body="point", a=0)
    assert snapload.Case(**point) == point and len(case) == len(list(case))
    assert case.__replace__(e=0.5) == case.replace(e=0.5)
    case.to_file(tmp_path / "case.toml")
    again = snapload.Case.from_file(tmp_path / "case.toml")
    assert again == case and again.replace(a=0.3).inertia == 0.3 * 0.3


#: Its second value is not meant.
MASKED = np.ma.array([0.5, 0.6], mask=[False, True])


def test_an_array_without_a_masked_value_is_an_array():
    whole = np.ma.array([0.5, 0.6])
    assert snapload.sweep(snapload.Case(t_end=1), e=whole).e.values.tolist() == [0.5, 0.6]
    # In a list of cases a masked value is a missing one.
    cases = snapload.sweep(snapload.Case(t_end=1, e=0.7), cases={"e": MASKED})
    assert cases.e.values.tolist() == [0.5, 0.7]


def test_a_place_of_a_branch_is_checked():
    orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
    branch = snapload.continuation(orbit, "f_o", (1.35, 1.45))
    assert branch.orbit(-1) == branch.orbit(len(branch) - 1)
    with pytest.raises(IndexError, match=rf"there is no point 9999; there are {len(branch)} of them, from 0"):
        branch.orbit(9999)
    with pytest.raises(IndexError, match="there is no event 7; there are 0 of them"):
        branch.event(7)
    for wrong in (1.0, "1", slice(2)):
        with pytest.raises(TypeError, match=r"point = .* is not allowed; allowed: a whole number"):
            branch.orbit(wrong)


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda _: snapload.sweep("x"), TypeError, "case = 'x' is not allowed; allowed: a snapload.Case"),
        (lambda _: snapload.critical_force(None), TypeError, "case = None is not allowed"),
        (lambda _: snapload.Case(1.5), TypeError, "code = 1.5 is not allowed"),
        (lambda _: snapload.open_study("/no/such.parquet"), FileNotFoundError, "no/such"),
        (lambda _: snapload.sweep(snapload.Case(), cases="/no/such.csv"), FileNotFoundError, "no/such"),
        (lambda _: snapload.merge(["/no/such"], "x.parquet"), FileNotFoundError, "no/such"),
        (lambda _: snapload.sweep(snapload.Case(), e=[[0.5, 0.6]]), ValueError, "e = an array of 1 x 2 values"),
        (lambda path: snapload.sweep(snapload.Case(), out=path / "x.nc"), ValueError, "a name that ends in .parquet"),
        (lambda _: snapload.sweep(snapload.Case(), threads=2, client=1), ValueError, "threads are those of this"),
        (lambda _: snapload.sweep(snapload.Case(), seed=2), ValueError, "there are none; add random"),
        (lambda _: snapload.sweep(snapload.Case(), random=4, e=[0.5]), ValueError, "allowed with random: its two ends"),
        (lambda _: snapload.sweep(snapload.Case(), cases={"e": [1], "a": [1, 2]}), ValueError, "of several lengths"),
        (lambda _: snapload.sweep(snapload.Case(), cases=3), TypeError, "allowed: a DataFrame"),
        (lambda _: snapload.sweep(snapload.Case(), cases={"e": [0.5]}, r=[1]), ValueError, "cases determines"),
        (lambda _: snapload.sweep(snapload.Case(), chunks=2), ValueError, "give out"),
        (lambda _: snapload.Case().run(tolerance="x"), ValueError, "tolerance = 'x' is not allowed; allowed: a number"),
        (lambda _: snapload.Case().run(uncertainty="x"), ValueError, "uncertainty = 'x' is not allowed; allowed: a"),
        (lambda _: snapload.critical_force(snapload.Case(), largest=-1), ValueError, "largest = -1 is not allowed"),
        (lambda _: snapload.critical_force(snapload.Case(), over={"f_o": [1]}), ValueError, "the key that is searched"),
        (
            lambda _: snapload.critical_force(snapload.Case(), over="e"),
            ValueError,
            "over = 'e' is not allowed; allow",
        ),
        (
            lambda _: snapload.Hydro.from_dataset(None),
            TypeError,
            "dataset, a NoneType, is not allowed; allowed: an xa",
        ),
        (lambda _: snapload.cases[1], TypeError, "code = 1 is not allowed; allowed: the code of a built-in case"),
        (lambda _: snapload.sweep(snapload.Case(), e=MASKED), ValueError, "e = an array with 1 masked value is not"),
        (lambda _: snapload.sweep(snapload.Case(), random=2, e=MASKED), ValueError, "e = an array with 1 masked value"),
        (
            lambda _: snapload.Case(e=np.ma.masked),
            ValueError,
            r"e \(a masked value\) is not allowed; allowed: a num",
        ),
        (lambda _: snapload.Case().run(tolerance=np.ma.masked), ValueError, "tolerance = masked is not allowed"),
        (lambda _: snapload.Case().run(trust=False).at(MASKED), ValueError, "t = an array with 1 masked value"),
        (
            lambda _: snapload.Case().run(uncertainty=1e9),
            ValueError,
            "^uncertainty = 1e9 is not allowed; allowed: a s",
        ),
        (
            lambda _: snapload.ensemble(snapload.Case(), 5, uncertainty={"x": 1e9, "f_o": 1}),
            ValueError,
            "x=1e9, f_o=1",
        ),
    ],
)
def test_mistakes_are_reported(call, kind, message, tmp_path: Path):
    with pytest.raises(kind, match=message):
        call(tmp_path)


def test_annotations_are_types():
    for name in snapload.__all__:
        thing = getattr(snapload, name)
        members = vars(thing).items() if isinstance(thing, type) else ()
        for one in (thing, *(member for key, member in members if not key.startswith("_"))):
            if callable(one):
                typing.get_type_hints(one)
    assert typing.get_type_hints(snapload.sweep)["return"] is xarray.Dataset


def test_many_even_values_answer_ctrl_c():
    code = """
import signal, threading, time, snapload
threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
try:
    snapload.evenly(0, 1, 2 * 10**8)
except KeyboardInterrupt:
    print("interrupted")
"""
    began = time.monotonic()
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert result.stdout == "interrupted\n", result.stderr
    assert time.monotonic() - began < 5


@pytest.mark.skipif(importlib.util.find_spec("dask") is None, reason="needs Dask")
def test_a_study_opens_lazily(tmp_path: Path):
    out = tmp_path / "study.parquet"
    full = snapload.sweep(snapload.Case(t_end=1), out=out, trust=False, f_o="0.1:0.5:9", e="0.5:0.9:5")
    lazy = snapload.open_study(out, chunks={"f_o": 2})
    assert lazy.rho1.chunks == ((2, 2, 2, 2, 1), (5,)) and lazy.compute().identical(full)
    assert (
        lazy.rho1.isel(f_o=slice(6, 1, -2), e=3).values.tolist() == full.rho1.isel(f_o=[6, 4, 2], e=3).values.tolist()
    )
    assert lazy.end.sel(f_o=0.3).values.tolist() == full.end.sel(f_o=0.3).values.tolist()
    for chunks in ("auto", {}, 3):
        assert snapload.open_study(out, chunks=chunks).compute().identical(full)


def test_a_study_is_kept_once(tmp_path: Path):
    """What is kept of a study takes little more than its numbers."""
    code = f"""
import resource, sys
import xarray, snapload
out = {str(tmp_path / "study.parquet")!r}
snapload.sweep(snapload.Case(t_end=0.01), out=out, trust=False, f_o="0.1:0.5:300", e="0.5:0.9:200", progress=False)
if len(sys.argv) > 1:
    study = snapload.open_study(out)
    print(study.nbytes)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
"""
    script = tmp_path / "keep.py"
    script.write_text(code.replace("progress=False)", "progress=False, resume=True)", 1))
    subprocess.run([sys.executable, script], check=True, capture_output=True)
    alone = subprocess.run([sys.executable, script], check=True, capture_output=True, text=True).stdout.split()
    opened = subprocess.run([sys.executable, script, "open"], check=True, capture_output=True, text=True).stdout.split()
    size, more = int(opened[0]), int(opened[1]) - int(alone[-1])
    assert more < 2 * size, (size, more)
