"""The common part of all results."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar

import numpy as np


class Result:
    """A result is equal to another if all its fields, including arrays, are; its repr has those in ``_repr_fields``."""

    _repr_fields: ClassVar[tuple[str, ...]] = ()
    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(equal_values(getattr(self, name), getattr(other, name)) for name in _names(self))

    def __repr__(self) -> str:
        texts = [f"{name}={_short_text(getattr(self, name))}" for name in self._repr_fields or _names(self)]
        more = ", ..." if self._repr_fields else ""
        return f"{type(self).__name__}({', '.join(texts)}{more})"


def equal_values(one: object, other: object) -> bool:
    """Whether two values are equal; arrays are compared by their elements."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.asarray(one).dtype == np.asarray(other).dtype and np.array_equal(one, other)  # type: ignore[arg-type]
    return one == other


def _names(result: Any) -> list[str]:
    return [field.name for field in fields(result)]


def _short_text(value: object) -> str:
    return np.array2string(value, threshold=6, separator=", ") if isinstance(value, np.ndarray) else repr(value)
