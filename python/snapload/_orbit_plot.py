"""Pictures of orbits and branches with Matplotlib, which are readable without colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot
from matplotlib.ticker import MaxNLocator

from ._plot import _CABLES, _COLUMN, _MODES, GREY

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._base_orbit import BaseOrbit

#: Sign and scale of what may stand along an axis.
_SIGNS = {
    "t": ("$t$", "T"),
    "x": ("$x$", "L"),
    "y": ("$y$", "L"),
    "theta": ("$\\theta$", "rad"),
    "vx": ("$\\dot x$", "L/T"),
    "vy": ("$\\dot y$", "L/T"),
    "vtheta": ("$\\dot\\theta$", "rad/T"),
}


def label(name: str, in_scales: bool = True) -> str:
    """The name of an axis; the units of user-defined systems are unknown."""
    sign, scale = _SIGNS[name]
    return f"{sign} [{scale}]" if in_scales or scale == "rad" else sign


def new_axes(ax: Axes | None, height: float = 0.8) -> Axes:
    """The axes to draw into, of the width of a column."""
    if ax is None:
        _, ax = pyplot.subplots(figsize=(_COLUMN, height * _COLUMN), layout="constrained")
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
        if quantity not in _SIGNS:
            raise ValueError(f"{name} = {quantity!r} is not allowed; allowed: {', '.join(map(repr, _SIGNS))}")
    ax, lap = new_axes(ax), orbit.curve()
    only, seen = style.pop("label", None), set()
    real = bool(orbit.admissible)
    before: Any = None
    for number in range(int(lap.leg[-1]) + 1):
        leg = lap[lap.leg == number]
        mode = ("slack", "sliding", "rocking")[min(int(leg.taut[0]), 2)]
        colour, width = _MODES[mode]
        look: dict[str, Any] = {"color": colour, "linewidth": width} if real else {"color": GREY, "linestyle": "--"}
        name = only or (mode if real else "not a motion")
        ax.plot(leg[x], leg[y], **{"label": None if name in seen else name, **look, **style})
        seen.add(name)
        if before is not None:
            # Quantities that jump at a snap.
            ax.plot(*([before[q], leg[q][0]] for q in (x, y)), color="black", linewidth=0.6, linestyle=":")
        before = leg[-1]
    snaps = [row for row in orbit.events if row["kind"] == "snap"]
    for cable in sorted({row["cable"] for row in snaps}):
        colour, marker = _CABLES[(cable - 1) % len(_CABLES)]
        places = lap[[int(np.argmin(np.abs(lap.t - row["t"]))) for row in snaps if row["cable"] == cable]]
        look = {"color": colour, "marker": marker, "markersize": 5, "markerfacecolor": "none"}
        ax.plot(places[x], places[y], label=f"cable {cable}", linestyle="none", **look)
    ax.plot(lap[x][0], lap[y][0], "o", color="black", markersize=3.5, zorder=4)
    ax.set_xlabel(label(x, orbit._in_scales))
    ax.set_ylabel(label(y, orbit._in_scales))
    ax.xaxis.set_major_locator(MaxNLocator(5))
    legend_above(ax, 4)
    return ax
