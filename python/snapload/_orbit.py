"""Periodic orbits: that of the attractor, that near a start, and those found from random starts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _engine
from ._arguments import engine_case, flag, whole_number
from ._lazy_import import LazyModule
from ._orbit_base import STATE, BaseOrbit, Start, orbit_options, orbit_or_error, start_values
from ._progress import progress_bar
from ._run import Run
from ._system import System, SystemRun

if TYPE_CHECKING:
    from . import _case
else:
    _case = LazyModule("snapload._case")

#: Accumulating snaps are followed down to this velocity, as in the orbit itself.
_V_STICK = 1e-7


class Orbit(BaseOrbit):
    """A motion of a case that repeats itself after a whole number of forcing periods.

    Returned by :meth:`snapload.Case.orbit` and :func:`snapload.find_orbits`.

    Attributes
    ----------
    case : Case
        The case of the orbit.
    state : numpy.ndarray, shape (6,)
        x, y, theta, vx, vy, vtheta at the section [L, rad, L/T, rad/T].
    phase : float
        Time of the section, in periods of the forcing.
    periods : int
        Period of the orbit, in periods of the forcing.
    smallest_periods : int
        Number of forcing periods after which it first repeats itself; fewer if a shorter orbit is repeated.
    period : float
        Period of the orbit [T].
    symbol : tuple of str
        The events in order of time: ``2`` is a snap of cable 2, ``stick 2`` means that the cable stays taut, and
        ``release 2`` that it loses its tension.
    events : Table
        ``t`` [T], ``kind`` (snap, stick, release), ``cable``, ``v_n`` [L/T], ``impulse`` [m L/T].
    modes : tuple of dict
        The intervals with a fixed set of taut cables: ``from``, ``to``, ``taut``.
    multipliers : numpy.ndarray of complex
        The Floquet multipliers, the largest first: six, or four for a point mass.
    zeros_from_contact : int
        The number of multipliers that are exactly 0, because a taut cable removes two directions, or because a snap
        without rebound stops the body.
    exponents : numpy.ndarray
        ln|multiplier| / period [1/T]; minus infinity for a multiplier of 0.
    product : float
        The product of the multipliers without those zeros.
    product_rule : float or None
        The exact value of that product, e^2N for N snaps; None if contact makes multipliers 0.
    stable : bool or str
        True or False, ``"neutral"`` if multipliers lie on the unit circle and none outside, ``"superstable"`` if all
        are 0.
    attracts : bool
        Whether nearby motions converge to it, that is, whether it is stable or superstable.
    admissible : Admissible
        Whether it is a possible motion of the body and, if not, why.
    return_error : float or None
        The error of the state after one simulated period; None if the motion stops before.
    error_bound : float or None
        A proved bound on the error of the state; None without a proof.
    proved : bool
        Whether the orbit is proved to exist.
    proof : dict or None
        The result of the proof: ``state`` and ``events`` with ``t`` and ``v_n`` as decimals of which each digit is
        right; ``alone_within``, a distance within which there is no other orbit of this period; ``prime``, whether the
        orbit has no smaller period; or ``why_not``, the reason why the proof failed. None if no proof was tried.
    start_distance : float or None
        The largest difference between `state` and the given start; None if no start was given. If it is large, the
        orbit may not be the intended one.

    See Also
    --------
    snapload.Case.orbit : Finds an orbit.
    snapload.continuation : Follows an orbit as a key changes.

    Examples
    --------
    >>> import snapload
    >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
    >>> orbit
    <Orbit: stable, 1 period, 2, 1>
    >>> orbit.stable, orbit.admissible.yes, f"{abs(orbit.multipliers[0]):.6f}"
    (True, True, '0.487806')
    >>> orbit.events["cable"].tolist(), abs(orbit.product - orbit.product_rule) < 1e-14
    ([2, 1], True)
    """

    def __init__(
        self,
        case: _case.Case,
        engine: _engine.Orbit | None,
        start_distance: float | None = None,
        data: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(engine, data)
        self.case = case
        self.start_distance = start_distance

    def _recompute(self) -> tuple[_engine.Orbit | None, str]:
        start = dict(zip(STATE, self.state.tolist(), strict=True))
        return _engine.orbit(self.case._engine, start, *self._options, None)

    def _case_or_system(self) -> object:
        return self.case

    def prove(self) -> Orbit:
        """Prove with numbers of many digits that the orbit exists.

        Returns
        -------
        Orbit
            The same orbit with `proved`, `error_bound` and `proof`. The decimals in which the case is written are
            taken as exact. The theorem says that one period of the motion has exactly these snaps, each at a velocity
            above zero, that no limit is reached, and that there is one such orbit within `error_bound` of `state`.
            Orbits with a taut cable are not proved.

        Raises
        ------
        ValueError
            If the orbit does not belong to a case.

        See Also
        --------
        snapload.find_orbits : Proves all orbits that it finds, with ``prove=True``.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit().prove()
        >>> orbit.proved, orbit.error_bound < 1e-14, orbit.proof["state"][0]
        (True, True, '-0.268810219181438605342115917801')
        """
        return Orbit(self.case, self._engine.proved(), self.start_distance)

    def run(self, laps: int = 1, *, trust: bool = True) -> Run:
        """Simulate the motion from the state of the orbit at a whole period of the forcing.

        Parameters
        ----------
        laps : int
            Number of periods of the orbit.
        trust : bool
            Whether to compute how far the run can be trusted.

        Returns
        -------
        Run
            The finished run, which does not stop when the body settles or slides. The motion leaves an unstable orbit
            after some periods.

        Raises
        ------
        ValueError
            If the start is not legal.

        See Also
        --------
        curve : Computes one period from the sequence of events.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
        >>> run = orbit.run(3)
        >>> run.end.reason, run.impacts["cable"].tolist()
        ('end_time', [2, 1, 2, 1, 2, 1])
        """
        start: Any = dict(zip(STATE, self._engine.begins(), strict=True))
        case = self.case.replace(
            **start,
            t_end=whole_number("laps", laps) * self.period,
            v_stick=min(_V_STICK, self.case.v_stick),
            stop_when_settled=False,
            stop_when_sliding=False,
        )
        return case.run(trust=trust, members=0 if trust else None)

    def __reduce__(self) -> tuple[Any, ...]:
        return Orbit, (self.case, None, self.start_distance, self._data)


class SystemOrbit(BaseOrbit):
    """A motion of a user-defined system that repeats itself after whole periods of its first sinusoid.

    Returned by :meth:`snapload.System.orbit`. It has the attributes of :class:`snapload.Orbit`, in your own units.

    Attributes
    ----------
    system : System
        The system of the orbit.

    See Also
    --------
    snapload.System.orbit : Finds an orbit.
    snapload.Orbit : An orbit of a case.

    Examples
    --------
    A ball on a rope that is shaken like a ball on a vibrating table: one impact in each period (Holmes 1982).

    >>> import math, snapload
    >>> rope, shaken = snapload.Cable((0, 5), 5), snapload.Sinusoid((0, 1.2), 3, phase=(0, -math.pi / 2))
    >>> ball = snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1), [shaken]), 0.5)
    >>> orbit = ball.orbit(start={"y": 0.2, "vy": -1.3})
    >>> orbit.symbol, round(float(orbit.events["v_n"][0]), 6)
    (('1',), 1.396263)
    """

    _nondimensional = False

    def __init__(
        self,
        system: System,
        engine: _engine.Orbit | None,
        start_distance: float | None = None,
        data: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(engine, data)
        self.system = system
        self.start_distance = start_distance

    def _recompute(self) -> tuple[_engine.Orbit | None, str]:
        return _engine.orbit_of_system(self.system._engine_system, self.state.tolist(), *self._options)

    def _case_or_system(self) -> object:
        return self.system

    def run(self, laps: int = 1, *, trust: bool = True) -> SystemRun:
        """Simulate the motion from the state of the orbit at a whole period of the forcing.

        Parameters
        ----------
        laps : int
            Number of periods of the orbit.
        trust : bool
            Whether to compute how far the run can be trusted.

        Returns
        -------
        SystemRun
            The finished run, which does not stop when the body settles or slides.

        Raises
        ------
        ValueError
            If the start is not legal.

        See Also
        --------
        curve : Computes one period from the sequence of events.

        Examples
        --------
        >>> import math, snapload
        >>> rope, shaken = snapload.Cable((0, 5), 5), snapload.Sinusoid((0, 1.2), 3, phase=(0, -math.pi / 2))
        >>> ball = snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1), [shaken]), 0.5)
        >>> len(ball.orbit(start={"y": 0.2, "vy": -1.3}).run(4).impacts)
        4
        """
        start: Any = dict(zip(STATE, self._engine.begins(), strict=True))
        system = self.system.replace(
            **start,
            t_end=whole_number("laps", laps) * self.period,
            v_stick=min(_V_STICK, self.system.v_stick),
            settled_below=None,
            sliding_above=None,
        )
        return system.run(trust=trust)

    def __reduce__(self) -> tuple[Any, ...]:
        return SystemOrbit, (self.system, None, self.start_distance, self._data)


class HasOrbits:
    """The methods of a case that find periodic orbits."""

    _engine: _engine.Case

    def orbit(
        self,
        start: Start | None = None,
        *,
        periods: int | None = None,
        symbol: Iterable[int | str] | None = None,
        phase: float = 0.0,
        progress: bool = True,
    ) -> Orbit:
        """Find the periodic orbit that the motion converges to, or the one near a start, to rounding.

        Parameters
        ----------
        start : dict of str to float, or array_like of six, optional
            A state at the section that is near the orbit; values left out are those of the case. The orbit may be
            unstable. If left out, the motion of the case is followed over many periods.
        periods : int, optional
            Period of the orbit in periods of the forcing; if left out, 1 near a start, else that of the motion.
        symbol : iterable of int, optional
            The cables that snap, in order, such as ``[2, 1]``; any sequence if left out.
        phase : float
            Time of the section, in periods of the forcing.
        progress : bool
            Whether to show a progress bar if the computation takes long.

        Returns
        -------
        Orbit
            The orbit, with its multipliers and its admissibility.

        Raises
        ------
        NoOrbitError
            If there is no such orbit; the message says what was found instead.
        ValueError
            If an option is out of its range.

        See Also
        --------
        snapload.find_orbits : Finds orbits from random starts.
        snapload.section : Samples a long motion, which need not be periodic.

        Notes
        -----
        The motion does not stop when the body settles or slides. Python's lock is released during the computation, and
        Ctrl-C interrupts it.

        Examples
        --------
        >>> import snapload
        >>> case = snapload.Case(body="point", r=1.3, e=0.7, f_o=0.9, nu=1.2, omega=4)
        >>> case.orbit({"x": -0.115, "y": 0.241, "vx": 0.303, "vy": -0.603}, symbol=[2, 1, 1]).stable
        False
        """
        case: Any = self
        given = None if start is None else start_values(start)
        options = orbit_options(periods, symbol, phase)
        with progress_bar(
            "following the motion", _engine.ATTRACTOR_PERIODS, progress and given is None
        ) as report_progress:
            engine = orbit_or_error(*_engine.orbit(engine_case(case), given, *options, report_progress))
        distance = None
        if given is not None:
            start_state = [float(given.get(name, case[name])) for name in STATE]
            distance = engine.distance(start_state)
        return Orbit(case, engine, distance)


def find_orbits(
    case: _case.Case,
    starts: int = 2000,
    *,
    seed: int = 0,
    periods: int | None = None,
    symbol: Iterable[int | str] | None = None,
    phase: float = 0.0,
    prove: bool = False,
    progress: bool = True,
) -> list[Orbit]:
    """Search for stable and unstable periodic orbits from random starts.

    Parameters
    ----------
    case : Case
        The case to search.
    starts : int
        Number of starts. A thousand starts take about a second.
    seed : int
        Seed of the random starts.
    periods : int, optional
        Period of the orbits in periods of the forcing; 1 if left out.
    symbol : iterable of int, optional
        The cables that snap, in order; any sequence if left out.
    phase : float
        Time of the section, in periods of the forcing.
    prove : bool
        Whether to prove each orbit, as :meth:`Orbit.prove` does.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    list of Orbit
        The admissible orbits that were found, each once, the most stable first.

    Raises
    ------
    ValueError
        If an option is out of its range.

    See Also
    --------
    snapload.Case.orbit : Finds the orbit near a start.

    Notes
    -----
    Python's lock is released during the computation, and Ctrl-C interrupts it. More starts may
    find more orbits; it is not certain that all are found.

    Examples
    --------
    >>> import snapload
    >>> orbits = snapload.find_orbits(snapload.Case(omega=3), 1000)
    >>> len(orbits) > 0, any(orbit.attracts for orbit in orbits)
    (True, False)
    """
    engine, options = engine_case(case), orbit_options(periods, symbol, phase)
    starts, seed = whole_number("starts", starts), whole_number("seed", seed)
    with progress_bar("random starts", starts, progress) as report_progress:
        found = _engine.find_orbits(engine, starts, seed, *options, flag("prove", prove), report_progress)
    return [Orbit(case, orbit) for orbit in found]


def orbit_of_system(
    system: System, start: Start | None, periods: int | None, symbol: Iterable[int | str] | None, phase: float
) -> SystemOrbit:
    """The orbit near a given start, or near the start of the system."""
    waves = system.forcing.sinusoids
    if not waves or waves[0].omega == 0:
        allowed = "forces with a sinusoid of a frequency other than 0, a period of which is one of the orbit"
        raise ValueError(f"forcing = {system.forcing!r} is not allowed; allowed: {allowed}")
    for wave in waves[1:]:
        parts = wave.omega / waves[0].omega
        if abs(parts - round(parts)) > 1e-12:
            allowed = f"whole multiples of the first frequency, {waves[0].omega}, as an orbit repeats itself with it"
            raise ValueError(f"omega = {wave.omega} is not allowed; allowed: {allowed}")
    system_start = {name: getattr(system, name) for name in STATE}
    given = start_values(start) if start is not None else {}
    for name in given:
        if name not in system_start:
            raise ValueError(f"start = {name} is not allowed; allowed: values of the state, {', '.join(STATE)}")
    start_state = [float((system_start | given)[name]) for name in STATE]
    options = orbit_options(periods, symbol, phase, len(system.cables))
    engine = orbit_or_error(*_engine.orbit_of_system(system._engine_system, start_state, *options))
    return SystemOrbit(system, engine, engine.distance(start_state))
