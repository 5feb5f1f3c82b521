"""What options may be, told in the words of the engine."""

from __future__ import annotations

from collections.abc import Mapping
from operator import index
from typing import SupportsIndex, TypeAlias

#: One size for every start value, a size for each key, or nothing but rounding.
Uncertainty: TypeAlias = float | Mapping[str, float] | None


def whole(name: str, value: SupportsIndex, low: int, high: int) -> int:
    """A whole number within bounds."""
    try:
        number = index(value)
    except TypeError:
        number = low - 1
    if low <= number <= high:
        return number
    raise ValueError(f"{name} = {value!r} is not allowed; allowed: a whole number, {low} <= {name} <= {high:g}")


def plain(uncertainty: Uncertainty) -> dict[str, float] | float | None:
    """As the engine takes it."""
    if uncertainty is None or not isinstance(uncertainty, Mapping):
        return uncertainty
    return {str(key): float(size) for key, size in uncertainty.items()}
