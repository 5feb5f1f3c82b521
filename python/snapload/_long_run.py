"""Long motions: sections, Lyapunov exponents, and bifurcation diagrams."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Unpack

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._arguments import engine_case, flag, number, whole_number
from ._axes import axis_values
from ._case import Case
from ._keys import Axes
from ._lazy_import import LazyModule
from ._orbit_base import STATE
from ._progress import progress_bar
from ._result import Result
from ._schema import attributes, attributes_as, with_own_names, with_scales
from ._signature import with_keys
from ._table import numbers, or_nan

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")


def section(
    case: Case,
    *,
    periods: int = 400,
    keep: int = 100,
    phase: float = 0.0,
    at: Literal["periods", "impacts"] = "periods",
    progress: bool = True,
) -> xarray.Dataset:
    """Sample the state of a long motion once per forcing period, as ``snapload section`` does.

    Parameters
    ----------
    case : Case
        The case, with its start.
    periods : int
        Total number of forcing periods.
    keep : int
        Number of forcing periods to keep, at the end of the motion.
    phase : float
        Time of the section, in periods of the forcing. The start is the state at that time, so another phase gives
        another motion.
    at : {"periods", "impacts"}
        Where points are taken: once per period, or at every impact of the kept periods.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    xarray.Dataset
        With ``at="periods"``, ``x`` to ``vtheta`` over ``k``, the number of the period. With ``at="impacts"``,
        ``t``, ``phase``, ``cable``, ``v_n``, ``impulse`` and the state over ``impact``, with velocities before and
        after the impact. In both cases, over ``direction``, the Lyapunov exponents per unit of time with their
        standard errors: ``exponent``, minus infinity where a taut cable removes a direction, and ``exponent_se``, NaN
        if fewer than five periods are kept. Attributes: ``period`` of the motion in periods of the forcing (NaN if it
        is not periodic), ``snaps`` per period, ``y_max``, ``theta_max``, and, if the motion stopped at a limit,
        ``stop``, ``stop_t`` and ``stop_certain``, which is 0 where rounding decides ``stop_t``, otherwise 1. The scale
        of an attribute is in another one, such as ``y_max_scale``.

    Raises
    ------
    ValueError
        If an option is out of its range.

    See Also
    --------
    snapload.orbit_diagram : Computes the section points against a key.
    snapload.Case.orbit : Finds the orbit of a periodic motion.

    Notes
    -----
    The motion does not stop when the body settles or slides. If it stops before the first point, the dataset has no
    points, and there is a warning. Python's lock is released during the computation, and Ctrl-C interrupts it.

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
    data = _section(case, periods, keep, phase, at == "impacts", progress)
    if data["stop"] is not None and not data["points"]:
        warnings.warn(
            f"the motion from this start {_stop_text(data)}, before the first point of the section, which comes after "
            f"{periods - keep} periods of the forcing; use fewer periods, or another start",
            stacklevel=2,
        )
    from ._dataset import title_and_case

    variables: dict[str, Any] = {}
    if at == "impacts":
        coords: dict[str, Any] = {"impact": ("impact", np.arange(1, len(data["impacts"]) + 1))}
        variables |= _impact_variables(data["impacts"])
    else:
        states = np.array([point["state"] for point in data["points"]], dtype=np.float64).reshape(-1, len(STATE))
        k_attrs = {"long_name": "number of the period of the forcing"}
        coords = {"k": ("k", np.array([point["k"] for point in data["points"]], dtype=np.int64), k_attrs)}
        variables |= {
            name: ("k", states[:, place], attributes_as(name, f"{name} at the section"))
            for place, name in enumerate(STATE)
        }
    spectrum = _spectrum(data["exponents"])
    coords["direction"] = ("direction", np.arange(1, len(spectrum[0]) + 1), {"long_name": "direction"})
    for place, name in enumerate(("exponent", "exponent_se")):
        variables[name] = ("direction", spectrum[place], attributes()[name])
    measures = {name: or_nan(data[name]) for name in ("phase", "period", "snaps", "y_max", "theta_max")}
    attrs: dict[str, Any] = dict(title_and_case("A section of a long motion of a body on cables", case._engine))
    if data["stop"] is not None:
        stop = data["stop"]
        attrs |= {"stop": stop["reason"], "stop_certain": int(stop["certain"])}
        measures["stop_t"] = stop["t"]
    return with_own_names(xarray.Dataset(variables, coords, attrs | with_scales(measures)))


