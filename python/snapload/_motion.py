"""Motions: records of times and states that know their units."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

#: Scales of the case, units of the user's own, or SI.
MotionUnits = Literal["scales", "own", "si"]


class Motion(np.recarray[Any, Any]):
    """A motion as an array of records.

    Its units are those of parts of it and of copies, in other processes too. Arrays that NumPy computes from it, as
    by ``numpy.concatenate``, are no motions.
    """

    _units: MotionUnits = "scales"

    @classmethod
    def of(cls, records: NDArray[Any], units: MotionUnits) -> Motion:
        """The records as a motion in these units."""
        motion: Motion = records.view(cls)
        motion._units = units
        return motion

    def __array_finalize__(self, obj: Any) -> None:
        super().__array_finalize__(obj)
        if isinstance(obj, Motion):
            self._units = obj._units

    def __reduce__(self) -> tuple[Any, ...]:
        restore, arguments, state = tuple(super().__reduce__())
        return restore, arguments, (self._units, state)

    def __setstate__(self, state: Any) -> None:
        self._units, contents = state
        super().__setstate__(contents)
