"""The numbers, files and words are those of the command line, to the bit."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas
import polars
import pyarrow
import pytest
import snapload

CODES = ["1910001000-359", "1922001000-559", "1920001000-359", "sliding-example", "rocking-example"]
STATE = ["x", "y", "theta", "vx", "vy", "vtheta"]


def in_json(ensemble):
    """An ensemble in the shape of the command's JSON."""
    if ensemble is None:
        return None
    ends = [{"reason": reason, **asdict(share)} for reason, share in ensemble.ends.items()]
    return {"members": ensemble.members, "seed": ensemble.seed, "ends": ends}


@pytest.mark.parametrize("code", CODES)
def test_a_run_is_the_same(command_json, code):
    data = command_json("run", "--case", code, "--sample", "0.25", "--ensemble", "30")
    run = snapload.cases[code].run(members=30)

    assert (run.end.reason, run.end.t, run.end.t_limit) == tuple(data["end"][k] for k in ("reason", "t", "t_limit"))
    assert {k: getattr(run.norms, k) for k in data["norms"]} == data["norms"]
    assert (run.trust.t, run.trust.impact, run.trust.because) == tuple(
        data["trust"][k] for k in ("t", "impact", "because")
    )
    assert list(run.trust.exponents) == data["trust"]["exponents"]
    assert in_json(run.outcome.ensemble) == data["outcome"]["ensemble"]
    assert run.case.keys() == data["case"]

    impacts = run.impacts
    for column in ("t", "cable", "v_n", "impulse", "energy_lost", "digits"):
        assert impacts[column].tolist() == [row[column] for row in data["impacts"]]
    for side in ("before", "after"):
        states = np.column_stack([impacts[f"{side}_{name}"] for name in STATE])
        assert states.tolist() == [row[side] for row in data["impacts"]]
    modes = run.modes
    assert [list(taut) for taut in modes["taut"]] == [row["taut"] for row in data["modes"]]
    for column in ("mode", "t_start", "t_end"):
        assert modes[column].tolist() == [row[column] for row in data["modes"]]

    motion = run.motion(0.25)
    for name in motion.dtype.names:
        assert motion[name].tolist() == [row[name] for row in data["motion"]]
    assert run.at(motion.t).tolist() == motion.tolist()
    assert tuple(run.at(run.end.t).item())[1:7] == run.end.state


def test_the_text_and_the_json_are_the_same(command):
    run = snapload.cases["sliding-example"].run(members=20)
    line = command("run", "--case", "sliding-example", "--ensemble", "20", "--sample", "1", "--json", "-")
    assert run.to_json(1.0) == line.rstrip("\n")
    assert str(run) == command("run", "--case", "sliding-example", "--ensemble", "20").rstrip("\n")
    assert repr(snapload.cases["1910001000-359"].run(members=0)).startswith("<Run of Case('1910001000-359'): settled")


def test_uncertainty_is_the_same(command_json):
    data = command_json("run", "--uncertainty", "1e-3", "--uncertainty", "f_o=0.01", "--seed", "7", "--ensemble", "40")
    sizes = dict.fromkeys(STATE, 1e-3) | {"f_o": 0.01}
    run = snapload.Case().run(uncertainty=sizes, seed=7, members=40)
    assert in_json(run.outcome.ensemble) == data["outcome"]["ensemble"]
    assert run.trust.uncertainty == data["trust"]["uncertainty"]
    assert run.trust.impact == data["trust"]["impact"]
    counted = snapload.ensemble(snapload.Case(), 40, uncertainty=sizes, seed=7)
    assert {end: share.count for end, share in counted.ends.items()} == {
        row["reason"]: row["count"] for row in data["outcome"]["ensemble"]["ends"]
    }


def test_the_critical_force_is_the_same(command_json):
    data = command_json("critical", "--max", "0.5", "--ensemble", "10")
    found = snapload.critical_force(snapload.Case(), largest=0.5, members=10)
    assert (found.f_cr, found.reason, found.t) == (data["f_cr"], data["reason"], data["t"])
    assert found.exceeding.tolist() == data["exceeding"]
    assert found.uncertain.tolist() == data["uncertain"]
    assert found.certain is data["certain"]
    assert found.passes == data["passes"]
    for name in ("f_o", "certain", "cut_short", "count", "part", "low", "high"):
        values = [np.nan if point[name] is None else point[name] for point in data["probability"]]
        np.testing.assert_array_equal(found.probability[name], values)
    # Where one run decides, no neighbour is run: there is no count, and nothing is left open.
    certain = found.probability[found.probability.certain]
    assert len(certain) and np.isnan(certain.count).all() and (certain.low == certain.high).all()


