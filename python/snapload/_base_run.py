"""What there is to ask of any finished run."""

from __future__ import annotations

import json
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._check import number
from ._later import Later
from ._neighbours import Ensemble, Share
from ._table import Table
from ._told import End, Norms, Outcome, Trust

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

    from . import _animate
    from ._geometry import Geometry
else:
    matplotlib = Later("matplotlib")
    _animate = Later("snapload._animate")
    _geometry = Later("snapload._geometry")

#: What can be drawn of a run.
Picture = Literal["trajectory", "rotation", "velocities", "tensions"]


class BaseRun:
    """A finished run of a case or of a system of one's own.

    Whoever derives from it says how the run is made once more, which gives the same bits, and what stands where.
    """

    _made: _engine.Run | None
    _trusted: bool
    #: Whether it is told in the scales L, m, F and T, and not in units of one's own.
    _in_scales = True

    def _again(self) -> _engine.Run:
        """The run once more."""
        raise NotImplementedError

    def _geometry(self) -> Geometry:
        """Cables and outline of the body."""
        raise NotImplementedError

    @property
    def _engine(self) -> _engine.Run:
        """The run of the engine. One that came from another process has left it there: it is run once more."""
        if self._made is None:
            again = self._again()
            if json.loads(again.head()) != self._head:
                raise ValueError(f"another version of snapload made this run; {_engine.__version__} has other bits")
            self._made = again
        return self._made

    @cached_property
    def _head(self) -> dict[str, Any]:
        return cast(dict[str, Any], json.loads(self._engine.head()))

    @cached_property
    def end(self) -> End:
        """How it ended.

        See Also
        --------
        outcome : Whether that is certain.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().end.reason
        'rotation_limit'
        """
        return End(**self._head["end"], state=tuple(self._head["state"]))

    @cached_property
    def norms(self) -> Norms:
        """Norms of the snaps, and the largest height and rotation.

        See Also
        --------
        impacts : What they are made of.

        Examples
        --------
        >>> import snapload
        >>> round(snapload.Case(f_o=0.31).run().norms.rho1, 4)
        0.4921
        """
        return Norms(**self._head["norms"])

    @cached_property
    def outcome(self) -> Outcome:
        """Whether the end is certain, and how the neighbours end if not; there is none with ``trust=False``.

        See Also
        --------
        trust : How far the run is known.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().outcome.certain
        True
        """
        told = self._of_trust("outcome")
        about = told["ensemble"]
        if about is not None:
            ends = {
                end["reason"]: Share(*(end[key] for key in ("count", "part", "low", "high"))) for end in about["ends"]
            }
            about = Ensemble(about["members"], about["seed"], ends)
        return Outcome(told["certain"], about)

    @cached_property
    def trust(self) -> Trust:
        """How far the run can be trusted; there is nothing with ``trust=False``.

        See Also
        --------
        outcome : Whether the end is certain.

        Examples
        --------
        >>> import snapload
        >>> print(snapload.Case(f_o=0.31).run().trust.t, snapload.Case().run().trust.impact)
        None 191
        """
        told: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value for key, value in self._of_trust("trust").items()
        }
        return Trust(**told)

    def _of_trust(self, name: str) -> dict[str, Any]:
        if not self._trusted:
            raise AttributeError(f"this run has no {name}: it was made with trust=False; run it without that")
        return cast(dict[str, Any], self._head[name])

    @property
    def _horizon(self) -> float:
        """Past this nothing is known; infinite where trust goes to the end, or was not asked for."""
        horizon = self.trust.t if self._trusted else None
        return np.inf if horizon is None else horizon

    @cached_property
    def impacts(self) -> Table:
        """The impacts, a row an impact and cable.

        Columns ``t`` [T], ``cable`` (from 1), ``v_n`` [L/T], ``impulse`` [m L/T], ``energy_lost`` [F L],
        ``before_x`` to ``before_vtheta`` and ``after_x`` to ``after_vtheta``, and, with trust, ``digits``, the
        decimal digits that are expected to be right. A row with ``v_n = 0`` is an impulse passed into a taut cable.

        See Also
        --------
        modes : What goes on between them.

        Examples
        --------
        >>> import snapload
        >>> impacts = snapload.Case(f_o=0.31).run().impacts
        >>> len(impacts), impacts["cable"][:4].tolist()
        (12, [2, 1, 2, 2])
        """
        return Table(self._engine.impacts())

    @cached_property
    def modes(self) -> Table:
        """The mode intervals: ``mode`` (slack, sliding, rocking), ``taut`` cables, ``t_start``, ``t_end`` [T].

        See Also
        --------
        impacts : What ends some of them.

        Examples
        --------
        >>> import snapload
        >>> modes = snapload.cases["sliding-example"].replace(t_end=8).run(members=0).modes
        >>> modes["mode"].tolist(), modes["taut"][1]
        (['slack', 'sliding'], (2,))
        """
        return Table(self._engine.modes())

    @cached_property
    def exponents(self) -> Table:
        """The spectrum of finite-time Lyapunov exponents, the largest first.

        Columns ``direction``, from 1, and ``exponent`` [1/T], minus infinity in the two directions that a cable closes
        which has stayed taut. Six of them, four of a point mass; none without trust.

        See Also
        --------
        snapload.sensitivities : How the first impacts change with each key.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().exponents["direction"].tolist()
        [1, 2, 3, 4, 5, 6]
        """
        told = self.trust.exponents if self._trusted else ()
        values = np.array([-np.inf if exponent is None else exponent for exponent in told], dtype=np.float64)
        directions = np.arange(1, len(values) + 1)
        return Table._of(
            [
                ("direction", "", "number of the direction, the one that grows most first", directions),
                ("exponent", "1/T", "finite-time Lyapunov exponent", values),
            ]
        )

    def motion(self, dt: float) -> np.recarray[Any, Any]:
        """Play the motion at 0, dt, 2 dt, ... and at the end.

        Parameters
        ----------
        dt : float
            Step [T].

        Returns
        -------
        numpy.recarray, shape (n,)
            Fields ``t`` [T], ``x``, ``y`` [L], ``theta`` [rad], ``vx``, ``vy`` [L/T], ``vtheta`` [rad/T], the
            tensions ``T1``, ``T2`` and so on, one a cable [F], and ``energy`` [F L]; also as attributes.

        Raises
        ------
        ValueError
            If dt is not above 0, or gives more than ten million rows.

        See Also
        --------
        at : Plays it at any times.

        Examples
        --------
        >>> import snapload
        >>> motion = snapload.Case(f_o=0.31).run().motion(0.01)
        >>> motion.shape, float(motion.y[0])
        ((347,), 0.1)
        """
        return self._records(self._engine.motion(number("dt", dt)))

    def at(self, t: ArrayLike) -> np.recarray[Any, Any]:
        """Play the motion at any times, held to the span of the run; at the instant of an event, just after it.

        Parameters
        ----------
        t : array_like
            Times [T].

        Returns
        -------
        numpy.recarray, shape of `t`
            As :meth:`motion`.

        Raises
        ------
        ValueError
            If a time is not a number.

        See Also
        --------
        motion : Plays it at even steps.

        Examples
        --------
        >>> import snapload
        >>> run = snapload.Case(f_o=0.31).run()
        >>> float(run.at(0.0).y), run.at([0.1, 0.2]).shape
        (0.1, (2,))
        """
        times = np.asarray(t, dtype=np.float64)
        if np.isnan(times).any():
            raise ValueError("t = nan is not allowed; allowed: numbers; those outside the run are held to its span")
        flat = self._records(self._engine.motion_at(np.ascontiguousarray(times.ravel())))
        return flat.reshape(times.shape).view(np.recarray)

    def _records(self, data: bytearray) -> np.recarray[Any, Any]:
        tensions = [f"T{cable}" for cable in range(1, len(self._geometry().cables) + 1)]
        names = ("t", "x", "y", "theta", "vx", "vy", "vtheta", *tensions, "energy")
        records: NDArray[np.void] = np.frombuffer(data, dtype=[(name, np.float64) for name in names])
        return records.view(np.recarray)

    def plot(
        self, what: Picture = "trajectory", ax: matplotlib.axes.Axes | None = None, **style: Any
    ) -> matplotlib.axes.Axes:
        """Draw the run into axes of Matplotlib, and return them.

        Parameters
        ----------
        what : {"trajectory", "rotation", "velocities", "tensions"}
            The path of the centre; the rotation over time; the normal velocity of each snap, a cross for cable 1 and
            a circle for cable 2; the tensions over time.
        ax : matplotlib.axes.Axes, optional
            Where to draw; new ones, of the width of a column, if left out.
        **style
            Passed on to the lines, such as ``color`` or ``linewidth``.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, to compose further. What lies past the horizon of trust is grey.

        Raises
        ------
        ValueError
            If there is no such picture.

        See Also
        --------
        overview : All four pictures.
        animate : The run as a moving picture.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().plot("rotation").get_ylabel()
        '$\\\\theta$ [rad]'
        """
        from ._plot import draw

        return draw(self, what, ax, style)

    def overview(self, figure: matplotlib.figure.Figure | None = None) -> matplotlib.figure.Figure:
        """Draw all four pictures into one figure of the width of a page.

        Parameters
        ----------
        figure : matplotlib.figure.Figure, optional
            An empty one to draw into.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        See Also
        --------
        plot : One of them.

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
        """Make a moving picture of the run: body, cables, path.

        Parameters
        ----------
        start, stop : float, optional
            From and to [T]; all of the run if left out.
        seconds : float
            How long it plays.
        fps : int
            Pictures a second.

        Returns
        -------
        Animation
            Shows itself in a notebook, as HTML5 with buttons; ``save("run.gif")``, ``"run.mp4"`` or
            ``"run.html"`` writes a file.

        Raises
        ------
        ValueError
            If a value is out of its range.

        See Also
        --------
        plot : Pictures that stand still.

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
        return self._words[0]

    @property
    def _words(self) -> tuple[str, list[tuple[str, str]]]:
        """What there is to read, as one text, and the same as labels and texts."""
        raise NotImplementedError

    def _in_short(self, of: str) -> str:
        return f"<Run of {of}: {self.end.reason} at t = {self.end.t:.4f}, {len(self.impacts)} impacts>"

    def _repr_html_(self) -> str:
        rows = []
        for label, text in self._words[1]:
            lines = escape(text).replace("\n", "<br>")
            rows.append(
                f"<tr><th style='text-align:left;vertical-align:top'>{label}</th>"
                f"<td style='text-align:left'>{lines}</td></tr>"
            )
        return f"<table>{''.join(rows)}</table>"
