"""Results of structures as xarray, with the units in which their names end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import doubles
from ._lazy_import import LazyModule
from ._schema import with_own_names

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")

#: Units by the endings of names, longest first.
_UNITS = {
    "_kg_m2": "kg m2",
    "_n_s_m": "N s m-1",
    "_n_s": "N s",
    "_n_m": "N m-1",
    "_kg_m": "kg m-1",
    "_m_s": "m s-1",
    "_rad": "rad",
    "_kg": "kg",
    "_n": "N",
    "_m": "m",
    "_s": "s",
    "_j": "J",
}

_CHECK: dict[str, type] = {"answer": str, "criterion": str, "limit": float, "line": int, "value": float}

#: The columns of rows of which there may be none, with the type of their values.
COLUMNS: dict[str, dict[str, type]] = {
    "snaps": {
        **dict.fromkeys(("effective_mass_kg", "effective_speed_m_s", "energy_lost_j", "energy_peak_n"), float),
        **{"formula_n": float, "front_n": float, "impulse_n_s": float, "jolt": bool, "line": int},
        **dict.fromkeys(("peak_n", "speed_m_s", "t_s", "utilisation"), float),
    },
    "pulls": {
        **{"from_s": float, "line": int},
        **dict.fromkeys(("peak_n", "peak_s", "rebound_m_s", "speed_m_s", "to_s"), float),
    },
    "checks": _CHECK | {"answer_in_words": str, "neighbours_agreeing": int, "words": str},
    "checks of seas": _CHECK | {"median": float, "of": int, "passing": int},
}


def attributes_of(name: str) -> dict[str, str]:
    """Attributes of a quantity from its name: the name in words, and the unit."""
    ending = next((ending for ending in _UNITS if name.endswith(ending)), "")
    return {"long_name": name.removesuffix(ending).replace("_", " "), "units": _UNITS.get(ending, "1")}


def column_values(values: list[Any]) -> NDArray[Any]:
    """Numbers, with NaN for missing values; other values unchanged."""
    if all(value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)) for value in values):
        if any(value is None or isinstance(value, float) for value in values):
            return np.array([np.nan if value is None else value for value in values], dtype=np.float64)
        return np.array(values, dtype=np.int64)
    return np.array(["" if value is None else value for value in values])


def rows_dataset(
    rows: Sequence[Mapping[str, Any]], along: str, columns: Mapping[str, type] | None = None, index: str | None = None
) -> xarray.Dataset:
    """Rows as a dataset along one dimension, with the column `index`, if given, as its coordinate.

    Without rows it has the given columns, which are empty.
    """
    if not rows:
        types = columns or {}
        empty: dict[str, Any] = {name: (along, np.empty(0, types[name]), attributes_of(name)) for name in types}
        return with_own_names(xarray.Dataset(empty))
    variables = {
        name: (along, column_values([row[name] for row in rows]), attributes_of(name))
        for name in rows[0]
        if name != index and not isinstance(rows[0][name], (list, dict))
    }
    coords = {along: [row[index] for row in rows]} if index else {}
    return with_own_names(xarray.Dataset(variables, coords=coords))


def finite_row(times: ArrayLike) -> list[float]:
    """Times that are one row of finite numbers."""
    values = doubles("times", times)
    if values.ndim != 1 or not np.isfinite(values).all():
        raise ValueError("these times are not allowed; allowed: one row of finite numbers")
    row: list[float] = values.tolist()
    return row


def motion_dataset(
    columns: tuple[list[float], list[float], list[float], list[float], list[list[float]]], line_count: int
) -> xarray.Dataset:
    """A motion from its columns: times, x, z, rotation, and the tensions of all lines at each time."""
    t, x, z, theta, tension = columns
    lines = np.arange(1, line_count + 1)
    coordinates = {"x_m": x, "z_m": z, "theta_rad": theta}
    variables: dict[str, Any] = {
        name: ("t_s", np.array(values), attributes_of(name)) for name, values in coordinates.items()
    }
    tensions = np.array(tension, dtype=np.float64).reshape(len(t), len(lines))
    variables["tension_n"] = (("t_s", "line"), tensions, attributes_of("tension_n"))
    coords = {"t_s": ("t_s", np.array(t), attributes_of("t_s")), "line": lines}
    return with_own_names(xarray.Dataset(variables, coords=coords))
