"""Safe basins, their erosion, and basins of attraction over a window of two keys."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import engine_case, flag, whole_number
from ._axes import axis_values
from ._case import Case
from ._keys import Axes
from ._lazy_import import LazyModule
from ._orbit import Orbit
from ._orbit_base import STATE
from ._progress import progress_bar
from ._schema import attributes, attributes_as, attributes_in, units, with_own_names, with_scales
from ._signature import with_keys
from ._table import numbers, or_nan

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")

#: The total of a progress bar, if the work has several stages.
_PROGRESS_TOTAL = 1000


def safe_basin(case: Case, *, trust: bool = True, progress: bool = True, **window: Unpack[Axes]) -> xarray.Dataset:
    """Compute which starts of a window stay below the limits (safe basin), as ``snapload basin`` does.

    Parameters
    ----------
    case : Case
        The case with all keys that do not vary. A run that settles or continues to ``t_end`` is safe.
    trust : bool
        Whether to run the neighbours of each cell, which takes most of the time.
    progress : bool
        Whether to show a progress bar if the computation takes long.
    **window : array_like or str
        The evenly spaced values of any two keys, such as ``x`` and ``y``, as arrays or as ``"first:last:n"``.

    Returns
    -------
    xarray.Dataset
        Variables over the two keys: ``outcome``, how the run ended, in words (empty where the start is beyond a cable
        or a limit and therefore not in the window); ``outcome_code``, the same as numbers for maps; ``t``, the time of
        the end; ``legal``; ``safe``; and with trust ``decided``, whether the neighbours at 1e-8 end alike, and
        ``trusted``, whether the horizon of trust lies past the end, both false where the start is not legal.
        Attributes: the numbers of ``legal``, ``safe`` and ``undecided`` cells, and of those whose run is ``cut_short``
        by the impact limit or a standstill, which count neither as safe nor as unsafe; ``fraction`` and ``gim``, the
        global integrity measure, with ``interval95``; and ``cell``, the size of a cell. If both keys are start values,
        there are also ``lim``, the distance of the nearest unsafe start from the equilibrium, ``if``, the radius of
        the largest disc in the window without unsafe starts, and ``iim``, the smallest unsafe velocity if one of the
        keys is a velocity. They are NaN where there is no such value; ``lim`` and ``iim`` are also NaN where another
        start key is not 0, because the equilibrium is then not in the plane of the two keys, and where legal starts
        that were not run to their end are nearer. ``lim_at_least``, ``if_at_least`` and ``iim_at_least`` are the same
        where undecided cells count as unsafe. The scale of such an attribute is in another one: ``lim_scale`` is
        ``L``, but ``L and L/T`` for a window of a position and a velocity, where a distance has no single unit.

    Raises
    ------
    ValueError
        If there are not exactly two keys, or a value of a key is not allowed.

    See Also
    --------
    snapload.erosion : Computes how the basin shrinks along a third key.
    snapload.plot_basin : Draws the basin.

    Notes
    -----
    Python's lock is released during the computation, and Ctrl-C interrupts it.

    Examples
    --------
    >>> import snapload
    >>> basin = snapload.safe_basin(snapload.Case(t_end=30), x="-0.2:0.2:9", y="0.05:0.4:8")
    >>> basin.outcome.dims, basin.attrs["legal"]
    (('x', 'y'), 60)
    >>> bool(basin.safe.sum() / basin.legal.sum() == basin.attrs["gim"])
    True
    """
    from ._dataset import flag_attributes, title_and_case

    engine, axes, trust = engine_case(case), _window_axes(window), flag("trust", trust)
    with progress_bar("safe basin", _PROGRESS_TOTAL, progress) as report_progress:
        answer, columns = _engine.safe_basin(engine, axes, trust, report_progress)
    data, coords = json.loads(answer), _axis_coordinates(axes)
    shape = tuple(len(values) for _, values, _ in coords.values())
    variables: dict[str, Any] = {}
    for name, kind, buffer, words in columns:
        variables[name] = (
            tuple(coords),
            _column(kind, buffer, words).reshape(shape),
            attributes_as("t", "when it ended") if name == "t" else {"long_name": _LONG_NAMES[name]},
        )
    ends: list[str] = next(entry["words"] for entry in _engine.columns() if entry["name"] == "end")
    codes = {word: code for code, word in enumerate(ends)}
    outcomes = variables["outcome"][1]
    code = np.array([codes.get(word, -1) for word in outcomes.ravel()], dtype=np.int8).reshape(shape)
    code_attributes = flag_attributes(ends)
    code_attributes |= {"long_name": "how the run ended, as a number", "flag_meanings": " ".join(["not_legal", *ends])}
    variables["outcome_code"] = (tuple(coords), code, code_attributes)
    measures = _measure_attributes(data) | {"cell": np.array([data["cell"][key] for key in data["keys"]])}
    distances = _distances(data["keys"]).items()
    scales = {of: scale for name, (scale, _) in distances for of in (name, f"{name}_at_least")}
    scales["cell"] = ", ".join(units()[key] or "1" for key in data["keys"])
    title = title_and_case("A safe basin of a body on cables", engine)
    return with_own_names(xarray.Dataset(variables, coords, title | with_scales(measures, scales)))


with_keys(safe_basin, defaults=False)


def basins_of_attraction(
    case: Case, *, transient: int = 300, trust: bool = True, progress: bool = True, **window: Unpack[Axes]
) -> tuple[xarray.DataArray, dict[int, Orbit]]:
    """Compute which attractor each start of a window reaches, as ``snapload basin --kind attractor`` does.

    Parameters
    ----------
    case : Case
        The case with all keys that do not vary.
    transient : int
        Forcing periods to skip before attractors are identified.
    trust : bool
        Whether to follow the neighbours of each cell, which takes most of the time.
    progress : bool
        Whether to show a progress bar if the computation takes long.
    **window : array_like or str
        The evenly spaced values of the two keys, as arrays or as ``"first:last:n"``.

    Returns
    -------
    labels : xarray.DataArray
        The number of the attractor over the two keys, counted from 1 in order of decreasing numbers of cells; 0 where
        no period up to 15 forcing periods was found, which a longer transient may show; -1 where the start is not
        legal; -2 and below where the motion stops at a limit, as ``flag_values`` and ``flag_meanings`` describe.
        With trust the coordinates ``decided``, whether neighbours at 1e-8 behave alike, and ``trusted``, whether
        rounding can not have decided it, both false where the start is not legal.
        Attributes: the number of ``legal`` and, with trust, of ``undecided`` cells, and the ``cells`` of each attractor
        with their ``fractions``.
    attractors : dict of int to Orbit
        The orbit of each label, if both keys are start values and the orbit could be computed.

    Raises
    ------
    ValueError
        If there are not exactly two keys, or a value of a key is not allowed.

    See Also
    --------
    snapload.safe_basin : Computes which starts stay below the limits.
    snapload.plot_basin : Draws the labels.

    Notes
    -----
    Runs do not stop when the body settles or slides. A motion may come to rest on its cables, which is an attractor,
    too. Python's lock is released during the computation, and Ctrl-C interrupts it.

    Examples
    --------
    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
    >>> labels, attractors = snapload.basins_of_attraction(case, x="-0.2:0.2:3", y="0.2:0.4:2", transient=60)
    >>> labels.dims, attractors[1]
    (('x', 'y'), <Orbit: stable, 1 period, 2, 1>)
    """
    from ._dataset import title_and_case

    engine, axes = engine_case(case), _window_axes(window)
    transient, trust = whole_number("transient", transient), flag("trust", trust)
    with progress_bar("basins of attraction", _PROGRESS_TOTAL, progress) as report_progress:
        answer, columns, orbits = _engine.basins_of_attraction(engine, axes, transient, trust, report_progress)
    data, coords = json.loads(answer), _axis_coordinates(axes)
    found = {name: _column(kind, buffer, words) for name, kind, buffer, words in columns}
    shape = tuple(len(values) for _, values, _ in coords.values())
    end_reasons: list[str] = next(entry["words"] for entry in _engine.columns() if entry["name"] == "end")
    codes = {"": -1, "attracted": 0, "aperiodic": 0} | {word: -2 - place for place, word in enumerate(end_reasons)}
    labels = np.array([codes[word] for word in found["outcome"]], dtype=np.int32)
    attracted = ~np.isnan(found["attractor"])
    labels[attracted] = found["attractor"][attracted].astype(np.int32)
    numbers = [row["attractor"] for row in data["attractors"]]
    flag_names = [(-2 - place, word) for place, word in reversed(list(enumerate(end_reasons)))]
    flag_names += [(-1, "not_legal"), (0, "aperiodic"), *((number, f"attractor_{number}") for number in numbers)]
    attrs = {
        "long_name": "attractor",
        "flag_values": np.array([value for value, _ in flag_names], dtype=np.int32),
        "flag_meanings": " ".join(word for _, word in flag_names),
        "legal": data["legal"],
        "cells": np.array([row["cells"] for row in data["attractors"]], dtype=np.int64),
        "fractions": np.array([row["fraction"] for row in data["attractors"]], dtype=np.float64),
        "periods": np.array([row["period"] for row in data["attractors"]], dtype=np.int64),
        **title_and_case("Basins of attraction of a body on cables", engine),
    }
    if trust:
        attrs["undecided"] = data["undecided"]
    flags = {name: found[name].reshape(shape) for name in ("decided", "trusted") if name in found}
    of_cells = {name: (tuple(coords), values, {"long_name": _LONG_NAMES[name]}) for name, values in flags.items()}
    variables = {"attractor": (tuple(coords), labels.reshape(shape), attrs)}
    array = with_own_names(xarray.Dataset(variables, coords | of_cells)).attractor
    label_orbits = zip(numbers, orbits, strict=True)
    return array, {number: Orbit(case, orbit) for number, orbit in label_orbits if orbit is not None}


with_keys(basins_of_attraction, defaults=False)


def erosion(
    case: Case,
    *,
    over: Mapping[str, ArrayLike | str],
    trust: bool = True,
    progress: bool = True,
    **window: Unpack[Axes],
) -> xarray.Dataset:
    """Compute how the safe part of a window shrinks along a third key, as ``snapload erosion`` does.

    Parameters
    ----------
    case : Case
        The case with all keys that do not vary.
    over : dict of str to array_like or str
        The third key and its values, such as ``{"f_o": "0:0.6:21"}``.
    trust : bool
        Whether to run the neighbours of each cell, which takes most of the time.
    progress : bool
        Whether to show a progress bar if the computation takes long.
    **window : array_like or str
        The evenly spaced values of the two keys of the window, as arrays or as ``"first:last:n"``.

    Returns
    -------
    xarray.Dataset
        Variables over the third key: ``gim`` with its 95 % interval from ``low`` to ``high``; ``lim``, ``if`` and
        ``iim`` as in :func:`snapload.safe_basin`; the numbers of cells that are ``legal``, ``safe``, ``undecided``
        (NaN without trust) and ``cut_short``; and ``decided_fraction``, the safe fraction of the decided cells. The
        attribute ``knee`` is the last value up to which that fraction never falls below nine tenths of its value at
        the first one; NaN if it never does. The attribute ``knee_between`` has the smallest and the largest possible
        ``knee``, whatever the ends of the undecided cells; NaN stands for one beyond the last value. Without trust all
        cells count as decided that are not cut short, and ``knee_between`` is absent if none is. ``knee_scale`` is the
        scale of the third key, if it has one.

    Raises
    ------
    ValueError
        If there are not two keys and a third one, or a value of a key is not allowed.

    See Also
    --------
    snapload.safe_basin : Computes the window at one value.
    snapload.plot_erosion : Draws the erosion.

    Notes
    -----
    Python's lock is released during the computation, and Ctrl-C interrupts it.

    Examples
    --------
    >>> import snapload
    >>> window = dict(x="-0.3:0.3:7", y="0.05:0.65:7")
    >>> eroded = snapload.erosion(snapload.Case(t_end=30), over={"f_o": [0, 0.3, 0.6]}, trust=False, **window)
    >>> bool(eroded.gim[2] < eroded.gim[0]), eroded["if"].dims
    (True, ('f_o',))
    """
    from ._dataset import title_and_case

    engine, axes, trust = engine_case(case), _window_axes(window), flag("trust", trust)
    if not isinstance(over, Mapping) or len(over) != 1:
        allowed = "one key with its values, such as {'f_o': '0:0.6:21'}"
        raise ValueError(f"over = {over!r} is not allowed; allowed: {allowed}")
    ((key, values),) = over.items()
    over_axis = key, axis_values(key, values)
    with progress_bar("erosion", _PROGRESS_TOTAL, progress) as report_progress:
        data = json.loads(_engine.erosion(engine, axes, over_axis, trust, report_progress))
    points = data["points"]
    variables: dict[str, Any] = {}
    for point in points:
        point["low"], point["high"] = point["interval95"]
    distances = _distances([key for key, _ in axes])
    for name in _EROSION_VARIABLES:
        known = attributes_in(*distances[name]) if name in distances else attributes()[name]
        variables[name] = (key, numbers(points, name), known)
    coords = {key: (key, np.array([point["value"] for point in points], dtype=np.float64), attributes()[key])}
    knees: dict[str, Any] = {"knee": or_nan(data["knee"])}
    if data["knee_between"] is not None:
        knees["knee_between"] = [or_nan(knee) for knee in data["knee_between"]]
    title = title_and_case("Erosion of a safe basin of a body on cables", engine)
    return with_own_names(
        xarray.Dataset(variables, coords, title | with_scales(knees, dict.fromkeys(knees, units()[key])))
    )


with_keys(erosion, defaults=False)

#: The variables of an erosion.
_EROSION_VARIABLES = (
    *("gim", "low", "high", "lim", "if", "iim"),
    *("legal", "safe", "undecided", "cut_short", "decided_fraction"),
)

_LONG_NAMES = {
    "outcome": "how the run ended",
    "legal": "whether the start is legal",
    "safe": "whether it reaches no limit",
    "decided": "whether its neighbours end alike",
    "trusted": "whether trust reaches its end",
}


def _window_axes(window: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """The two keys of a window with their values."""
    if len(window) != 2:
        given = ", ".join(window) or "none"
        allowed = "two keys with their values, such as x='-0.4:0.4:41', y='0.02:0.72:36'"
        raise ValueError(f"keys = {given} is not allowed; allowed: {allowed}")
    return [(key, axis_values(key, values)) for key, values in window.items()]


def _axis_coordinates(axes: list[tuple[str, Any]]) -> dict[str, Any]:
    from ._dataset import grid_coordinates

    return grid_coordinates(axes)


def _distances(keys: list[str]) -> dict[str, tuple[str, str]]:
    """Scale and long name of the distances in a window.

    In the plane of a length and a velocity a distance has no single unit. Without two start values there are none.
    """
    starts = [units()[key] for key in keys] if set(keys) <= set(STATE) else ["L"]
    distance = " and ".join(dict.fromkeys(starts))
    velocity = next((units()[key] for key in keys if key in _VELOCITIES), units()["vx"])
    return {
        "lim": (distance, "nearest unsafe start"),
        "if": (distance, "largest disc"),
        "iim": (velocity, "least unsafe velocity"),
    }


#: The velocities among the start values.
_VELOCITIES = ("vx", "vy", "vtheta")


def _measure_attributes(data: dict[str, Any]) -> dict[str, Any]:
    """The measures as attributes of a kind that every file format of xarray can store."""
    counts = ("legal", "safe", "fraction", "undecided", "cut_short", "past_horizon")
    names = (*counts, "gim", "lim", "if", "iim", "lim_at_least", "if_at_least", "iim_at_least")
    return {name: or_nan(data[name]) for name in names} | {"interval95": np.array(data["interval95"])}


def _column(kind: str, buffer: bytearray, words: list[str]) -> NDArray[Any]:
    """The values of all cells."""
    if kind == "words":
        return np.array(words, dtype=object)[np.frombuffer(buffer, dtype=np.int32)]
    return np.frombuffer(buffer, dtype=kind)
