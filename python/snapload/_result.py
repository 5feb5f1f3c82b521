"""The common part of all results."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray


class Result:
    """A result is equal to another if all its fields, including arrays, are; its repr has those in ``_repr_fields``.

    NaN, which stands for what is not known, is equal to NaN. Arrays can not be written to, as a result does not change.
    """

    _repr_fields: ClassVar[tuple[str, ...]] = ()
    __hash__ = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        for name in _names(self):
            if isinstance(value := getattr(self, name), np.ndarray):
                value.flags.writeable = False

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(equal_values(getattr(self, name), getattr(other, name)) for name in _names(self))

    def __repr__(self) -> str:
        texts = [f"{name}={_short_text(getattr(self, name))}" for name in self._repr_fields or _names(self)]
        more = ", ..." if self._repr_fields else ""
        return f"{type(self).__name__}({', '.join(texts)}{more})"


def equal_values(one: Any, other: Any) -> bool:
    """Whether two values are equal; arrays are compared by their elements, and NaN is equal to NaN."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _equal_arrays(np.asarray(one), np.asarray(other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(equal_values(one[key], other[key]) for key in one)
    if isinstance(one, (list, tuple)) and type(one) is type(other):
        return len(one) == len(other) and all(map(equal_values, one, other))
    if isinstance(one, float) and isinstance(other, float) and np.isnan(one) and np.isnan(other):
        return True
    return bool(one == other)


def _equal_arrays(one: NDArray[Any], other: NDArray[Any]) -> bool:
    if one.dtype != other.dtype or one.shape != other.shape:
        return False
    if one.dtype.names is not None:
        return all(_equal_arrays(one[name], other[name]) for name in one.dtype.names)
    return np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")


def _names(result: Any) -> list[str]:
    return [field.name for field in fields(result)]


def _short_text(value: object) -> str:
    return np.array2string(value, threshold=6, separator=", ") if isinstance(value, np.ndarray) else repr(value)
