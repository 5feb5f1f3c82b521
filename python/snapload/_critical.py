"""The critical force, and why one number is not enough."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._check import Uncertainty, plain, whole
from ._progress import bar

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._case import Case


@dataclass(frozen=True)
class CriticalForce:
    """The force amplitudes at which a case exceeds the limits of its mooring.

    Attributes
    ----------
    f_cr : float or None
        The smallest one that exceeds [F]; None if none does.
    reason : str or None
        How its run ends: ``rotation_limit`` or ``upper_bound``.
    t : float or None
        When [T].
    exceeding : numpy.ndarray, shape (n, 2)
        All that exceed, as intervals of neighbouring amplitudes ``[from, to]`` [F]. The set is no interval: an
        amplitude above the critical one may settle.
    probability : numpy.recarray or None
        With an ensemble, at each amplitude: ``f_o``, whether the end is ``certain``, ``count`` of the members that
        exceed, ``part``, and the 95 % interval from ``low`` to ``high``.
    passes : dict of str to float or None
        With an ensemble, the amplitudes at which 5, 50 and 95 % exceed: ``p05``, ``p50``, ``p95``.
    """

    f_cr: float | None
    reason: str | None
    t: float | None
    exceeding: NDArray[np.float64]
    probability: np.recarray[Any, Any] | None
    passes: dict[str, float | None]
    _step: float
    _max: float

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws which amplitudes exceed, or how probably, into axes of Matplotlib, and returns them."""
        from matplotlib import pyplot

        from ._plot import BLUE, ORANGE, VERMILION, legend

        if ax is None:
            _, ax = pyplot.subplots(figsize=(3.5, 2.6), layout="constrained")
        half = self._step / 2
        for place, (start, stop) in enumerate(self.exceeding):
            label = "exceeds" if place == 0 else None
            ax.axvspan(start - half, stop + half, color=ORANGE, alpha=0.35, linewidth=0, label=label)
        if self.probability is not None:
            at = self.probability
            ax.fill_between(at.f_o, at.low, at.high, color=BLUE, alpha=0.25, linewidth=0)
            ax.plot(at.f_o, at.part, color=BLUE, linewidth=1.0, label="neighbours")
            ax.set_ylabel("probability of exceeding")
            ax.set_ylim(-0.02, 1.02)
            ax.set_yticks([0, 0.25, 0.5, 0.75, 1])
        else:
            ax.set_yticks([])
        if self.f_cr is not None:
            ax.axvline(self.f_cr, color=VERMILION, linewidth=1.2, linestyle="--", label=f"$f_{{cr}}$ = {self.f_cr:g}")
        ax.set_xlim(0, self._max)
        ax.set_xlabel("$f_o$ [F]")
        if ax.get_legend_handles_labels()[0]:
            legend(ax)
        return ax

    def _repr_html_(self) -> str:
        def interval(start: float, stop: float) -> str:
            return f"{start:g}" if start == stop else f"{start:g} to {stop:g}"

        rows = [("f_cr", "none" if self.f_cr is None else f"{self.f_cr:g}")]
        if self.reason is not None:
            rows.append(("because of", f"{self.reason.replace('_', ' ')} at t = {self.t:.4f}"))
        rows.append(("exceeding", ", ".join(interval(*pair) for pair in self.exceeding)))
        rows += [(f"{name[1:].lstrip('0')} % exceed from", str(f_o)) for name, f_o in self.passes.items()]
        cells = (f"<tr><th style='text-align:left'>{a}</th><td style='text-align:left'>{b}</td></tr>" for a, b in rows)
        return f"<table>{''.join(cells)}</table>"


def critical_force(
    case: Case,
    *,
    step: float = 0.01,
    max: float = 1.0,
    members: int = 0,
    uncertainty: Uncertainty = None,
    tolerance: float = 1e-3,
    seed: int = 1,
    progress: bool = True,
) -> CriticalForce:
    """Runs a case at the force amplitudes step, 2 step, ... up to max, and finds which exceed the limits.

    Parameters
    ----------
    case : Case
        The case; its own ``f_o`` does not matter. With ``stop_when_sliding=True`` a run that begins to slide ends
        there, as in the studies of the thesis.
    step, max : float
        The amplitudes [F].
    members : int
        With a number above 0, so many neighbours are run at each amplitude where one run can not tell, for the
        probability of exceeding.
    uncertainty : float or dict of str to float, optional
        What is in doubt of the neighbours: one size for every start value, or a size for each key.
    tolerance : float
        Error of state and time above which a result counts as not known.
    seed : int
        Which neighbours.
    progress : bool
        Whether to show a bar if it takes long.

    Returns
    -------
    CriticalForce
        The smallest amplitude that exceeds, and all others.

    Raises
    ------
    ValueError
        If an option is out of its range.

    Notes
    -----
    The critical force is that of section 6.4.2 of the thesis.

    Examples
    --------
    >>> import snapload
    >>> snapload.critical_force(snapload.Case()).f_cr
    0.31
    """
    members, seed = whole("members", members, 0, 10**9), whole("seed", seed, 0, 2**64 - 1)
    if uncertainty is not None and members == 0:
        raise ValueError("uncertainty asks for neighbours, but none are to be run; give members, such as members=200")
    found = json.loads(_engine.critical_force(case._engine, step, max))
    exceeding = np.array(found.pop("exceeding"), dtype=np.float64).reshape(-1, 2)
    curve, passes = None, {}
    if members > 0:
        with bar("force amplitudes", round(max / step), progress, 0) as tell:
            answer = _engine.probability(case._engine, step, max, plain(uncertainty), tolerance, members, seed, tell)
        answered = json.loads(answer)
        passes = answered["passes"]
        kinds = [("f_o", "f8"), ("certain", "?"), ("count", "i8"), ("part", "f8"), ("low", "f8"), ("high", "f8")]
        points = [tuple(point[name] for name, _ in kinds) for point in answered["probability"]]
        curve = np.array(points, dtype=kinds).view(np.recarray)
    return CriticalForce(**found, exceeding=exceeding, probability=curve, passes=passes, _step=step, _max=max)