@dataclass(frozen=True, repr=False, eq=False)
class LyapunovSpectrum(Result):
    """Lyapunov exponents of a long motion, the largest first.

    ``values, errors = snapload.lyapunov_spectrum(case)`` unpacks the exponents and their standard errors.

    Attributes
    ----------
    values : numpy.ndarray
        The exponents [1/T]: six, or four for a point mass; minus infinity where a taut cable removes a direction.
    standard_errors : numpy.ndarray
        The standard errors [1/T], from twenty batches of periods. They include the amount by which a growth rate that
        is still decreasing may fall, and the accuracy of the linearised motion along taut cables; NaN for fewer than
        four periods, infinite where an exponent has no limit as ``v_stick`` falls.
    periods : int
        Number of forcing periods over which the exponents are averaged.
    transient : int
        Number of forcing periods before these that were left out.

    See Also
    --------
    snapload.lyapunov_spectrum : Computes the exponents.

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
    """Compute the Lyapunov exponents of the long-term motion of a case.

    Parameters
    ----------
    case : Case
        The case, with its start.
    periods : int
        Number of forcing periods over which the exponents are averaged.
    transient : int
        Number of forcing periods before these that are left out.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    LyapunovSpectrum
        The exponents and their standard errors.

    Raises
    ------
    ValueError
        If the motion stops at a limit before the end, or an option is out of its range.

    See Also
    --------
    snapload.section : Samples the motion itself.

    Notes
    -----
    If all snaps happen in slack flight, the sum of the exponents is 2 ln e times the number of snaps per unit of time.

    Examples
    --------
    >>> import math, snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
    >>> spectrum = snapload.lyapunov_spectrum(case, periods=200)
    >>> math.isclose(spectrum.values.sum(), 2 * math.log(0.35) * 2 * 3.1 / math.tau, rel_tol=1e-9)
    True
    """
    periods, transient = whole_number("spectrum.periods", periods), whole_number("spectrum.transient", transient)
    # Growth is measured between sections, so that one more than periods is needed.
    data = _section(case, transient + periods + 1, periods + 1, 0.0, False, progress)
    if data["stop"] is not None:
        raise ValueError(f"the motion from this start {_stop_text(data)}; use another start, or fewer periods")
    values, errors = _spectrum(data["exponents"])
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
    """Compute a bifurcation diagram: follow the attractor along the values of a key.

    The motion at each value starts from the final state of the motion at the previous value.

    Parameters
    ----------
    case : Case
        The case, whose start is the start at the first value.
    periods : int
        Total number of forcing periods at each value.
    keep : int
        Number of forcing periods to keep, at the end of the motion.
    phase : float
        Time of the section, in periods of the forcing. The start is the state at that time, so another phase gives
        another motion.
    down : bool
        Whether to go from the last value to the first. If both directions give different results, there is more than
        one attractor.
    progress : bool
        Whether to show a progress bar if the computation takes long.
    **axis : array_like or str
        The values of the one key that varies, or ``"first:last:n"``.

    Returns
    -------
    xarray.Dataset
        Over the key and ``k``, the number of the period of the forcing: ``x`` to ``vtheta``, NaN where the motion
        stopped at a limit. Over the key: ``period`` in periods of the forcing (NaN if the motion is not periodic),
        ``snaps`` per period, the largest Lyapunov ``exponent`` (minus infinity where taut cables remove all directions)
        with ``exponent_se``, ``y_max``, ``stop`` (empty if the motion did not stop) with ``stop_t`` and
        ``stop_certain``, false where rounding decides that time and otherwise true, and ``restarted``, whether the
        motion started from the start of the case, as it does at the first value, after a stop, and where the last
        state is not legal at the next value, as when ``r`` varies and a cable is taut. The values are in the order in
        which they were followed.

    Raises
    ------
    ValueError
        If there is not exactly one key, orbits do not depend on it, as on a key of the start, a value of it is not
        allowed, or an option is out of its range.

    See Also
    --------
    snapload.continuation : Follows stable and unstable orbits.
    snapload.plot_diagram : Draws the diagram.

    Examples
    --------
    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, nu=0.8, omega=3.1)
    >>> found = snapload.orbit_diagram(case, f_o=snapload.evenly(1.4, 1.5, 3), periods=150, keep=40)
    >>> found.x.dims, found.period.values.tolist()
    (('f_o', 'k'), [1.0, 1.0, 1.0])
    """
    from ._dataset import title_and_case

    if len(axis) != 1:
        given = ", ".join(axis) or "none"
        raise ValueError(f"keys = {given} is not allowed; allowed: one key with its values, such as f_o='0.6:1:41'")
    engine = engine_case(case)
    ((key, values),) = axis.items()
    sampling = whole_number("periods", periods), whole_number("keep", keep), number("phase", phase)
    varied = key, axis_values(key, values)  # type: ignore[arg-type]
    with progress_bar("following the attractor", _count(varied[1]), progress) as report_progress:
        answer, counts, state_data = _engine.diagram(engine, varied, flag("down", down), sampling, report_progress)
    rows, states = json.loads(answer), np.frombuffer(state_data, dtype=np.float64).reshape(-1, len(STATE))
    points = np.full((len(rows), keep + 1, len(STATE)), np.nan)
    filled = 0
    for row, count in enumerate(counts):
        points[row, :count] = states[filled : filled + count]
        filled += count

    variables: dict[str, Any] = {
        name: ((key, "k"), points[:, :, place], attributes_as(name, f"{name} at the section"))
        for place, name in enumerate(STATE)
    }
    known = attributes() | {"exponent": attributes_as("exponent", "largest exponent")}
    for name in ("period", "snaps", "exponent", "exponent_se", "y_max"):
        variables[name] = (key, numbers(rows, name), known[name])
    all_removed = [row["exponent"] is None and row["exponent_se"] is not None for row in rows]
    variables["exponent"][1][all_removed] = -np.inf
    stopped = [row["stop"] or {"reason": "", "t": np.nan, "certain": None} for row in rows]
    stops = np.array([stop["reason"] for stop in stopped], dtype=object)
    variables["stop"] = (key, stops, {"long_name": "which limit stopped the motion"})
    stop_t = np.array([stop["t"] for stop in stopped], dtype=np.float64)
    variables["stop_t"] = (key, stop_t, attributes_as("t", "time at which the motion stopped"))
    certain = np.array([stop["certain"] is not False for stop in stopped], dtype=bool)
    variables["stop_certain"] = (key, certain, {"long_name": "rounding does not decide the time of the stop"})
    restarted = np.array([row["restarted"] for row in rows], dtype=bool)
    variables["restarted"] = (key, restarted, {"long_name": "started again from the start of the case"})
    coords = {
        key: (key, numbers(rows, "value"), attributes()[key]),
        "k": (
            "k",
            np.arange(sampling[0] - sampling[1], sampling[0] + 1),
            {"long_name": "number of the period of the forcing"},
        ),
    }
    title = title_and_case("The attractor of a body on cables against a key", engine)
    return with_own_names(xarray.Dataset(variables, coords, title))


with_keys(orbit_diagram, defaults=False)


def _section(case: Case, periods: int, keep: int, phase: float, impacts: bool, progress: bool) -> dict[str, Any]:
    engine = engine_case(case)
    periods, keep = whole_number("periods", periods), whole_number("keep", keep)
    with progress_bar("following the motion", periods, progress) as report_progress:
        data: dict[str, Any] = json.loads(
            _engine.section(engine, periods, keep, number("phase", phase), impacts, report_progress)
        )
    return data


def _impact_variables(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The impacts one by one, in the columns of the command's table."""
    known = attributes()
    columns: dict[str, tuple[Any, dict[str, str]]] = {
        "t": (np.float64, attributes_as("t", "time")),
        "phase": (np.float64, known["phase"]),
        "cable": (np.int64, {"long_name": "number of the cable"}),
        "v_n": (np.float64, known["v_n"]),
        "impulse": (np.float64, known["impulse"]),
    }
    variables: dict[str, Any] = {
        name: ("impact", np.array([row[name] for row in rows], dtype=kind), attrs)
        for name, (kind, attrs) in columns.items()
    }
    before, after = (
        np.array([row[side] for row in rows], dtype=np.float64).reshape(-1, len(STATE)) for side in ("before", "after")
    )
    for place, name in enumerate(STATE):
        if name.startswith("v"):
            for side, states in (("before", before), ("after", after)):
                attrs = attributes_as(name, f"{name} just {side}")
                variables[f"{name}_{side}"] = ("impact", states[:, place], attrs)
        else:
            variables[name] = ("impact", before[:, place], attributes_as(name, f"{name} at the impact"))
    return variables


def _spectrum(rows: list[dict[str, float | None]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    values = [-np.inf if row["value"] is None else row["value"] for row in rows]
    return np.array(values, dtype=np.float64), np.array([or_nan(row["se"]) for row in rows], dtype=np.float64)


def _stop_text(data: dict[str, Any]) -> str:
    doubt = "" if data["stop"]["certain"] else " (not certain)"
    return f"stops at t = {data['stop']['t']:.4f}{doubt}, {data['stop']['reason'].replace('_', ' ')}"


def _count(values: str | NDArray[Any]) -> int:
    """The number of values, for a progress bar; the engine refuses a range that is not valid."""
    if isinstance(values, str):
        last = values.rsplit(":", 1)[1]
        return int(last) if last.strip().isdigit() else 1
    return len(values)