def test_the_proof_is_the_same(command_json, command):
    args = ["verify", "--case", "1710001000-359", "--tolerance", "1e-15"]
    data = command_json(*args)
    proof = snapload.verify(snapload.cases["1710001000-359"], tolerance=1e-15)
    assert proof.first_wrong is not None
    for name in ("digits", "digits_left", "first_wrong", "predicted", "compared", "end", "t", "impacts"):
        assert getattr(proof, name) == data[name]
    assert proof.differences.tolist() == data["differences"]
    assert str(proof) == command(*args).rstrip("\n")


def test_an_end_that_is_not_known_is_none():
    # With 153 digits this run has 322 impacts.
    proof = snapload.verify(snapload.cases["1922001000-359"])
    assert (proof.end, proof.t, proof.impacts, proof.digits_left) == (None, None, None, 0)
    assert 200 < len(proof.exact) < 322
    assert proof.first_wrong is not None
    assert "its end is not" in str(proof)


def test_the_file_of_a_study_is_the_same_to_the_byte(command, tmp_path: Path):
    by_package, by_command = tmp_path / "ours.parquet", tmp_path / "theirs.parquet"
    axes = ["--vary", "f_o=0.2:0.5:4", "--vary", "e=0.5,0.9,1.0", "--vary", "body=rigid,point"]
    command("sweep", "--set", "t_end=5", *axes, "--out", str(by_command))
    case = snapload.Case(t_end=5)
    there = snapload.sweep(case, out=by_package, f_o="0.2:0.5:4", e=[0.5, 0.9, 1.0], body=["rigid", "point"])
    assert by_package.read_bytes() == by_command.read_bytes()
    assert snapload.open_study(by_command).identical(there)
    # A row is the run of its case.
    run = case.replace(f_o=0.4, e=0.9).run(members=0)
    row = there.sel(f_o=0.4, e=0.9, body="rigid")
    assert (row.t, row.rho3, row.y_max) == (run.end.t, run.norms.rho3, run.norms.y_max)
    assert row.impacts_1 + row.impacts_2 == (run.impacts["v_n"] > 0).sum()


def test_words_count_impacts_without_impulses_passed_into_a_taut_cable():
    case = snapload.Case(f_o=0.27, stop_when_settled=False, t_end=9)
    run = case.run(members=0)
    of_cables = [int(((run.impacts["cable"] == k) & (run.impacts["v_n"] > 0)).sum()) for k in (1, 2)]
    passed = len(run.impacts) - sum(of_cables)
    assert passed > 1 and repr(run).endswith(f", {sum(of_cables)} impacts>")
    counts = f"{of_cables[0]} of cable 1, {of_cables[1]} of cable 2; {passed} impulses passed into a taut cable"
    assert counts in str(run)


def test_parts_lists_and_random_points_open(command, tmp_path: Path):
    part, box, cases = (tmp_path / name for name in ("part.parquet", "box.parquet", "cases.parquet"))
    command("sweep", "--vary", "e=0.5:0.9:5", "--shard", "2/2", "--out", str(part))
    opened = snapload.open_study(part)
    assert opened.e.values.tolist() == [0.7, 0.8, 0.9] and opened.attrs["first_row"] == 2
    command("sweep", "--vary", "e=0.5:0.9", "--random", "4", "--out", str(box))
    assert snapload.open_study(box).sizes == {"row": 4}
    (tmp_path / "cases.csv").write_text("e,f_o\n0.5,0.3\n2,0.3\n")
    command("sweep", "--list", str(tmp_path / "cases.csv"), "--out", str(cases))
    listed = snapload.open_study(cases)
    assert listed.end.values.tolist() == ["settled", ""] and "e = 2 is not allowed" in listed.error.values[1]
    (tmp_path / "half.parquet").write_bytes(box.read_bytes()[:-100])
    with pytest.raises(OSError, match="half.parquet"):
        snapload.open_study(tmp_path / "half.parquet")


