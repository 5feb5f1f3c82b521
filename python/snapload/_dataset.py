"""Rows of a study as a labelled dataset."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._table import Table

if TYPE_CHECKING:
    import xarray

#: What the letters of the units stand for.
UNITS = (
    "nondimensional: L half the distance of the anchors, m the mass of the body, F its net buoyancy, T = sqrt(m L / F)"
)


@cache
def attributes() -> dict[str, dict[str, str]]:
    """Long name, units and symbol of every key and result, in the words of CF, from the one schema."""
    described = {}
    for entry in (*_engine.keys(), *_engine.columns()):
        name, meaning = entry["title"], entry["meaning"]
        words = {"long_name": name, "units": entry["unit"], "comment": "" if name == meaning else meaning}
        described[entry["name"]] = {key: word for key, word in words.items() if word}
    described["error"] = {"long_name": "why there was no run"}
    return described


def dataset(table: Table, description: str, version: str) -> xarray.Dataset:
    """The rows of a whole study: over the axes of a grid, or over ``row`` where it is no grid."""
    study = tomllib.loads(description)
    keys = [entry["name"] for entry in _engine.keys()]
    results = [entry["name"] for entry in _engine.columns()]
    if "random" in study or "list" in study:
        shape, coords = {"row": len(table)}, {"row": ("row", table["row"])}
        shown = [*keys, *results]
    else:
        shape = {key: _count(values) for key, values in study.get("vary", {}).items()}
        coords, shown = _axes(table, shape), results
    return _labelled(table, shape, coords, shown, {"study": description, "source": f"snapload {version}"})


def part(table: Table, description: str, version: str, start: int) -> xarray.Dataset:
    """The rows of a part of a study."""
    names = [entry["name"] for entry in (*_engine.keys(), *_engine.columns())]
    attrs = {"study": description, "source": f"snapload {version}", "first_row": start}
    return _labelled(table, {"row": len(table)}, {"row": ("row", table["row"])}, names, attrs)


def _count(values: Any) -> int:
    """How many values an axis of a study file has."""
    if isinstance(values, str):
        return int(values.rsplit(":", 1)[1])
    return len(values) if isinstance(values, list) else 1


def _axes(table: Table, shape: dict[str, int]) -> dict[str, Any]:
    """The values along each axis, as they stand in the rows: the first axis is the slowest."""
    coords = {}
    for place, key in enumerate(shape):
        along = [0] * len(shape)
        index: list[Any] = list(along)
        index[place] = slice(None)
        coords[key] = (key, table[key].reshape(tuple(shape.values()))[tuple(index)], attributes()[key])
    return coords


def _labelled(
    table: Table, shape: dict[str, int], coords: dict[str, Any], names: list[str], attrs: dict[str, Any]
) -> xarray.Dataset:
    import xarray

    dims, sizes = tuple(shape), tuple(shape.values())
    variables = {}
    for name in names:
        values = _plain(table[name])
        # Without trust there is nothing to say of it.
        if values.dtype != object and values.size and name in ("horizon_t", "horizon_impact", "certain"):
            if np.isnan(table["certain"].astype(float)).all():
                continue
        variables[name] = (dims, values.reshape(sizes), attributes()[name])
    variables["end_code"] = (dims, *_end_codes(table["end"], sizes))
    if any(word is not None for word in table["error"]):
        variables["error"] = (dims, _plain(table["error"]).reshape(sizes), attributes()["error"])
    about = {"title": "A study of a body on cables that go slack and snap taut", "units_comment": UNITS}
    return xarray.Dataset(variables, coords, {**about, **attrs})


def _plain(values: NDArray[Any]) -> NDArray[Any]:
    """Words that are missing are empty ones, which files can hold."""
    if values.dtype != object:
        return values
    return np.array(["" if word is None else word for word in values], dtype=object)


def _end_codes(ends: NDArray[Any], sizes: tuple[int, ...]) -> tuple[NDArray[np.int8], dict[str, Any]]:
    """The ends as numbers with flags after CF, for maps; -1 where there was no run."""
    words: list[str] = next(entry["words"] for entry in _engine.columns() if entry["name"] == "end")
    codes = {word: code for code, word in enumerate(words)}
    values = np.array([codes.get(end, -1) for end in ends], dtype=np.int8)
    flags = {
        "long_name": "why the run ended, as a number",
        "flag_values": np.arange(-1, len(words), dtype=np.int8),
        "flag_meanings": " ".join(["no_run", *words]),
    }
    return values.reshape(sizes), flags
