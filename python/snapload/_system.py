"""User-defined systems: any body, cables and forces."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from . import _engine
from ._arguments import Uncertainty, flag, number, whole_number
from ._geometry import Geometry
from ._keys import LIMIT_PARAMETERS, LIMITS, LimitBounds
from ._lazy_import import LazyModule
from ._orbit_base import Start
from ._run_base import BaseRun
from ._system_keys import in_order, with_keys
from ._system_parts import Body, Cable, Forcing, set_fields, tuple_of_parts, within

if TYPE_CHECKING:
    import xarray

    from . import _orbit
else:
    xarray = LazyModule("xarray")
    _orbit = LazyModule("snapload._orbit")

#: The start, in the order of the engine.
START = ("x", "y", "theta", "vx", "vy", "vtheta")

#: The rules that may be left out.
_OPTIONAL_STOP_RULES = (*LIMITS, "settled_below", "sliding_above")


@dataclass(frozen=True, repr=False)
class System(LimitBounds):
    """A body on any cables under any sinusoidal forces, with its start and stop rules.

    Parameters
    ----------
    body : Body
        The body that moves.
    cables : iterable of Cable
        One to sixteen cables, numbered from 1.
    forcing : Forcing
        All forces except those of the cables, including the weight.
    restitution : float
        Coefficient of restitution of every snap, from 0 to 1.
    {limits}
    x, y, theta, vx, vy, vtheta : float
        The start: position of the centre, rotation, and their velocities. Each cable must be long enough to reach the
        body there.
    t_end : float
        The run ends at this time at the latest.
    settled_below : float, optional
        The run ends if a cable sticks, or two cables are taut, while y is below this value.
    sliding_above : float, optional
        The run ends if a cable sticks while y is at this value or above.
    max_impacts : int
        The run ends if it has more impacts than this.
    v_stick : float
        After a snap with a smaller normal velocity the cable stays taut, if its tension would be positive.

    Raises
    ------
    ValueError
        If a value is not allowed, or the start is beyond the reach of a cable.
    TypeError
        If a part has the wrong type.

    See Also
    --------
    snapload.Case : Describes the breakwater on two cables by its keys.
    snapload.Body : The body of a system.
    snapload.Cable : A cable of a system.
    snapload.Forcing : The forces of a system.

    Notes
    -----
    You may choose any consistent units, such as metres, kilograms, newtons and seconds. Units in which lengths, masses
    and forces are near 1 are best, because the estimate of rounding errors assumes this.

    Examples
    --------
    A disc that hangs on three cables, each a tenth longer than necessary, and is shaken sideways:

    >>> import math, snapload
    >>> places = [(-1.0, -0.2), (0.0, 0.0), (1.0, 0.2)]
    >>> cables = [snapload.Cable((x, 1.2), 1.1 * math.dist((x, 1.2), (p, 0)), (p, 0)) for x, p in places]
    >>> waves = snapload.Sinusoid((0.4, 0.0), 1.7)
    >>> body = snapload.Body(inertia=0.02, radius=0.2)
    >>> system = snapload.System(body, cables, snapload.Forcing((0, -1), [waves]), 0.6, t_end=5)
    >>> run = system.run()
    >>> run.end.reason, run.impacts["cable"][:3].tolist()
    ('end_time', [2, 1, 2])
    >>> system.replace(length_2=1.25).cables[1].length
    1.25
    """

    body: Body
    cables: tuple[Cable, ...] | list[Cable]
    forcing: Forcing
    restitution: float
    _: KW_ONLY
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    vx: float = 0.0
    vy: float = 0.0
    vtheta: float = 0.0
    t_end: float = 100.0
    settled_below: float | None = None
    sliding_above: float | None = None
    max_impacts: int = 1_000_000
    v_stick: float = 1e-6

    def __post_init__(self) -> None:
        for name, kind in (("body", Body), ("forcing", Forcing)):
            if not isinstance(part := getattr(self, name), kind):
                raise TypeError(f"{name} = {part!r} is not allowed; allowed: a snapload.{kind.__name__}")
        set_fields(self, cables=tuple_of_parts("cables", self.cables, Cable, _engine.MAX_CABLES))
        set_fields(self, restitution=within("restitution", self.restitution, 0.0, 1.0))
        set_fields(self, **{name: within(name, getattr(self, name)) for name in START})
        set_fields(self, t_end=within("t_end", self.t_end, 0.0, above=True))
        for name in _OPTIONAL_STOP_RULES:
            if getattr(self, name) is not None:
                set_fields(self, **{name: within(name, getattr(self, name))})
        set_fields(self, max_impacts=whole_number("max_impacts", self.max_impacts))
        set_fields(self, v_stick=within("v_stick", self.v_stick, 0.0))
        if self.body.inertia is None:
            self._check_point()
        # This checks whether the start is legal.
        _ = self._engine_system

    def _check_point(self) -> None:
        """Checks that a point mass has no rotation and no fairlead away from its centre."""
        for index, cable in enumerate(self.cables, 1):
            if cable.fairlead != (0.0, 0.0):
                raise ValueError(
                    f"fairlead = {cable.fairlead} of cable {index} is not allowed; allowed: (0, 0) for a point mass; "
                    "give the body an inertia"
                )
        for name in ("theta", "vtheta"):
            if getattr(self, name) != 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} is not allowed; allowed: 0 for a point mass")

    @cached_property
    def _engine_system(self) -> _engine.System:
        """The system at its start."""
        start = [getattr(self, name) for name in START]
        return _engine.System(self.body, list(self.cables), self.forcing, self.restitution, start, self)

    @property
    def _limits(self) -> dict[str, float]:
        """The bounds of the limits that are given."""
        return {name: bound for name in LIMITS if (bound := getattr(self, name)) is not None}

    def replace(self, **keys: Any) -> System:
        """Return a system with some keys changed.

        Parameters
        ----------
        **keys
            Any of the parameters; ``mass``, ``inertia`` and ``radius`` of the body; ``force_x`` and ``force_y``, the
            constant force; ``length``, ``anchor_x``, ``anchor_y``, ``fairlead_x`` and ``fairlead_y`` of every cable;
            ``amplitude_x``, ``amplitude_y``, ``omega``, ``phase_x`` and ``phase_y`` of every sinusoid. A key with a
            number, such as ``length_2``, changes only the cable or sinusoid with that number. No two keys may change
            the same, as ``length`` and ``length_2`` would.

        Returns
        -------
        System
            A new system; this one does not change.

        Raises
        ------
        ValueError
            If a key is unknown or its value is not allowed, if the system has no part of its kind, or if two keys
            change the same.

        See Also
        --------
        sweep : Runs all combinations of the values of some keys.

        Examples
        --------
        >>> import snapload
        >>> swing = snapload.System(snapload.Body(), [snapload.Cable((0, 0), 1)], snapload.Forcing((0, -1)), 0.5)
        >>> swing.replace(y=-1, vx=1.9).vx, swing.replace(length=2).cables[0].length
        (1.9, 2.0)
        """
        return dataclasses.replace(self, **with_keys(self, keys))

    def run(self, *, trust: bool = True, uncertainty: Uncertainty = None, tolerance: float = 1e-3) -> SystemRun:
        """Run the system to its end, and compute how far the run can be trusted.

        Parameters
        ----------
        trust : bool
            Whether to compute how far the run can be trusted. The motion is the same to the bit.
        uncertainty : float or dict of str to float, optional
            Uncertainty of the start in either direction: one size for every start value, or a size for each. If left
            out, only rounding is uncertain.
        tolerance : float
            Error of state and time, relative to values above 1, above which a result counts as not known.

        Returns
        -------
        SystemRun
            The finished run with its end, impacts, modes, norms, trust and motion.

        Raises
        ------
        ValueError
            If an option is out of its range.

        See Also
        --------
        sweep : Runs many systems.
        snapload.Case.run : Runs the breakwater and its neighbours.

        Examples
        --------
        A pendulum that starts with a velocity at its lowest point, goes slack at 120 degrees and snaps taut:

        >>> import snapload
        >>> rope, weight = snapload.Cable(anchor=(0, 0), length=1), snapload.Forcing((0, -1))
        >>> swing = snapload.System(snapload.Body(), [rope], weight, 0.5, y=-1, vx=3.5**0.5, t_end=5)
        >>> run = swing.run()
        >>> run.modes["mode"][:2].tolist(), len(run.impacts) > 0
        (['sliding', 'slack'], True)
        """
        if not flag("trust", trust):
            if uncertainty is not None:
                raise ValueError("trust=False follows no deviations; leave out uncertainty, or trust=False")
            return SystemRun(self, None, _engine.run_system(self._engine_system, None, 0.0))
        options = self._uncertainties(uncertainty), number("tolerance", tolerance)
        return SystemRun(self, options, _engine.run_system(self._engine_system, *options))

    def orbit(
        self,
        start: Start | None = None,
        *,
        periods: int | None = None,
        symbol: Iterable[int | str] | None = None,
        phase: float = 0.0,
    ) -> _orbit.SystemOrbit:
        """Find the periodic orbit near a start, to rounding.

        Parameters
        ----------
        start : dict of str to float, or array_like of six, optional
            A state at the section that is near the orbit; values left out are those of the system.
        periods : int, optional
            Period of the orbit in periods of the first sinusoid; 1 if left out.
        symbol : iterable of int, optional
            The cables that snap, in order; any sequence if left out.
        phase : float
            Time of the section, in periods of the first sinusoid.

        Returns
        -------
        SystemOrbit
            The orbit, with its multipliers and its admissibility.

        Raises
        ------
        NoOrbitError
            If there is no such orbit; the message says what was found instead.
        ValueError
            If an option is out of its range, the start is beyond a cable, or the forces are not periodic.

        See Also
        --------
        snapload.Case.orbit : Finds an orbit of a case.

        Examples
        --------
        >>> import math, snapload
        >>> rope, shaken = snapload.Cable((0, 5), 5), snapload.Sinusoid((0, 1.2), 3, phase=(0, -math.pi / 2))
        >>> ball = snapload.System(snapload.Body(), [rope], snapload.Forcing((0, -1), [shaken]), 0.5)
        >>> ball.orbit({"y": 0.2, "vy": -1.3}).admissible.yes
        True
        """
        from ._orbit import orbit_of_system

        return orbit_of_system(self, start, periods, symbol, phase)

    def _uncertainties(self, uncertainty: Uncertainty) -> list[float]:
        """The uncertainty of each start value."""
        rotates = self.body.inertia is not None
        coordinates = [name for name in START if rotates or name not in ("theta", "vtheta")]
        if uncertainty is None:
            sizes: Mapping[str, Any] = {}
        elif isinstance(uncertainty, Mapping):
            sizes = uncertainty
        else:
            size = within("uncertainty", uncertainty, 0.0)
            sizes = dict.fromkeys(coordinates, size)
        for key in sizes:
            if key not in coordinates:
                allowed = f"start values, {', '.join(coordinates)}"
                raise ValueError(f"uncertainty: {key} is not allowed; allowed: {allowed}")
        return [within(f"uncertainty: {name}", sizes.get(name, 0.0), 0.0) for name in START]

    def sweep(
        self, *, trust: bool = True, threads: int | None = None, progress: bool = True, **axes: ArrayLike | str
    ) -> xarray.Dataset:
        """Run every combination of the values of some keys.

        Parameters
        ----------
        trust : bool
            Whether to compute how far each run can be trusted, which takes two to three times as long.
        threads : int, optional
            Number of threads; as many as the machine has if left out.
        progress : bool
            Whether to show a progress bar if the computation takes long.
        **axes
            The values of each key that varies, with the names of :meth:`replace`, or ``"first:last:n"`` for evenly
            spaced values. The first key varies slowest.

        Returns
        -------
        xarray.Dataset
            The results over the keys that vary, with the names and meanings of :func:`snapload.sweep`. A system that
            is not legal has NaN, is not ``certain``, and has a message in ``error``.

        Raises
        ------
        ValueError
            If a key is not allowed, as for :meth:`replace`, a range can not be read, or none of the systems is legal.

        See Also
        --------
        snapload.sweep : Runs studies of the breakwater, also to files and on several machines.

        Notes
        -----
        Python's lock is released during the computation, and Ctrl-C interrupts it. All results are kept in memory;
        ``to_netcdf`` writes them.

        Examples
        --------
        >>> import snapload
        >>> rope, weight = snapload.Cable(anchor=(0, 0), length=1), snapload.Forcing((0, -1))
        >>> swing = snapload.System(snapload.Body(), [rope], weight, 0.5, y=-1, vx=1.8, t_end=5)
        >>> study = swing.sweep(vx=[1.0, 1.8], restitution=[0.0, 0.5, 0.9])
        >>> study.impacts_1.dims, study.impacts_1.sel(vx=1.0).values.tolist()
        (('vx', 'restitution'), [0.0, 0.0, 0.0])
        """
        from ._system_sweep import sweep_systems

        return sweep_systems(self, axes, trust, threads, progress)

    def __repr__(self) -> str:
        values = ((field, getattr(self, field.name)) for field in in_order(self))
        arguments = (f"{field.name}={value!r}" for field, value in values if value != field.default)
        return f"System({', '.join(arguments)})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore_system, ({field.name: getattr(self, field.name) for field in dataclasses.fields(self)},)

    def _geometry(self) -> Geometry:
        cables = tuple((cable.anchor, cable.fairlead, cable.length) for cable in self.cables)
        return Geometry(cables, self.body.half_size or self.body.radius or 0.0, self.rotation_limit)


System.__doc__ = (System.__doc__ or "").replace("{limits}", LIMIT_PARAMETERS.strip())


class SystemRun(BaseRun):
    """A finished run of a user-defined system with its end, impacts and modes, and how far it can be trusted.

    Returned by :meth:`snapload.System.run`.

    Attributes
    ----------
    system : System
        The system that was run.

    See Also
    --------
    snapload.System.run : Runs a system.
    snapload.Run : A run of a case.

    Examples
    --------
    >>> import snapload
    >>> rope, weight = snapload.Cable(anchor=(0, 0), length=1), snapload.Forcing((0, -1))
    >>> run = snapload.System(snapload.Body(), [rope], weight, 0.5, y=-1, vx=1.0, t_end=5).run()
    >>> run.modes["mode"].tolist(), round(float(run.at(0.0)["T1"]), 6)
    (['sliding'], 2.0)
    """

    _nondimensional = False

    def __init__(self, system: System, options: tuple[list[float], float] | None, engine: _engine.Run | None) -> None:
        self.system = system
        self._options = options
        self._trusted = options is not None
        self._engine_object = engine

    def _rerun(self) -> _engine.Run:
        return _engine.run_system(self.system._engine_system, *(self._options or (None, 0.0)))

    def _geometry(self) -> Geometry:
        return self.system._geometry()

    @cached_property
    def _summary(self) -> tuple[str, list[tuple[str, str]]]:
        lines = [("End", f"{self.end.reason.replace('_', ' ')} at t = {self.end.t:.4f}")]
        if self._trusted:
            lines += [("Trust", self._engine.trust_in_words())]
        lines += [("Impacts", self._impacts_in_words(len(self.system.cables)))]
        # As the command prints it: labels of ten letters, and further lines are indented by as much.
        rows = ["\n".join(f"{a if i == 0 else '':<10}{line}" for i, line in enumerate(b.split("\n"))) for a, b in lines]
        return "\n".join(rows), lines

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SystemRun):
            return NotImplemented
        return self.system == other.system and self._head == other._head and self.impacts == other.impacts

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        cached = {name: getattr(self, name) for name in ("_head", "_summary", "impacts", "modes")}
        return _restore, (self.system, self._options, cached)

    def __repr__(self) -> str:
        cables = len(self.system.cables)
        return self._short_repr(f"a body on {cables} cable{'s' if cables > 1 else ''}")


def _restore_system(fields: dict[str, Any]) -> System:
    return System(**fields)


def _restore(system: System, options: tuple[list[float], float] | None, cached: dict[str, Any]) -> SystemRun:
    run = SystemRun(system, options, None)
    run.__dict__.update(cached)
    return run