def test_random_points_tables_and_parts_are_the_same(command, tmp_path: Path):
    by_command, by_package = tmp_path / "theirs.parquet", tmp_path / "ours.parquet"
    case = snapload.Case(t_end=5)
    command("sweep", "--set=t_end=5", "--vary=e=0.5:0.9", "--random=9", "--seed=3", "--out", str(by_command))
    box = snapload.sweep(case, out=by_package, random=9, seed=3, e=(0.5, 0.9))
    assert by_package.read_bytes() == by_command.read_bytes() and box.sizes == {"row": 9}

    table = tmp_path / "cases.csv"
    table.write_text("e,stop_when_settled,max_impacts\n0.5,true,\n0.75,false,7\n,true,100\n")
    by_command.unlink(), by_package.unlink()
    command("sweep", "--set=t_end=5", "--set=a=0.2", "--list", str(table), "--out", str(by_command))
    frame = pandas.DataFrame({"e": [0.5, 0.75, None], "stop_when_settled": [True, False, True]})
    frame["max_impacts"] = [None, 7, 100]
    listed = snapload.sweep(case.replace(a=0.2), out=by_package, cases=frame)
    assert by_package.read_bytes() == by_command.read_bytes()
    assert listed.e.values.tolist() == [0.5, 0.75, 0.9]
    for same in (polars.from_pandas(frame), pyarrow.Table.from_pandas(frame), dict(frame), table):
        assert snapload.sweep(case.replace(a=0.2), cases=same).identical(listed)

    parts = [tmp_path / f"part-{i}.parquet" for i in (1, 2)]
    for i, part in enumerate(parts, 1):
        command("sweep", "--set=t_end=5", "--vary=e=0.5:0.9:5", "--shard", f"{i}/2", "--out", str(part))
    whole = snapload.merge(parts, tmp_path / "whole.parquet")
    assert whole.drop_attrs().identical(snapload.sweep(case, e="0.5:0.9:5").drop_attrs())
    with pytest.raises(ValueError, match="exists already"):
        snapload.merge(parts, tmp_path / "whole.parquet")


def test_the_critical_force_over_keys_is_the_same(command_json):
    data = command_json("critical", "--max=0.6", "--step=0.02", "--over", "e=0.7:0.9:3")
    found = snapload.critical_force(snapload.Case(), over={"e": "0.7:0.9:3"}, largest=0.6, step=0.02)
    assert found.e.values.tolist() == [point["value"] for point in data["points"]]
    for point in data["points"]:
        here = found.sel(e=point["value"])
        assert (None if np.isnan(here.f_cr) else float(here.f_cr)) == point["f_cr"]
        exceeds = here.f_o.values[here.exceeds.values]
        assert sum(((exceeds >= low) & (exceeds <= high)).sum() for low, high in point["exceeding"]) == len(exceeds)
        assert {low for low, _ in point["exceeding"]} <= set(exceeds)
        assert bool(here.certain) is point["certain"]
        uncertain = here.f_o.values[here.uncertain.values]
        assert {low for low, _ in point["uncertain"]} <= set(uncertain)
    grid = snapload.critical_force(snapload.Case(), over={"r": [0.5, 1.5], "e": [0.9]}, largest=0.4, step=0.1)
    assert grid.f_cr.dims == ("r", "e") and "r > |1 - a|" in grid.error.sel(r=0.5).item()


def test_derivatives_are_those_of_the_command(command_json):
    data = command_json("run", "--set=f_o=0.31")["trust"]
    rows = {(row["impact"], row["key"]): row for row in snapload.sensitivities(snapload.Case(f_o=0.31))}
    for impact in data["sensitivity"]:
        for name in ("t", "v_n", "impulse"):
            for key, value in impact[name].items():
                assert rows[impact["impact"], key][name] == value
    assert snapload.Case(f_o=0.31).run().exponents["exponent"].tolist() == data["exponents"]


