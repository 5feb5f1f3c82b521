"""What an option may not be is refused in the words of the command line, before anything is computed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest
import snapload
import xarray

ROOT = Path(__file__).resolve().parents[2]
CYLINDER = str(ROOT / "docs/examples/cylinder.toml")
PONTOON = str(ROOT / "docs/examples/pontoon.nc")
CASE = snapload.Case()
POINT = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
SEA = {"sea.hs": 2, "sea.tp": 6}


def cylinder() -> snapload.Structure:
    return snapload.Structure.from_toml(CYLINDER)


def sea() -> snapload.Structure:
    return cylinder().without("wave").replace(SEA)


BOX: dict[str, Any] = {"e": (0.5, 0.9)}
WINDOW: dict[str, Any] = {"x": [0, 0.1], "y": [0, 0.1]}
#: The option of Python; that of the command and what comes before it; and the call.
WHOLE: list[tuple[str, str, list[str], Callable[[Any], Any]]] = [
    ("neighbours", "--neighbours", ["assess", CYLINDER], lambda n: cylinder().assess(neighbours=n)),
    ("seeds", "--seeds", ["seas", CYLINDER], lambda n: sea().seas(seeds=n)),
    ("segments", "--segments", ["moordyn", "write", CYLINDER], lambda n: cylinder().to_moordyn("x.txt", segments=n)),
    ("pairs", "--pairs", ["hydro", PONTOON], lambda n: snapload.Hydro.from_file(PONTOON, pairs=n)),
    ("members", "--ensemble", ["run"], lambda n: CASE.run(members=n)),
    ("seed", "--seed", ["run"], lambda n: CASE.run(seed=n)),
    ("members", "--ensemble", ["critical"], lambda n: snapload.ensemble(CASE, n)),
    ("periods", "--periods", ["section"], lambda n: snapload.section(CASE, periods=n)),
    ("keep", "--keep", ["section"], lambda n: snapload.section(CASE, keep=n)),
    ("periods", "--periods", ["orbit"], lambda n: CASE.orbit(periods=n)),
    ("starts", "--find", ["orbit"], lambda n: snapload.find_orbits(CASE, starts=n)),
    ("seed", "--seed", ["orbit", "--find", "1"], lambda n: snapload.find_orbits(CASE, starts=1, seed=n)),
    ("transient", "--transient", ["basin"], lambda n: snapload.basins_of_attraction(CASE, transient=n, **WINDOW)),
    ("random", "--random", ["sweep", "--out", "x.parquet"], lambda n: snapload.sweep(CASE, random=n, **BOX)),
    ("seed", "--seed", ["sweep", "--out", "x.parquet"], lambda n: snapload.sweep(CASE, random=1, seed=n, **BOX)),
    ("threads", "--threads", ["sweep", "--out", "x.parquet"], lambda n: snapload.sweep(CASE, threads=n, e=[0.5])),
    ("digits", "--digits", ["verify"], lambda n: snapload.verify(CASE, n)),
    ("impacts", "--impacts", ["sensitivities"], lambda n: snapload.sensitivities(CASE, n)),
]


@pytest.mark.parametrize("value", [-1, 10**30])
@pytest.mark.parametrize(("name", "option", "verb", "call"), WHOLE, ids=[f"{row[2][0]}-{row[0]}" for row in WHOLE])
def test_whole_numbers_have_the_bounds_and_messages_of_the_command(command, name, option, verb, call, value):
    message = command(*verb, option, str(value), fails=True)
    with pytest.raises(ValueError) as error:
        call(value)
    # Python calls some options otherwise.
    expected = message.replace(option, name).replace(f"= {option[2:]} <=", f"= {name} <=")
    assert f"error: {error.value}\n" == expected
    assert f"{name} = {value} is not allowed; allowed: a whole number, " in expected


@pytest.mark.parametrize(
    ("name", "option", "value"),
    [
        *(("stiffer", "--stiffer", value) for value in (0, -1, 1e12, float("nan"), float("inf"))),
        *(("every", "--every", value) for value in (0, -1, float("nan"), 1e9)),
    ],
)
def test_numbers_have_the_bounds_and_messages_of_the_command(command, name, option, value):
    message = command("elastic", CYLINDER, option, str(value), fails=True)
    with pytest.raises(ValueError) as error:
        cylinder().elastic(**{name: value})
    allowed = "is not allowed; allowed: a number, 1e-6 <= "
    assert allowed in message and allowed in str(error.value)
    assert message.rpartition("allowed: ")[2].rstrip() == str(error.value).rpartition("allowed: ")[2]
    assert str(error.value).startswith(f"{name} = ")


def test_the_states_that_are_kept_fit_into_memory(command, tmp_path: Path):
    message = command("elastic", CYLINDER, "--every", "1e-6", "--out", str(tmp_path / "x.csv"), fails=True)
    with pytest.raises(ValueError) as error:
        cylinder().elastic(every=1e-6)
    assert message == f"error: --{error.value}\n"


@pytest.mark.parametrize(
    ("message", "call"),
    [
        ("seeds = 0 is not", lambda: sea().seas(seeds=0)),
        ("seeds = 10001 is not", lambda: sea().seas(seeds=10001)),
        ("neighbours = 1000000000 is not", lambda: cylinder().assess(neighbours=10**9)),
        ("neighbours = 2.5 is not", lambda: cylinder().assess(neighbours=2.5)),
        ("neighbours = 'many' is not", lambda: cylinder().assess(neighbours="many")),
        ("pairs = 0 is not", lambda: snapload.Hydro.from_file(PONTOON, pairs=0)),
        ("mass = nan is not", lambda: snapload.Hydro.from_file(PONTOON, mass=float("nan"))),
        ("damping = .* is not", lambda: snapload.Hydro.from_file(PONTOON, damping=("a", 0, 0))),
        ("count = -1 is not", lambda: snapload.evenly(0, 1, -1)),
        ("laps = -1 is not", lambda: POINT.orbit().run(laps=-1)),
        ("max_impacts = 0 is not", lambda: CASE.replace(max_impacts=0)),
        ("stiffer = 10+ is not", lambda: cylinder().elastic(stiffer=10**400)),
        ("phase = 10+ is not", lambda: POINT.orbit(phase=10**400)),
        ("first = 10+ is not", lambda: snapload.evenly(10**400, 1, 2)),
    ],
)
def test_what_the_command_does_not_offer_is_refused_as_well(message, call):
    with pytest.raises(ValueError, match=message):
        call()


def test_the_bounds_themselves_are_allowed():
    whole = snapload._engine.whole
    assert whole("seed", 2**64 - 1) == 2**64 - 1
    assert whole("neighbours", np.int64(100_000)) == 100_000
    assert whole("seeds", np.array(1)) == 1
    assert whole("symbol", 2, 2) == 2


def test_a_list_of_cases_is_named_in_errors(tmp_path: Path):
    with pytest.raises(ValueError, match=r'^the list of cases: there is no key "f_oo"; did you mean f_o\?'):
        snapload.sweep(CASE, cases=pandas.DataFrame({"f_oo": [0.1]}))
    with pytest.raises(ValueError, match="^can not read the list of cases: it contains no case"):
        snapload.sweep(CASE, cases={"f_o": []})
    path = tmp_path / "mine.csv"
    path.write_text("f_oo\n0.1\n")
    with pytest.raises(ValueError) as error:
        snapload.sweep(CASE, cases=path)
    assert str(error.value).startswith(f'{path}: there is no key "f_oo"')


def test_cases_have_no_index_that_would_be_left_out():
    frame = pandas.DataFrame({"f_o": [0.1, 0.2], "e": [0.5, 0.6]})
    indexed = frame.set_index("f_o")
    two = frame.assign(r=[1.4, 1.5]).set_index(["f_o", "r"])
    datasets = [indexed.to_xarray(), xarray.Dataset(frame).assign_coords(r=1.5)]
    messages = [r"an index \(f_o\)", r"an index \(f_o, r\)", r"coordinates \(f_o\)", r"coordinates \(.*r\)"]
    for cases, message in zip([indexed, two, *datasets], messages, strict=True):
        with pytest.raises(ValueError, match=rf"^cases with {message} is not allowed; allowed: .*reset_index\(\)"):
            snapload.sweep(CASE, cases=cases, progress=False)
    listed = snapload.sweep(CASE.replace(t_end=1), cases=frame, progress=False)
    for cases in (indexed.reset_index(), indexed.to_xarray().to_dataframe().reset_index()):
        assert snapload.sweep(CASE.replace(t_end=1), cases=cases, progress=False).identical(listed)
    # The index of a filtered frame has no name.
    assert snapload.sweep(CASE, cases=frame[frame.e > 0.55], progress=False).f_o.values.tolist() == [0.2]


def test_a_flag_is_no_number():
    for flag in (True, False, np.True_):
        with pytest.raises(ValueError, match=f"^random = .*{flag}.* is not allowed; allowed: "):
            snapload.sweep(CASE, random=flag, f_o=(0.1, 0.2), progress=False)
    with pytest.raises(ValueError, match="^seed = True is not allowed"):
        snapload.ensemble(CASE, 10, seed=True)


def test_random_points_without_a_range_report_how_to_give_one():
    with pytest.raises(ValueError, match=r"1 to \d+ keys, and none varies; vary one with .* such as e=\(0.5, 0.9\)$"):
        snapload.sweep(CASE, random=10)


def test_a_file_that_is_no_study_is_refused(tmp_path: Path):
    for contents in (b"", b"f_o\n0.1\n"):
        path = tmp_path / "x.csv"
        path.write_bytes(contents)
        with pytest.raises(ValueError) as error:
            snapload.open_study(path)
        assert str(error.value) == f"{path}: not a Parquet file of snapload sweep"


@pytest.mark.parametrize("value", ["no", 1, None])
def test_what_is_true_or_false_is_nothing_else(value):
    calls = {
        "trust": [
            lambda: CASE.run(trust=value),
            lambda: snapload.sweep(CASE, e=[0.5], trust=value),
            lambda: snapload.safe_basin(CASE, trust=value, **WINDOW),
            lambda: snapload.erosion(CASE, over={"f_o": [0.1]}, trust=value, **WINDOW),
        ],
        "down": [lambda: snapload.orbit_diagram(CASE, f_o=[0.1, 0.2], down=value)],
        "prove": [lambda: snapload.find_orbits(POINT, starts=1, prove=value)],
        "elastic": [lambda: sea().seas(seeds=1, elastic=value)],
    }
    for name, each in calls.items():
        for call in each:
            with pytest.raises(ValueError, match=f"^{name} = {value!r} is not allowed; allowed: True or False$"):
                call()
    assert CASE.run(trust=np.True_).trust is not None


@pytest.mark.parametrize("value", [True, np.False_])
def test_true_is_no_number(value):
    for name, call in (
        ("uncertainty", lambda: CASE.run(uncertainty=value)),
        ("mass", lambda: snapload.Body(mass=value)),
        ("length", lambda: snapload.Scales(value, 1, 1)),
        ("first", lambda: snapload.evenly(value, 2, 2)),
        ("dt", lambda: CASE.run().motion(value)),
    ):
        with pytest.raises(ValueError, match=f"^{name} = {value!r} is not allowed; allowed: a number"):
            call()


def test_a_range_of_a_branch_is_no_side_of_a_box(command):
    orbit = POINT.orbit()
    message = "body is not allowed; allowed: a key on which orbits depend: one of r, e, a, b, inertia, f_o, nu, omega"
    with pytest.raises(ValueError, match=f"^key = {message}$"):
        snapload.continuation(orbit, "body", (0.1, 2))
    assert f"along = {message}" in command("branch", "--along", "body=0.1:2", fails=True)
    with pytest.raises(ValueError, match=r"^f_o = \(1.2,\) is not allowed; allowed: its two ends, such as"):
        snapload.continuation(orbit, "f_o", (1.2,))
    with pytest.raises(ValueError, match=r"^f_o = \(1.2,\) is not allowed; allowed with random: its two ends"):
        snapload.sweep(POINT, random=1, f_o=(1.2,))


@pytest.mark.parametrize(
    "read", [snapload.Case.from_file, snapload.Structure.from_toml, snapload.Structure.from_moordyn]
)
def test_a_file_that_is_no_text_is_named(read, tmp_path):
    path = tmp_path / "latin1.toml"
    path.write_bytes("# Öre\nf_o = 0.31\n".encode("latin-1"))
    with pytest.raises(ValueError, match=f"^{path}: not a text file in UTF-8 \\(byte 2\\); save it as UTF-8$"):
        read(path)


def test_a_file_without_coefficients_is_named(tmp_path):
    (tmp_path / "x.toml").write_text("")
    for path, why in ((tmp_path, "RadiationCoefficients.tec"), (tmp_path / "x.toml", "it is none of these")):
        with pytest.raises(ValueError, match=f"^{path}: can not be read: {why}"):
            snapload.Hydro.from_file(path)
    # What is wrong with an option is not the fault of the file.
    with pytest.raises(ValueError, match="^the mass in kg = -1"):
        snapload.Hydro.from_file(PONTOON, mass=-1)


def test_arguments_of_another_kind_are_refused_in_words():
    with pytest.raises(ValueError, match="^t has a number that is too large; allowed: numbers below 1e308$"):
        CASE.run().at(10**400)
    with pytest.raises(ValueError, match="^times has a number that is too large"):
        cylinder().replace({"run.duration": 70}).assess(neighbours=0).motion([10**400])
    with pytest.raises(TypeError, match=r"^changes = \[\('wave.height', 1\)\] is not allowed; allowed: a dict such as"):
        cylinder().replace([("wave.height", 1)])
    with pytest.raises(
        TypeError, match=r"^symbol = 1 is not allowed; allowed: the cables of the snaps, such as \[2, 1\]$"
    ):
        POINT.orbit(symbol=1)
