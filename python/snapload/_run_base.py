"""The common part of all finished runs."""

from __future__ import annotations

import json
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import doubles, number
from ._lazy_import import LazyModule
from ._motion import Motion
from ._neighbours import Ensemble, Share
from ._run_results import End, Norms, Outcome, Trust
from ._schema import units
from ._table import Table

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

    from . import _animate
    from ._geometry import Geometry
else:
    matplotlib = LazyModule("matplotlib")
    _animate = LazyModule("snapload._animate")
    _geometry = LazyModule("snapload._geometry")

#: What can be drawn of a run.
Picture = Literal["trajectory", "rotation", "velocities", "tensions"]


class BaseRun:
    """A finished run of a case or of a user-defined system.

    A derived class repeats the run if necessary, which gives the same bits, and describes the geometry.
    """

    _engine_object: _engine.Run | None
    _trusted: bool
    #: Whether quantities are in the scales L, m, F and T, and not in units of the user.
    _nondimensional = True

    def _rerun(self) -> _engine.Run:
        """Repeats the run."""
        raise NotImplementedError

    def _geometry(self) -> Geometry:
        """Cables and outline of the body."""
        raise NotImplementedError

    def _in_its_units(self, table: Table) -> Table:
        return table if self._nondimensional else table._in_own_units()

    def _impacts_in_words(self, cables: int) -> str:
        snaps = self.impacts["cable"][self.impacts["v_n"] > 0]
        counts = [f"{(snaps == k + 1).sum()} of cable {k + 1}" for k in range(cables)]
        passed = len(self.impacts) - len(snaps)
        beside = f"; {passed} impulse{'s' * (passed != 1)} passed into a taut cable" if passed else ""
        return f"{len(snaps)}: {', '.join(counts)}{beside}"

    @property
    def _engine(self) -> _engine.Run:
        """The run of the engine. It does not travel to other processes, where the run is repeated."""
        if self._engine_object is None:
            rerun = self._rerun()
            if json.loads(rerun.head()) != self._head:
                raise ValueError(f"another version of snapload made this run; {_engine.__version__} computes another")
            self._engine_object = rerun
        return self._engine_object

    @cached_property
    def _head(self) -> dict[str, Any]:
        return cast(dict[str, Any], json.loads(self._engine.head()))

    @cached_property
    def end(self) -> End:
        """How the run ended.

        See Also
        --------
        outcome : Whether the end is certain.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().end.reason
        'rotation_limit'
        """
        return End(**self._head["end"], state=tuple(self._head["state"]))

    @cached_property
    def norms(self) -> Norms:
        """Norms of the snaps, the largest height and the largest rotation.

        See Also
        --------
        impacts : The impacts, from which the norms are computed.

        Examples
        --------
        >>> import snapload
        >>> round(snapload.Case(f_o=0.31).run().norms.rho1, 4)
        0.4921
        """
        return Norms(**self._head["norms"])

    @cached_property
    def outcome(self) -> Outcome:
        """Whether the end is certain, and how neighbours end if it is not; not available with ``trust=False``.

        See Also
        --------
        trust : How far the run can be trusted.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().outcome.certain
        True
        """
        data = self._trust_entry("outcome")
        ensemble = data["ensemble"]
        if ensemble is not None:
            ends = {
                end["reason"]: Share(*(end[key] for key in ("count", "part", "low", "high")))
                for end in ensemble["ends"]
            }
            ensemble = Ensemble(ensemble["members"], ensemble["seed"], ends)
        return Outcome(data["certain"], ensemble)

    @cached_property
    def trust(self) -> Trust:
        """How far the run can be trusted; not available with ``trust=False``.

        See Also
        --------
        outcome : Whether the end is certain.

        Examples
        --------
        >>> import snapload
        >>> print(snapload.Case(f_o=0.31).run().trust.t, snapload.Case().run().trust.impact)
        None 191
        """
        values: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value for key, value in self._trust_entry("trust").items()
        }
        return Trust(**values)

    def _trust_entry(self, name: str) -> dict[str, Any]:
        if not self._trusted:
            raise AttributeError(f"this run has no {name}: it was made with trust=False; run the case without it")
        return cast(dict[str, Any], self._head[name])

    @property
    def _horizon(self) -> float:
        """The time of the horizon of trust; infinite if trust reaches the end or was not computed."""
        horizon = self.trust.t if self._trusted else None
        return np.inf if horizon is None else horizon

    @cached_property
    def impacts(self) -> Table:
        """The impacts, with one row for each impact and cable.

        Columns ``t`` [T], ``cable`` (from 1), ``v_n`` [L/T], ``impulse`` [m L/T], ``energy_lost`` [F L],
        ``before_x`` to ``before_vtheta`` and ``after_x`` to ``after_vtheta``. With trust there is also ``digits``, the
        number of decimal digits that are expected to be right. A row with ``v_n = 0`` is an impulse that is
        transmitted to a taut cable.

        See Also
        --------
        modes : The modes of motion between the impacts.

        Examples
        --------
        >>> import snapload
        >>> impacts = snapload.Case(f_o=0.31).run().impacts
        >>> len(impacts), impacts["cable"][:4].tolist()
        (12, [2, 1, 2, 2])
        """
        return self._in_its_units(Table(self._engine.impacts()))

    @cached_property
    def modes(self) -> Table:
        """The mode intervals: ``mode`` (slack, sliding, rocking), ``taut`` cables, ``t_start``, ``t_end`` [T].

        See Also
        --------
        impacts : The impacts, some of which end a mode interval.

        Examples
        --------
        >>> import snapload
        >>> modes = snapload.cases["sliding-example"].replace(t_end=8).run(members=0).modes
        >>> modes["mode"].tolist(), modes["taut"][1]
        (['slack', 'sliding'], (2,))
        """
        return self._in_its_units(Table(self._engine.modes()))

    @cached_property
    def exponents(self) -> Table:
        """Estimates of the Lyapunov exponents from this run alone, the largest first.

        They are the mean rates of growth of deviations that begin along the coordinates and are kept orthogonal on the
        way. In a short run each depends on the directions in which the deviations begin.

        Columns ``direction``, from 1, and ``exponent`` [1/T], minus infinity in the two directions that are removed by
        a cable that has stayed taut. There are six exponents, or four for a point mass; none without trust.

        See Also
        --------
        snapload.lyapunov_spectrum : Exponents of the long-term motion, with standard errors.
        snapload.sensitivities : Computes how the first impacts change with each key.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().exponents["direction"].tolist()
        [1, 2, 3, 4, 5, 6]
        """
        found = self.trust.exponents if self._trusted else ()
        values = np.array([-np.inf if exponent is None else exponent for exponent in found], dtype=np.float64)
        directions = np.arange(1, len(values) + 1)
        table = Table._from_columns(
            [
                ("direction", "", "number of the direction, the one that grows most first", directions),
                ("exponent", units()["exponent"], "estimate of the Lyapunov exponent", values),
            ]
        )
        return self._in_its_units(table)

    def motion(self, dt: float) -> np.recarray[Any, Any]:
        """Return the motion at the times 0, dt, 2 dt, ... and at the end.

        Parameters
        ----------
        dt : float
            Time step [T].

        Returns
        -------
        numpy.recarray, shape (n,)
            Fields ``t`` [T], ``x``, ``y`` [L], ``theta`` [rad], ``vx``, ``vy`` [L/T], ``vtheta`` [rad/T], the
            tensions ``T1``, ``T2`` and so on of the cables [F], and ``energy`` [F L]; also as attributes.

        Raises
        ------
        ValueError
            If `dt` is not above 0, or gives more than ten million rows.

        See Also
        --------
        at : Returns the motion at any times.

        Examples
        --------
        >>> import snapload
        >>> motion = snapload.Case(f_o=0.31).run().motion(0.01)
        >>> motion.shape, float(motion.y[0])
        ((347,), 0.1)
        """
        return self._records(self._engine.motion(number("dt", dt)))

    def at(self, t: ArrayLike) -> np.recarray[Any, Any]:
        """Return the motion at any times.

        Times outside the run are replaced by its start or its end. At the time of an event the state is that just
        after the event.

        Parameters
        ----------
        t : array_like
            Times [T].

        Returns
        -------
        numpy.recarray, shape of `t`
            The fields of :meth:`motion`.

        Raises
        ------
        ValueError
            If a time is not a number.

        See Also
        --------
        motion : Returns the motion at even time steps.

        Examples
        --------
        >>> import snapload
        >>> run = snapload.Case(f_o=0.31).run()
        >>> float(run.at(0.0).y), run.at([0.1, 0.2]).shape
        (0.1, (2,))
        """
        times = doubles("t", t)
        if np.isnan(times).any():
            raise ValueError("t = nan is not allowed; allowed: numbers; those outside the run are clipped to it")
        flat = self._records(self._engine.motion_at(np.ascontiguousarray(times.ravel())))
        return flat.reshape(times.shape).view(Motion)

    def _records(self, data: bytearray) -> Motion:
        tensions = [f"T{cable}" for cable in range(1, len(self._geometry().cables) + 1)]
        names = ("t", "x", "y", "theta", "vx", "vy", "vtheta", *tensions, "energy")
        records: NDArray[np.void] = np.frombuffer(data, dtype=[(name, np.float64) for name in names])
        return Motion.of(records, "scales" if self._nondimensional else "own")

    def plot(
        self, what: Picture = "trajectory", ax: matplotlib.axes.Axes | None = None, **style: Any
    ) -> matplotlib.axes.Axes:
        """Draw the run into Matplotlib axes, and return the axes.

        Parameters
        ----------
        what : {"trajectory", "rotation", "velocities", "tensions"}
            The picture to draw: the path of the centre; the rotation over time; the normal velocity of each snap,
            with a cross for cable 1 and a circle for cable 2; or the tensions over time.
        ax : matplotlib.axes.Axes, optional
            Axes to draw into; if left out, new ones of the width of a column.
        **style
            Properties of the lines, such as ``color`` or ``linewidth``.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, for further changes. The motion past the horizon of trust is grey.

        Raises
        ------
        ValueError
            If the picture is unknown.

        See Also
        --------
        overview : Draws all four pictures.
        animate : Creates an animation of the run.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().plot("rotation").get_ylabel()
        '$\\\\theta$ [rad]'
        """
        from ._plot import draw

        return draw(self, what, ax, style)

    def overview(self, figure: matplotlib.figure.Figure | None = None) -> matplotlib.figure.Figure:
        """Draw all four pictures into one figure of page width.

        Parameters
        ----------
        figure : matplotlib.figure.Figure, optional
            An empty figure to draw into.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        See Also
        --------
        plot : Draws one of the pictures.

        Examples
        --------
        >>> import snapload
        >>> len(snapload.Case(f_o=0.31).run().overview().axes)
        4
        """
        from ._plot import overview

        return overview(self, figure)

    def animate(
        self, *, start: float = 0.0, stop: float | None = None, seconds: float = 8.0, fps: int = 25
    ) -> _animate.Animation:
        """Create an animation of the run with body, cables and path.

        A cable is dashed while it is slack and thick while it is taut. A ring marks each snap for half a second.

        Parameters
        ----------
        start, stop : float, optional
            Start and end of the shown part [T]; the whole run if left out.
        seconds : float
            Duration of the animation [s].
        fps : int
            Frames per second; at most 50 in a GIF.

        Returns
        -------
        Animation
            The animation. A notebook shows it as HTML5 with buttons; ``save("run.gif")``, ``"run.mp4"`` or
            ``"run.html"`` writes a file.

        Raises
        ------
        ValueError
            If a value is out of its range.

        See Also
        --------
        plot : Draws static pictures.

        Examples
        --------
        >>> import snapload
        >>> from pathlib import Path
        >>> from tempfile import mkdtemp
        >>> moving = snapload.Case(f_o=0.31).run().animate(seconds=2)
        >>> moving.save(Path(mkdtemp()) / "run.html").name
        'run.html'
        """
        from ._animate import Animation

        return Animation(self, start=start, stop=stop, seconds=seconds, fps=fps)

    def __str__(self) -> str:
        return self._summary[0]

    @property
    def _summary(self) -> tuple[str, list[tuple[str, str]]]:
        """The summary as one text, and as pairs of label and text."""
        raise NotImplementedError

    def _short_repr(self, of: str) -> str:
        # A row with v_n = 0 is no impact.
        count = int((self.impacts["v_n"] > 0).sum())
        return f"<Run of {of}: {self.end.reason} at t = {self.end.t:.4f}, {count} impacts>"

    def _repr_html_(self) -> str:
        rows = []
        for label, text in self._summary[1]:
            lines = escape(text).replace("\n", "<br>")
            rows.append(
                f"<tr><th style='text-align:left;vertical-align:top'>{label}</th>"
                f"<td style='text-align:left'>{lines}</td></tr>"
            )
        return f"<table>{''.join(rows)}</table>"
