"""Comparison of a run with the same run in many digits."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._case import Case
from ._lazy_import import LazyModule
from ._question import ask
from ._result import Result

if TYPE_CHECKING:
    import matplotlib.axes
else:
    matplotlib = LazyModule("matplotlib")


@dataclass(frozen=True, repr=False, eq=False)
class Verification(Result):
    """An ordinary run, compared with the same run in many digits.

    Attributes
    ----------
    digits : int
        Decimal digits of the run with many digits.
    digits_left : float
        Number of digits that are still right at the end of that run; 0 if they are lost before.
    first_wrong : int or None
        The first impact, from 1, at which the ordinary run is wrong; None if it is right at all that are known.
    predicted : int or None
        The impact at which trust ends according to the ordinary run.
    compared : int
        Number of impacts up to the first that is of another cable in the ordinary run, or missing there, as far as
        they are known with many digits.
    end : str or None
        How the run with many digits ends; None if a cable stayed taut before, where the comparison ends, and
        if its digits are lost before.
    t : float or None
        The time at which that run, or the comparison, ends [T]; None if its digits are lost before.
    impacts : int or None
        Number of impacts of that run up to there; None if its digits are lost before.
    differences : numpy.ndarray, shape (compared,)
        The largest difference of time and states at each of these impacts, relative where a value is above 1.
    exact : tuple of dict
        The impacts of the run with many digits, up to the last one that is known: ``t``, ``v_n`` and
        ``impulse`` as decimals in a str, which `decimal.Decimal` reads, with as many digits as are right; and
        ``cable``.
    tolerance : float
        The difference that counts as wrong.

    See Also
    --------
    snapload.verify : Runs both and compares them.

    Examples
    --------
    >>> import snapload
    >>> proof = snapload.verify(snapload.Case(f_o=0.31))
    >>> proof.end, proof.exact[0]["t"][:12], bool(proof.differences.max() < 1e-12)
    ('rotation_limit', '0.4055014592', True)
    """

    digits: int
    digits_left: float
    first_wrong: int | None
    predicted: int | None
    compared: int
    end: str | None
    t: float | None
    impacts: int | None
    differences: NDArray[np.float64]
    exact: tuple[dict[str, Any], ...]
    tolerance: float
    _summary: str

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draw the difference at each impact.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw into; new ones if left out.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, for further changes.

        See Also
        --------
        snapload.Run.plot : Draws a run.

        Examples
        --------
        >>> import snapload
        >>> snapload.verify(snapload.Case(f_o=0.31)).plot().get_ylabel()
        'difference'
        """
        from matplotlib import pyplot

        from ._orbit_plot import legend_above
        from ._plot import BLUE, REFERENCE, VERMILION

        if ax is None:
            _, ax = pyplot.subplots(figsize=(3.5, 2.6), layout="constrained")
        impacts = np.arange(1, self.compared + 1)
        shown = np.maximum(self.differences, 1e-18)
        ax.semilogy(impacts, shown, color=BLUE, linewidth=1.0)
        ax.axhline(self.tolerance, **REFERENCE)
        for impact, name, style in ((self.predicted, "predicted", "--"), (self.first_wrong, "computed", "-")):
            if impact is not None:
                ax.axvline(impact, color=VERMILION, linewidth=1.0, linestyle=style, label=f"first wrong, {name}")
        ax.set_xlabel("impact")
        ax.set_ylabel("difference")
        legend_above(ax, 2)
        return ax

    def __str__(self) -> str:
        return self._summary.rstrip("\n")

    def __repr__(self) -> str:
        return f"<Verification with {self.digits} digits: first_wrong {self.first_wrong}, predicted {self.predicted}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def verify(case: Case, digits: int = 60, *, tolerance: float = 1e-3) -> Verification:
    """Repeat the run of a case with many digits, and find the impact from which the ordinary run is wrong.

    The comparison covers slack flight, impacts and the stop rules; it ends where a cable stays taut. A number
    counts as the shortest decimal of its double: 0.1 is a tenth.

    Parameters
    ----------
    case : Case
        The case to run.
    digits : int
        Decimal digits to compute with, at least.
    tolerance : float
        Error of state and time, relative to values above 1, above which the ordinary run counts as wrong.

    Returns
    -------
    Verification
        Both runs, compared impact by impact.

    Raises
    ------
    ValueError
        If an option is out of its range.

    See Also
    --------
    snapload.Case.run : Computes where trust in a run ends.

    Examples
    --------
    >>> import snapload
    >>> proof = snapload.verify(snapload.Case(f_o=0.31))
    >>> proof.first_wrong is None, proof.compared
    (True, 12)
    """
    data, summary = ask("verify", case, digits=digits, tolerance=tolerance)
    return Verification(
        **{key: data[key] for key in ("digits", "digits_left", "first_wrong", "predicted", "compared")},
        **{key: data[key] for key in ("end", "t", "impacts")},
        differences=np.array(data["differences"], dtype=np.float64),
        exact=tuple(data["exact"]),
        tolerance=tolerance,
        _summary=summary,
    )
