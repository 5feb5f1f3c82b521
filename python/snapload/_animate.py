"""Animations of a run."""

from __future__ import annotations

import json
import math
from functools import cached_property
from importlib import resources
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy as np
from matplotlib import animation
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from PIL import Image

from ._arguments import whole_number
from ._plot import axis_label, cable_styles, curve_times
from ._progress import progress_bar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._run_base import BaseRun

#: The longest animation, in pictures.
_MAX_FRAMES = 5000

#: The writer of Matplotlib for each file extension.
_WRITERS = {".gif": "pillow", ".mp4": "ffmpeg", ".html": "html"}

#: The most pictures per second of a GIF; browsers slow down those with more.
_MAX_GIF_FPS = 50

#: Pixels in an inch of a GIF or an MP4.
_DPI = 110

#: How long a snap, which has no duration, is shown [s].
_SNAP_SHOWN_S = 0.45

#: The colour of a snap, which is that of no cable.
_SNAP_COLOUR = "#A1121F"


class Animation:
    """An animation of a run, returned by :meth:`snapload.Run.animate`.

    A notebook shows it, with buttons, if it is the last value of a cell.

    See Also
    --------
    snapload.Run.plot : Draws static pictures.

    Examples
    --------
    >>> import snapload
    >>> moving = snapload.Case(f_o=0.31).run().animate(seconds=2)
    >>> "<canvas" in moving._repr_html_()
    True
    """

    def __init__(self, run: BaseRun, *, start: float, stop: float | None, seconds: float, fps: int) -> None:
        end = run.end.t
        if end == 0:
            raise ValueError("this run ends at t = 0, where it starts, so there is nothing to animate")
        stop = end if stop is None else float(stop)
        if not 0 <= start < stop <= end:
            raise ValueError(
                f"start = {start!r}, stop = {stop!r} is not allowed; allowed: 0 <= start < stop <= {end!r}, the end"
            )
        fps = whole_number("fps", fps)
        if not 0 < seconds * fps <= _MAX_FRAMES:
            raise ValueError(
                f"seconds = {seconds!r} is not allowed; allowed: 0 < seconds <= {_MAX_FRAMES / fps:g} at {fps} "
                "pictures per second"
            )
        self._run, self._span, self._fps = run, (float(start), stop), fps
        self._count = max(2, round(seconds * fps))

    @cached_property
    def _html(self) -> str:
        scene = self._scene()
        page = resources.files(__package__).joinpath("animation.html").read_text(encoding="utf-8")
        data = {
            "scene": scene,
            "seconds": self._count / self._fps,
            "colours": scene["colours"],
            "snapColour": _SNAP_COLOUR,
        }
        return page.replace("{id}", f"snapload-{uuid4().hex}").replace("{data}", json.dumps(data))

    def _repr_html_(self) -> str:
        return self._html

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the animation as GIF, MP4 (which needs ffmpeg) or HTML, depending on the file extension.

        Parameters
        ----------
        path : path-like
            The file to write; an existing file is overwritten.

        Returns
        -------
        pathlib.Path
            The path of the file.

        Raises
        ------
        ValueError
            If the extension is a different one, or ffmpeg is needed and not available, or a GIF would have more than
            50 frames per second.

        See Also
        --------
        snapload.Run.animate : Creates the animation.

        Examples
        --------
        >>> import snapload, tempfile
        >>> moving = snapload.Case(f_o=0.31).run().animate(seconds=0.4, fps=10)
        >>> moving.save(f"{tempfile.mkdtemp()}/run.gif").name
        'run.gif'
        """
        target = Path(fspath(path))
        writer = _WRITERS.get(target.suffix.lower())
        if writer is None:
            raise ValueError(f"path = {str(target)!r} is not allowed; allowed: a name that ends in .gif, .mp4 or .html")
        if writer == "html":
            target.write_text(self._html, encoding="utf-8")
            return target
        if not animation.writers.is_available(writer):
            raise ValueError(f"{target}: there is no {writer} on this machine; install it, or write a .gif or .html")
        if writer == "pillow" and self._fps > _MAX_GIF_FPS:
            raise ValueError(f"fps = {self._fps} is not allowed; allowed: at most {_MAX_GIF_FPS} in a GIF")
        canvas, drawn, move = self._drawing()
        with progress_bar(f"writing {target.name}", self._count, visible=True) as report_progress:

            def one_more(*_: object) -> None:
                if report_progress:
                    report_progress(1)

            if writer == "pillow":
                _save_gif(target, _pictures(canvas, drawn, move, self._count, one_more), self._fps)
            else:
                film = animation.FuncAnimation(canvas.figure, move, frames=self._count, interval=1000 / self._fps)
                movie_writer = animation.writers[writer](fps=self._fps)
                film.save(target, writer=movie_writer, dpi=_DPI, progress_callback=one_more)
        return target

    def _scene(self) -> dict[str, Any]:
        return _scene_data(self._run, *self._span, self._count, self._fps)

    def _drawing(self) -> tuple[Any, list[Artist], Callable[[int], list[Artist]]]:
        """A canvas, which Matplotlib leaves untyped, what is drawn in its axes, and what moves that to a frame."""
        figure = Figure(figsize=(5.0, 3.6), layout="constrained", dpi=_DPI)
        canvas: Any = FigureCanvasAgg(figure)
        ax = figure.subplots()
        move = _draw_scene(ax, self._scene())
        # The layout is computed once and not for every picture.
        canvas.draw()
        figure.set_layout_engine("none")
        drawn: list[Artist] = [*ax.lines, *ax.patches, *ax.texts]
        return canvas, sorted(drawn, key=lambda artist: artist.get_zorder()), move


def _pictures(
    canvas: Any,
    drawn: list[Artist],
    move: Callable[[int], object],
    count: int,
    one_more: Callable[[], object],
) -> Iterator[Image.Image]:
    """The pictures of an animation. The axes, which take most of the time, are drawn once."""
    for artist in drawn:
        artist.set_animated(True)
    canvas.draw()
    axes_alone = canvas.copy_from_bbox(canvas.figure.bbox)
    for k in range(count):
        move(k)
        canvas.restore_region(axes_alone)
        for artist in drawn:
            artist.draw(canvas.renderer)
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
        one_more()


def _save_gif(target: Path, pictures: Iterator[Image.Image], fps: int) -> None:
    """Writes a GIF that lasts as long as it should.

    A GIF counts in hundredths of a second, and Matplotlib's own writer shortens every picture to whole ones.
    """
    first, *others = pictures
    ends = np.round(100 / fps * np.arange(len(others) + 2))
    durations_ms = (10 * np.diff(ends)).astype(int).tolist()
    first.save(target, format="GIF", save_all=True, append_images=others, duration=durations_ms, loop=0)


def _scene_data(run: BaseRun, start: float, stop: float, count: int, fps: int) -> dict[str, Any]:
    """The data of the scene: its fixed parts, and at each time the position of the body and the state of the cables.

    A cable is taut or slack. A snap is its brightness, which begins at 1 and fades.
    """
    geometry = run._geometry()
    outline, half_extent = geometry.outline(), geometry.half_extent()
    anchors = [list(anchor) for anchor, _, _ in geometry.cables]
    path, times = run.at(curve_times(run, start, stop, 12)), np.linspace(start, stop, count)
    frames = run.at(times)
    t, cables, v_n = (run.impacts[name] for name in ("t", "cable", "v_n"))
    numbers = range(1, len(anchors) + 1)
    playing_s = (count - 1) / fps / (stop - start) * times
    snaps_s = [(count - 1) / fps / (stop - start) * t[(cables == cable) & (v_n > 0)] for cable in numbers]
    xs, ys = [x for x, _ in anchors], [y for _, y in anchors]
    left, right = min(*xs, path.x.min() - half_extent), max(*xs, path.x.max() + half_extent)
    low, high = min(*ys, path.y.min() - 1.3 * half_extent), max(*ys, path.y.max() + 1.3 * half_extent)
    size = max(right - left, high - low)
    # Far more digits than a picture shows, and no more, as a page holds thousands of these numbers.
    decimals, time_decimals = _decimals(size, 5), _decimals(stop - start, 6)
    return {
        "anchors": anchors,
        "names": [axis_label(run, "$x$", "L"), axis_label(run, "$y$", "L")],
        "colours": [colour for colour, _ in cable_styles(run).values()],
        "fairleads": [list(fairlead) for _, fairlead, _ in geometry.cables],
        "outline": outline.round(_decimals(half_extent, 5)).tolist(),
        "box": [left - 0.03 * size, right + 0.03 * size, low - 0.03 * size, high + 0.03 * size],
        "path": np.column_stack([path.t.round(time_decimals), path.x.round(decimals), path.y.round(decimals)]).tolist(),
        "frames": np.column_stack(
            [times.round(time_decimals), *(frames[name].round(decimals) for name in ("x", "y")), frames.theta.round(5)]
        ).tolist(),
        "taut": [(frames[f"T{cable}"] > 0).astype(int).tolist() for cable in numbers],
        "snaps": [_brightness(playing_s, snaps, fps).round(3).tolist() for snaps in snaps_s],
        "clockDecimals": max(2, _decimals(stop - start, 2)),
    }


def _decimals(size: float, digits: int) -> int:
    """The number of decimals that numbers of this size have, with so many digits after the first one."""
    return digits - math.floor(math.log10(size))


def _brightness(playing_s: NDArray[np.float64], snaps_s: NDArray[np.float64], fps: int) -> NDArray[np.float64]:
    """How bright the last snap of a cable still is in each picture, from 1 at the snap to 0."""
    # Every snap is seen in one picture at least.
    shown_s = max(_SNAP_SHOWN_S, 2 / fps)
    last = np.concatenate([[-np.inf], snaps_s])[np.searchsorted(snaps_s, playing_s, side="right")]
    brightness: NDArray[np.float64] = np.maximum(1 - (playing_s - last) / shown_s, 0.0)
    return brightness


def _draw_scene(ax: Axes, scene: dict[str, Any]) -> Callable[[int], list[Artist]]:
    """Draws the fixed parts, and returns the function that moves the other parts to a frame."""
    anchors, fairleads, outline, path, frames = (
        np.array(scene[name]) for name in ("anchors", "fairleads", "outline", "path", "frames")
    )
    left, right, low, high = scene["box"]
    ax.set_xlim(left, right)
    ax.set_ylim(low, high)
    ax.set_aspect("equal")
    ax.set_xlabel(scene["names"][0])
    ax.set_ylabel(scene["names"][1])
    ax.plot(*anchors.T, "^", color="black", markersize=7)
    ax.plot(*path[:, 1:].T, color="black", linewidth=0.4, alpha=0.35)
    lines = [ax.plot([], [], solid_capstyle="round", color=colour)[0] for colour in scene["colours"]]
    snap_style: dict[str, Any] = {"fillstyle": "none", "color": _SNAP_COLOUR, "markeredgewidth": 1.6, "zorder": 5}
    rings = [ax.plot([], [], "o", **snap_style)[0] for _ in lines]
    (trail,) = ax.plot([], [], color="black", linewidth=0.9, zorder=4)
    body = Polygon(outline, facecolor="white", edgecolor="black")
    ax.add_patch(body)
    time_text = ax.text(0.5, 0.95, "", transform=ax.transAxes, ha="center", va="top", fontsize="small")

    def move(k: int) -> list[Artist]:
        now, x, y, theta = frames[k]
        sine, cosine = np.sin(theta), np.cos(theta)
        turn, centre = np.array([[cosine, -sine], [sine, cosine]]), np.array([x, y])
        body.set_xy(outline @ turn.T + centre)
        past = path[path[:, 0] <= now]
        trail.set_data(past[:, 1], past[:, 2])
        for cable, (line, ring) in enumerate(zip(lines, rings, strict=True)):
            fairlead = turn @ fairleads[cable] + centre
            line.set_data(*np.column_stack([anchors[cable], fairlead]))
            taut, bright = scene["taut"][cable][k], scene["snaps"][cable][k]
            line.set(linewidth=2.4 if taut else 0.9, linestyle="-" if taut else "--")
            ring.set_data(*fairlead[:, None])
            ring.set(alpha=bright, markersize=16 - 8 * bright)
        time_text.set_text(f"$t$ = {now:.{scene['clockDecimals']}f}")
        return [*lines, *rings, trail, body, time_text]

    return move
