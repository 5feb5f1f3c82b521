"""Pictures of a run with Matplotlib, in colours that everybody can distinguish (Okabe & Ito 2008)."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle, islice, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ._run_base import BaseRun

BLUE, VERMILION, GREEN, ORANGE = "#0072B2", "#D55E00", "#009E73", "#E69F00"

#: The colour of motion past the horizon of trust, and of nothing else.
GREY = "#999999"

#: The colour of objects drawn for comparison.
REFERENCE: dict[str, Any] = {"color": "black", "linewidth": 0.7, "linestyle": ":", "zorder": 1}

#: The colours of the cables, in their order; they repeat if there are more cables.
_CABLE_STYLES = ((BLUE, "x"), (VERMILION, "o"), (GREEN, "^"), (ORANGE, "s"), ("#56B4E9", "d"), ("#CC79A7", "v"))

#: Colour and width of the path in each mode.
_MODE_STYLES = {"slack": (BLUE, 0.9), "sliding": (ORANGE, 2.0), "rocking": (GREEN, 2.0)}

#: The width of a column of a journal, and of a page [in].
_COLUMN_WIDTH, _PAGE_WIDTH = 3.5, 7.2

#: Samples of a whole curve, and of each flight in it. A parabola that is drawn in so many pieces is off by less than a
#: thousandth of its height.
_SAMPLES, _FLIGHT_SAMPLES = 2000, 32
#: A flight shorter than this part of the curve is less than a dot wide.
_DOT = 1 / 4000


def draw(run: BaseRun, what: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """Draws one picture."""
    pictures: dict[str, Callable[[BaseRun, Axes, dict[str, Any]], None]] = {
        "trajectory": _trajectory,
        "rotation": _rotation,
        "velocities": _velocities,
        "tensions": _tensions,
    }
    if what not in pictures:
        raise ValueError(f"what = {what!r} is not allowed; allowed: {', '.join(map(repr, pictures))}")
    if ax is None:
        _, ax = pyplot.subplots(figsize=(_COLUMN_WIDTH, 0.75 * _COLUMN_WIDTH), layout="constrained")
    shown = _shown_limits(ax)
    pictures[what](run, ax, style)
    for name, limits, view in zip("xy", shown, (ax.get_xlim(), ax.get_ylim()), strict=True):
        if limits is not None:
            ax.set(**{f"{name}lim": (min(*limits, *view), max(*limits, *view))})
    return ax


def _shown_limits(ax: Axes) -> list[tuple[float, float] | None]:
    """The limits in each direction if something is drawn there, such as another run, in these axes or with them."""
    directions = (
        (ax.get_xlim(), [other.dataLim.intervalx for other in ax.get_shared_x_axes().get_siblings(ax)]),
        (ax.get_ylim(), [other.dataLim.intervaly for other in ax.get_shared_y_axes().get_siblings(ax)]),
    )
    return [limits if any(low <= high for low, high in drawn) else None for limits, drawn in directions]


def overview(run: BaseRun, figure: Figure | None) -> Figure:
    """All four pictures."""
    if figure is None:
        figure = pyplot.figure(figsize=(_PAGE_WIDTH, 0.72 * _PAGE_WIDTH), layout="constrained")
    axes = figure.subplots(2, 2)
    for what, ax in zip(("trajectory", "rotation", "velocities", "tensions"), axes.flat, strict=True):
        draw(run, what, ax, {})
    return figure


def cable_styles(run: BaseRun) -> dict[int, tuple[str, str]]:
    """Colour and marker of each cable, by number."""
    return dict(enumerate(islice(cycle(_CABLE_STYLES), len(run._geometry().cables)), 1))


def axis_label(run: BaseRun, name: str, scale: str) -> str:
    """The name of an axis with its scale; the units of user-defined systems are unknown."""
    return f"{name} [{scale}]" if run._nondimensional else name


def curve_times(run: BaseRun, start: float, stop: float, flight_samples: int = _FLIGHT_SAMPLES) -> NDArray[np.float64]:
    """Times at which a curve is drawn: at every event, where it may have a corner, and enough of them between."""
    modes = run.modes
    events = np.concatenate([run.impacts["t"], modes["t_start"], modes["t_end"]])
    inside = events[(start < events) & (events < stop)]
    corners = np.unique(np.concatenate([[start, stop], inside]))
    spans = np.diff(corners)
    even = np.ceil(_SAMPLES * spans / max(run.end.t, 1e-300)).astype(int)
    pieces = np.where(spans > _DOT * (stop - start), np.maximum(even, flight_samples), 1)
    # Every flight is divided evenly into its number of pieces.
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    parts = (np.arange(pieces.sum()) - first) / np.repeat(pieces, pieces)
    times = np.repeat(corners[:-1], pieces) + parts * np.repeat(spans, pieces)
    return np.union1d(times, corners)


def _mode_segments(run: BaseRun) -> list[tuple[str, float, float, bool]]:
    """Mode intervals, divided where trust ends: mode, start, end, whether it is past the horizon."""
    horizon = run._horizon
    segments = []
    for mode, start, stop in zip(run.modes["mode"], run.modes["t_start"], run.modes["t_end"], strict=True):
        cuts = [start, *([horizon] if start < horizon < stop else []), stop]
        segments += [(mode, a, b, a >= horizon) for a, b in pairwise(cuts)]
    return segments


def _trajectory(run: BaseRun, ax: Axes, style: dict[str, Any]) -> None:
    geometry = run._geometry()
    # A given label is for the whole path.
    given_label = style.pop("label", None)
    labelled: set[str] = set()
    first, last = run.at(0.0), run.at(run.end.t)
    xs, ys = ([float(first[name]), *(place[k] for place in geometry.shown_points)] for k, name in enumerate(("x", "y")))
    for mode, start, stop, past_horizon in _mode_segments(run):
        motion = run.at(curve_times(run, start, stop))
        colour, width = _MODE_STYLES[mode]
        label = given_label or ("past the horizon" if past_horizon else mode)
        line_style = {"color": GREY if past_horizon else colour, "linewidth": width, "zorder": 2 if past_horizon else 3}
        ax.plot(motion.x, motion.y, **{"label": None if label in labelled else label, **line_style, **style})
        labelled.add(label)
        xs += [motion.x.min(), motion.x.max()]
        ys += [motion.y.min(), motion.y.max()]
    ax.plot(first.x, first.y, "o", color="black", markersize=4, zorder=4)
    ax.plot(last.x, last.y, "s", color="black", markersize=4, zorder=4)
    half = 0.6 * max(max(xs) - min(xs), max(ys) - min(ys), 1e-6)
    apart = float(np.hypot(first.x - last.x, first.y - last.y)) > 0.06 * half
    for place, name in ((first, "start"), (last, "end")) if apart else ((first, "start, end"),):
        ax.annotate(name, (float(place.x), float(place.y)), (4, 3), textcoords="offset points", fontsize="small")
    # The positions at which a cable is taut with the body upright.
    middle = (max(xs) + min(xs)) / 2
    x = np.linspace(middle - 1.1 * half, middle + 1.1 * half, 400)
    for (centre_x, centre_y), (_, _, r) in zip(geometry.circle_centres(), geometry.cables, strict=True):
        inside = r**2 - (x - centre_x) ** 2
        reach = np.sqrt(np.where(inside >= 0, inside, np.nan))
        ax.plot([*x, np.nan, *x], [*(centre_y - reach), np.nan, *(centre_y + reach)], **REFERENCE)
    margin = 0.06 * half
    ax.set_xlim(min(xs) - 3 * margin, max(xs) + 3 * margin)
    ax.set_ylim(min(ys) - margin, max(ys) + 2 * margin)
    ax.set_xlabel(axis_label(run, "$x$", "L"))
    ax.set_ylabel(axis_label(run, "$y$", "L"))
    ax.xaxis.set_major_locator(MaxNLocator(5))
    if len(labelled) > 1:
        legend(ax)


def _over_time(run: BaseRun, ax: Axes, quantity: str, label: str | None, line_style: dict[str, Any]) -> None:
    """A quantity over time, grey past the horizon. The curve is interrupted where a tension jumps."""
    label = line_style.pop("label", label)
    for place, (_, start, stop, past_horizon) in enumerate(_mode_segments(run)):
        times = curve_times(run, start, stop)
        # At its end instant a segment already has the state of the next one.
        times[-1] = np.nextafter(stop, start) if stop < run.end.t else stop
        colour = {"color": GREY} if past_horizon else {}
        ax.plot(times, run.at(times)[quantity], **{"label": label if place == 0 else None, **line_style, **colour})


def _rotation(run: BaseRun, ax: Axes, style: dict[str, Any]) -> None:
    _over_time(run, ax, "theta", None, {"color": BLUE, "linewidth": 1.0, **style})
    top = 1.05 * max(run.norms.theta_max, 1e-3)
    ax.set_ylim(-top, top)
    limit = run._geometry().rotation_limit
    for level in () if limit is None else (-limit, limit):
        ax.axhline(level, **REFERENCE)
    _label_time(run, ax, "$\\theta$ [rad]")


def _velocities(run: BaseRun, ax: Axes, style: dict[str, Any]) -> None:
    t, v, cable = (run.impacts[name] for name in ("t", "v_n", "cable"))
    horizon, given_label = run._horizon, style.pop("label", None)
    ax.autoscale(axis="y")
    for number, (colour, marker) in cable_styles(run).items():
        of_cable = (cable == number) & (v > 0)
        line_style = {"linestyle": "none", "marker": marker, "markersize": 4, "markerfacecolor": "none", **style}
        for past_horizon in (True, False):
            shown = of_cable & ((t >= horizon) == past_horizon)
            name = f"cable {number}" if given_label is None else given_label
            label = name if not past_horizon and of_cable.any() else None
            ax.plot(t[shown], v[shown], **{"label": label, "color": GREY if past_horizon else colour, **line_style})
    ax.set_ylim(bottom=0)
    _label_time(run, ax, axis_label(run, "$v_n$", "L/T"))
    if (v > 0).any():
        legend(ax)


def _tensions(run: BaseRun, ax: Axes, style: dict[str, Any]) -> None:
    alone = not ax.lines
    ax.autoscale(axis="y")
    for number, (colour, _) in cable_styles(run).items():
        line_style = {"color": colour, "linewidth": 1.2, "linestyle": "-" if number % 2 else "--", **style}
        _over_time(run, ax, f"T{number}", f"cable {number}", line_style)
    ax.set_ylim(bottom=0)
    if any(run.modes["mode"] != "slack"):
        legend(ax)
    elif alone:
        # Impulses are not drawn here, and without them the panel would be empty.
        ax.text(0.5, 0.5, _without_tensions(run), transform=ax.transAxes, ha="center", fontsize="small")
    _label_time(run, ax, axis_label(run, "tension", "F"))


def _without_tensions(run: BaseRun) -> str:
    """Why no cable has a tension for any time, in words."""
    if run.end.t == 0:
        return "the run ends at t = 0"
    if not (run.impacts["v_n"] > 0).any():
        return "no cable is taut"
    last = run.at(run.end.t)
    until = " before the end" if any(last[f"T{cable}"] > 0 for cable in cable_styles(run)) else ""
    return f"no cable stays taut{until}:\nonly impulses"


def legend(ax: Axes) -> None:
    """A legend in one row above the curves, with each label once."""
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.15 * (high - low))
    handles, labels = ax.get_legend_handles_labels()
    first = {label: handle for handle, label in zip(handles[::-1], labels[::-1], strict=True)}
    ax.legend(
        [first[label] for label in dict.fromkeys(labels)],
        dict.fromkeys(labels),
        fontsize="small",
        framealpha=0.8,
        edgecolor="none",
        loc="upper center",
        ncols=3,
        handlelength=1.4,
        columnspacing=1.0,
        borderpad=0.1,
    )


def _label_time(run: BaseRun, ax: Axes, label: str) -> None:
    ax.set_xlim(0, run.end.t or 1.0)
    ax.set_xlabel(axis_label(run, "$t$", "T"))
    ax.set_ylabel(label)
