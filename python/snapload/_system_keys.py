"""The keys of a system by name: its own keys, and those of its parts."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
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
    """Every name that `with_keys` accepts, except those with numbers."""
    own = [field.name for field in in_order(system)]
    return [*own, *_BODY_KEYS, *_FORCE_KEYS, *_CABLE_KEYS, *_SINUSOID_KEYS]


def with_keys(system: System, keys: Mapping[str, Any]) -> dict[str, Any]:
    """The parts to which keys belong, with the keys changed."""
    check_keys(system, keys)
    parts: dict[str, Any] = {}
    for key, value in keys.items():
        parts |= _with_key(system, parts, key, value)
    return parts


def check_keys(system: System, keys: Iterable[str]) -> None:
    """Refuses unknown keys, those of parts that the system does not have, and those that change one number twice."""
    targets = [(key, _target_of(system, key)) for key in keys]
    for place, (key, target) in enumerate(targets):
        for other, other_target in targets[:place]:
            if target.overlaps(other_target):
                raise ValueError(
                    f"{key} beside {other} is not allowed, as both change the same; allowed: one of them, or each part "
                    "with a number of its own, such as length_1 and length_2"
                )


@dataclass(frozen=True)
class _Target:
    """What a key changes: a field of the system, or a number of one of its parts, or of all parts of a kind."""

    field: str
    number: str | None = None
    place: int | None = None

    def overlaps(self, other: _Target) -> bool:
        if self.field != other.field or self.number is None or other.number is None:
            return self.field == other.field
        return self.number == other.number and (self.place is None or other.place in (None, self.place))


def _target_of(system: System, key: str) -> _Target:
    if key in {field.name for field in dataclasses.fields(system)}:
        return _Target(key)
    if key in _BODY_KEYS:
        return _Target("body", key)
    if key in _FORCE_KEYS:
        return _Target("forcing", key)
    match = re.fullmatch(r"(\w+?)(?:_([1-9][0-9]*))?", key)
    name, place = (match[1], match[2]) if match else (key, None)
    if name in _CABLE_KEYS:
        field, what, count = "cables", "cables", len(system.cables)
    elif name in _SINUSOID_KEYS:
        field, what, count = "forcing", "sinusoids", len(system.forcing.sinusoids)
    else:
        raise ValueError(
            f"there is no key {key!r}; the keys are {', '.join(names(system))}, and length_2 or omega_1 for one part"
        )
    if count < (int(place) if place else 1):
        there = {0: f"the system has no {what}", 1: "there is one of them"}.get(count, f"there are {count} of them")
        raise ValueError(f"there is no key {key!r}: {there}")
    return _Target(field, name, int(place) if place else None)


def _with_key(system: System, parts: dict[str, Any], key: str, value: Any) -> dict[str, Any]:
    """The part to which a key belongs, with the key changed; `parts` are those changed before."""

    def part(name: str) -> Any:
        return parts.get(name, getattr(system, name))

    target = _target_of(system, key)
    if target.number is None:
        return {key: value}
    if key in _BODY_KEYS:
        return {"body": dataclasses.replace(part("body"), **{key: value})}
    if key in _FORCE_KEYS:
        return {"forcing": _with_number(part("forcing"), _FORCE_KEYS[key], value)}
    if target.field == "cables":
        return {"cables": _one_or_all(part("cables"), target, value)}
    forcing = part("forcing")
    return {"forcing": dataclasses.replace(forcing, sinusoids=_one_or_all(forcing.sinusoids, target, value))}


def _one_or_all(parts: tuple[Any, ...], target: _Target, value: Any) -> tuple[Any, ...]:
    """The parts with one changed, or all of them."""
    assert target.number is not None
    return tuple(
        _with_number(part, target.number, value) if target.place in (None, number) else part
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