@pytest.mark.parametrize(
    "keys",
    [
        {"e": 1.5},
        {"r": 0.5},
        {"y": -3.0},
        {"omgea": 1.0},
        {"h": 1.0},
        {"max_impacts": 0},
        {"body": "ball"},
        {"inertia": 1e-20},
        {"theta": 2.0},
        {"stop_when_settled": 3},
    ],
)
def test_errors_have_the_same_messages(command, keys):
    sets = [f"--set={key}={json.dumps(value)}" for key, value in keys.items()]
    data = command("run", *sets, fails=True)
    with pytest.raises(ValueError) as error:
        snapload.Case(**keys)
    message = str(error.value)
    assert message in data.replace("--set ", ""), (message, data)
    with pytest.raises(ValueError) as again:
        snapload.Case(f_o=0.2).replace(**keys)
    assert str(again.value) == message


def test_a_file_is_read_as_the_command_reads_it(command, command_json, tmp_path: Path):
    path = tmp_path / "mooring.toml"
    path.write_text("a = 0.2\nb = 0.1\nf_o = 0.25\nt_end = 5\n")
    case = snapload.Case.from_file(path)
    assert case.keys() == command_json("run", str(path))["case"] and case.name == str(path)
    path.write_text("a = 0.2\ne = 7\n")
    with pytest.raises(ValueError, match="mooring.toml: e = 7 is not allowed"):
        snapload.Case.from_file(path)
    path.write_text("a == 2")
    with pytest.raises(ValueError, match="mooring.toml"):
        snapload.Case.from_file(path)
    path.write_bytes(b"f_o = 0.2 # \xff")
    message = r"mooring.toml: not a text file in UTF-8 \(byte 12\); save it as UTF-8"
    with pytest.raises(ValueError, match=message):
        snapload.Case.from_file(path)
    assert re.search(message, command("run", str(path), fails=True))


def test_a_file_with_a_byte_order_mark_is_read_as_the_command_reads_it(command_json, tmp_path: Path):
    path = tmp_path / "mooring.toml"
    path.write_bytes(b"\xef\xbb\xbff_o = 0.25\r\nt_end = 5\r\n")
    case = snapload.Case.from_file(path)
    assert case == snapload.Case(f_o=0.25, t_end=5) and case.keys() == command_json("run", str(path))["case"]


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have names in Unicode only")
def test_a_path_that_is_no_text_is_read_as_the_command_reads_it(command_json, tmp_path: Path):
    path = tmp_path / os.fsdecode(b"m\xfcring.toml")
    path.write_text("f_o = 0.25\nt_end = 5\n")
    case = snapload.Case.from_file(path)
    assert case.keys() == command_json("run", str(path))["case"] and case.name == f"{tmp_path}/m\ufffdring.toml"
    assert snapload.Case.from_file(os.fsencode(path)) == case
    path.write_text("e = 7\n")
    with pytest.raises(ValueError, match="m\ufffdring.toml: e = 7 is not allowed"):
        snapload.Case.from_file(path)


def test_the_command_of_the_package_is_the_command(command, tmp_path: Path):
    def run(*args: str, folder: Path = tmp_path) -> subprocess.CompletedProcess[str]:
        message = [sys.executable, "-m", "snapload", *args]
        return subprocess.run(message, capture_output=True, text=True, cwd=folder, timeout=60)

    for line in (["run", "--json", "-"], ["--version"], ["keys"], ["run", "--help"]):
        assert run(*line).stdout == command(*line)
    bad = run("run", "--set", "e=2")
    assert (bad.returncode, bad.stdout, bad.stderr) == (2, "", command("run", "--set", "e=2", fails=True))
    swept = run("sweep", "--vary", "e=0.5,0.9", "--out", "e.parquet")
    assert swept.returncode == 0 and snapload.open_study(tmp_path / "e.parquet").sizes == {"e": 2}


def test_the_report_is_written_to_the_given_directory(monkeypatch, tmp_path: Path):
    files = [("report.html", b"page"), ("figures/6-1.svg", b"figure")]
    monkeypatch.setattr(snapload._engine, "reproduce", lambda tell: files)
    page = snapload.reproduce(tmp_path / "chapter" / "6")
    assert page == tmp_path / "chapter" / "6" / "report.html"
    assert [(page.parent / name).read_bytes() for name, _ in files] == [contents for _, contents in files]
