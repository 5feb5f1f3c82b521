"""Pictures of branches with Matplotlib, which are readable without colour."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ._orbit_base import STATE
from ._orbit_plot import label, legend_above, new_axes
from ._plot import BLUE, GREEN, GREY, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._branch import Branch

#: How a part of a branch is drawn, by the stability of its orbits.
_LINE_STYLES: dict[str, dict[str, Any]] = {
    "stable": {"color": BLUE, "linewidth": 1.8, "linestyle": "-"},
    "unstable": {"color": VERMILION, "linewidth": 1.1, "linestyle": (0, (4, 1.5))},
    "neutral": {"color": GREEN, "linewidth": 1.4, "linestyle": (0, (5, 1, 1, 1))},
    "not a motion": {"color": GREY, "linewidth": 1.0, "linestyle": (0, (1, 1.2))},
}

#: The marker of each kind of event; a kind that is absent is another limit.
_MARKERS = {
    "fold": "o",
    "period_doubling": "s",
    "neimark_sacker": "D",
    "branch_point": "p",
    "graze": "^",
    "corner": "X",
    "tension_lost": "v",
    "rotation_limit": "*",
    "upper_bound": "P",
}
_OTHER_LIMIT = "H"


def draw_branch(branch: Branch, y: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """Draws a branch against its key."""
    known = (*(name for name in STATE if name != branch.along), "largest_multiplier")
    if y not in known:
        raise ValueError(f"y = {y!r} is not allowed; allowed: {', '.join(map(repr, known))}")
    ax, points, events = new_axes(ax, 0.95), branch.points, branch.events
    point_kinds = points.stability.where(points.admissible, "not a motion").values
    # Events are among the points, as the stability of a branch changes there.
    order = np.argsort(np.concatenate([points.arclength.values, events["arclength"]]), kind="stable")
    values = np.concatenate([points[branch.along].values, events["value"]])[order]
    heights = np.concatenate([points[y].values, events[y]])[order]
    ordered = np.concatenate([np.where(point_kinds == "superstable", "stable", point_kinds), [""] * len(events)])[order]
    symbols = np.concatenate([points.symbol.values, [""] * len(events)])[order]
    for place in range(len(ordered) - 1, -1, -1):
        if ordered[place] == "":
            adjacent = [k for k in (place - 1, place + 1) if 0 <= k < len(ordered) and symbols[k] != ""]
            nearest = min(adjacent, key=lambda k: abs(heights[k] - heights[place]), default=place)
            ordered[place] = ordered[min(place + 1, len(ordered) - 1)] or ordered[place - 1]
            symbols[place] = symbols[nearest]
    kinds = ordered
    # The velocity at the section jumps where an event passes it.
    jumps = y in ("vx", "vy", "vtheta")
    cuts = [k for k in range(1, len(values)) if kinds[k] != kinds[k - 1] or (jumps and symbols[k] != symbols[k - 1])]
    given_label, labelled = style.pop("label", None), set()
    for start, stop in pairwise([0, *cuts, len(values)]):
        kind = str(kinds[start])
        joined = stop < len(values) and not (jumps and symbols[stop] != symbols[stop - 1])
        part = slice(start, stop + 1 if joined else stop)
        name = given_label or kind
        ax.plot(
            values[part], heights[part], **{"label": None if name in labelled else name, **_LINE_STYLES[kind], **style}
        )
        labelled.add(name)
    marker_style: dict[str, Any] = {"linestyle": "none", "color": "black", "markerfacecolor": "white", "markersize": 5}
    for kind in dict.fromkeys([*_MARKERS, *events["kind"]]):
        of_kind = events["kind"] == kind
        if of_kind.any():
            name, marker = kind.replace("_", " "), _MARKERS.get(kind, _OTHER_LIMIT)
            ax.plot(events["value"][of_kind], events[y][of_kind], label=name, marker=marker, zorder=5, **marker_style)
    ax.set_xlabel(str(key_label(branch.along)))
    ax.set_ylabel("largest |multiplier|" if y == "largest_multiplier" else label(y))
    if y == "largest_multiplier":
        ax.axhline(1.0, color="black", linewidth=0.7, linestyle=":", zorder=1)
    legend_above(ax, 2)
    return ax


def key_label(key: str, unit: str = "") -> str:
    """The name of the axis of a key, with the unit of its values if they have one, else with its scale."""
    from ._schema import attributes

    symbols = {"f_o": "$f_o$", "nu": "$\\nu$", "omega": "$\\Omega$", "e": "$e$", "r": "$r$"}
    key_attrs = attributes()[key]
    if key in STATE:
        return label(key, unit=unit)
    shown = unit or key_attrs.get("scale") or own_unit(key_attrs)
    return f"{symbols.get(key, key)} [{shown}]" if shown else symbols.get(key, key)


def own_unit(attrs: Any) -> str:
    """The unit of numbers by their metadata; empty if they have no dimension or are in scales of the case."""
    unit: str = attrs.get("units", "1")
    return "" if unit == "1" else unit
