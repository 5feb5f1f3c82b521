"""Tables that pandas, Polars and PyArrow read where they lie."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _engine

if TYPE_CHECKING:
    import pandas

#: So many rows are shown.
_SHOWN = 10


class Table:
    """Columns of equal length.

    A table speaks the Arrow C data interface, so ``polars.DataFrame(table)``, ``pyarrow.table(table)`` and
    ``pandas.DataFrame.from_arrow(table)`` take it without a copy, with units and long names as metadata of the
    fields.

    Examples
    --------
    >>> import snapload
    >>> impacts = snapload.Case(f_o=0.31).run().impacts
    >>> impacts.columns[:3]
    ('t', 'cable', 'v_n')
    >>> impacts["cable"][:3]
    array([2, 1, 2])
    """

    def __init__(self, table: _engine.Table) -> None:
        self._table = table
        self._types = dict(table.columns())

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(self._types)

    def __len__(self) -> int:
        return len(self._table)

    def __iter__(self) -> Iterator[str]:
        return iter(self._types)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """One column as an array of NumPy, shape ``(len(table),)``; numbers that are missing are NaN.

        Raises
        ------
        KeyError
            If there is no such column.
        """
        if name not in self._types:
            raise KeyError(f"there is no column {name!r}; the columns are {', '.join(self._types)}")
        kind, values = self._table.column(name)
        if kind != "object":
            return np.frombuffer(values, dtype=kind)
        array = np.empty(len(values), dtype=object)
        for i, value in enumerate(values):
            array[i] = tuple(value) if isinstance(value, list) else value
        return array

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a DataFrame of pandas (a copy; needs no PyArrow)."""
        import pandas

        return pandas.DataFrame({name: self[name] for name in self})

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._table.__arrow_c_stream__(requested_schema)

    def __arrow_c_schema__(self) -> object:
        return self._table.__arrow_c_schema__()

    def _rows(self) -> Iterator[list[str]]:
        """The rows that are shown: all of them, or the first and last ones with dots between."""
        count = len(self)
        whole = count <= _SHOWN
        head = count if whole else _SHOWN // 2
        shown = [*range(head), *range(head if whole else count - _SHOWN // 2, count)]
        columns = [self[name] for name in self]
        for place, k in enumerate(shown):
            if not whole and place == head:
                yield ["..."] * len(columns)
            yield [_word(column[k]) for column in columns]

    def __repr__(self) -> str:
        rows = [list(self._types), *self._rows()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = ["  ".join(word.rjust(width) for word, width in zip(row, widths, strict=True)) for row in rows]
        return "\n".join([*lines, f"[{len(self)} rows]"])

    def _repr_html_(self) -> str:
        def row(words: list[str], tag: str) -> str:
            return "<tr>" + "".join(f"<{tag}>{escape(word)}</{tag}>" for word in words) + "</tr>"

        body = "".join(row(words, "td") for words in self._rows())
        head = row(list(self._types), "th")
        return (
            "<div style='overflow-x:auto'><table style='white-space:nowrap'>"
            f"<thead>{head}</thead><tbody>{body}</tbody></table></div><p>{len(self)} rows</p>"
        )


def _word(value: object) -> str:
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return "" if value is None else str(value)
