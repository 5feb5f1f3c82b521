"""The keys of a system by name: its own keys, and those of its parts."""

from __future__ import annotations

import dataclasses
import re
from typing import TYPE_CHECKING, Any

from ._keys import LIMITS

if TYPE_CHECKING:
    from ._system import System

_BODY_KEYS = ("mass", "inertia", "radius")
_FORCE_KEYS = {"force_x": "constant_x", "force_y": "constant_y"}
_CABLE_KEYS = ("length", "anchor_x", "anchor_y", "fairlead_x", "fairlead_y")
_SINUSOID_KEYS = ("amplitude_x", "amplitude_y", "omega", "phase_x", "phase_y")


def in_order(system: System) -> list[dataclasses.Field[Any]]:
    """The fields of a system, with the limits last; as fields of a base class they would come first."""
    return sorted(dataclasses.fields(system), key=lambda field: field.name in LIMITS)


def names(system: System) -> list[str]:
    """Every name that `with_key` accepts, except those with numbers."""
    own = [field.name for field in in_order(system)]
    return [*own, *_BODY_KEYS, *_FORCE_KEYS, *_CABLE_KEYS, *_SINUSOID_KEYS]


def with_key(system: System, parts: dict[str, Any], key: str, value: Any) -> dict[str, Any]:
    """The part to which a key belongs, with the key changed; `parts` are those changed before."""

    def part(name: str) -> Any:
        return parts.get(name, getattr(system, name))

    if key in {field.name for field in dataclasses.fields(system)}:
        return {key: value}
    if key in _BODY_KEYS:
        return {"body": dataclasses.replace(part("body"), **{key: value})}
    if key in _FORCE_KEYS:
        return {"forcing": _with_number(part("forcing"), _FORCE_KEYS[key], value)}
    match = re.fullmatch(r"(\w+?)(?:_([1-9][0-9]*))?", key)
    name, place = (match[1], match[2]) if match else (key, None)
    if name in _CABLE_KEYS:
        return {"cables": _one_or_all(key, part("cables"), name, place, value)}
    if name in _SINUSOID_KEYS:
        forcing = part("forcing")
        sinusoids = _one_or_all(key, forcing.sinusoids, name, place, value)
        return {"forcing": dataclasses.replace(forcing, sinusoids=sinusoids)}
    raise ValueError(
        f"there is no key {key!r}; the keys are {', '.join(names(system))}, and length_2 or omega_1 for one part"
    )


def _one_or_all(key: str, parts: tuple[Any, ...], name: str, place: str | None, value: Any) -> tuple[Any, ...]:
    """The parts with one changed, or all of them."""
    if place is not None and int(place) > len(parts):
        raise ValueError(f"there is no key {key!r}: there are {len(parts)} of them")
    return tuple(
        _with_number(part, name, value) if place is None or int(place) == number else part
        for number, part in enumerate(parts, 1)
    )


def _with_number(part: Any, name: str, value: Any) -> Any:
    """A part with one number changed; ``name_x`` is the first of the pair ``name``."""
    pair = {"x": 0, "y": 1}.get(name[-1]) if name[-2:] in ("_x", "_y") else None
    if pair is None:
        return dataclasses.replace(part, **{name: value})
    numbers = list(getattr(part, name[:-2]))
    numbers[pair] = value
    return dataclasses.replace(part, **{name[:-2]: tuple(numbers)})
