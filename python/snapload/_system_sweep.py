"""Studies of user-defined systems."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray

from . import _engine
from ._axes import listed, values_of
from ._check import threads_for
from ._dataset import ABOUT, attributes, flags
from ._progress import bar

if TYPE_CHECKING:
    from ._system import System

#: The most runs of a study, which is kept in memory.
_MOST = 10**7


def sweep_systems(
    system: System, axes: Mapping[str, Any], trust: bool, threads: int | None, progress: bool
) -> xarray.Dataset:
    """Runs every combination."""
    values = {key: values_of(listed(key, value)) for key, value in axes.items()}
    shape = tuple(len(along) for along in values.values())
    count = math.prod(shape)
    if not 1 <= count <= _MOST:
        raise ValueError(f"{count} runs are not allowed; allowed: 1 to {_MOST}")
    if threads is not None:
        threads = threads_for(threads, callers=2)
    systems: list[_engine.System] = []
    errors = np.full(count, "", dtype=object)
    for row, combination in enumerate(product(*(along.tolist() for along in values.values()))):
        try:
            systems.append(system.replace(**dict(zip(values, combination, strict=True)))._begun)
        except ValueError as error:
            errors[row] = str(error)
    if not systems:
        raise ValueError(errors[0])
    with bar("sweep", len(systems), progress) as tell:
        columns = _engine.sweep_systems(systems, len(system.cables), trust, threads, tell)
    legal = errors == ""
    variables: dict[str, Any] = {}
    for name, kind, data, words in columns:
        variables[name] = (tuple(values), _spread(kind, data, words, legal).reshape(shape), _about(name))
    ends: list[str] = next(entry["words"] for entry in _engine.columns() if entry["name"] == "end")
    codes = {word: code for code, word in enumerate(ends)}
    end = variables["end"][1]
    code = np.array([codes.get(word, -1) for word in end.ravel()], dtype=np.int8).reshape(shape)
    variables["end_code"] = (tuple(values), code, flags(ends))
    if not legal.all():
        variables["error"] = (tuple(values), errors.reshape(shape), attributes()["error"])
    coords = {key: (key, along, {"long_name": key}) for key, along in values.items()}
    title = "A study of a body on cables that go slack and snap taut"
    about = {"title": title, "source": f"snapload {_engine.__version__}", "Conventions": ABOUT["Conventions"]}
    return xarray.Dataset(variables, coords, about)


def _about(name: str) -> dict[str, Any]:
    known = attributes().get(name)
    if known is None:
        return {"long_name": name.replace("_", " of cable ")}
    words = {"long_name": known.get("comment") or known["long_name"]}
    # Units are the user's own.
    return words


def _spread(kind: str, data: Any, words: list[str], legal: Any) -> Any:
    """The values of all rows, with missing values for the rows that were not run."""
    if kind == "words":
        whole: Any = np.full(len(legal), "", dtype=object)
        whole[legal] = np.array(words, dtype=object)[np.frombuffer(data, dtype=np.int32)]
    elif kind == "bool":
        whole = np.zeros(len(legal), dtype=bool)
        whole[legal] = np.frombuffer(data, dtype=bool)
    else:
        whole = np.full(len(legal), np.nan)
        whole[legal] = np.frombuffer(data, dtype=np.float64)
    return whole
