"""The values of keys in a study."""

from __future__ import annotations

from collections.abc import Mapping
from csv import writer
from io import StringIO
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import number, unmasked, whole_number

#: The most values of an axis that is kept in memory.
MAX_VALUES = 10**7


def axis_values(key: str, values: ArrayLike | str) -> str | NDArray[Any]:
    """The values along one axis: text of a range, or a list."""
    if isinstance(values, str) and ":" in values:
        return values
    more = "; for pairs of values, not all combinations, give cases"
    # NumPy would make texts of the numbers beside a text, and 1 of True beside numbers: each value
    # is judged by itself.
    kinds = {_kind(value) for value in values} if isinstance(values, (list, tuple)) else set()
    return _flat(key, np.asarray(unmasked(key, values), dtype=object if len(kinds) > 1 else None), more)


def _kind(value: Any) -> str:
    """Whether NumPy takes it as a flag, a text, or as something else."""
    if isinstance(value, (bool, np.bool_)):
        return "flag"
    return "text" if isinstance(value, (str, bytes)) else "else"


def _flat(key: str, array: NDArray[Any], more: str = "") -> NDArray[Any]:
    """An array of one dimension at most; ``more`` says what else is allowed."""
    if array.ndim > 1:
        shape = " x ".join(map(str, array.shape))
        allowed = f"one value or a list of them{more}"
        raise ValueError(f"{key} = an array of {shape} values is not allowed; allowed: {allowed}")
    return np.ravel(array)


def range_ends(key: str, ends: Any, where: str = "") -> str | tuple[float, float]:
    """The ends of a range; `where` says in errors where it is one."""
    if isinstance(ends, str):
        return ends
    unmasked(key, ends)
    try:
        low, high = (float(end) for end in ends)
    except (TypeError, ValueError, OverflowError):
        allowed = 'its two ends, such as (0.1, 0.6) or "0.1:0.6"'
        raise ValueError(f"{key} = {ends!r} is not allowed; allowed{where}: {allowed}") from None
    return low, high


def all_values(key: str, values: str | NDArray[Any]) -> NDArray[Any]:
    """All values along an axis, which need not be that of a key of a case."""
    if isinstance(values, str):
        return np.frombuffer(_engine.range_values(key, values, MAX_VALUES))
    return values


def cases_csv(cases: Any) -> bytes:
    """A table of cases as a CSV file for the command line, with an empty cell for each missing value."""
    names = getattr(cases, "column_names", getattr(cases, "columns", None))
    if names is None and isinstance(cases, Mapping):
        names = cases.keys()
    if names is None:
        allowed = "a DataFrame, a dict of columns, or the path of a CSV or Parquet file"
        raise TypeError(f"cases, a {type(cases).__name__}, is not allowed; allowed: {allowed}")
    _refuse_index(cases)
    counts = {key["name"] for key in _engine.keys() if key["kind"] == "int"}
    columns = []
    names = list(names)
    if twice := [str(name) for name in names if names.count(name) > 1]:
        raise ValueError(f"cases with two columns {twice[0]} is not allowed; allowed: one column for each key")
    for name in names:
        column = cases[name]
        array = column.to_numpy() if hasattr(column, "to_numpy") else np.asanyarray(column)
        # The list of a masked array has None for each masked value.
        values = _flat(str(name), array).tolist()
        columns.append([_cell(value, str(name) in counts) for value in values])
    if len({len(column) for column in columns}) > 1:
        lengths = ", ".join(f"{name}: {len(column)}" for name, column in zip(names, columns, strict=True))
        raise ValueError(f"cases has columns of several lengths ({lengths}); allowed: as many values of each key")
    text = StringIO()
    writer(text, lineterminator="\n").writerows([map(str, names), *zip(*columns, strict=True)])
    return text.getvalue().encode()


def _refuse_index(cases: Any) -> None:
    """Refuses a named index, and coordinates of a dataset: they would be left out, although they may be keys."""
    if hasattr(cases, "coords"):
        kind, names = "coordinates", [str(name) for name in cases.coords]
        kept, dropped = ".to_dataframe().reset_index()", f".drop_vars({names})"
    else:
        levels = getattr(getattr(cases, "index", None), "names", ())
        kind, names = "an index", [str(name) for name in levels if name is not None]
        kept, dropped = ".reset_index()", ".reset_index(drop=True)"
    if names:
        raise ValueError(
            f"cases with {kind} ({', '.join(names)}) is not allowed; allowed: columns alone; cases{kept} has columns "
            f"of the same names, cases{dropped} leaves them out"
        )


def _cell(value: Any, count: bool) -> str:
    # A comparison with pandas.NA is NA, which is neither true nor false.
    if value is None or type(value).__name__ == "NAType" or value != value:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    # pandas stores a column of whole numbers as floats if some are missing.
    return str(int(value)) if count and isinstance(value, float) and value.is_integer() else str(value)


def evenly(first: float | str, last: float | str, count: int) -> NDArray[np.float64]:
    """Return evenly spaced values, each the double nearest to the decimal that one would write.

    Parameters
    ----------
    first, last : float or str
        The first and the last value.
    count : int
        The number of values, including the first and the last.

    Returns
    -------
    numpy.ndarray, shape (count,)
        The values. ``numpy.linspace`` rounds intermediate results, so that some of its values differ from the decimal
        in the last digit. In a chaotic motion such a value is a different case.

    Raises
    ------
    ValueError
        If the values do not form a range.

    See Also
    --------
    snapload.sweep : Runs a case at evenly spaced values.

    Examples
    --------
    >>> import numpy, snapload
    >>> float(snapload.evenly(0.1, 0.5, 5)[2]), float(numpy.linspace(0.1, 0.5, 5)[2])
    (0.3, 0.30000000000000004)
    """
    ends = (("first", first), ("last", last))
    decimals = [end if isinstance(end, str) else repr(number(name, end)) for name, end in ends]
    return np.frombuffer(_engine.evenly(decimals[0], decimals[1], whole_number("count", count)))
