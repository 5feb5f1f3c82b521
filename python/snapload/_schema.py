"""Long names, units and scales of keys and results, from the engine's schema."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from . import _engine

if TYPE_CHECKING:
    import xarray

#: Pictures of xarray are labelled by long name and unit, in lines of so many letters. A second line lies outside the
#: picture, so that a longer name gives way to that of the column.
_MAX_LABEL = 30


@cache
def units() -> dict[str, str]:
    """The unit of every key and result in the scales of the case, such as ``L/T``; "", 1 or rad without a scale."""
    entries = (*_engine.quantities(), *_engine.columns(), *_engine.keys())
    return {entry["name"]: entry["unit"] for entry in entries}


@cache
def attributes() -> dict[str, dict[str, str]]:
    """Long name and units of every key and result after the CF conventions."""
    described = {}
    for entry in (*_engine.quantities(), *_engine.columns(), *_engine.keys()):
        name, title, meaning, unit = entry["name"], entry["title"], entry["meaning"], dict(entry["cf"])
        scale = f", in {unit['scale']}" if unit["scale"] else ""
        long_name = title + scale if _fits(title + scale, unit["units"]) else name + scale
        entry_attributes = {"long_name": long_name, **unit, "comment": "" if meaning == long_name else meaning}
        described[name] = {key: word for key, word in entry_attributes.items() if word}
    described["error"] = {"long_name": "why there was no run"}
    return described


def attributes_as(name: str, long_name: str) -> dict[str, str]:
    """Attributes with the unit of a key or result, but a long name of their own."""
    known = attributes()[name]
    unit: dict[str, str] = {key: known[key] for key in ("units", "scale") if key in known}
    return {"long_name": _with_scale(long_name, unit.get("scale", "")), **unit}


def attributes_in(scale: str, long_name: str) -> dict[str, str]:
    """Attributes of a quantity whose scale depends on the keys that vary; empty or 1 for none."""
    if scale in ("", "1", "rad"):
        return {"long_name": long_name, "units": scale or "1"}
    return {"long_name": _with_scale(long_name, scale), "units": "1", "scale": scale}


def with_own_names(result: xarray.Dataset) -> xarray.Dataset:
    """A dataset with the name of each number and flag in its metadata, which `Scales.si` compares with the variable's.

    Arithmetic of xarray keeps metadata, although the unit is another one, and flags become floats where it puts NaN
    between them.
    """
    for name, variable in result.variables.items():
        if variable.dtype.kind in "biufc":
            variable.attrs["quantity"] = name
    return result


def with_scales(values: Mapping[str, Any], scales: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Attributes of a dataset, each with its scale in another one, such as ``y_max_scale`` of ``y_max``.

    Scales that are not given are those of the schema. Several scales, with commas between, are those of a list.
    """
    known = {name: (scales or {}).get(name, units().get(name, "")) for name in values}
    return {**values, **{f"{name}_scale": scale for name, scale in known.items() if scale not in ("", "1")}}


def _with_scale(long_name: str, scale: str) -> str:
    """The long name with its scale, if both fit in one line of a label."""
    complete = f"{long_name}, in {scale}"
    return complete if scale and _fits(complete, "1") else long_name


def _fits(long_name: str, unit: str) -> bool:
    return len(f"{long_name} [{unit}]" if unit else long_name) <= _MAX_LABEL
