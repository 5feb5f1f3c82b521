"""The critical force, and all other force amplitudes that exceed the limits."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import Uncertainty, engine_case, number, uncertainty_for_engine, whole_number
from ._axes import axis_values
from ._case import Case
from ._lazy_import import LazyModule
from ._progress import progress_bar
from ._result import Result
from ._schema import attributes, with_own_names

if TYPE_CHECKING:
    import matplotlib.axes
    import xarray
else:
    matplotlib, xarray = LazyModule("matplotlib"), LazyModule("xarray")


#: Those of the neighbours, if they are left out.
_TOLERANCE, _SEED = 1e-3, 1


@dataclass(frozen=True, repr=False, eq=False)
class CriticalForce(Result):
    """The force amplitudes at which a case exceeds the limits of its mooring.

    Attributes
    ----------
    f_cr : float or None
        The smallest amplitude that exceeds a limit [F]; None if none does.
    reason : str or None
        The limit at which its run ends, such as ``rotation_limit`` or ``upper_bound``.
    t : float or None
        The time of that end [T].
    certain : bool
        Whether the run of ``f_cr`` ends before its horizon of trust, and no smaller amplitude is ``uncertain`` or
        ``cut_short``; if none exceeds a limit, whether none is.
    exceeding : numpy.ndarray, shape (n, 2)
        All amplitudes that exceed a limit, as intervals ``[from, to]`` of adjacent amplitudes [F]. There may be several
        intervals, because a run with an amplitude above the critical one may settle.
    uncertain : numpy.ndarray, shape (n, 2)
        All amplitudes at which neighbours disagree, as such intervals [F]: the run passes its horizon of trust, and of
        20 neighbours within rounding, or of the `members`, some exceed a limit and others do not or are
        cut short.
    cut_short : numpy.ndarray, shape (n, 2)
        All amplitudes whose run stopped at the impact limit or a standstill, as such intervals [F]: whether they exceed
        a limit is not known.
    probability : numpy.recarray or None
        With an ensemble, at each amplitude: ``f_o``; whether the end is ``certain``, so that no members are run;
        ``count``, the number of members that exceed a limit, NaN where none are run; ``part``, their fraction, which is
        0 or 1 there; and the 95 % interval of it from ``low`` to ``high``, which are equal to it there. ``cut_short``
        says whether the run or members stopped at the impact limit or a standstill: the interval holds whether or not
        those members exceed, and is from 0 to 1 where the run itself did.
    passes : dict of str to float or None
        With an ensemble, the smallest amplitudes at which at least 5, 50 and 95 % of the neighbours exceed a limit:
        ``p05``, ``p50``, ``p95``. At a larger amplitude the percentage may be lower again.

    See Also
    --------
    snapload.critical_force : Computes the critical force.

    Examples
    --------
    >>> import snapload
    >>> found = snapload.critical_force(snapload.Case(), largest=0.4)
    >>> found.f_cr, found.reason, found.exceeding.tolist()
    (0.31, 'rotation_limit', [[0.31, 0.39]])
    """

    f_cr: float | None
    reason: str | None
    t: float | None
    certain: bool
    exceeding: NDArray[np.float64]
    uncertain: NDArray[np.float64]
    cut_short: NDArray[np.float64]
    probability: np.recarray[Any, Any] | None
    passes: dict[str, float | None]
    _step: float
    _largest: float
    _repr_fields = ("f_cr", "certain", "reason", "t", "exceeding", "uncertain", "cut_short")

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draw which amplitudes exceed a limit, or with which probability.

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
        >>> snapload.critical_force(snapload.Case(), step=0.1).plot().get_xlabel()
        '$f_o$ [F]'
        """
        from matplotlib import pyplot

        from ._orbit_plot import legend_above
        from ._plot import BLUE, ORANGE, VERMILION

        if ax is None:
            _, ax = pyplot.subplots(figsize=(3.5, 2.6), layout="constrained")
        half = self._step / 2
        for place, (start, stop) in enumerate(self.exceeding):
            label = "exceeds" if place == 0 else None
            ax.axvspan(start - half, stop + half, color=ORANGE, alpha=0.35, linewidth=0, label=label)
        for place, (start, stop) in enumerate((*self.uncertain, *self.cut_short)):
            label = "not certain" if place == 0 else None
            ax.axvspan(
                start - half, stop + half, facecolor="none", edgecolor="0.4", hatch="////", linewidth=0, label=label
            )
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
        ax.set_xlim(0, self._largest)
        ax.set_xlabel("$f_o$ [F]")
        legend_above(ax, 2)
        return ax

    def _repr_html_(self) -> str:
        def interval(start: float, stop: float) -> str:
            return f"{start:g}" if start == stop else f"{start:g} to {stop:g}"

        sure = "" if self.certain else " (not certain)"
        rows = [("f_cr", ("none" if self.f_cr is None else f"{self.f_cr:g}") + sure)]
        if self.reason is not None:
            rows.append(("reason", f"{self.reason.replace('_', ' ')} at t = {self.t:.4f}"))
        rows.append(("exceeding", ", ".join(interval(*pair) for pair in self.exceeding)))
        rows.append(("uncertain", ", ".join(interval(*pair) for pair in self.uncertain)))
        if len(self.cut_short):
            rows.append(("cut short", ", ".join(interval(*pair) for pair in self.cut_short)))
        rows += [
            (f"{name[1:].lstrip('0')} % exceed first at", "none" if f_o is None else f"{f_o:g}")
            for name, f_o in self.passes.items()
        ]
        cells = (f"<tr><th style='text-align:left'>{a}</th><td style='text-align:left'>{b}</td></tr>" for a, b in rows)
        return f"<table>{''.join(cells)}</table>"


