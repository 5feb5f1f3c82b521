"""Studies: labelled, interruptible, resumable, without Python's lock, on one machine and on several."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import snapload
import xarray
from matplotlib import pyplot


def test_a_dataset_is_labelled(tmp_path: Path):
    f_o, e = snapload.evenly(0.1, 0.5, 3), [0.5, 0.9]
    study = snapload.sweep(snapload.Case(), f_o=f_o, e=e)
    assert study.rho1.dims == ("f_o", "e") and study.f_o.values.tolist() == [0.1, 0.3, 0.5]
    about = {"long_name": "rho1, in L/T", "units": "1", "scale": "L/T", "comment": "largest v_n of a snap"}
    about["quantity"] = "rho1"
    assert study.rho1.attrs == about
    assert study.f_o.attrs["scale"] == "F" and study.e.attrs["units"] == "1"
    assert study.end.sel(f_o=0.3, e=0.9) == "settled"
    flags = dict(zip(study.end_code.flag_values, study.end_code.flag_meanings.split(), strict=True))
    assert [flags[code] for code in study.end_code.values.ravel()] == study.end.values.ravel().tolist()
    path = tmp_path / "study.nc"
    study.to_netcdf(path, engine="h5netcdf")
    with xarray.open_dataset(path, engine="h5netcdf") as again:
        xarray.testing.assert_identical(again.load(), study)
    study.rho1.plot(x="f_o", hue="e")
    ax = pyplot.gca()
    ax.figure.canvas.draw()
    # Labels are whole, in a picture of the usual size.
    for label in (ax.xaxis.label, ax.yaxis.label):
        box = label.get_window_extent()
        assert ax.figure.bbox.containsx(box.x0) and ax.figure.bbox.containsy(box.y0)


def test_values_are_the_decimals_that_one_would_write():
    assert snapload.evenly(0.01, 0.6, 60).tolist() == [k / 100 for k in range(1, 61)]
    with pytest.raises(ValueError, match="count = 0 is not allowed"):
        snapload.evenly(0, 1, 0)
    with pytest.raises(ValueError, match="is not a range"):
        snapload.evenly("a", 1, 3)


def test_without_trust_its_columns_are_absent():
    plain = snapload.sweep(snapload.Case(), trust=False, e=[0.5])
    assert "certain" not in plain and "horizon_t" not in plain and plain.sizes == {"e": 1}
    assert snapload.sweep(snapload.Case(t_end=1)).sizes == {}


def test_illegal_cases_are_reported():
    study = snapload.sweep(snapload.Case(), a=[0.1, 0.2], r=[0.5, 1.5])
    assert np.isnan(study.t.sel(r=0.5)).all() and np.isfinite(study.t.sel(r=1.5)).all()
    assert "r > |1 - a| = 0.9" in study.error.sel(a=0.1, r=0.5).item()
    assert study.end_code.sel(a=0.1, r=0.5) == -1


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ({"e": [0.5, 1.5]}, "e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1"),
        ({"omgea": [1]}, "did you mean omega"),
        ({"e": "0:1"}, "write first:last:n"),
        ({"e": []}, "give at least one value"),
    ],
)
def test_mistakes_are_refused_with_a_message(axes, message):
    with pytest.raises(ValueError, match=message):
        snapload.sweep(snapload.Case(), **axes)


def test_only_resume_continues(tmp_path: Path):
    out = tmp_path / "e.parquet"
    first = snapload.sweep(snapload.Case(), out=out, e=[0.5, 0.6])
    assert snapload.sweep(snapload.Case(), out=out, resume=True, e=[0.5, 0.6]).identical(first)
    with pytest.raises(ValueError, match="exists already"):
        snapload.sweep(snapload.Case(), out=out, e=[0.5, 0.6])
    with pytest.raises(ValueError, match="holds something else"):
        snapload.sweep(snapload.Case(), out=out, resume=True, e=[0.5, 0.7])


INTERRUPTED = """
import sys, time, snapload
snapload.sweep(snapload.Case(t_end=0.1), e=[0.5])
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print(time.monotonic(), flush=True)
    {after}
