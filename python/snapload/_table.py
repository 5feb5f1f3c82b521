"""Tables that pandas, Polars and PyArrow can read without a copy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._lazy_import import LazyModule

if TYPE_CHECKING:
    import pandas
else:
    pandas = LazyModule("pandas")

#: The number of rows that are shown.
_SHOWN_ROWS = 10


def or_nan(value: float | None) -> float:
    """A number, NaN where there is none."""
    return float("nan") if value is None else value


def numbers(rows: Sequence[Mapping[str, Any]], name: str) -> NDArray[np.float64]:
    """The values of one column of the rows, NaN where a value is missing."""
    return np.array([or_nan(row[name]) for row in rows], dtype=np.float64)


class Table:
    """A table with named columns of equal length.

    ``table["t"]`` is a column and ``table[0]`` a row. The length of the table is that of its columns, iteration gives
    the rows, and ``dict(table)`` has the columns by name.

    A table implements the Arrow C data interface, so ``polars.DataFrame(table)``, ``pyarrow.table(table)`` and
    ``pandas.DataFrame.from_arrow(table)`` read it without a copy, with units and long names as metadata of the
    fields. ``pandas.DataFrame(table)`` and ``numpy.asarray(table)`` copy it.

    See Also
    --------
    snapload.Run.impacts : The impacts of a run.
    snapload.Run.modes : The modes of a run.
    snapload.Run.exponents : The Lyapunov exponents of a run.
    snapload.sensitivities : Derivatives of the first impacts.

    Examples
    --------
    >>> import snapload
    >>> impacts = snapload.Case(f_o=0.31).run().impacts
    >>> impacts.columns[:3]
    ('t', 'cable', 'v_n')
    >>> impacts["cable"][:3]
    array([2, 1, 2])
    >>> impacts[0]["cable"], len(impacts), len(list(impacts))
    (2, 12, 12)
    """

    def __init__(self, table: _engine.Table) -> None:
        self._table = table
        self._names = tuple(name for name, _ in table.columns())

    @classmethod
    def _from_columns(cls, columns: Iterable[tuple[str, str, str, NDArray[Any]]]) -> Table:
        """A table of columns: name, scale (empty, if it is no quantity), meaning, values."""
        kinds = {"f": ("float64", np.float64), "i": ("int64", np.int64), "b": ("bool", np.bool_)}
        parts = []
        for name, scale, meaning, values in columns:
            kind, dtype = kinds.get(values.dtype.kind, ("words", None))
            unit = {"units": scale} if scale in ("1", "rad") else {"units": "1" if scale else "", "scale": scale}
            attrs = {"long_name": meaning, **unit}
            data = values.tolist() if dtype is None else bytearray(values.astype(dtype).tobytes())
            parts.append((name, kind, {key: word for key, word in attrs.items() if word}, data))
        return cls(_engine.Table.of(parts))

    def _in_own_units(self) -> Table:
        """The table of a system, whose scales are dimensions in units of the user."""
        parts = []
        for name, kind, attrs, values in self._table.parts():
            if scale := attrs.get("scale"):
                attrs = {key: word for key, word in attrs.items() if key not in ("units", "scale")}
                attrs["dimension"] = scale
            parts.append((name, kind, attrs, values))
        return Table(_engine.Table.of(parts))

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns.

        See Also
        --------
        keys : Returns the names for ``dict(table)``.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case().run().modes.columns
        ('mode', 'taut', 't_start', 't_end')
        """
        return self._names

    def keys(self) -> tuple[str, ...]:
        """Return the names of the columns, which ``dict(table)`` needs.

        Returns
        -------
        tuple of str
            The names in the order of the columns.

        See Also
        --------
        columns : The names as a property.

        Examples
        --------
        >>> import snapload
        >>> dict(snapload.Case().run().modes)["mode"][0]
        'slack'
        """
        return self._names

    def __len__(self) -> int:
        return len(self._table)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[dict[str, Any]]:
        columns = [self[name].tolist() for name in self._names]
        for row in zip(*columns, strict=True):
            yield dict(zip(self._names, row, strict=True))

    @overload
    def __getitem__(self, place: str) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, place: int) -> dict[str, Any]: ...
    def __getitem__(self, place: str | int) -> NDArray[Any] | dict[str, Any]:
        """Return one column as a NumPy array of shape ``(len(table),)``, or one row as a dict.

        Raises
        ------
        KeyError
            If there is no such column.
        IndexError
            If there is no such row.
        """
        if not isinstance(place, str):
            try:
                row = range(len(self))[place]
            except IndexError:
                raise IndexError(f"there is no row {place}; there are {len(self)} rows, from 0") from None
            if not isinstance(row, int):
                raise TypeError(f"{place!r} is not allowed; allowed: the name of a column or the number of a row")
            return {name: self[name][row : row + 1].tolist()[0] for name in self._names}
        if place not in self._names:
            raise KeyError(f"there is no column {place!r}; the columns are {', '.join(self._names)}")
        kind, values = self._table.column(place)
        if kind != "object":
            return np.frombuffer(values, dtype=kind)
        array = np.empty(len(values), dtype=object)
        for i, value in enumerate(values):
            array[i] = tuple(value) if isinstance(value, list) else value
        return array

    def to_pandas(self) -> pandas.DataFrame:
        """Copy the table to a pandas DataFrame; PyArrow is not needed.

        Returns
        -------
        pandas.DataFrame
            A DataFrame with the columns of the table.

        See Also
        --------
        columns : The names of the columns.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().impacts.to_pandas().shape
        (12, 18)
        """
        import pandas

        return pandas.DataFrame({name: self[name] for name in self._names})

    @property
    def __array_interface__(self) -> dict[str, Any]:
        """For ``numpy.asarray``: the rows as a structured array, each time a copy of its own."""
        columns = dict(self)
        array = np.empty(len(self), dtype=[(name, column.dtype) for name, column in columns.items()])
        for name, column in columns.items():
            array[name] = column
        # NumPy keeps what stands here as long as its array lives; with the address it would keep only this table.
        return array.__array_interface__ | {"data": array}

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._table.__arrow_c_stream__(requested_schema)

    def __arrow_c_schema__(self) -> object:
        return self._table.__arrow_c_schema__()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._table.parts() == other._table.parts()

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (self._table.parts(),)

    def _rows(self) -> Iterator[list[str]]:
        """The rows that are shown: all of them, or the first and last ones with dots between."""
        count = len(self)
        complete = count <= _SHOWN_ROWS
        head = count if complete else _SHOWN_ROWS // 2
        shown = [*range(head), *range(head if complete else count - _SHOWN_ROWS // 2, count)]
        columns = [self[name] for name in self._names]
        for place, k in enumerate(shown):
            if not complete and place == head:
                yield ["..."] * len(columns)
            yield [_cell_text(column[k]) for column in columns]

    def __repr__(self) -> str:
        rows = [list(self._names), *self._rows()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = ["  ".join(text.rjust(width) for text, width in zip(row, widths, strict=True)) for row in rows]
        return "\n".join([*lines, f"[{len(self)} rows]"])

    def _repr_html_(self) -> str:
        def row(texts: list[str], tag: str) -> str:
            return "<tr>" + "".join(f"<{tag}>{escape(text)}</{tag}>" for text in texts) + "</tr>"

        body = "".join(row(words, "td") for words in self._rows())
        head = row(list(self._names), "th")
        return (
            "<div style='overflow-x:auto'><table style='white-space:nowrap'>"
            f"<thead>{head}</thead><tbody>{body}</tbody></table></div><p>{len(self)} rows</p>"
        )


def _restore(parts: list[tuple[str, str, dict[str, str], Any]]) -> Table:
    return Table(_engine.Table.of(parts))


def _cell_text(value: object) -> str:
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return "" if value is None else str(value)