@overload
def critical_force(
    case: Case,
    *,
    over: None = None,
    step: float = 0.01,
    largest: float = 1.0,
    members: int = 0,
    uncertainty: Uncertainty = None,
    tolerance: float = _TOLERANCE,
    seed: int = _SEED,
    progress: bool = True,
) -> CriticalForce: ...
@overload
def critical_force(
    case: Case,
    *,
    over: Mapping[str, ArrayLike],
    step: float = 0.01,
    largest: float = 1.0,
    progress: bool = True,
) -> xarray.Dataset: ...
def critical_force(
    case: Case,
    *,
    over: Mapping[str, ArrayLike] | None = None,
    step: float = 0.01,
    largest: float = 1.0,
    members: int = 0,
    uncertainty: Uncertainty = None,
    tolerance: float = _TOLERANCE,
    seed: int = _SEED,
    progress: bool = True,
) -> CriticalForce | xarray.Dataset:
    """Run a case at evenly spaced force amplitudes, and find those that exceed the limits.

    Parameters
    ----------
    case : Case
        The case; its own ``f_o`` has no effect. With ``stop_when_sliding=True`` a run ends when the body begins to
        slide, as in the studies of the thesis.
    over : dict of str to array_like or str, optional
        Values of other keys, as for :func:`snapload.sweep`. The result is computed for all their combinations.
    step, largest : float
        The amplitudes are step, 2 step, ... up to the largest [F].
    members : int
        The number of neighbours to run at each amplitude where one run can not decide, to compute the probability of
        exceeding a limit; 0 for none.
    uncertainty : float or dict of str to float, optional
        Uncertainty of the neighbours: one size for every start value, or a size for each key. If left out, only
        rounding is uncertain; neighbours are then drawn from 1e-12 about every start value.
    tolerance : float
        Error of state and time of the neighbours, relative to values above 1, above which a result counts as not known.
    seed : int
        Seed of the neighbours.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    CriticalForce or xarray.Dataset
        The smallest amplitude that exceeds a limit, and all others that do. With `over`, a dataset over those keys
        with ``f_cr`` (NaN if no amplitude exceeds a limit), whether it is ``certain``, ``reason``, ``t``, and over
        these keys and ``f_o`` which amplitudes exceed a limit (``exceeds``), of which this is ``uncertain``, and whose
        runs are ``cut_short``.

    Raises
    ------
    ValueError
        If an option is out of its range.

    See Also
    --------
    snapload.ensemble : Runs neighbours at one amplitude.

    Notes
    -----
    The critical force is defined in section 6.4.2 of the thesis. Runs with larger amplitudes may settle again, so the
    critical force alone does not say at which amplitudes the limits are kept.

    Examples
    --------
    >>> import snapload
    >>> snapload.critical_force(snapload.Case()).f_cr
    0.31
    >>> snapload.critical_force(snapload.Case(), over={"e": [0.8, 0.9]}, largest=0.5).f_cr.values.tolist()
    [0.4, 0.31]
    """
    engine, step, largest = engine_case(case), number("step", step), number("largest", largest)
    changed = {"uncertainty": uncertainty is not None, "tolerance": tolerance != _TOLERANCE, "seed": seed != _SEED}
    of_neighbours = [option for option, is_given in changed.items() if is_given]
    if over is not None:
        if not isinstance(over, Mapping):
            allowed = "a dict of keys with their values, such as {'e': [0.5, 0.9]}"
            raise ValueError(f"over = {over!r} is not allowed; allowed: {allowed}")
        if members or of_neighbours:
            given = " and ".join(["members"] * bool(members) + of_neighbours)
            raise ValueError(f"over runs no neighbours; leave out {given}, or over")
        return _critical_over_keys(engine, over, step, largest, progress)
    members, seed = whole_number("members", members), whole_number("seed", seed)
    if of_neighbours and members == 0:
        raise ValueError(f"{of_neighbours[0]} needs neighbours, but none are run; give members, such as members=200")
    probability, passes = None, {}
    if members == 0:
        data = json.loads(_engine.critical_force(engine, step, largest))
    else:
        with progress_bar("force amplitudes", round(largest / step), progress, 0) as report_progress:
            size, tolerance = uncertainty_for_engine(uncertainty), number("tolerance", tolerance)
            options = (size, tolerance, members, seed, report_progress)
            data = json.loads(_engine.critical_force_of_ensemble(engine, step, largest, *options))
        passes = data["passes"]
        kinds = [("f_o", "f8"), ("certain", "?"), ("cut_short", "?"), ("count", "f8")]
        kinds += [("part", "f8"), ("low", "f8"), ("high", "f8")]
        points = [tuple(point[name] for name, _ in kinds) for point in data["probability"]]
        probability = np.array(points, dtype=kinds).view(np.recarray)
    f_cr, reason, t, certain = (data[name] for name in ("f_cr", "reason", "t", "certain"))
    exceeding, uncertain, cut_short = (
        np.array(data[name], dtype=np.float64).reshape(-1, 2) for name in ("exceeding", "uncertain", "cut_short")
    )
    return CriticalForce(f_cr, reason, t, certain, exceeding, uncertain, cut_short, probability, passes, step, largest)


