"""Results of structures as xarray, with the units in which their names end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._lazy_import import LazyModule

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


def rows_dataset(rows: Sequence[Mapping[str, Any]], along: str, index: str | None = None) -> xarray.Dataset:
    """Rows as a dataset along one dimension, with the column `index`, if given, as its coordinate."""
    names = list(rows[0]) if rows else []
    variables = {
        name: (along, column_values([row[name] for row in rows]), attributes_of(name))
        for name in names
        if name != index and not isinstance(rows[0][name], (list, dict))
    }
    coords = {along: [row[index] for row in rows]} if index else {}
    return xarray.Dataset(variables, coords=coords)


def motion_dataset(
    columns: tuple[list[float], list[float], list[float], list[float], list[list[float]]],
) -> xarray.Dataset:
    """A motion from its columns: times, x, z, rotation, and the tensions of all lines at each time."""
    t, x, z, theta, tension = columns
    lines = np.arange(1, len(tension[0]) + 1 if tension else 1)
    coordinates = {"x_m": x, "z_m": z, "theta_rad": theta}
    variables: dict[str, Any] = {
        name: ("t_s", np.array(values), attributes_of(name)) for name, values in coordinates.items()
    }
    tensions = np.array(tension, dtype=np.float64).reshape(len(t), len(lines))
    variables["tension_n"] = (("t_s", "line"), tensions, attributes_of("tension_n"))
    return xarray.Dataset(variables, coords={"t_s": ("t_s", np.array(t), attributes_of("t_s")), "line": lines})
