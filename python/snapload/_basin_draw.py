"""Pictures of basins, erosion and diagrams with Matplotlib, which are readable without colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._branch_plot import key_label
from ._keys import REASONS
from ._orbit_plot import label, legend_above, new_axes
from ._plot import BLUE, GREEN, ORANGE, REFERENCE, VERMILION

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

#: The colour of each end of a run: light where it is safe, dark where a limit is reached. What is not here is another
#: limit.
_ENDS = {
    "settled": ("#9AD0F3", "settled"),
    "end_time": ("#56B4E9", "continues"),
    "sliding_start": ("#56B4E9", "slides"),
    "impact_limit": ("#56B4E9", "continues"),
    "rotation_limit": (VERMILION, "rotation limit"),
    "upper_bound": ("#7A3B00", "upper bound"),
}
_OTHER_LIMIT = "#5D3A9B"

#: The colours of attractors, in their order; they repeat if there are more attractors.
_ATTRACTORS = ("#9AD0F3", ORANGE, GREEN, "#CC79A7", "#F0E442", BLUE)

#: The colours of cells outside the window, and of motions without a period.
_NOTHING, _APERIODIC = "white", "#BBBBBB"


def draw_basin(basin: xarray.Dataset | xarray.DataArray, ax: Axes | None) -> Axes:
    """Draws a map of cells."""
    axes_of: Any = basin
    if hasattr(basin, "data_vars") and "outcome" in basin.data_vars:
        numbers, looks = _of_ends(np.asarray(basin["outcome"].values))
        undecided = ~basin["decided"].values & basin["legal"].values if "decided" in basin.data_vars else None
        first, second = basin["outcome"].dims
    elif "flag_meanings" in getattr(basin, "attrs", {}):
        numbers, looks = _of_labels(axes_of)
        undecided = None
        first, second = basin.dims
    else:
        allowed = "what snapload.safe_basin gives, or the labels of snapload.basins_of_attraction"
        raise TypeError(f"basin, a {type(basin).__name__}, is not allowed; allowed: {allowed}")
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    ax = new_axes(ax, 0.9)
    x, y = np.asarray(basin[first].values), np.asarray(basin[second].values)
    colours = ListedColormap([_NOTHING, *(colour for colour, _ in looks)])
    norm = BoundaryNorm(np.arange(-0.5, len(looks) + 1), len(looks) + 1)
    ax.pcolormesh(_edges(x), _edges(y), numbers.T, cmap=colours, norm=norm, rasterized=True)
    shown = [Patch(facecolor=colour, edgecolor="black", linewidth=0.4, label=name) for colour, name in looks]
    if undecided is not None and undecided.any():
        _hatch(ax, x, y, undecided)
        shown.append(Patch(facecolor="white", edgecolor="black", hatch="//////", linewidth=0.4, label="undecided"))
    ax.set_xlabel(key_label(str(first)))
    ax.set_ylabel(key_label(str(second)))
    above: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
    ax.legend(handles=shown, fontsize="small", frameon=False, handlelength=1.2, columnspacing=1.0, **above)
    return ax


def _of_ends(outcomes: NDArray[Any]) -> tuple[NDArray[np.int64], list[tuple[str, str]]]:
    """The end of each cell as a number from 1, and the style of each number; 0 is no legal start."""
    numbers = np.zeros(outcomes.shape, dtype=np.int64)
    looks: list[tuple[str, str]] = []
    for word in dict.fromkeys([*_ENDS, *REASONS]):
        look, there = _look_of(word), outcomes == word
        if there.any():
            if look not in looks:
                looks.append(look)
            numbers[there] = looks.index(look) + 1
    return numbers, looks


def _look_of(reason: str) -> tuple[str, str]:
    """The colour and the words of an end."""
    return _ENDS.get(reason, (_OTHER_LIMIT, reason.replace("_", " ")))


def _of_labels(labels: xarray.DataArray) -> tuple[NDArray[np.int64], list[tuple[str, str]]]:
    """The number and the style of each cell, from labels of attractors."""
    values = np.asarray(labels.values)
    words = dict(zip(labels.attrs["flag_values"].tolist(), labels.attrs["flag_meanings"].split(), strict=True))
    numbers = np.zeros(values.shape, dtype=np.int64)
    looks: list[tuple[str, str]] = []
    for value in sorted(set(values.ravel().tolist()) - {-1}, key=lambda value: (value < 1, abs(value))):
        if value > 0:
            look = _ATTRACTORS[(value - 1) % len(_ATTRACTORS)], f"attractor {value}"
        else:
            look = (_APERIODIC, "no period") if value == 0 else _look_of(words[value])
        looks.append(look)
        numbers[values == value] = len(looks)
    return numbers, looks


def _hatch(ax: Axes, x: NDArray[Any], y: NDArray[Any], cells: NDArray[np.bool_]) -> None:
    """Hatches some cells."""
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle

    left, low = _edges(x), _edges(y)
    boxes = [
        Rectangle((left[i], low[j]), left[i + 1] - left[i], low[j + 1] - low[j])
        for i, j in zip(*np.nonzero(cells), strict=True)
    ]
    look: dict[str, Any] = {"facecolor": "none", "edgecolor": "black", "linewidth": 0.3}
    ax.add_collection(PatchCollection(boxes, hatch="//////", **look))


def _edges(values: NDArray[Any]) -> NDArray[np.float64]:
    """Where the cells of evenly spaced values begin and end."""
    half = (values[-1] - values[0]) / (len(values) - 1) / 2 if len(values) > 1 else 0.5
    return np.append(values - half, values[-1] + half)


def draw_erosion(eroded: xarray.Dataset, ax: Axes | None) -> Axes:
    """Draws the safe fraction and the distances."""
    if not hasattr(eroded, "data_vars") or not {"gim", "lim", "if"} <= set(eroded.data_vars):
        allowed = "what snapload.erosion gives"
        raise TypeError(f"eroded, a {type(eroded).__name__}, is not allowed; allowed: {allowed}")
    ax = new_axes(ax, 0.8)
    key = str(eroded["gim"].dims[0])
    values = eroded[key].values
    ax.fill_between(values, eroded["low"], eroded["high"], color=BLUE, alpha=0.25, linewidth=0)
    ax.plot(values, eroded["gim"], color=BLUE, linewidth=1.4, marker="o", markersize=3, label="part (GIM)")
    if (eroded["undecided"] > 0).any():
        # The knee is computed without the undecided cells.
        of_decided: dict[str, Any] = {"color": BLUE, "linestyle": ":", "linewidth": 1.1, "label": "of decided cells"}
        ax.plot(values, eroded["decided_fraction"], **of_decided)
    ax.set_ylim(bottom=0)
    ax.set_xlabel(key_label(key))
    ax.set_ylabel("safe part of the starts")
    if not np.isnan(eroded.attrs["knee"]):
        ax.axvline(eroded.attrs["knee"], **REFERENCE)
        # On the side on which the axes go on.
        side, place = ("right", (-3, 3)) if eroded.attrs["knee"] > np.min(values) else ("left", (3, 3))
        look: dict[str, Any] = {"textcoords": "offset points", "fontsize": "small", "ha": side}
        ax.annotate("knee", (eroded.attrs["knee"], 0), place, **look)
    lines, names = ax.get_legend_handles_labels()
    looks = (("lim", VERMILION, "--", "^", "nearest (LIM)"), ("if", GREEN, "-.", "s", "disc (IF)"))
    shown = [look for look in looks if not np.isnan(eroded[look[0]]).all()]
    if shown:
        right = ax.twinx()
        for name, colour, style, marker, words in shown:
            of: dict[str, Any] = {"color": colour, "linestyle": style, "marker": marker, "markersize": 3}
            right.plot(values, eroded[name], linewidth=1.1, label=words, **of)
        right.set_ylim(bottom=0)
        right.set_ylabel("distance in the window")
        more = right.get_legend_handles_labels()
        lines, names = lines + more[0], names + more[1]
    above: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
    ax.legend(lines, names, fontsize="small", frameon=False, handlelength=1.8, columnspacing=1.0, **above)
    return ax


def draw_diagram(diagram: xarray.Dataset, y: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """Draws section points against a key."""
    if not hasattr(diagram, "data_vars") or not {"stop", "restarted"} <= set(diagram.data_vars):
        allowed = "what snapload.orbit_diagram gives"
        raise TypeError(f"diagram, a {type(diagram).__name__}, is not allowed; allowed: {allowed}")
    known = [str(name) for name, values in diagram.data_vars.items() if "k" in values.dims]
    if y not in known:
        raise ValueError(f"y = {y!r} is not allowed; allowed: {', '.join(map(repr, known))}")
    ax = new_axes(ax, 0.8)
    key = str(diagram["stop"].dims[0])
    values = np.repeat(diagram[key].values, diagram.sizes["k"])
    look: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 1.6, "markeredgewidth": 0}
    ax.plot(values, diagram[y].values.ravel(), **{**look, "color": "black", "rasterized": True, **style})
    stopped = diagram["stop"].values != ""
    if stopped.any():
        places = diagram[key].values[stopped]
        sign: dict[str, Any] = {"color": VERMILION, "marker": "|", "markersize": 6, "linestyle": "none"}
        ax.plot(places, np.zeros(len(places)), transform=ax.get_xaxis_transform(), label="stops at a limit", **sign)
    ax.set_xlabel(key_label(key))
    ax.set_ylabel(label(y))
    legend_above(ax)
    return ax
