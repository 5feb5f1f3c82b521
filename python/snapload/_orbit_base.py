"""The common part of all periodic orbits."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import number, unmasked, whole_number
from ._lazy_import import LazyModule
from ._motion import Motion
from ._schema import units
from ._table import Table, or_nan

if TYPE_CHECKING:
    import matplotlib.axes
else:
    matplotlib = LazyModule("matplotlib")

#: The values of the state, in the order of the engine.
STATE = ("x", "y", "theta", "vx", "vy", "vtheta")

#: Stability by the multipliers: true, false, or a word.
Stability: TypeAlias = bool | Literal["neutral", "superstable"]

#: Some values of the state, or all six of them.
Start: TypeAlias = Mapping[str, float] | ArrayLike

#: The options of a search for an orbit: periods, cables, time of the section.
OrbitOptions: TypeAlias = tuple[int | None, list[int] | None, float]


#: The number of events of an orbit that are shown in a line.
_SHOWN = 8


class NoOrbitError(ValueError):
    """Raised if no orbit was found; the message says what was found instead.

    See Also
    --------
    snapload.Case.orbit : Searches for an orbit.

    Examples
    --------
    >>> import snapload
    >>> try:
    ...     snapload.Case(f_o=0.5).orbit()
    ... except snapload.NoOrbitError as error:
    ...     print(str(error)[:57])
    no orbit was found: the motion from this start stops at t
    """


@dataclass(frozen=True)
class Admissible:
    """Whether an orbit is a possible motion of the body, with its extreme values between events.

    In a condition it has the value of `yes`: ``if orbit.admissible: ...``.

    Attributes
    ----------
    yes : bool
        Whether the orbit is a possible motion of the body.
    largest_gap : float or None
        The largest gap g between events, where a cable comes closest to being taut [L^2]; None if none comes close.
    least_tension : float or None
        The smallest tension of a taut cable, besides that at its release [F]; None if no cable is taut.
    least_v_n : float or None
        The smallest normal velocity of a snap [L/T]; None if there is no snap.
    y_max : float
        The highest y of the centre [L].
    theta_max : float
        The largest rotation in either direction [rad].
    why_not : tuple of str
        The reasons why the orbit is not a possible motion; empty if it is one.

    See Also
    --------
    snapload.Orbit : The orbit that has this attribute.

    Examples
    --------
    A periodic solution in which cable 2 would have to push:

    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.4, e=0.9, nu=0, omega=3, f_o=0.5)
    >>> admissible = case.orbit(start={"x": 0.0894, "y": 0.1005, "vx": 0.468, "vy": 0.58}).admissible
    >>> admissible.yes, admissible.least_tension < 0
    (False, True)
    """

    yes: bool
    largest_gap: float | None
    least_tension: float | None
    least_v_n: float | None
    y_max: float
    theta_max: float
    why_not: tuple[str, ...]

    def __bool__(self) -> bool:
        return self.yes


class BaseOrbit:
    """A motion that repeats itself after a whole number of forcing periods.

    A derived class has the case or system of the orbit, and computes the orbit again if necessary.
    """

    #: Whether quantities are in the scales L, m, F and T, and not in units of the user.
    _nondimensional = True

    def __init__(self, engine: _engine.Orbit | None, data: dict[str, Any] | None = None) -> None:
        self._engine_object = engine
        if data is None:
            assert engine is not None
            data = json.loads(engine.json()) | {"attracts": engine.attracts(), "words": engine.summary().rstrip("\n")}
        self._data: dict[str, Any] = data
        self.state: NDArray[np.float64] = np.array(data["section"]["state"])
        self.phase: float = data["section"]["phase"]
        self.periods: int = data["period"]["forcing_periods"]
        self.smallest_periods: int = data["period"]["smallest"]
        self.period: float = data["period"]["t"]
        self.symbol: tuple[str, ...] = tuple(data["symbol"])
        self.multipliers: NDArray[np.complex128] = complex_array(data["multipliers"])
        self.zeros_from_contact: int = data["zeros_from_contact"]
        self.exponents: NDArray[np.float64] = np.array([-np.inf if e is None else e for e in data["exponents"]])
        self.stable: Stability = data["stable"]
        self.attracts: bool = data["attracts"]
        self.product: float = data["product"]["value"]
        self.product_rule: float | None = data["product"]["rule"]
        admissible = data["admissible"]
        self.admissible = Admissible(**{**admissible, "why_not": tuple(admissible["why_not"])})
        self.return_error: float | None = data["return_error"]
        self.error_bound: float | None = data["error_bound"]
        self.proved: bool = data["proved"]
        self.proof: dict[str, Any] | None = data.get("proof")
        self.modes: tuple[dict[str, Any], ...] = tuple(data["modes"])
        # An orbit does not change. Who changes values does so in a copy.
        for values in (self.state, self.multipliers, self.exponents):
            values.flags.writeable = False
        events = _events(data["events"])
        self.events = events if self._nondimensional else events._in_own_units()

    def _recompute(self) -> tuple[_engine.Orbit | None, str]:
        """Computes the orbit again from its own state."""
        raise NotImplementedError

    @property
    def _options(self) -> OrbitOptions:
        return self.periods, [row["cable"] for row in self._data["events"] if row["kind"] == "snap"], self.phase

    @property
    def _engine(self) -> _engine.Orbit:
        """The orbit of the engine. It does not travel to other processes, where it is computed again."""
        if self._engine_object is None:
            self._engine_object = orbit_or_error(*self._recompute())
        return self._engine_object

    def curve(self, pieces: int = 400) -> np.recarray[Any, Any]:
        """Compute one period of the orbit from its sequence of events, admissible or not.

        Parameters
        ----------
        pieces : int
            The approximate number of pieces of equal time; every flight has at least eight.

        Returns
        -------
        numpy.recarray, shape (n,)
            Fields ``leg``, the number of the interval between two events, from 0; ``taut``, how many cables are taut
            in it; ``t``; and the state ``x`` to ``vtheta``. At an event there are two rows, before and after it.

        See Also
        --------
        run : Simulates the motion.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> lap = orbit.curve()
        >>> int(lap.leg[-1]), bool(abs(lap.x[-1] - lap.x[0]) < 1e-12)
        (2, True)
        """
        data = self._engine.curve(whole_number("pieces", pieces))
        names = ("leg", "taut", "t", *STATE)
        rows = np.frombuffer(data, dtype=np.float64).reshape(-1, len(names))
        kinds = [(name, "i8" if name in ("leg", "taut") else "f8") for name in names]
        records = np.empty(len(rows), dtype=kinds)
        for place, name in enumerate(names):
            records[name] = rows[:, place]
        return Motion.of(records, "scales" if self._nondimensional else "own")

    def plot(
        self, x: str = "x", y: str = "y", ax: matplotlib.axes.Axes | None = None, **style: Any
    ) -> matplotlib.axes.Axes:
        """Draw one period of the orbit into Matplotlib axes, and return the axes.

        Parameters
        ----------
        x, y : {"t", "x", "y", "theta", "vx", "vy", "vtheta"}
            The quantities on the horizontal and the vertical axis.
        ax : matplotlib.axes.Axes, optional
            Axes to draw into; if left out, new ones of the width of a column.
        **style
            Properties of the lines, such as ``color`` or ``linewidth``.

        Returns
        -------
        matplotlib.axes.Axes
            The axes, for further changes. The black dot is the section. A cross is a snap of cable 1, a circle a snap
            of cable 2. An orbit that is not admissible is dashed and grey.

        Raises
        ------
        ValueError
            If a quantity is unknown.

        See Also
        --------
        curve : The data of the picture.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> orbit.plot("y", "vy").get_xlabel()
        '$y$ [L]'
        """
        from ._orbit_plot import draw_orbit

        return draw_orbit(self, x, y, ax, style)

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, BaseOrbit):
            return NotImplemented
        return self._case_or_system() == other._case_or_system() and self._data == other._data

    __hash__ = None  # type: ignore[assignment]

    def _case_or_system(self) -> object:
        """The case or system of the orbit."""
        raise NotImplementedError

    def __str__(self) -> str:
        text: str = self._data["words"]
        return text

    def __repr__(self) -> str:
        stability = self.stable if isinstance(self.stable, str) else "stable" if self.stable else "unstable"
        duration = "1 period" if self.periods == 1 else f"{self.periods} periods"
        symbol = ", ".join(self.symbol[:_SHOWN]) or "no events"
        if len(self.symbol) > _SHOWN:
            symbol += f", ... ({len(self.symbol)} events)"
        return f"<Orbit: {stability}{'' if self.admissible else ', not admissible'}, {duration}, {symbol}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def complex_array(pairs: Iterable[tuple[float | None, float | None]]) -> NDArray[np.complex128]:
    """Pairs of real and imaginary parts as complex numbers, NaN where there is none as at a snap of zero velocity."""
    return np.array([complex(or_nan(real), or_nan(imaginary)) for real, imaginary in pairs], dtype=np.complex128)


def orbit_or_error(orbit: _engine.Orbit | None, why: str) -> _engine.Orbit:
    """Returns the orbit, or raises an error if there is none."""
    if orbit is None:
        raise NoOrbitError(f"no orbit was found: {why}")
    return orbit


def start_values(start: Start) -> dict[str, Any]:
    """A start as a dict of its keys."""
    if isinstance(start, Mapping):
        return {str(key): value for key, value in start.items()}
    values = np.asarray(unmasked("start", start))
    if values.shape != (len(STATE),) or values.dtype.kind not in "fiu":
        allowed = "some of " + ", ".join(STATE) + " by their names, such as {'x': 0.1}, or all six in this order"
        raise ValueError(f"start = {start!r} is not allowed; allowed: {allowed}")
    return dict(zip(STATE, values.tolist(), strict=True))


def orbit_options(
    periods: int | None, symbol: Iterable[int | str] | None, phase: float, cables: int = 2
) -> OrbitOptions:
    """The options of a search, with those checks that the engine does not make."""
    if periods is not None:
        periods = whole_number("orbit.periods", periods)
    if symbol is None:
        return periods, None, number("phase", phase)
    snapping = []
    entries = symbol.split(",") if isinstance(symbol, str) else symbol
    if not isinstance(entries, Iterable):
        raise TypeError(f"symbol = {symbol!r} is not allowed; allowed: the cables of the snaps, such as [2, 1]")
    for entry in entries:
        # In the form of an orbit's own symbol: which cables stick and release follows from the snaps.
        if isinstance(entry, str) and entry.strip().split(" ")[0] in ("stick", "release", "none", ""):
            continue
        cable = int(entry) if isinstance(entry, str) and entry.strip().isdigit() else entry
        snapping.append(whole_number("symbol", cable, cables))  # type: ignore[arg-type]
    return periods, snapping, number("phase", phase)


def _events(rows: list[dict[str, Any]]) -> Table:
    def column(name: str, dtype: Any = np.float64) -> NDArray[Any]:
        return np.array([row[name] for row in rows], dtype=dtype)

    scales = units()
    return Table._from_columns(
        [
            ("t", scales["t"], "time", column("t")),
            ("kind", "", "snap, stick or release", column("kind", object)),
            ("cable", "", "number of the cable", column("cable", np.int64)),
            ("v_n", scales["v_n"], "normal velocity before", column("v_n")),
            ("impulse", scales["impulse"], "impulse of the cable", column("impulse")),
        ]
    )
