"""Rows of a study as a labelled dataset."""

from __future__ import annotations

import math
import tomllib
from typing import Any

import numpy as np
import xarray
from numpy.typing import NDArray
from xarray.backends import BackendArray
from xarray.core import indexing

from . import _engine
from ._arguments import case_text
from ._axes import all_values
from ._schema import attributes, with_own_names

#: Attributes that all datasets have.
COMMON_ATTRIBUTES = {
    "Conventions": "CF-1.12",
    "scales": "L half the distance of the anchors, m the mass of the body, F its net buoyancy, T = sqrt(m L / F)",
}


def title_and_case(title: str, engine: _engine.Case) -> dict[str, str]:
    """The attributes of the answer to a question about a case: its title, and the case."""
    case = case_text(engine) or "# the standard case\n"
    return {"title": title, **COMMON_ATTRIBUTES, "source": f"snapload {_engine.__version__}", "case": case}


#: The number of rows of a chunk, if its size is not given.
_CHUNK_ROWS = 1 << 18


def grid_coordinates(axes: list[tuple[str, Any]]) -> dict[str, Any]:
    """The coordinates of a grid."""
    return {key: (key, all_values(key, values), attributes()[key]) for key, values in axes}


def dataset(
    path: str, description: str, version: str, cases: int, first: int, count: int, chunks: Any
) -> xarray.Dataset:
    """The rows of a file over the axes of a grid, or over ``row`` if they are not a complete grid."""
    study = tomllib.loads(description)
    keys = [entry["name"] for entry in _engine.keys()]
    results = [entry["name"] for entry in _engine.columns()]
    attrs: dict[str, Any] = {"study": description, "source": f"snapload {version}"}
    axes = study.get("vary", {})
    if count < cases:
        attrs["first_row"] = first
    if count < cases or "random" in study or "list" in study:
        axes, shown = {"row": count}, [*keys, *results]
        coords: dict[str, Any] = {"row": ("row", np.arange(first, first + count))}
        sizes: tuple[int, ...] = (count,)
    else:
        coords, shown = _axis_coordinates(path, axes), results
        sizes = tuple(len(values) for _, values, _ in coords.values())
    if not study.get("trust", True):
        # Without trust these columns have no values.
        shown = [name for name in shown if name not in ("horizon_t", "horizon_impact", "certain")]
    ends: list[str] = next(entry["words"] for entry in _engine.columns() if entry["name"] == "end")
    columns = {name: _Column(path, name, sizes) for name in shown}
    variables = {name: (tuple(axes), column, attributes()[name]) for name, column in columns.items()}
    variables["end_code"] = (tuple(axes), _Column(path, "end", sizes, ends), flag_attributes(ends))
    _, codes, messages = _engine.read_column(path, "error", 0, count)
    del codes
    if len(messages) > 1:
        variables["error"] = (tuple(axes), _Column(path, "error", sizes), attributes()["error"])
    lazy = {
        name: xarray.Variable(dims, indexing.LazilyIndexedArray(column), column_attrs)
        for name, (dims, column, column_attrs) in variables.items()
    }
    title = {"title": "A study of a body on cables that go slack and snap taut", **COMMON_ATTRIBUTES}
    opened = with_own_names(xarray.Dataset(lazy, coords, {**title, **attrs}))
    if chunks is None:
        return opened.load()
    if chunks == "auto" and sizes:
        # Dask can not estimate the size of text. Whole rows along the first dimension are read at once.
        chunks = {next(iter(axes)): max(1, _CHUNK_ROWS // math.prod(sizes[1:]))}
    return opened.chunk(chunks)


def _axis_coordinates(path: str, axes: dict[str, Any]) -> dict[str, Any]:
    """The values along each axis, read from the rows; the first axis varies slowest."""
    counts = [_count(values) for values in axes.values()]
    coords = {}
    for place, key in enumerate(axes):
        step = math.prod(counts[place + 1 :])
        if step == 1:
            values = _rows(path, key, 0, counts[place])
        else:
            values = np.concatenate([_rows(path, key, k * step, k * step + 1) for k in range(counts[place])])
        coords[key] = (key, values, attributes()[key])
    return coords


def _count(values: Any) -> int:
    """The number of values of an axis of a study file."""
    if isinstance(values, str):
        return int(values.rsplit(":", 1)[1])
    return len(values) if isinstance(values, list) else 1


def _rows(path: str, name: str, start: int, stop: int, codes: list[str] | None = None) -> NDArray[Any]:
    """Some rows of one column. Missing words are empty strings, which files can store."""
    kind, data, categories = _engine.read_column(path, name, start, stop)
    if kind != "words":
        return np.frombuffer(data, dtype=kind)
    places = np.frombuffer(data, dtype=np.int32)
    if codes is None:
        return np.array(categories, dtype=object)[places]
    return np.array([codes.index(word) if word in codes else -1 for word in categories], dtype=np.int8)[places]


class _Column(BackendArray):
    """A column of a file in the shape of its grid, which is read when it is needed.

    The index along the first dimension decides which rows are read.
    """

    def __init__(self, path: str, name: str, shape: tuple[int, ...], codes: list[str] | None = None) -> None:
        self._source = (path, name)
        self._codes = codes
        self.shape = shape
        self.dtype = _rows(*self._source, 0, 1, codes).dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[Any, ...]) -> NDArray[Any]:
        if not self.shape:
            return _rows(*self._source, 0, 1, self._codes).reshape(())
        inner = math.prod(self.shape[1:])
        index = range(self.shape[0])[key[0]]
        indices = range(index, index + 1) if isinstance(index, int) else index
        if not indices:
            return np.empty((0, *self.shape[1:]), self.dtype)[(slice(None), *key[1:])]
        low, high = min(indices), max(indices) + 1
        rows = _rows(*self._source, low * inner, high * inner, self._codes).reshape(high - low, *self.shape[1:])
        first = index - low if isinstance(index, int) else slice(None, None, indices.step)
        return rows[(first, *key[1:])]


def flag_attributes(names: list[str]) -> dict[str, Any]:
    """The meaning of the numbers of the ends after the CF conventions, for maps; -1 if there was no run."""
    return {
        "long_name": "why the run ended, as a number",
        "flag_values": np.arange(-1, len(names), dtype=np.int8),
        "flag_meanings": " ".join(["no_run", *names]),
    }
