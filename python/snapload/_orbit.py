"""Periodic orbits: of the attractor, near a start, and all that random starts lead to."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _engine
from ._base_orbit import STATE, BaseOrbit, Start, orbit_or_error, start_of, wanted
from ._check import engine_of, whole
from ._later import Later
from ._progress import bar
from ._run import Run
from ._system import System, SystemRun

if TYPE_CHECKING:
    from . import _case
else:
    _case = Later("snapload._case")

#: Accumulating snaps are followed down to this velocity, as in the orbit itself.
_V_STICK = 1e-7


class Orbit(BaseOrbit):
    """A motion of a case that repeats itself after whole periods of the forcing.

    Made by :meth:`snapload.Case.orbit` and :func:`snapload.find_orbits`.

    Attributes
    ----------
    case : Case
        The case that it is an orbit of.
    state : numpy.ndarray, shape (6,)
        x, y, theta, vx, vy, vtheta at the section [L, rad, L/T, rad/T].
    phase : float
        Time of the section, in periods of the forcing.
    periods : int
        Its length in periods of the forcing.
    smallest_periods : int
        After how many of them it first repeats itself: fewer where it is a shorter orbit several times.
    period : float
        Its length [T].
    symbol : tuple of str
        Its events in their order: ``2`` is a snap of cable 2, ``stick 2`` says that the cable stays taut, ``release
        2`` that its tension ends.
    events : Table
        ``t`` [T], ``kind`` (snap, stick, release), ``cable``, ``v_n`` [L/T], ``impulse`` [m L/T].
    modes : tuple of dict
        Which cables are taut from when to when: ``from``, ``to``, ``taut``.
    multipliers : numpy.ndarray of complex
        The Floquet multipliers, the largest first: six, four of a point mass.
    zeros_from_contact : int
        How many of them are exactly 0, as a taut cable closes two directions.
    exponents : numpy.ndarray
        ln|multiplier| / period [1/T]; minus infinity of a multiplier that is 0.
    product : float
        The product of the multipliers without those zeros.
    product_rule : float or None
        What it has to be, e^2N for N snaps; None where a cable is taut on the way.
    stable : bool or str
        True or False, ``"neutral"`` where multipliers lie on the unit circle and none outside, ``"superstable"`` where
        all are 0.
    attracts : bool
        Whether neighbours come back to it: it is stable or superstable.
    admissible : Admissible
        Whether a body can have it, and why not.
    return_error : float or None
        How far the motion is off when it is run for one lap; None where it stops before.
    error_bound : float or None
        A bound on the error of the state where one is proved.
    proved : bool
        Whether it is.
    proof : dict or None
        What is proved: ``state``, ``events`` with their ``t`` and ``v_n`` as decimals, each digit of which is right;
        ``alone_within``, a distance within which there is no other orbit of this length; ``prime``, whether it takes no
        fewer periods; or ``why_not``. None where no proof was tried.
    start_distance : float or None
        The largest difference of `state` from the start that was given; None if none was. Far from it another orbit may
        have been meant.

    See Also
    --------
    snapload.Case.orbit : Finds one.
    snapload.continuation : Follows it as a key changes.

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
        told: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(engine, told)
        self.case = case
        self.start_distance = start_distance

    def _again(self) -> tuple[_engine.Orbit | None, str]:
        start = dict(zip(STATE, self.state.tolist(), strict=True))
        return _engine.orbit(self.case._engine, start, *self._wanted, None)

    def _of(self) -> object:
        return self.case

    def prove(self) -> Orbit:
        """Prove that there is such an orbit, in numbers of many digits.

        Returns
        -------
        Orbit
            The same orbit with `proved`, `error_bound` and `proof`. The theorem is about the case as the decimals that
            it is written in: the lap has these snaps, each at a velocity above zero, and no others, no limit is
            reached, and there is one such orbit within `error_bound` of `state`. Orbits with a taut cable are not
            proved.

        Raises
        ------
        ValueError
            If it is an orbit of no case.

        See Also
        --------
        snapload.find_orbits : Proves all that it finds, if asked to.

        Examples
        --------
        >>> import snapload
        >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit().prove()
        >>> orbit.proved, orbit.error_bound < 1e-14, orbit.proof["state"][0]
        (True, True, '-0.268810219181438605342115917801')
        """
        return Orbit(self.case, self._engine.proved(), self.start_distance)

    def run(self, laps: int = 1, *, trust: bool = True) -> Run:
        """Run the motion from the orbit's state at a whole period of the forcing.

        Parameters
        ----------
        laps : int
            How many times round.
        trust : bool
            Whether to say how far the run can be trusted.

        Returns
        -------
        Run
            The finished run, with the stops by settling and sliding off. An unstable orbit is left after some laps.

        Raises
        ------
        ValueError
            If no body can begin there.

        See Also
        --------
        curve : One lap as its sequence of events has it.

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
            t_end=whole("laps", laps) * self.period,
            v_stick=min(_V_STICK, self.case.v_stick),
            stop_when_settled=False,
            stop_when_sliding=False,
        )
        return case.run(trust=trust, members=0 if trust else None)

    def __reduce__(self) -> tuple[Any, ...]:
        return Orbit, (self.case, None, self.start_distance, self._told)


class SystemOrbit(BaseOrbit):
    """A motion of a system of one's own that repeats itself after whole periods of its first sinusoid.

    Made by :meth:`snapload.System.orbit`. Its attributes are those of :class:`snapload.Orbit`, in your own units.

    Attributes
    ----------
    system : System
        The system that it is an orbit of.

    See Also
    --------
    snapload.System.orbit : Finds one.
    snapload.Orbit : The same of a case.

    Examples
    --------
    A ball that a table shakes, hung on a rope: it jumps once a period (Holmes 1982).

    >>> import math, snapload
    >>> rope, shaken = snapload.Cable((0, 5), 5), snapload.Sinusoid((0, 1.2), 3, phase=(0, -math.pi / 2))
    >>> ball = snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1), [shaken]), 0.5)
    >>> orbit = ball.orbit(start={"y": 0.2, "vy": -1.3})
    >>> orbit.symbol, round(float(orbit.events["v_n"][0]), 6)
    (('1',), 1.396263)
    """

    _in_scales = False

    def __init__(
        self,
        system: System,
        engine: _engine.Orbit | None,
        start_distance: float | None = None,
        told: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(engine, told)
        self.system = system
        self.start_distance = start_distance

    def _again(self) -> tuple[_engine.Orbit | None, str]:
        return _engine.orbit_of_system(self.system._begun, self.state.tolist(), *self._wanted)

    def _of(self) -> object:
        return self.system

    def run(self, laps: int = 1, *, trust: bool = True) -> SystemRun:
        """Run the motion from the orbit's state at a whole period of the forcing.

        Parameters
        ----------
        laps : int
            How many times round.
        trust : bool
            Whether to say how far the run can be trusted.

        Returns
        -------
        SystemRun
            The finished run, with the stops by settling and sliding off.

        Raises
        ------
        ValueError
            If no body can begin there.

        See Also
        --------
        curve : One lap as its sequence of events has it.

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
            t_end=whole("laps", laps) * self.period,
            v_stick=min(_V_STICK, self.system.v_stick),
            settled_below=None,
            sliding_above=None,
        )
        return system.run(trust=trust)

    def __reduce__(self) -> tuple[Any, ...]:
        return SystemOrbit, (self.system, None, self.start_distance, self._told)


