"""Checks of options, with the messages of the engine."""

from __future__ import annotations

import json
import operator
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, SupportsFloat, SupportsIndex, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine

if TYPE_CHECKING:
    from ._case import Case

#: One size for every start value, a size for each key, or nothing but rounding.
Uncertainty: TypeAlias = float | Mapping[str, float] | None


def engine_case(case: Case) -> _engine.Case:
    """The engine's case of an argument that has to be a case."""
    from ._case import Case

    if isinstance(case, Case):
        return case._engine
    from ._system import System

    if isinstance(case, System):
        raise TypeError("case = a snapload.System is not allowed; allowed: a snapload.Case; a System has its own sweep")
    raise TypeError(f"case = {case!r} is not allowed; allowed: a snapload.Case, such as snapload.Case(f_o=0.31)")


def case_text(engine: _engine.Case) -> str:
    """The given keys of a case, as a file of a case has them."""
    # JSON's numbers, words and flags are TOML's.
    return "".join(f"{key} = {json.dumps(value)}\n" for key, value in engine.given().items())


def whole_number(option: str, value: SupportsIndex, most: int | None = None) -> int:
    """A whole number that is allowed for an option, which the engine identifies by name."""
    return _engine.whole(option, value, most)


def threads_for(requested: SupportsIndex, callers: int) -> int:
    """The requested number of threads, limited to a few for each thread that the machine runs at a time.

    If it is reduced, there is a warning at the code that called the package through `callers` functions.
    """
    threads, fewer = _engine.threads_for(number := whole_number("threads", requested))
    if fewer:
        warnings.warn(f"threads={number}: {fewer}", stacklevel=2 + callers)
    return threads


def flag(name: str, value: Any) -> bool:
    """True or false, and nothing that merely counts as one of them, such as a text."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise ValueError(f"{name} = {value!r} is not allowed; allowed: True or False")


def number(name: str, value: SupportsFloat) -> float:
    """A number; the engine checks whether it is allowed."""
    try:
        # NumPy's mark of a masked value would give NaN, and True would be 1.
        if not isinstance(value, (str, bytes, bool, np.bool_)) and type(value).__name__ != "MaskedConstant":
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"{name} = {value!r} is not allowed; allowed: a number")


def place_of(what: str, place: SupportsIndex, count: int) -> int:
    """The place of one of so many things, from 0; a negative place counts from the end."""
    try:
        number = operator.index(place)
    except TypeError:
        raise TypeError(f"{what} = {place!r} is not allowed; allowed: a whole number") from None
    if not -count <= number < count:
        raise IndexError(f"there is no {what} {number}; there are {count} of them, from 0")
    return number % count


def unmasked(name: str, values: Any) -> Any:
    """Values for an array. A masked array has values that are not meant."""
    if hasattr(values, "compressed") and (count := int(np.sum(values.mask))):
        masked = "1 masked value" if count == 1 else f"{count} masked values"
        allowed = "values without a mask; the array's method compressed() leaves out the masked ones"
        raise ValueError(f"{name} = an array with {masked} is not allowed; allowed: {allowed}")
    return values


def doubles(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """An array of doubles."""
    try:
        array: NDArray[np.float64] = np.asarray(unmasked(name, values), dtype=np.float64)
    except OverflowError:
        raise ValueError(f"{name} has a number that is too large; allowed: numbers below 1e308") from None
    return array


def uncertainty_for_engine(uncertainty: Uncertainty) -> dict[str, float] | float | None:
    """An uncertainty in the form that the engine expects."""
    if uncertainty is None:
        return None
    if isinstance(uncertainty, Mapping):
        return {str(key): number(f"uncertainty: {key}", size) for key, size in uncertainty.items()}
    try:
        return number("uncertainty", uncertainty)
    except ValueError:
        allowed = "a number, or one for each key, such as {'f_o': 0.01}"
        raise ValueError(f"uncertainty = {uncertainty!r} is not allowed; allowed: {allowed}") from None


def utf8_text(name: str, contents: bytes) -> str:
    """The text of a file of that name."""
    try:
        # Some editors of Windows begin a text with a byte-order mark.
        return contents.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{name}: not a text file in UTF-8 (byte {error.start}); save it as UTF-8") from None


def existing_file(path: str) -> str:
    """A file that can be opened; otherwise Python's own error is raised, such as ``FileNotFoundError``."""
    with open(path, "rb"):
        return path
