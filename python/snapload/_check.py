"""What options may be, told in the words of the engine."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, SupportsFloat, SupportsIndex, TypeAlias

from . import _engine

if TYPE_CHECKING:
    from ._case import Case

#: One size for every start value, a size for each key, or nothing but rounding.
Uncertainty: TypeAlias = float | Mapping[str, float] | None


def engine_of(case: Case) -> _engine.Case:
    """The case of the engine, of what has to be a case."""
    from ._case import Case

    if isinstance(case, Case):
        return case._engine
    from ._system import System

    if isinstance(case, System):
        raise TypeError("case = a snapload.System is not allowed; allowed: a snapload.Case; a System has its own sweep")
    raise TypeError(f"case = {case!r} is not allowed; allowed: a snapload.Case, such as snapload.Case(f_o=0.31)")


def whole(option: str, value: SupportsIndex, most: int | None = None) -> int:
    """A whole number that an option takes, which the engine knows by its name."""
    return _engine.whole(option, value, most)


def threads_for(asked: SupportsIndex, callers: int) -> int:
    """As many threads as asked for, up to a few for each that the machine runs at a time.

    Where these are fewer a warning says so, at the code that called the package through so many functions.
    """
    threads, fewer = _engine.threads_for(number := whole("threads", asked))
    if fewer:
        warnings.warn(f"threads={number}: {fewer}", stacklevel=2 + callers)
    return threads


def number(name: str, value: SupportsFloat) -> float:
    """A number; which ones are allowed the engine says."""
    try:
        if not isinstance(value, (str, bytes)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"{name} = {value!r} is not allowed; allowed: a number")


def plain(uncertainty: Uncertainty) -> dict[str, float] | float | None:
    """As the engine takes it."""
    if uncertainty is None:
        return None
    if isinstance(uncertainty, Mapping):
        return {str(key): number(f"uncertainty: {key}", size) for key, size in uncertainty.items()}
    try:
        return number("uncertainty", uncertainty)
    except ValueError:
        allowed = "a number, or one for each key, such as {'f_o': 0.01}"
        raise ValueError(f"uncertainty = {uncertainty!r} is not allowed; allowed: {allowed}") from None


def there(path: str) -> str:
    """A file that can be opened; if not, the error is Python's own, such as ``FileNotFoundError``."""
    with open(path, "rb"):
        return path
