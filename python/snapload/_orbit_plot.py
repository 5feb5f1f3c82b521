"""Pictures of orbits and branches with Matplotlib, which are readable without colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot
from matplotlib.ticker import MaxNLocator

from ._plot import _CABLE_STYLES, _COLUMN_WIDTH, _MODE_STYLES, GREY

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._orbit_base import BaseOrbit

#: Symbol and scale of the quantities that an axis may have.
_AXIS_SYMBOLS = {
    "t": ("$t$", "T"),
    "x": ("$x$", "L"),
    "y": ("$y$", "L"),
    "theta": ("$\\theta$", "rad"),
    "vx": ("$\\dot x$", "L/T"),
    "vy": ("$\\dot y$", "L/T"),
    "vtheta": ("$\\dot\\theta$", "rad/T"),
}


def label(name: str, nondimensional: bool = True, unit: str = "") -> str:
    """The name of an axis, with the unit of its numbers if they have one; those of user-defined systems are unknown."""
    symbol, scale = _AXIS_SYMBOLS[name]
    shown = unit or (scale if nondimensional or scale == "rad" else "")
    return f"{symbol} [{shown}]" if shown else symbol


def new_axes(ax: Axes | None, height: float = 0.8) -> Axes:
    """The axes to draw into, of the width of a column."""
    if ax is None:
        _, ax = pyplot.subplots(figsize=(_COLUMN_WIDTH, height * _COLUMN_WIDTH), layout="constrained")
    return ax


def legend_above(ax: Axes, columns: int = 3) -> None:
    """A legend above the axes, where it hides nothing."""
    if ax.get_legend_handles_labels()[0]:
        ax.legend(
            fontsize="small",
            frameon=False,
            loc="lower center",
            bbox_to_anchor=(0.5, 1.0),
            ncols=columns,
            handlelength=1.8,
            columnspacing=1.0,
            borderpad=0.1,
        )


def draw_orbit(orbit: BaseOrbit, x: str, y: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """Draws one period of an orbit."""
    for name, quantity in (("x", x), ("y", y)):
        if quantity not in _AXIS_SYMBOLS:
            raise ValueError(f"{name} = {quantity!r} is not allowed; allowed: {', '.join(map(repr, _AXIS_SYMBOLS))}")
    ax, cycle = new_axes(ax), orbit.curve()
    given_label, labelled = style.pop("label", None), set()
    admissible = bool(orbit.admissible)
    previous_end: Any = None
    for number in range(int(cycle.leg[-1]) + 1):
        leg = cycle[cycle.leg == number]
        mode = ("slack", "sliding", "rocking")[min(int(leg.taut[0]), 2)]
        colour, width = _MODE_STYLES[mode]
        line_style: dict[str, Any] = (
            {"color": colour, "linewidth": width} if admissible else {"color": GREY, "linestyle": "--"}
        )
        name = given_label or (mode if admissible else "not a motion")
        ax.plot(leg[x], leg[y], **{"label": None if name in labelled else name, **line_style, **style})
        labelled.add(name)
        if previous_end is not None:
            # Quantities that jump at a snap.
            ax.plot(*([previous_end[q], leg[q][0]] for q in (x, y)), color="black", linewidth=0.6, linestyle=":")
        previous_end = leg[-1]
    snaps = [row for row in orbit.events if row["kind"] == "snap"]
    for cable in sorted({row["cable"] for row in snaps}):
        colour, marker = _CABLE_STYLES[(cable - 1) % len(_CABLE_STYLES)]
        snap_points = cycle[[int(np.argmin(np.abs(cycle.t - row["t"]))) for row in snaps if row["cable"] == cable]]
        line_style = {"color": colour, "marker": marker, "markersize": 5, "markerfacecolor": "none"}
        ax.plot(snap_points[x], snap_points[y], label=f"cable {cable}", linestyle="none", **line_style)
    ax.plot(cycle[x][0], cycle[y][0], "o", color="black", markersize=3.5, zorder=4)
    ax.set_xlabel(label(x, orbit._nondimensional))
    ax.set_ylabel(label(y, orbit._nondimensional))
    ax.xaxis.set_major_locator(MaxNLocator(5))
    legend_above(ax, 4)
    return ax
