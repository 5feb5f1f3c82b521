"""Long motions: sections, Lyapunov exponents, and the attractor against a key."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Unpack

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._axes import listed
from ._base_orbit import STATE
from ._case import Case
from ._check import engine_of, number, whole
from ._keys import Axes
from ._later import Later
from ._progress import bar
from ._result import Result
from ._signature import with_keys
from ._table import numbers, or_nan

if TYPE_CHECKING:
    import xarray
else:
    xarray = Later("xarray")


def section(
    case: Case,
    *,
    periods: int = 400,
    keep: int = 100,
    phase: float = 0.0,
    at: Literal["periods", "impacts"] = "periods",
    progress: bool = True,
) -> xarray.Dataset:
    """Follow a long motion, and keep its state once a period of the forcing, as ``snapload section`` does.

    Parameters
    ----------
    case : Case
        The case, with its start.
    periods : int
        Periods of the forcing in all.
    keep : int
        Periods that are kept, the last ones.
    phase : float
        Time of the section, in periods of the forcing. The start is the state then: another phase is another motion.
    at : {"periods", "impacts"}
        Where the points are: once a period, or at every impact of the kept periods.
    progress : bool
        Whether to show a bar if it takes long.

    Returns
    -------
    xarray.Dataset
        ``x`` to ``vtheta`` over ``k``, the number of the period; or over ``impact`` ``t``, ``phase``, ``cable``,
        ``v_n``, ``impulse`` and the state, with velocities before and after. Over ``direction`` the Lyapunov exponents
        in a unit of time with their standard errors: ``exponent``, minus infinity where a taut cable closes a
        direction, and ``exponent_se``, NaN where fewer than five periods are kept.
        Attributes: ``period`` of the motion in periods of the forcing (NaN if it has none), ``snaps`` a period,
        ``y_max``, ``theta_max``, and if it stopped at a limit ``stop`` and ``stop_t``.

    Raises
    ------
    ValueError
        If an option is out of its range.

    See Also
    --------
    snapload.orbit_diagram : The same against a key.
    snapload.Case.orbit : Its orbit, if it is periodic.

    Notes
    -----
    The stops by settling and sliding are off. A motion that stops before the first point leaves a dataset without
    points, and a warning. Python's lock is released meanwhile, and Ctrl-C ends it.

    Examples
    --------
    A point mass whose motion never repeats itself:

    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.976, e=0.71, nu=0.87, omega=4.847, f_o=1.6, x=0, y=0.4, vx=0.1)
    >>> points = snapload.section(case, periods=600, keep=200)
    >>> points.x.shape, bool(points.attrs["period"] > 0), abs(float(points.exponent[0])) < 0.01
    ((201,), False, True)
    """
    if at not in ("periods", "impacts"):
        raise ValueError(f"at = {at!r} is not allowed; allowed: 'periods', 'impacts'")
    told = _section(case, periods, keep, phase, at == "impacts", progress)
    if told["stop"] is not None and not told["points"]:
        warnings.warn(
            f"the motion of this start {_stopped(told)}, before the first point of the section, which comes after "
            f"{periods - keep} periods of the forcing; ask for fewer periods, or begin elsewhere",
            stacklevel=2,
        )
    from ._dataset import ABOUT

    variables: dict[str, Any] = {}
    if at == "impacts":
        coords: dict[str, Any] = {"impact": ("impact", np.arange(1, len(told["impacts"]) + 1))}
        variables |= _impacts(told["impacts"])
    else:
        states = np.array([point["state"] for point in told["points"]], dtype=np.float64).reshape(-1, len(STATE))
        about = {"long_name": "number of the period of the forcing"}
        coords = {"k": ("k", np.array([point["k"] for point in told["points"]], dtype=np.int64), about)}
        variables |= {name: ("k", states[:, place], of_state(name)) for place, name in enumerate(STATE)}
    spectrum = _spectrum(told["exponents"])
    rate = {"units": "1", "scale": "1/T"}
    coords["direction"] = ("direction", np.arange(1, len(spectrum[0]) + 1), {"long_name": "direction"})
    variables["exponent"] = ("direction", spectrum[0], {"long_name": "Lyapunov exponent, in 1/T", **rate})
    variables["exponent_se"] = ("direction", spectrum[1], {"long_name": "standard error, in 1/T", **rate})
    attrs: dict[str, Any] = {
        "title": "A section of a long motion of a body on cables",
        **ABOUT,
        "phase": told["phase"],
        "period": or_nan(told["period"]),
        "snaps": or_nan(told["snaps"]),
        "y_max": told["y_max"],
        "theta_max": told["theta_max"],
    }
    if told["stop"] is not None:
        attrs |= {"stop": told["stop"]["reason"], "stop_t": told["stop"]["t"]}
    return xarray.Dataset(variables, coords, attrs)


@dataclass(frozen=True, repr=False, eq=False)
class LyapunovSpectrum(Result):
    """Lyapunov exponents of a long motion, the largest first.

    ``values, errors = snapload.lyapunov_spectrum(case)`` takes them apart.

    Attributes
    ----------
    values : numpy.ndarray
        The exponents [1/T]: six, four of a point mass; minus infinity where contact closes a direction.
    standard_errors : numpy.ndarray
        Their standard errors [1/T], from twenty batches of periods, with what growth that still slows down may fall
        by; NaN of fewer than four periods.
    periods : int
        Over how many periods of the forcing they are means.
    transient : int
        How many were left out before.

    See Also
    --------
    snapload.lyapunov_spectrum : Makes it.

    Examples
    --------
    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
    >>> values, errors = snapload.lyapunov_spectrum(case, periods=200)
    >>> bool(values.max() < 0)
    True
    """

    values: NDArray[np.float64]
    standard_errors: NDArray[np.float64]
    periods: int
    transient: int

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        return iter((self.values, self.standard_errors))


def lyapunov_spectrum(
    case: Case, *, periods: int = 1000, transient: int = 400, progress: bool = True
) -> LyapunovSpectrum:
    """Compute the Lyapunov exponents of the motion that a case comes to.

    Parameters
    ----------
    case : Case
        The case, with its start.
    periods : int
        Periods of the forcing over which they are means.
    transient : int
        Periods that are left out before.
    progress : bool
        Whether to show a bar if it takes long.

    Returns
    -------
    LyapunovSpectrum
        The exponents and their standard errors.

    Raises
    ------
    ValueError
        If the motion stops at a limit before, or an option is out of its range.

    See Also
    --------
    snapload.section : The motion itself.

    Notes
    -----
    Of any motion that snaps in slack flight alone the sum is 2 ln e times the snaps in unit time.

    Examples
    --------
    >>> import math, snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
    >>> spectrum = snapload.lyapunov_spectrum(case, periods=200)
    >>> math.isclose(spectrum.values.sum(), 2 * math.log(0.35) * 2 * 3.1 / math.tau, rel_tol=1e-9)
    True
    """
    periods, transient = whole("periods", periods, 1, 10**6 - 1), whole("transient", transient, 0, 10**8)
    # Growth is measured between sections, of which there is one more than periods.
    told = _section(case, transient + periods + 1, periods + 1, 0.0, False, progress)
    if told["stop"] is not None:
        raise ValueError(f"the motion of this start {_stopped(told)}; begin elsewhere, or ask less")
    values, errors = _spectrum(told["exponents"])
    return LyapunovSpectrum(values, errors, periods, transient)


def orbit_diagram(
    case: Case,
    *,
    periods: int = 400,
    keep: int = 100,
    phase: float = 0.0,
    down: bool = False,
    progress: bool = True,
    **axis: Unpack[Axes],
) -> xarray.Dataset:
    """Follow the attractor along the values of a key, each value begun where the one before ended.

    Parameters
    ----------
    case : Case
        The case, with the start that the first value begins with.
    periods : int
        Periods of the forcing in all, at each value.
    keep : int
        Periods that are kept, the last ones.
    phase : float
        Time of the section, in periods of the forcing. The start is the state then: another phase is another motion.
    down : bool
        Whether to go from the last value to the first. Where up and down differ there is more than one attractor.
    progress : bool
        Whether to show a bar if it takes long.
    **axis : array_like or str
        The values of the one key that changes, or ``"first:last:n"``.

    Returns
    -------
    xarray.Dataset
        ``x`` to ``vtheta`` over the key and ``k``, NaN where the motion stopped at a limit. Over the key ``period`` in
        periods of the forcing (NaN without one), ``snaps`` a period, the largest Lyapunov ``exponent`` (minus infinity
        where taut cables close all directions) with ``exponent_se``, ``y_max``, ``stop`` (empty if it did not), and
        ``restarted``: whether the value began with the case's own start again. The values stand in the order in which
        they were followed.

    Raises
    ------
    ValueError
        If there is not one key, it can not take a value, or an option is out of its range.

    See Also
    --------
    snapload.continuation : Follows unstable orbits, too.
    snapload.plot_diagram : Draws it.

    Examples
    --------
    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, nu=0.8, omega=3.1)
    >>> found = snapload.orbit_diagram(case, f_o=snapload.evenly(1.4, 1.5, 3), periods=150, keep=40)
    >>> found.x.dims, found.period.values.tolist()
    (('f_o', 'k'), [1.0, 1.0, 1.0])
    """
    from ._dataset import ABOUT, attributes

    if len(axis) != 1:
        given = ", ".join(axis) or "none"
        raise ValueError(f"keys = {given} is not allowed; allowed: one key with its values, such as f_o='0.6:1:41'")
    engine = engine_of(case)
    ((key, values),) = axis.items()
    stretch = whole("periods", periods, 1, 10**8), whole("keep", keep, 1, 10**6), number("phase", phase)
    side = key, listed(key, values)  # type: ignore[arg-type]
    with bar("following the attractor", _count(side[1]), progress) as tell:
        answer, counts, data = _engine.diagram(engine, side, bool(down), stretch, tell)
    rows, states = json.loads(answer), np.frombuffer(data, dtype=np.float64).reshape(-1, len(STATE))
    points = np.full((len(rows), keep + 1, len(STATE)), np.nan)
    at = 0
    for row, count in enumerate(counts):
        points[row, :count] = states[at : at + count]
        at += count

    about = attributes()
    variables: dict[str, Any] = {
        name: ((key, "k"), points[:, :, place], of_state(name)) for place, name in enumerate(STATE) if name != key
    }
    for name, meaning in _OF_VALUES.items():
        variables[name] = (key, numbers(rows, name), {"long_name": meaning})
    closed = [row["exponent"] is None and row["exponent_se"] is not None for row in rows]
    variables["exponent"][1][closed] = -np.inf
    stops = np.array([row["stop"] or "" for row in rows], dtype=object)
    variables["stop"] = (key, stops, {"long_name": "which limit stopped the motion"})
    restarted = np.array([row["restarted"] for row in rows], dtype=bool)
    variables["restarted"] = (key, restarted, {"long_name": "begun with the start of the case"})
    coords = {
        key: (key, numbers(rows, "value"), about[key]),
        "k": ("k", np.arange(keep + 1), {"long_name": "number of the period that is kept"}),
    }
    title = {"title": "The attractor of a body on cables against a key", **ABOUT}
    return xarray.Dataset(variables, coords, title)


with_keys(orbit_diagram, defaults=False)

#: What is told of every value of a diagram, beside its points.
_OF_VALUES = {
    "period": "period, in periods of the forcing",
    "snaps": "snaps a period of the forcing",
    "exponent": "largest Lyapunov exponent, in 1/T",
    "exponent_se": "its standard error, in 1/T",
    "y_max": "highest y, in L",
}


def of_state(name: str) -> dict[str, Any]:
    """What is told of a value of the state at a section."""
    from ._dataset import attributes

    about = attributes()[name]
    scale: dict[str, Any] = {key: about[key] for key in ("units", "scale") if key in about}
    return {"long_name": f"{name} at the section", **scale}


def _section(case: Case, periods: int, keep: int, phase: float, impacts: bool, progress: bool) -> dict[str, Any]:
    engine = engine_of(case)
    periods, keep = whole("periods", periods, 1, 10**8), whole("keep", keep, 1, 10**6)
    with bar("following the motion", periods, progress) as tell:
        told: dict[str, Any] = json.loads(_engine.section(engine, periods, keep, number("phase", phase), impacts, tell))
    return told


def _impacts(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The impacts one by one, in the columns of the command's table."""
    variables: dict[str, Any] = {}
    meanings = {
        "t": "time, in T",
        "phase": "phase of the forcing, in periods",
        "cable": "number of the cable",
        "v_n": "normal velocity before, in L/T",
        "impulse": "impulse, in m L/T",
    }
    for name, meaning in meanings.items():
        kind = np.int64 if name == "cable" else np.float64
        variables[name] = ("impact", np.array([row[name] for row in rows], dtype=kind), {"long_name": meaning})
    before, after = (
        np.array([row[side] for row in rows], dtype=np.float64).reshape(-1, len(STATE)) for side in ("before", "after")
    )
    for place, name in enumerate(STATE):
        if name.startswith("v"):
            for side, states in (("before", before), ("after", after)):
                variables[f"{name}_{side}"] = ("impact", states[:, place], {"long_name": f"{name} just {side}"})
        else:
            variables[name] = ("impact", before[:, place], {"long_name": f"{name} at the impact"})
    return variables


def _spectrum(rows: list[dict[str, float | None]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    values = [-np.inf if row["value"] is None else row["value"] for row in rows]
    return np.array(values, dtype=np.float64), np.array([or_nan(row["se"]) for row in rows], dtype=np.float64)


def _stopped(told: dict[str, Any]) -> str:
    return f"stops at t = {told['stop']['t']:.4f}, {told['stop']['reason'].replace('_', ' ')}"


def _count(values: str | NDArray[Any]) -> int:
    """How many values there are, for a bar; what is no range is refused by the engine."""
    if isinstance(values, str):
        last = values.rsplit(":", 1)[1]
        return int(last) if last.strip().isdigit() else 1
    return len(values)
