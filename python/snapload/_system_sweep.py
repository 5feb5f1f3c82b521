"""Studies of user-defined systems."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import flag, threads_for, whole_number
from ._axes import all_values, axis_values
from ._dataset import COMMON_ATTRIBUTES, flag_attributes
from ._progress import progress_bar
from ._schema import attributes
from ._system_keys import check_keys

if TYPE_CHECKING:
    from ._system import System

#: The most runs of a study, which is kept in memory.
_MAX_RUNS = 10**7


def sweep_systems(
    system: System, axes: Mapping[str, Any], trust: bool, threads: int | None, progress: bool
) -> xarray.Dataset:
    """Runs every combination."""
    check_keys(system, axes)
    trust = flag("trust", trust)
    values = {key: _axis(key, value) for key, value in axes.items()}
    shape = tuple(len(axis) for axis in values.values())
    count = math.prod(shape)
    if not 1 <= count <= _MAX_RUNS:
        raise ValueError(f"{count} runs are not allowed; allowed: 1 to {_MAX_RUNS}")
    if threads is not None:
        threads = threads_for(threads, callers=2)
    systems: list[_engine.System] = []
    errors = np.full(count, "", dtype=object)
    for row, combination in enumerate(product(*(axis.tolist() for axis in values.values()))):
        try:
            systems.append(system.replace(**dict(zip(values, combination, strict=True)))._engine_system)
        except ValueError as error:
            errors[row] = str(error)
    if not systems:
        raise ValueError(errors[0])
    with progress_bar("sweep", len(systems), progress) as report_progress:
        columns = _engine.sweep_systems(systems, len(system.cables), trust, threads, report_progress)
    legal = errors == ""
    variables: dict[str, Any] = {}
    for name, kind, data, words in columns:
        variables[name] = (tuple(values), _fill_rows(kind, data, words, legal).reshape(shape), _attributes_of(name))
    ends: list[str] = next(entry["words"] for entry in _engine.columns() if entry["name"] == "end")
    codes = {word: code for code, word in enumerate(ends)}
    end = variables["end"][1]
    code = np.array([codes.get(word, -1) for word in end.ravel()], dtype=np.int8).reshape(shape)
    variables["end_code"] = (tuple(values), code, flag_attributes(ends))
    if not legal.all():
        variables["error"] = (tuple(values), errors.reshape(shape), attributes()["error"])
    coords = {key: (key, axis, {"long_name": key}) for key, axis in values.items()}
    title = "A study of a body on cables that go slack and snap taut"
    attrs = {
        "title": title,
        "source": f"snapload {_engine.__version__}",
        "Conventions": COMMON_ATTRIBUTES["Conventions"],
    }
    return xarray.Dataset(variables, coords, attrs)


def _axis(key: str, values: ArrayLike | str) -> NDArray[Any]:
    """The values of an axis. Those of a count are whole numbers, as in a study of a case."""
    read = all_values(key, axis_values(key, values))
    if key != "max_impacts" or read.dtype.kind != "f":
        return read
    for fraction in read[read % 1 != 0].tolist():
        whole_number(key, fraction)
    return read.astype(np.int64)


def _attributes_of(name: str) -> dict[str, Any]:
    known = attributes().get(name)
    if known is None:
        return {"long_name": name.replace("_", " of cable ")}
    attrs = {"long_name": known.get("comment") or known["long_name"].removesuffix(f", in {known.get('scale')}")}
    # Units are the user's own.
    if scale := known.get("scale"):
        attrs["dimension"] = scale
    return attrs


def _fill_rows(kind: str, data: Any, categories: list[str], legal: Any) -> Any:
    """The values of all rows, with missing values for the rows that were not run."""
    if kind == "words":
        filled: Any = np.full(len(legal), "", dtype=object)
        filled[legal] = np.array(categories, dtype=object)[np.frombuffer(data, dtype=np.int32)]
    elif kind == "bool":
        filled = np.zeros(len(legal), dtype=bool)
        filled[legal] = np.frombuffer(data, dtype=bool)
    else:
        filled = np.full(len(legal), np.nan)
        filled[legal] = np.frombuffer(data, dtype=np.float64)
    return filled
