"""Products of the scales of a case, in the notation of the metadata of results."""

from __future__ import annotations

import re
from fractions import Fraction

#: The scales of which products consist, and the SI unit of each.
_UNITS = {"L": "m", "m": "kg", "F": "N", "T": "s", "rad": "rad"}

#: A scale with its power, which is a whole number or a fraction.
_POWER = re.compile(r"(L|m|F|T|rad|1)(?:\^(\d+)|\^\((\d+)/([1-9]\d*)\))?")


def powers(scale: str) -> list[tuple[str, float]]:
    """The scales in a product such as ``L^(1/2)/T``, each with its power."""
    if not isinstance(scale, str):
        raise TypeError(f"scale = {scale!r} is not allowed; allowed: a product such as 'L/T' or 'm L^2'")
    # The bar of a fraction is not the one that divides the product.
    numerator, *denominator = re.split(r"/(?![^(]*\))", scale, maxsplit=1)
    found: list[tuple[str, float]] = []
    for factors, sign in ((numerator, 1), *((factors, -1) for factors in denominator)):
        # A fraction has something above and below its line.
        for factor in factors.split() or [""] * len(denominator):
            match = _POWER.fullmatch(factor)
            if match is None:
                raise ValueError(f"scale = {scale!r} is not allowed; allowed: a product such as 'L/T' or 'm L^2'")
            if match[1] != "1":
                power = Fraction(int(match[3]), int(match[4])) if match[3] else Fraction(match[2] or 1)
                found.append((match[1], float(sign * power)))
    return found


def unit_of(scale: str) -> str:
    """The SI unit of a product of scales, after the CF conventions: ``m s-1``."""
    return " ".join(f"{_UNITS[name]}{power:g}" if power != 1 else _UNITS[name] for name, power in powers(scale)) or "1"