class HasOrbits:
    """What a case has for being one whose motion may repeat itself."""

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
        """Find the periodic orbit that the motion comes to, or the one near a start, closed to rounding.

        Parameters
        ----------
        start : dict of str to float, or array_like of six, optional
            The state at the section near which the orbit is; values left out are the case's own. The orbit may be an
            unstable one. If left out, the motion of the case is followed over many periods.
        periods : int, optional
            Length in periods of the forcing; 1 near a start, what the motion has otherwise.
        symbol : iterable of int, optional
            The cables that snap, in their order, such as ``[2, 1]``; any if left out.
        phase : float
            Time of the section, in periods of the forcing.
        progress : bool
            Whether to show a bar if it takes long.

        Returns
        -------
        Orbit
            The orbit, with its multipliers, and whether a body can have it.

        Raises
        ------
        NoOrbitError
            If there is none; the words say what there is instead.
        ValueError
            If an option is out of its range.

        See Also
        --------
        snapload.find_orbits : All that random starts lead to.
        snapload.section : A long motion that need not repeat itself.

        Notes
        -----
        The stops by settling and sliding are off. Python's lock is released meanwhile, and Ctrl-C ends it.

        Examples
        --------
        >>> import snapload
        >>> case = snapload.Case(body="point", r=1.3, e=0.7, f_o=0.9, nu=1.2, omega=4)
        >>> case.orbit({"x": -0.115, "y": 0.241, "vx": 0.303, "vy": -0.603}, symbol=[2, 1, 1]).stable
        False
        """
        case: Any = self
        given = None if start is None else start_of(start)
        asked = wanted(periods, symbol, phase)
        with bar("following the motion", _engine.ATTRACTOR_PERIODS, progress and given is None) as tell:
            engine = orbit_or_error(*_engine.orbit(engine_of(case), given, *asked, tell))
        far = None
        if given is not None:
            begun = [float(given.get(name, case[name])) for name in STATE]
            far = engine.distance(begun)
        return Orbit(case, engine, far)


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
    """Look for periodic orbits from random starts, stable and unstable ones.

    Parameters
    ----------
    case : Case
        The case.
    starts : int
        How many starts. A thousand take about a second.
    seed : int
        Which starts.
    periods : int, optional
        Length in periods of the forcing; 1 if left out.
    symbol : iterable of int, optional
        The cables that snap, in their order; any if left out.
    phase : float
        Time of the section, in periods of the forcing.
    prove : bool
        Whether to prove each of them, as :meth:`Orbit.prove` does.
    progress : bool
        Whether to show a bar if it takes long.

    Returns
    -------
    list of Orbit
        Those found that a body can have, each once, the most stable ones first.

    Raises
    ------
    ValueError
        If an option is out of its range.

    See Also
    --------
    snapload.Case.orbit : The one near a start.

    Notes
    -----
    Python's lock is released meanwhile, and Ctrl-C ends it. More starts may find more orbits; nothing says that all are
    found.

    Examples
    --------
    >>> import snapload
    >>> orbits = snapload.find_orbits(snapload.Case(omega=3), 1000)
    >>> len(orbits) > 0, any(orbit.attracts for orbit in orbits)
    (True, False)
    """
    engine, asked = engine_of(case), wanted(periods, symbol, phase)
    starts, seed = whole("starts", starts), whole("seed", seed)
    with bar("random starts", starts, progress) as tell:
        found = _engine.find_orbits(engine, starts, seed, *asked, bool(prove), tell)
    return [Orbit(case, orbit) for orbit in found]