"""


def interrupt(call: str, after: str = "", at_work: Callable[[], bool] | None = None) -> tuple[float, str]:
    """Sends Ctrl-C to a Python at work; returns the time until it answered, and what it printed after that.

    It is sent as soon as `at_work` holds, or else after 0.7 s to calls that take minutes."""
    code = INTERRUPTED.format(call=call, after=after)
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        if at_work is None:
            time.sleep(0.7)
        else:
            while not at_work():
                assert process.poll() is None, "it ended before the signal was sent"
                time.sleep(0.001)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        answered = float(process.stdout.readline())
        rest = process.stdout.read()
    assert process.returncode == 0
    return answered - sent, rest


@pytest.mark.parametrize(
    "call",
    [
        "snapload.sweep(snapload.Case(), f_o='0.1:0.6:1000', omega='0.5:1.5:1000')",
        "snapload.Case('rocking-example', t_end=1e6).run()",
        "snapload.ensemble(snapload.Case(), 10**7)",
        "snapload._engine.reproduce(None)",
        "run = snapload.Case().run(); run.to_json(1e-6)",
        "snapload.critical_force(snapload.Case(t_end=1e4, stop_when_settled=False), members=10**6)",
    ],
)
def test_ctrl_c_is_answered_within_a_second(call):
    took, _ = interrupt(call)
    assert took < 1.0


def test_after_ctrl_c_the_same_process_continues(tmp_path: Path):
    out = tmp_path / "map.parquet"
    call = f"snapload.sweep(snapload.Case(t_end=1), out={str(out)!r}, trust=False, f_o='0.1:0.6:400', e='0.5:0.9:400')"
    # What was being brought to the disk holds the file until it is there; the error says so.
    again = f"""
    while True:
        try:
            {call.replace("trust", "resume=True, trust")}
            break
        except ValueError as error:
            assert "another snapload process is writing" in str(error)
            time.sleep(0.05)
    print('whole')"""
    took, printed = interrupt(call, again, lambda: any(tmp_path.glob("map.parquet.parts/rows-*")))
    assert took < 1.0
    assert printed == "whole\n"
    assert snapload.open_study(out).sizes == {"f_o": 400, "e": 400}


def test_more_threads_than_help_are_capped_with_a_warning():
    with pytest.warns(UserWarning, match=r"^threads=60000: this machine runs \d+ at a time.* are used$"):
        study = snapload.sweep(snapload.Case(), f_o=[0.3, 0.31], threads=60_000)
    assert study.sizes["f_o"] == 2


def test_other_threads_run_meanwhile():
    work = threading.Thread(target=snapload.sweep, args=[snapload.Case()], kwargs=dict(e="0.5:0.9:3000"))
    began = time.monotonic()
    work.start()
    turns = 0
    while work.is_alive():
        time.sleep(0.002)
        turns += 1
    took = time.monotonic() - began
    # With the lock held there would be none while it computes.
    assert took > 0.05 and turns > 0.1 * took / 0.002


@pytest.mark.filterwarnings("ignore")
def test_dask_computes_the_same_bits_though_a_worker_is_killed(tmp_path: Path):
    from distributed import Client, LocalCluster

    case, axes = snapload.Case(), dict(f_o="0.1:0.6:60", e="0.5:0.95:40")
    here, there = tmp_path / "here.parquet", tmp_path / "there.parquet"
    local = snapload.sweep(case, out=here, **axes)
    killed = []

    def kill(pid: int) -> None:
        while not any((tmp_path / "there.parquet.parts").glob("rows-*")):
            time.sleep(0.005)
        os.kill(pid, signal.SIGKILL)
        killed.append(not there.exists())

    with (
        LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster,
        Client(cluster) as client,
    ):
        killer = threading.Thread(target=kill, args=[min(client.run(os.getpid).values())])
        killer.start()
        far = snapload.sweep(case, out=there, client=client, **axes)
        killer.join()
        assert killed == [True], "the worker was to die in the middle"
        # What a dead driver left is taken up, and only the rest is computed.
        again = tmp_path / "again.parquet"
        study = snapload._engine.Study.grid(case._engine, list(axes.items()), True)
        store = snapload._engine.Store.open(study, again, False)
        data = study.chunk(100, 300)
        store.keep(100, 300, data)
        store.close()
        snapload.sweep(case, out=again, resume=True, client=client, **axes)
    assert far.identical(local)
    assert here.read_bytes() == there.read_bytes() == again.read_bytes()


def test_rows_of_another_study_are_refused(tmp_path: Path):
    engine = snapload._engine
    ours, other = (engine.Study.grid(snapload.Case()._engine, [("e", values)], True) for values in ([0.5], [0.6]))
    store = engine.Store.open(ours, tmp_path / "e.parquet", False)
    with pytest.raises(ValueError, match="came from another study or another version of snapload"):
        store.keep(0, 1, other.chunk(0, 1))


def test_a_part_without_rows_is_opened(tmp_path: Path, command: Callable[..., str]):
    parts = [tmp_path / f"{k}.parquet" for k in range(1, 6)]
    for k, part in enumerate(parts, 1):
        vary_options = ["--vary", "e=0.5:0.7:3", "--set", "t_end=2"]
        command("sweep", *vary_options, "--shard", f"{k}/5", "--out", str(part))
    sizes = [snapload.open_study(part).sizes["row"] for part in parts]
    # Of three rows the k-th part ends at the whole number below 3 k / 5.
    assert sizes == [0, 1, 0, 1, 1]
    full, empty = snapload.open_study(parts[1]), snapload.open_study(parts[0])
    assert {name: values.dtype for name, values in empty.items()} == {
        name: values.dtype for name, values in full.items()
    }
    assert snapload.open_study(parts[0], chunks="auto").rho1.compute().size == 0
    assert snapload.merge(parts, tmp_path / "whole.parquet").e.values.tolist() == [0.5, 0.6, 0.7]


def test_a_study_of_which_no_case_can_be_run_is_an_error(tmp_path: Path):
    message = "none of the 2 cases could be run; the first: .*0,3"
    with pytest.raises(ValueError, match=message):
        snapload.sweep(snapload.Case(), cases={"f_o": ["0,3", "0,4"]})
    with pytest.raises(ValueError, match=message):
        snapload.sweep(snapload.Case(), out=tmp_path / "f_o.parquet", cases={"f_o": ["0,3", "0,4"]})
    # The file has the reason of every case, as that of the command.
    reasons = snapload.open_study(tmp_path / "f_o.parquet").error.values
    assert ["0,3" in reasons[0], "0,4" in reasons[1]] == [True, True]
    some = snapload.sweep(snapload.Case(), cases={"f_o": ["0,3", "0.3"]})
    assert some.end.values.tolist() == ["", "settled"]


@pytest.mark.parametrize("values", ["1:4:3", [1, 2.5, 4]])
def test_a_count_takes_no_fractions(values):
    cables = [snapload.Cable((side, 1.2), 1.45) for side in (-1, 1)]
    forcing = snapload.Forcing((0, -1), [])
    system = snapload.System(snapload.Body(mass=1.0), cables, forcing, 0.5, y=0.6, t_end=3)
    for sweep in (lambda **axes: snapload.sweep(snapload.Case(t_end=3), **axes), system.sweep):
        with pytest.raises(ValueError, match=r"max_impacts = 2.5 is not allowed; allowed: a whole number"):
            sweep(max_impacts=values)
        assert sweep(max_impacts="1:3:3").max_impacts.values.tolist() == [1, 2, 3]


def test_a_place_where_nothing_can_be_merged_is_named(tmp_path: Path):
    part = tmp_path / "part.parquet"
    snapload.sweep(snapload.Case(t_end=1), out=part, e=[0.5])
    missing = tmp_path / "none" / "m.parquet"
    with pytest.raises(ValueError, match=f"can not write {missing}: there is no folder {missing.parent}; make it"):
        snapload.merge([part], missing)
    with pytest.raises(ValueError, match=f"can not write {tmp_path / 'm.csv'}: rows are written as Parquet"):
        snapload.merge([part], tmp_path / "m.csv")


@pytest.mark.parametrize(("values", "refused"), [([0.1, "a"], "a"), ([True, 0.2], "true"), ([0.1, "0,3"], "0,3")])
def test_each_value_of_a_mixed_list_is_judged_by_itself(values, refused):
    with pytest.raises(ValueError, match=f'f_o = "?{refused}"? is not allowed'):
        snapload.sweep(snapload.Case(t_end=1), f_o=values)
    assert snapload.sweep(snapload.Case(t_end=1), f_o=[0.1, np.float32(0.5), 1]).f_o.values.tolist() == [0.1, 0.5, 1]


def test_dates_are_no_values_of_a_key(tmp_path: Path):
    pandas = pytest.importorskip("pandas")
    dates = pandas.DataFrame({"f_o": pandas.to_datetime(["2026-01-01"])})
    dates.to_parquet(tmp_path / "dates.parquet")
    with pytest.raises(ValueError, match=r"column f_o holds Timestamp; allowed: numbers, texts"):
        snapload.sweep(snapload.Case(), cases=tmp_path / "dates.parquet")
