"""Pictures of basins, erosion and diagrams with Matplotlib, which are readable without colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._branch_plot import key_label, own_unit
from ._keys import REASONS
from ._orbit_plot import label, legend_above, new_axes
from ._plot import BLUE, GREEN, GREY, ORANGE, REFERENCE, VERMILION

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

#: The colour of each end of a run: light where it is safe, dark where a limit is reached. An end that is
#: absent is another limit.
_ENDS = {
    "settled": ("#9AD0F3", "settled"),
    "end_time": ("#56B4E9", "continues"),
    "sliding_start": ("#F4EC8B", "slides"),
    "impact_limit": (GREY, "cut short"),
    "standstill": (GREY, "cut short"),
    "rotation_limit": (VERMILION, "rotation limit"),
    "upper_bound": ("#7A3B00", "upper bound"),
}
_OTHER_LIMIT = "#5D3A9B"

#: The colours of attractors, in their order; they repeat if there are more attractors.
_ATTRACTORS = ("#9AD0F3", ORANGE, GREEN, "#CC79A7", "#F0E442", BLUE)

#: The colours of cells outside the window, and of motions without a period.
_OUTSIDE_COLOUR, _APERIODIC_COLOUR = "white", "#BBBBBB"


def draw_basin(basin: xarray.Dataset | xarray.DataArray, ax: Axes | None) -> Axes:
    """Draws a map of cells."""
    label_array: Any = basin
    if hasattr(basin, "data_vars") and "outcome" in basin.data_vars:
        numbers, styles = _end_numbers(np.asarray(basin["outcome"].values))
        undecided = ~basin["decided"].values & basin["legal"].values if "decided" in basin.data_vars else None
        first, second = basin["outcome"].dims
    elif "flag_meanings" in getattr(basin, "attrs", {}):
        numbers, styles = _label_numbers(label_array)
        undecided = ~basin["decided"].values & (label_array.values != -1) if "decided" in basin.coords else None
        first, second = basin.dims
    else:
        allowed = "what snapload.safe_basin gives, or the labels of snapload.basins_of_attraction"
        raise TypeError(f"basin, a {type(basin).__name__}, is not allowed; allowed: {allowed}")
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    ax = new_axes(ax, 0.9)
    x, y = np.asarray(basin[first].values), np.asarray(basin[second].values)
    colours = ListedColormap([_OUTSIDE_COLOUR, *(colour for colour, _ in styles)])
    norm = BoundaryNorm(np.arange(-0.5, len(styles) + 1), len(styles) + 1)
    ax.pcolormesh(_edges(x), _edges(y), numbers.T, cmap=colours, norm=norm, rasterized=True)
    shown = [Patch(facecolor=colour, edgecolor="black", linewidth=0.4, label=name) for colour, name in styles]
    if undecided is not None and undecided.any():
        _hatch(ax, x, y, undecided)
        shown.append(Patch(facecolor="white", edgecolor="black", hatch="//////", linewidth=0.4, label="undecided"))
    ax.set_xlabel(_axis_label(basin, str(first)))
    ax.set_ylabel(_axis_label(basin, str(second)))
    legend_options: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
    ax.legend(handles=shown, fontsize="small", frameon=False, handlelength=1.2, columnspacing=1.0, **legend_options)
    return ax


def _end_numbers(outcomes: NDArray[Any]) -> tuple[NDArray[np.int64], list[tuple[str, str]]]:
    """The end of each cell as a number from 1, and the style of each number; 0 is no legal start."""
    numbers = np.zeros(outcomes.shape, dtype=np.int64)
    styles: list[tuple[str, str]] = []
    for word in dict.fromkeys([*_ENDS, *REASONS]):
        style, cells = _end_style(word), outcomes == word
        if cells.any():
            if style not in styles:
                styles.append(style)
            numbers[cells] = styles.index(style) + 1
    return numbers, styles


def _end_style(reason: str) -> tuple[str, str]:
    """The colour and the words of an end."""
    return _ENDS.get(reason, (_OTHER_LIMIT, reason.replace("_", " ")))


def _label_numbers(labels: xarray.DataArray) -> tuple[NDArray[np.int64], list[tuple[str, str]]]:
    """The number and the style of each cell, from labels of attractors."""
    values = np.asarray(labels.values)
    words = dict(zip(labels.attrs["flag_values"].tolist(), labels.attrs["flag_meanings"].split(), strict=True))
    numbers = np.zeros(values.shape, dtype=np.int64)
    styles: list[tuple[str, str]] = []
    for value in sorted(set(values.ravel().tolist()) - {-1}, key=lambda value: (value < 1, abs(value))):
        if value > 0:
            style = _ATTRACTORS[(value - 1) % len(_ATTRACTORS)], f"attractor {value}"
        else:
            style = (_APERIODIC_COLOUR, "no period found") if value == 0 else _end_style(words[value])
        styles.append(style)
        numbers[values == value] = len(styles)
    return numbers, styles


def _hatch(ax: Axes, x: NDArray[Any], y: NDArray[Any], cells: NDArray[np.bool_]) -> None:
    """Hatches some cells."""
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle

    left, low = _edges(x), _edges(y)
    boxes = [
        Rectangle((left[i], low[j]), left[i + 1] - left[i], low[j + 1] - low[j])
        for i, j in zip(*np.nonzero(cells), strict=True)
    ]
    hatch_style: dict[str, Any] = {"facecolor": "none", "edgecolor": "black", "linewidth": 0.3}
    ax.add_collection(PatchCollection(boxes, hatch="//////", **hatch_style))


def _axis_label(results: xarray.Dataset | xarray.DataArray, key: str) -> str:
    """The name of the axis of a key, whose values may be in SI units."""
    return key_label(key, own_unit(results[key].attrs))


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
    eroded = eroded.sortby(key)
    values = eroded[key].values
    ax.fill_between(values, eroded["low"], eroded["high"], color=BLUE, alpha=0.25, linewidth=0)
    ax.plot(values, eroded["gim"], color=BLUE, linewidth=1.4, marker="o", markersize=3, label="part (GIM)")
    if (eroded["undecided"] > 0).any():
        # The knee is computed without the undecided cells.
        decided_style: dict[str, Any] = {
            "color": BLUE,
            "linestyle": ":",
            "linewidth": 1.1,
            "label": "of decided cells",
        }
        ax.plot(values, eroded["decided_fraction"], **decided_style)
    ax.set_ylim(bottom=0)
    ax.set_xlabel(_axis_label(eroded, key))
    ax.set_ylabel("safe part of the starts")
    if not np.isnan(eroded.attrs["knee"]):
        ax.axvline(eroded.attrs["knee"], **REFERENCE)
        # On the side on which the axes continue.
        side, place = ("right", (-3, 3)) if eroded.attrs["knee"] > np.min(values) else ("left", (3, 3))
        text_options: dict[str, Any] = {"textcoords": "offset points", "fontsize": "small", "ha": side}
        ax.annotate("knee", (eroded.attrs["knee"], 0), place, **text_options)
    lines, names = ax.get_legend_handles_labels()
    measures = (("lim", VERMILION, "--", "^", "nearest (LIM)"), ("if", GREEN, "-.", "s", "disc (IF)"))
    defined = [measure for measure in measures if not np.isnan(eroded[measure[0]]).all()]
    if defined:
        right = ax.twinx()
        for name, colour, style, marker, legend_name in defined:
            line_options: dict[str, Any] = {"color": colour, "linestyle": style, "marker": marker, "markersize": 3}
            right.plot(values, eroded[name], linewidth=1.1, label=legend_name, **line_options)
        right.set_ylim(bottom=0)
        measured = eroded[defined[0][0]].attrs
        unit = own_unit(measured) or measured.get("scale", "")
        right.set_ylabel(f"distance in the window [{unit}]" if unit else "distance in the window")
        more = right.get_legend_handles_labels()
        lines, names = lines + more[0], names + more[1]
    legend_options: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
    ax.legend(lines, names, fontsize="small", frameon=False, handlelength=1.8, columnspacing=1.0, **legend_options)
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
    marker_style: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 1.6, "markeredgewidth": 0}
    ax.plot(values, diagram[y].values.ravel(), **{**marker_style, "color": "black", "rasterized": True, **style})
    stopped = diagram["stop"].values != ""
    if stopped.any():
        stopped_at = diagram[key].values[stopped]
        stop_style: dict[str, Any] = {"color": VERMILION, "marker": "|", "markersize": 6, "linestyle": "none"}
        ax.plot(
            stopped_at,
            np.zeros(len(stopped_at)),
            transform=ax.get_xaxis_transform(),
            label="stops at a limit",
            **stop_style,
        )
    ax.set_xlabel(_axis_label(diagram, key))
    ax.set_ylabel(label(y, unit=own_unit(diagram[y].attrs)))
    legend_above(ax)
    return ax