def _critical_over_keys(
    engine: _engine.Case, over: Mapping[str, ArrayLike], step: float, largest: float, progress: bool
) -> xarray.Dataset:
    """The result for every combination of some keys."""
    from ._dataset import grid_coordinates, title_and_case

    if "f_o" in over:
        raise ValueError("over = f_o is not allowed, as it is the key that is searched; allowed: other keys")
    axes = [(key, axis_values(key, values)) for key, values in over.items()]
    study = _engine.Study.grid(engine, axes, False)
    with progress_bar("critical force", len(study), progress) as report_progress:
        answer, amplitudes = _engine.critical_force_over(study, step, largest, report_progress)
    rows, forces = json.loads(answer), np.array(amplitudes)
    coords = grid_coordinates(axes)
    dims, shape = tuple(coords), tuple(len(values) for _, values, _ in coords.values())

    def within(name: str) -> NDArray[np.bool_]:
        within = np.zeros((len(rows), len(forces)), dtype=bool)
        for row, in_interval in zip(rows, within, strict=True):
            for first, last in row.get(name, ()):
                in_interval |= (first <= forces) & (forces <= last)
        return within.reshape(*shape, len(forces))

    def column(name: str, missing: Any) -> NDArray[Any]:
        values = [missing if row.get(name) is None else row[name] for row in rows]
        return np.array(values, dtype=object if missing == "" else np.float64).reshape(shape)

    about = attributes()
    smallest = {**about["f_o"], "long_name": "critical force, in F", "comment": "the smallest amplitude that exceeds"}
    variables: dict[str, Any] = {
        "f_cr": (dims, column("f_cr", np.nan), smallest),
        "certain": (
            dims,
            np.array([row.get("certain", False) for row in rows]).reshape(shape),
            {"long_name": "whether f_cr is certain"},
        ),
        "reason": (dims, column("reason", ""), {"long_name": "which limit is reached there"}),
        "t": (dims, column("t", np.nan), {**about["t"], "long_name": "when it is reached, in T"}),
        "exceeds": ((*dims, "f_o"), within("exceeding"), {"long_name": "whether the amplitude exceeds"}),
        "uncertain": (
            (*dims, "f_o"),
            within("uncertain"),
            {"long_name": "whether rounding decides"},
        ),
        "cut_short": (
            (*dims, "f_o"),
            within("cut_short"),
            {"long_name": "whether the run stopped too early to tell"},
        ),
    }
    if any("error" in row for row in rows):
        variables["error"] = (dims, column("error", ""), about["error"])
    title = title_and_case("Critical force of a body on cables that go slack and snap taut", engine)
    return with_own_names(xarray.Dataset(variables, {**coords, "f_o": ("f_o", forces, about["f_o"])}, title))