def orbit_of_system(
    system: System, start: Start | None, periods: int | None, symbol: Iterable[int | str] | None, phase: float
) -> SystemOrbit:
    """The orbit near a start, or near that of the system."""
    waves = system.forcing.sinusoids
    if not waves or waves[0].omega == 0:
        allowed = "forces with a sinusoid of a frequency above 0, a period of which is one of the orbit"
        raise ValueError(f"forcing = {system.forcing!r} is not allowed; allowed: {allowed}")
    for wave in waves[1:]:
        parts = wave.omega / waves[0].omega
        if abs(parts - round(parts)) > 1e-12:
            allowed = f"whole multiples of the first frequency, {waves[0].omega}, as an orbit repeats itself with it"
            raise ValueError(f"omega = {wave.omega} is not allowed; allowed: {allowed}")
    own = {name: getattr(system, name) for name in STATE}
    given = start_of(start) if start is not None else {}
    for name in given:
        if name not in own:
            raise ValueError(f"start = {name} is not allowed; allowed: values of the state, {', '.join(STATE)}")
    begun = [float((own | given)[name]) for name in STATE]
    asked = wanted(periods, symbol, phase, len(system.cables))
    engine = orbit_or_error(*_engine.orbit_of_system(system._begun, begun, *asked))
    return SystemOrbit(system, engine, engine.distance(begun))
