"""Tables are taken up where they lie."""

from __future__ import annotations

import gc

import numpy as np
import pandas
import polars
import pyarrow
import pytest
import snapload


@pytest.fixture(scope="module")
def run():
    return snapload.Case(f_o=0.31).run()


def test_pyarrow_polars_and_pandas_share_the_memory(run):
    table = run.impacts
    column = pyarrow.table(table).column("v_n").chunk(0)
    place = column.buffers()[1].address + 8 * column.offset
    # Each has its own capsule of the one table; the numbers lie at one address.
    assert pyarrow.table(table).column("v_n").chunk(0).buffers()[1].address == place
    assert polars.DataFrame(table)["v_n"].to_numpy(allow_copy=False).ctypes.data == place
    frame = pandas.DataFrame.from_arrow(table)
    assert frame["v_n"].tolist() == table["v_n"].tolist()
    assert np.asarray(pyarrow.table(table).column("v_n").chunk(0)).ctypes.data == place


def test_an_array_is_a_copy():
    run = snapload.Case(f_o=0.31).run()
    for table in (run.impacts, run.modes):
        name = table.columns[-1]
        values = table[name].tolist()
        array = np.asarray(table)
        array[name][:] = 99
        assert np.asarray(table)[name].tolist() == table[name].tolist() == values
    # The array lives longer than its table.
    array = np.asarray(snapload.Case(f_o=0.31).run().modes)
    del run, table
    gc.collect()
    assert array["mode"].tolist() == ["slack"] and array["t_start"].tolist() == [0.0]


def test_fields_have_units(run):
    schema = pyarrow.schema(run.impacts)
    assert schema.field("impulse").metadata == {
        b"units": b"1",
        b"scale": b"m L/T",
        b"long_name": b"impulse in the cable",
    }
    assert schema.field("cable").type == pyarrow.int64()
    assert pyarrow.table(run.modes).column("taut").to_pylist() == [[]]


def test_a_table_outlives_its_run():
    arrow = pyarrow.table(snapload.Case(f_o=0.31).run().impacts)
    polars_frame = polars.DataFrame(snapload.Case(f_o=0.31).run().impacts)
    assert arrow.column("t").to_pylist() == polars_frame["t"].to_list()


def test_columns_are_arrays(run):
    assert run.impacts["t"].dtype == np.float64 and run.impacts["cable"].dtype == np.int64
    assert len(run.impacts) == 12
    with pytest.raises(KeyError, match="there is no column 'v'; the columns are t, cable, v_n"):
        run.impacts["v"]
    frame = snapload.cases["sliding-example"].run(members=0).modes.to_pandas()
    assert frame["mode"].iloc[0] == "slack" and frame["taut"].iloc[0] == ()
    assert frame["t_start"].iloc[1:].tolist() == frame["t_end"].iloc[:-1].tolist()


def test_tables_are_shown_short(run):
    assert repr(run.impacts).endswith("[12 rows]") and len(repr(run.impacts).splitlines()) == 13
    html = run.impacts._repr_html_()
    assert html.count("<tr>") == 12 and "<th>energy_lost</th>" in html


def test_motion_is_numpys(run):
    motion = run.motion(0.5)
    assert motion.shape == (8,) and motion.t[-1] == run.end.t and motion["x"].dtype == np.float64
    assert run.at([[0.0, 0.1], [0.2, 9.0]]).shape == (2, 2)
    assert run.at(0.1).shape == () and run.at(-1.0).t == 0.0 and run.at(99.0).t == run.end.t
    # Free flight from rest: a closed form of its own.
    t = np.linspace(0.0, 0.3, 7)
    fall = 0.1 - t**2 / 2 + 0.5 * 0.31 / 0.9**2 * (0.9 * t - np.sin(0.9 * t))
    assert np.abs(run.at(t).y - fall).max() < 1e-15
    with pytest.raises(ValueError, match="t = nan"):
        run.at([0.0, np.nan])
    for dt in (0.0, -1.0, np.nan, 1e-9):
        with pytest.raises(ValueError, match="dt = .* is not allowed; allowed: a number above 0"):
            run.motion(dt)


def test_a_missing_cell_has_the_value_of_the_case() -> None:
    """Every dtype of pandas with a missing value of its own, and the value alone in a list."""
    case = snapload.Case(t_end=0.5, stop_when_settled=False, max_impacts=7, body="point")
    for key, cells, dtype in [
        ("stop_when_settled", [True, None], "boolean"),
        ("stop_when_settled", [True, pandas.NA], object),
        ("body", ["point", None], "string"),
        ("max_impacts", [9, None], "Int64"),
        ("e", [0.25, None], "Float64"),
    ]:
        given = pandas.Series(cells, dtype=dtype)
        for column in (given, list(given)):
            listed = snapload.sweep(case, cases={key: column}, progress=False)
            assert listed[key].values.tolist() == [cells[0], case[key]], (key, dtype)


def test_cases_with_columns_that_can_not_be_told_apart_are_refused() -> None:
    case = snapload.Case(t_end=0.5)
    twice = pyarrow.table([[0.1], [0.2]], names=["e", "e"])
    for cases in (twice, pandas.DataFrame([[0.1, 0.2]], columns=["e", "e"])):
        with pytest.raises(ValueError, match="two columns e is not allowed"):
            snapload.sweep(case, cases=cases)
    nested = pandas.DataFrame([[0.1]], columns=pandas.MultiIndex.from_tuples([("e", "low")]))
    with pytest.raises(ValueError, match="no key"):
        snapload.sweep(case, cases=nested)
    with pytest.raises(ValueError, match="f_o = an array of 2 x 2 values is not allowed; allowed: one value or a list"):
        snapload.sweep(case, cases={"f_o": np.full((2, 2), 0.1), "e": [0.1, 0.2, 0.3, 0.4]})
