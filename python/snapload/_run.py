"""A finished run."""

from __future__ import annotations

import json
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._certify import Certificate, certify
from ._later import Later
from ._neighbours import Ensemble, Share
from ._table import Table
from ._told import End, Norms, Outcome, Trust

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

    from . import _animate
    from ._case import Case
else:
    matplotlib = Later("matplotlib")
    _animate = Later("snapload._animate")

#: What a run was asked for: uncertainty, tolerance, members, seed.
Options: TypeAlias = tuple[dict[str, float] | float | None, float, int | None, int]

#: What a motion holds, in its order.
MOTION = ("t", "x", "y", "theta", "vx", "vy", "vtheta", "T1", "T2", "energy")

#: What can be drawn of a run.
Picture = Literal["trajectory", "rotation", "velocities", "tensions"]


class Run:
    """A finished run: how it ended, its impacts and modes, its norms, and how far it can be trusted.

    Made by :meth:`snapload.Case.run`.

    See Also
    --------
    snapload.Case.run, snapload.sweep

    Examples
    --------
    >>> import snapload
    >>> run = snapload.Case(f_o=0.31).run()
    >>> run.end.reason, round(run.end.t, 4)
    ('rotation_limit', 3.4522)
    >>> run.outcome.certain
    True
    """

    def __init__(self, case: Case, options: Options | None, engine: _engine.Run | None) -> None:
        #: The case that was run.
        self.case = case
        self._options = options
        self._made = engine

    @property
    def _engine(self) -> _engine.Run:
        """The run of the engine. One that came from another process has left it there: it is run once more, which
        gives the same bits."""
        if self._made is None:
            case, options = self.case._engine, self._options
            again = _engine.run_alone(case) if options is None else _engine.run(case, *options)
            if json.loads(again.head()) != self._head:
                raise ValueError(f"another version of snapload made this run; {_engine.__version__} has other bits")
            self._made = again
        return self._made

    @cached_property
    def _head(self) -> dict[str, Any]:
        return cast(dict[str, Any], json.loads(self._engine.head()))

    @cached_property
    def end(self) -> End:
        """How it ended."""
        return End(**self._head["end"], state=tuple(self._head["state"]))

    @cached_property
    def norms(self) -> Norms:
        """The norms."""
        return Norms(**self._head["norms"])

    @cached_property
    def outcome(self) -> Outcome:
        """Whether the end is certain, and how the neighbours end if not; there is none with ``trust=False``."""
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
        """How far the run can be trusted; there is nothing with ``trust=False``."""
        told: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value for key, value in self._of_trust("trust").items()
        }
        return Trust(**told)

    def _of_trust(self, name: str) -> dict[str, Any]:
        if self._options is None:
            raise AttributeError(f"this run has no {name}: it was made with trust=False; run the case without that")
        return cast(dict[str, Any], self._head[name])

    @property
    def _horizon(self) -> float:
        """Past this nothing is known; infinite where trust goes to the end, or was not asked for."""
        horizon = None if self._options is None else self.trust.t
        return np.inf if horizon is None else horizon

    @cached_property
    def impacts(self) -> Table:
        """The impacts, a row an impact and cable.

        Columns ``t`` [T], ``cable`` (1 or 2), ``v_n`` [L/T], ``impulse`` [m L/T], ``energy_lost`` [F L],
        ``before_x`` to ``before_vtheta`` and ``after_x`` to ``after_vtheta``, and, with trust, ``digits``, the
        decimal digits that are expected to be right. A row with ``v_n = 0`` is an impulse passed into a taut cable.
        """
        return Table(self._engine.impacts())

    @cached_property
    def modes(self) -> Table:
        """The mode intervals: ``mode`` (slack, sliding, rocking), ``taut`` cables, ``t_start``, ``t_end`` [T]."""
        return Table(self._engine.modes())

    @cached_property
    def exponents(self) -> Table:
        """The spectrum of finite-time Lyapunov exponents, the largest first.

        Columns ``direction``, from 1, and ``exponent`` [1/T], minus infinity where sticking closes a direction. Empty
        without trust.

        See Also
        --------
        snapload.sensitivities

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().exponents["direction"].tolist()
        [1, 2, 3, 4, 5, 6]
        """
        told = () if self._options is None else self.trust.exponents
        values = np.array([-np.inf if exponent is None else exponent for exponent in told], dtype=np.float64)
        directions = np.arange(1, len(values) + 1)
        return Table._of(
            [
                ("direction", "", "number of the direction, the one that grows most first", directions),
                ("exponent", "1/T", "finite-time Lyapunov exponent", values),
            ]
        )

    def motion(self, dt: float) -> np.recarray[Any, Any]:
        """The motion at 0, dt, 2 dt, ... and at the end.

        Parameters
        ----------
        dt : float
            Step [T].

        Returns
        -------
        numpy.recarray, shape (n,)
            Fields ``t`` [T], ``x``, ``y`` [L], ``theta`` [rad], ``vx``, ``vy`` [L/T], ``vtheta`` [rad/T], the
            tensions ``T1``, ``T2`` [F] and ``energy`` [F L]; also as attributes.

        Raises
        ------
        ValueError
            If dt is not above 0, or gives more than ten million rows.

        See Also
        --------
        at : at any times.

        Examples
        --------
        >>> import snapload
        >>> motion = snapload.Case(f_o=0.31).run().motion(0.01)
        >>> motion.shape, float(motion.y[0])
        ((347,), 0.1)
        """
        return _records(self._engine.motion(float(dt)))

    def at(self, t: ArrayLike) -> np.recarray[Any, Any]:
        """The motion at any times, held to the span of the run; at the instant of an event, just after it.

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
        motion : at even steps.

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
        flat = _records(self._engine.motion_at(np.ascontiguousarray(times.ravel())))
        return flat.reshape(times.shape).view(np.recarray)

    def to_json(self, dt: float | None = None) -> str:
        """The run as the line of JSON that ``snapload run --json -`` writes.

        Parameters
        ----------
        dt : float, optional
            Step of the motion [T], which is left out without it.

        Returns
        -------
        str
            One line.

        Raises
        ------
        ValueError
            If dt is not allowed, or the run was made without trust.

        Examples
        --------
        >>> import json, snapload
        >>> json.loads(snapload.Case(f_o=0.31).run().to_json())["end"]["reason"]
        'rotation_limit'
        """
        return self._engine.to_json(dt)

    def plot(
        self, what: Picture = "trajectory", ax: matplotlib.axes.Axes | None = None, **style: Any
    ) -> matplotlib.axes.Axes:
        """Draws the run into axes of Matplotlib, and returns them.

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
        overview, animate

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().plot("rotation").get_ylabel()
        '$\\\\theta$ [rad]'
        """
        from ._plot import draw

        return draw(self, what, ax, style)

    def overview(self, figure: matplotlib.figure.Figure | None = None) -> matplotlib.figure.Figure:
        """All four pictures in one figure of the width of a page.

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
        plot

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
        """The run as a moving picture: body, cables, path.

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
        """
        from ._animate import Animation

        return Animation(self, start=start, stop=stop, seconds=seconds, fps=fps)

    def certify(self) -> Certificate:
        """Proves the run in exact arithmetic: which impacts the motion has, when, and how it ends.

        The case counts as the decimals that its keys are written in, the shortest of each double. Where cables stay
        taut the proof goes on with them; that can take minutes.

        Returns
        -------
        Certificate
            What is proved, and how many digits of this run it confirms.

        Raises
        ------
        ValueError
            If the decimals of the case make no legal case or start.

        See Also
        --------
        snapload.verify : the same run with many digits, without a proof.

        Notes
        -----
        Python's lock is released meanwhile, and Ctrl-C ends it.

        Examples
        --------
        >>> import snapload
        >>> proof = snapload.Case(f_o=0.31).run().certify()
        >>> proof.proved, len(proof.impacts), proof.end
        (True, 12, 'rotation_limit')
        """
        return certify(self)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Run):
            return NotImplemented
        return self.case == other.case and self._head == other._head and self.impacts == other.impacts

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        told = {name: getattr(self, name) for name in ("_head", "_words", "impacts", "modes")}
        return _restore, (self.case, self._options, told)

    @cached_property
    def _words(self) -> tuple[str, list[tuple[str, str]]]:
        """What the command prints, and the same as labels and texts."""
        if self._options is None:
            lines = [("End", f"{self.end.reason.replace('_', ' ')} at t = {self.end.t:.4f}")]
            return repr(self), lines
        return self._engine.summary().rstrip("\n"), self._engine.summary_lines()

    def __str__(self) -> str:
        return self._words[0]

    def __repr__(self) -> str:
        return f"<Run of {self.case!r}: {self.end.reason} at t = {self.end.t:.4f}, {len(self.impacts)} impacts>"

    def _repr_html_(self) -> str:
        rows = []
        for label, text in self._words[1]:
            lines = escape(text).replace("\n", "<br>")
            rows.append(
                f"<tr><th style='text-align:left;vertical-align:top'>{label}</th>"
                f"<td style='text-align:left'>{lines}</td></tr>"
            )
        return f"<table>{''.join(rows)}</table>"


def _restore(case: Case, options: Options | None, told: dict[str, Any]) -> Run:
    run = Run(case, options, None)
    # Where these are kept once they are known.
    run.__dict__.update(told)
    return run


def _records(data: bytearray) -> np.recarray[Any, Any]:
    records: NDArray[np.void] = np.frombuffer(data, dtype=[(name, np.float64) for name in MOTION])
    return records.view(np.recarray)
