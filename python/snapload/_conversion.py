"""Results in SI units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _engine
from ._motion import Motion
from ._products import unit_of
from ._schema import units
from ._table import Table

if TYPE_CHECKING:
    from ._scales import Scales

#: What a quantity of a system says instead of units.
_OWN = "is in your own units, as all results of a snapload.System"


def converted_table(scales: Scales, table: Table) -> Table:
    """A table with its columns in SI units."""
    parts = []
    for name, kind, attrs, values in table._table.parts():
        if kind == "float64" and (scale := _scale(name, attrs)):
            factor = _factor(scales, name, scale)
            values = bytearray((np.frombuffer(values) * factor).tobytes())
            attrs = {key: text for key, text in attrs.items() if key != "scale"} | {"units": unit_of(scale)}
        parts.append((name, kind, attrs, values))
    return Table(_engine.Table.of(parts))


def converted_motion(scales: Scales, motion: Motion) -> Motion:
    """A motion in SI units."""
    if motion._units == "own":
        raise ValueError(f"the motion {_OWN}; allowed: a motion of a case, in its scales")
    if motion._units == "si":
        return motion
    converted = motion.copy()
    for name in motion.dtype.names or ():
        # Every cable has a tension, T1, T2 and so on; counts have no scale.
        if motion.dtype[name].kind == "f":
            converted[name] *= _factor(scales, name, units().get(name) or units()["tension"])
    converted._units = "si"
    return converted


def converted_dataset(scales: Scales, dataset: Any) -> Any:
    """A dataset of xarray with its coordinates, variables and attributes in SI units."""
    for name, variable in dataset.variables.items():
        _refuse_own_units(name, variable.attrs)
    variables = {name: _variable(scales, name, variable) for name, variable in dataset.variables.items()}
    converted = dataset.assign(variables)
    converted.attrs = _attributes(scales, dataset.attrs)
    return converted


def converted_array(scales: Scales, array: Any) -> Any:
    """An array of xarray with its coordinates in SI units."""
    name = "the array" if array.name is None else array.name
    variable = _variable(scales, name, array.variable)
    coordinates = {name: _variable(scales, name, along.variable) for name, along in array.coords.items()}
    converted = array.copy(data=variable.data)
    converted.attrs = dict(variable.attrs)
    return converted.assign_coords(coordinates)


def _variable(scales: Scales, name: Any, variable: Any) -> Any:
    if variable.dtype.kind != "f":
        return variable
    scale = _scale(name, variable.attrs)
    if scale or variable.attrs.get("units") == "1":
        _refuse_computed(name, variable.attrs, scale)
    if not scale:
        return variable
    converted = variable.copy(data=variable.data * _factor(scales, name, scale, variable.data))
    converted.attrs = {key: text for key, text in variable.attrs.items() if key != "scale"}
    # Long names end in the scale of the number.
    long_name = str(converted.attrs.get("long_name", "")).removesuffix(f", in {scale}")
    converted.attrs |= {"units": _si_unit(scale), "long_name": long_name}
    return converted


def _attributes(scales: Scales, attrs: dict[str, Any]) -> dict[str, Any]:
    """Attributes of a dataset; the scale of ``lim`` is in ``lim_scale``, with several for a list between commas."""
    converted: dict[str, Any] = {}
    for key, value in attrs.items():
        name = str(key).removesuffix("_scale")
        if name == key or name not in attrs or not isinstance(value, str):
            converted.setdefault(key, value)
            continue
        products = value.split(", ")
        factors = [_factor(scales, name, product, attrs[name]) for product in products]
        in_si = np.asarray(attrs[name], dtype=np.float64) * (factors if len(factors) > 1 else factors[0])
        converted[name] = in_si if in_si.ndim else float(in_si)
        converted[f"{name}_units"] = ", ".join(map(_si_unit, products))
    return converted


def _scale(name: Any, attrs: Any) -> str:
    """The scale of real numbers; empty if they are in SI units or have no dimension."""
    _refuse_own_units(name, attrs)
    scale: str = attrs.get("scale", "")
    known = "units" in attrs or attrs.get("quantity") == name or units().get(name, "?") in ("", "1", "rad")
    if not scale and not known:
        raise ValueError(
            f"{name} is not allowed, as its unit is unknown; allowed: quantities whose metadata have units, and for "
            "those in scales also scale and their own name, such as units = '1', scale = 'L/T' and quantity = 'rho1'"
        )
    return scale


def _refuse_computed(name: Any, attrs: Any, scale: str) -> None:
    """Refuses metadata that another quantity had. Files of earlier versions do not name the quantity."""
    owner = attrs.get("quantity")
    if owner == name or (owner is None and units().get(name) == (scale or "1")):
        return
    known = "of no known quantity" if owner is None else f"those of {owner}"
    raise ValueError(
        f"{name} is not allowed, as its metadata are {known}; allowed: results under their own names, so convert "
        "first, then compute or rename; or metadata with units, scale and quantity, which is the name"
    )


def _refuse_own_units(name: Any, attrs: Any) -> None:
    if "dimension" in attrs:
        raise ValueError(f"{name} {_OWN}; allowed: results of cases, in their scales")


def _factor(scales: Scales, name: Any, scale: str, values: Any = 0.0) -> float:
    """The factor of a quantity. What has no single unit may only be NaN."""
    try:
        return scales.factor(scale)
    except ValueError:
        if bool(np.isnan(values).all()):
            return 1.0
        raise ValueError(
            f"{name} is not allowed, as its scale, {scale}, is no single unit; allowed: results without it"
        ) from None


def _si_unit(scale: str) -> str:
    """The SI unit of a scale; 1 of numbers that have no single one, all of which are NaN."""
    try:
        return unit_of(scale)
    except ValueError:
        return "1"
