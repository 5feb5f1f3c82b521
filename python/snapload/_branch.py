"""Branches of periodic orbits along a key, with their bifurcations and other events."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._arguments import number as a_number
from ._arguments import place_of, whole_number
from ._axes import range_ends
from ._branch_events import events_table
from ._lazy_import import LazyModule
from ._orbit import Orbit
from ._orbit_base import STATE, NoOrbitError, complex_array
from ._progress import progress_bar
from ._schema import attributes, attributes_as, with_own_names
from ._table import Table

if TYPE_CHECKING:
    import matplotlib.axes
    import xarray
else:
    matplotlib, xarray = LazyModule("matplotlib"), LazyModule("xarray")

#: The options of a continuation: range of the key, first step, points in either direction.
Options: TypeAlias = tuple[str | tuple[float, float], float, int]

#: What can be drawn of a branch against its key.
Ordinate = Literal["x", "y", "theta", "vx", "vy", "vtheta", "largest_multiplier"]


class Branch:
    """A branch of periodic orbits of a case along one key.

    Returned by :func:`snapload.continuation` and :meth:`switch`.

    Attributes
    ----------
    case : Case
        The case of the orbit from which the branch was started.
    along : str
        The key that varies.
    ends : tuple of dict
        The two ends of the branch: ``at``, the value of the key, and ``because``, the reason why it ends there.

    See Also
    --------
    snapload.continuation : Computes a branch.
    snapload.orbit_diagram : Computes the attractor against a key by simulation.

    Examples
    --------
    >>> import snapload
    >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
    >>> branch = snapload.continuation(orbit, "f_o", (1.2, 2))
    >>> branch.events["kind"].tolist()
    ['corner', 'period_doubling', 'fold']
    >>> [round(value, 9) for value in branch.events["value"].tolist()]
    [1.76743408, 1.680507876, 1.304034133]
    >>> branch.ends[0]["because"][:6]
    'corner'
    """

    def __init__(
        self,
        orbit: Orbit,
        along: str,
        options: Options,
        engine: _engine.Branch | None,
        switches: tuple[tuple[int | None, Options], ...] = (),
        data: dict[str, Any] | None = None,
    ) -> None:
        if data is None:
            assert engine is not None
            data = json.loads(engine.json()) | {"words": engine.summary().rstrip("\n")}
        self.case = orbit.case
        self.along: str = data["along"]
        self.ends: tuple[dict[str, Any], ...] = tuple(data["ends"])
        self._start, self._options, self._switches = (orbit, along, options), options, switches
        self._engine_object, self._data = engine, data

    @property
    def _engine_branch(self) -> _engine.Branch:
        """The branch of the engine. It does not travel to other processes, where it is computed again."""
        if self._engine_object is None:
            orbit, along, options = self._start
            branch = _engine.continuation(orbit._engine, along, *options, None)
            for number, options in self._switches:
                branch = branch_or_error(*branch.doubled(number, *options, None))
            self._engine_object = branch
        return self._engine_object

    @cached_property
    def points(self) -> xarray.Dataset:
        """The points along the branch, over ``point``, with the key and the arclength as coordinates.

        ``x`` to ``vtheta`` are the state at the section, ``multipliers`` the complex Floquet multipliers, ``stability``
        the stability in words, ``stable`` whether nearby motions converge to the orbit, ``admissible`` whether the
        orbit is a possible motion of the body, and ``why_not`` the reasons if it is not.

        See Also
        --------
        orbit : Returns the orbit at a point.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> points = snapload.continuation(orbit, "f_o", (1.3, 1.5)).points
        >>> points.multipliers.dims, bool(points.stable.any()), bool(points.stable.all())
        (('point', 'multiplier'), True, False)
        """
        from ._dataset import title_and_case

        rows, key_attributes = self._data["points"], attributes()

        def column(name: str, dtype: Any) -> NDArray[Any]:
            values = [np.nan if row[name] is None else row[name] for row in rows]
            return np.array(values, dtype=dtype)

        states = np.array([row["section"] for row in rows], dtype=np.float64)
        variables: dict[str, Any] = {
            name: ("point", states[:, place], attributes_as(name, f"{name} at the section"))
            for place, name in enumerate(STATE)
            if name != self.along
        }
        multipliers = np.array([complex_array(row["multipliers"]) for row in rows])
        stability_names = [
            row["stable"] if isinstance(row["stable"], str) else _STABILITY_NAMES[row["stable"]] for row in rows
        ]
        stability = np.array(stability_names, dtype=object)
        texts: dict[str, tuple[list[str], str]] = {
            "stability": (stability_names, "stable, unstable, neutral or superstable"),
            "symbol": ([" ".join(row["symbol"]) for row in rows], "the events in their order"),
            "why_not": (["; ".join(row["why_not"]) for row in rows], "why the orbit is not admissible"),
        }
        variables |= {
            "multipliers": (("point", "multiplier"), multipliers, key_attributes["multipliers"]),
            "largest_multiplier": ("point", np.abs(multipliers).max(axis=1), key_attributes["largest_multiplier"]),
            "stable": ("point", np.isin(stability, ("stable", "superstable")), {"long_name": "neighbours converge"}),
            "admissible": ("point", column("admissible", bool), {"long_name": "whether the orbit is admissible"}),
            "return_error": ("point", column("return_error", np.float64), key_attributes["return_error"]),
        }
        variables |= {
            name: ("point", np.array(values, dtype=object), {"long_name": meaning})
            for name, (values, meaning) in texts.items()
        }
        coords = {
            self.along: ("point", column("value", np.float64), key_attributes[self.along]),
            "arclength": ("point", column("arclength", np.float64), key_attributes["arclength"]),
        }
        title = title_and_case("A branch of periodic orbits of a body on cables", self.case._engine)
        points = with_own_names(xarray.Dataset(variables, coords, title))
        # A branch does not change. Who changes values does so in a copy.
        for variable in points.variables.values():
            variable.values.flags.writeable = False
        return points

    @cached_property
    def events(self) -> Table:
        """Bifurcations and other events along the branch, in the order of its points.

        Columns ``kind`` (fold, period_doubling, neimark_sacker, branch_point, graze, corner, tension_lost, or a limit
        such as rotation_limit or upper_bound), ``value`` of the key, ``arclength``, the state ``x`` to ``vtheta``,
        ``cable`` (0 if no cable is involved), ``t`` within the period, ``normal_acceleration`` and
        ``sqrt_coefficient`` of a graze, ``largest_multiplier``, ``admissible`` (1 or 0), and ``located`` (0 where the
        event lies just before this point, and its value is not known more accurately). Missing values are NaN.

        See Also
        --------
        switch : Follows the branch that bifurcates at an event.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> events = snapload.continuation(orbit, "f_o", (1.3, 1.5)).events
        >>> events.to_pandas()[["kind", "value"]].round(6).values.tolist()
        [['fold', 1.304034]]
        """
        return events_table(self.along, self._data["events"])

    @property
    def origins(self) -> Table:
        """Period doublings at which this branch was reached from other branches, with the columns of `events`.

        See Also
        --------
        switch : Follows a branch that bifurcates from this one.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> len(snapload.continuation(orbit, "f_o", (1.3, 1.5)).origins)
        0
        """
        return events_table(self.along, self._data["from"])

    def __len__(self) -> int:
        return len(self._data["points"])

    def orbit(self, point: int) -> Orbit:
        """Return the orbit at a point.

        Parameters
        ----------
        point : int
            The index of the point, from 0; a negative index counts from the end.

        Returns
        -------
        Orbit
            The orbit, whose case has the value of the key at that place.

        Raises
        ------
        IndexError
            If the index is out of range.

        See Also
        --------
        event : Returns the orbit at an event.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> last = snapload.continuation(orbit, "f_o", (1.3, 1.5)).orbit(-1)
        >>> last.case.f_o
        1.5
        """
        return self._orbit(self._engine_branch.point(place_of("point", point, len(self))))

    def event(self, event: int) -> Orbit:
        """Return the orbit at an event.

        Parameters
        ----------
        event : int
            The row of `events`, from 0; a negative index counts from the end.

        Returns
        -------
        Orbit
            The orbit, whose case has the value of the key at that place.

        Raises
        ------
        IndexError
            If the index is out of range.

        See Also
        --------
        orbit : Returns the orbit at a point.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> fold = snapload.continuation(orbit, "f_o", (1.3, 1.5)).event(0)
        >>> bool(abs(fold.multipliers[0] - 1) < 1e-5)
        True
        """
        return self._orbit(self._engine_branch.event(place_of("event", event, len(self.events))))

    def _orbit(self, engine: _engine.Orbit) -> Orbit:
        case = engine.case()
        assert case is not None
        return Orbit(type(self.case)._from_engine(case), engine)

    def switch(
        self,
        kind: Literal["period_doubling"] = "period_doubling",
        number: int | None = None,
        *,
        between: str | Sequence[float] | None = None,
        step: float | None = None,
        points: int | None = None,
        progress: bool = True,
    ) -> Branch:
        """Follow the branch that bifurcates at an event: orbits of twice the period at a period doubling.

        Parameters
        ----------
        kind : {"period_doubling"}
            The kind of the event.
        number : int, optional
            The number of the event among those of its kind in `events`, counted from 1; the nearest one along the
            branch if left out.
        between : (float, float) or str, optional
            The smallest and the largest value of the key; those of this branch if left out.
        step : float, optional
            Length of the first step; that of this branch if left out.
        points : int, optional
            Maximum number of points in each direction; that of this branch if left out.
        progress : bool
            Whether to show a progress bar if the computation takes long.

        Returns
        -------
        Branch
            The new branch. Only one of its two halves is followed; the other has the same orbits, one period of the
            original orbit later.

        Raises
        ------
        NoOrbitError
            If there is no such event, or no direction of the new branch is found there.
        ValueError
            If no branch bifurcates at that kind of event, or an option is out of its range.

        See Also
        --------
        events : The events of this branch.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> branch = snapload.continuation(orbit, "f_o", (1.3, 1.75), step=0.002)
        >>> born = branch.switch("period_doubling")
        >>> born.orbit(0).periods, round(float(born.points.f_o[0]), 6)
        (2, 1.680508)
        """
        if kind != "period_doubling":
            allowed = "'period_doubling', the one kind at which a branch of other orbits is followed"
            raise ValueError(f"kind = {kind!r} is not allowed; allowed: {allowed}")
        if number is not None:
            number = whole_number("number", number)
        previous = self._options
        options = branch_options(
            self.along,
            previous[0] if between is None else between,
            previous[1] if step is None else step,
            previous[2] if points is None else points,
        )
        with progress_bar("points of the branch", 2 * options[2], progress) as report_progress:
            engine = branch_or_error(*self._engine_branch.doubled(number, *options, report_progress))
        orbit, along, _ = self._start
        switched = Branch(orbit, along, self._start[2], engine, (*self._switches, (number, options)))
        switched._options = options
        return switched

    def plot(self, y: Ordinate = "y", ax: matplotlib.axes.Axes | None = None, **style: Any) -> matplotlib.axes.Axes:
        """Draw the branch into Matplotlib axes, and return the axes.

        Parameters
        ----------
        y : {"x", "y", "theta", "vx", "vy", "vtheta", "largest_multiplier"}
            The quantity to draw against the key: a value of the state at the section, or the modulus of the largest
            multiplier.
        ax : matplotlib.axes.Axes, optional
            Axes to draw into; if left out, new ones of the width of a column.
        **style
            Properties of the lines, such as ``linewidth``.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, for further changes. The line is thick for stable orbits, dashed for unstable ones, dash-dotted
            for neutral ones, and dotted and grey for orbits that are not admissible. Events are marked by their kind.

        Raises
        ------
        ValueError
            If the quantity is unknown.

        See Also
        --------
        points : The data of the picture.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> snapload.continuation(orbit, "f_o", (1.3, 1.5)).plot("x").get_ylabel()
        '$x$ [L]'
        """
        from ._branch_plot import draw_branch

        return draw_branch(self, y, ax, style)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Branch):
            return NotImplemented
        return self.case == other.case and self._data == other._data

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (*self._start, self._switches, self._options, self._data)

    def __str__(self) -> str:
        text: str = self._data["words"]
        return text

    def __repr__(self) -> str:
        values = [row["value"] for row in self._data["points"]]
        count = len(self._data["events"])
        events = "1 event" if count == 1 else f"{count} events"
        return f"<Branch along {self.along} from {min(values):g} to {max(values):g}: {len(self)} points, {events}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


_STABILITY_NAMES = {True: "stable", False: "unstable"}


def branch_options(key: str, between: Any, step: float, points: int) -> Options:
    return range_ends(key, between), a_number("step", step), whole_number("points", points)


def branch_or_error(branch: _engine.Branch | None, why: str) -> _engine.Branch:
    if branch is None:
        raise NoOrbitError(f"no branch was found: {why}")
    return branch


def _restore(
    orbit: Orbit,
    along: str,
    options: Options,
    switches: tuple[tuple[int | None, Options], ...],
    last: Options,
    data: dict[str, Any],
) -> Branch:
    branch = Branch(orbit, along, options, None, switches, data)
    branch._options = last
    return branch
