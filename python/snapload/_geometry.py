"""Geometry of the cables and the outline of the body, for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._case import Case

Point: TypeAlias = tuple[float, float]

#: Half the size in which a body without size is shown, as a part of the longest cable.
_MIN_HALF_SIZE = 0.008


@dataclass(frozen=True)
class Geometry:
    """The geometry that pictures of a run show in addition to its motion."""

    #: Anchor, fairlead in the body's frame, and length of each cable.
    cables: tuple[tuple[Point, Point, float], ...]
    #: Radius of a circle about the centre, or half width and half height of a rectangle.
    body: float | Point
    #: How far the body may turn, if that ends a run.
    rotation_limit: float | None
    #: Points that are shown even if the body does not reach them.
    shown_points: tuple[Point, ...] = ()

    @classmethod
    def of_case(cls, case: Case) -> Geometry:
        """Of a breakwater on two cables."""
        keys = case.keys()
        r, a, b = keys["r"], keys["a"], keys["b"]
        # Both cables are taut where the body is upright at y = 0.
        height = float(np.sqrt(r**2 - (1 - a) ** 2)) + b
        cables = tuple(((side, height), (side * a, b), r) for side in (1.0, -1.0))
        return cls(cables, (a, b) if b > 0 else a, np.pi / 2, ((0.0, 0.0),))

    def outline(self) -> NDArray[np.float64]:
        """The outline of the body, shape (n, 2)."""
        if isinstance(self.body, tuple):
            a, b = self.body
            return np.array([[a, b], [-a, b], [-a, -b], [a, -b]])
        angles = np.linspace(0, 2 * np.pi, 60)
        return max(self.body, self._min_half_size()) * np.column_stack([np.cos(angles), np.sin(angles)])

    def half_extent(self) -> float:
        """The largest distance of the outline from the centre along either axis."""
        return max(float(np.abs(self.outline()).max()), self._min_half_size())

    def _min_half_size(self) -> float:
        return _MIN_HALF_SIZE * max(length for _, _, length in self.cables)

    def circle_centres(self) -> list[Point]:
        """The point about which each taut cable guides the centre of a body that stays upright."""
        return [(anchor[0] - fairlead[0], anchor[1] - fairlead[1]) for anchor, fairlead, _ in self.cables]
