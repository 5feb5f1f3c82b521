"""A run as a moving picture."""

from __future__ import annotations

from functools import cached_property
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import animation, pyplot, rc_context
from matplotlib.patches import Polygon

from ._check import whole
from ._plot import CABLES, GREY, geometry, times_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

    from ._run import Run

#: The longest animation, in pictures.
_MOST_FRAMES = 5000

#: What can be written, by ending, and by which writer of Matplotlib.
_WRITERS = {".gif": "pillow", ".mp4": "ffmpeg", ".html": "html"}


class Animation:
    """A moving picture of a run; made by :meth:`snapload.Run.animate`.

    The last value of a notebook's cell shows it, with buttons.
    """

    def __init__(self, run: Run, *, start: float, stop: float | None, seconds: float, fps: int) -> None:
        end = run.end.t
        stop = end if stop is None else float(stop)
        if not 0 <= start < stop <= end:
            raise ValueError(
                f"start = {start!r}, stop = {stop!r} is not allowed; allowed: 0 <= start < stop <= {end!r}, the end"
            )
        fps = whole("fps", fps, 1, 120)
        if not 0 < seconds * fps <= _MOST_FRAMES:
            raise ValueError(
                f"seconds = {seconds!r} is not allowed; allowed: 0 < seconds <= {_MOST_FRAMES / fps:g} at {fps} "
                "pictures a second"
            )
        self._run, self._span, self._fps = run, (float(start), stop), fps
        self._count = max(2, round(seconds * fps))

    @cached_property
    def _html(self) -> str:
        figure, artist = self._animation()
        try:
            with rc_context({"animation.embed_limit": 100.0}):
                html: str = artist.to_jshtml(fps=self._fps, default_mode="loop")
                return html
        finally:
            pyplot.close(figure)

    def _repr_html_(self) -> str:
        return self._html

    def save(self, path: str | PathLike[str]) -> Path:
        """Writes the animation as GIF, MP4 (which takes ffmpeg) or HTML, by the ending of the file.

        Raises
        ------
        ValueError
            If the ending is another one, or ffmpeg is asked for and not there.
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
        figure, artist = self._animation()
        try:
            artist.save(target, writer=writer, fps=self._fps, dpi=110)
        finally:
            pyplot.close(figure)
        return target

    def _animation(self) -> tuple[Figure, animation.FuncAnimation]:
        figure, ax = pyplot.subplots(figsize=(5.0, 3.6), layout="constrained", dpi=80)
        update = _scene(self._run, ax, *self._span)
        times = np.linspace(*self._span, self._count)
        moving = animation.FuncAnimation(figure, update, frames=times.tolist(), interval=1000 / self._fps, blit=True)
        return figure, moving


def _scene(run: Run, ax: Any, start: float, stop: float) -> Callable[[float], Iterable[Artist]]:
    """Draws what stands still, and returns what moves the rest to a time."""
    _, a, b, h = geometry(run)
    anchors = np.array([[1.0, h + b], [-1.0, h + b]])
    fairleads = np.array([[a, b], [-a, b]])
    angles = np.linspace(0, 2 * np.pi, 60)
    corners = np.array([[a, b], [-a, b], [-a, -b], [a, -b]])
    outline = corners if b > 0 else a * np.column_stack([np.cos(angles), np.sin(angles)])
    path = run.at(times_of(run, start, stop))
    t, cables = run.impacts["t"], run.impacts["cable"]
    flash = 4 * (stop - start) / 100

    size = max(a, b, 0.02)
    ax.set_xlim(min(-1.08, path.x.min() - 1.5 * size), max(1.08, path.x.max() + 1.5 * size))
    ax.set_ylim(path.y.min() - 1.5 * size, h + b + 0.08)
    ax.set_aspect("equal")
    ax.set_xlabel("$x$ [L]")
    ax.set_ylabel("$y$ [L]")
    ax.plot(*anchors.T, "^", color="black", markersize=7)
    ax.plot(path.x, path.y, color=GREY, linewidth=0.5, alpha=0.5)
    lines = [ax.plot([], [], solid_capstyle="round")[0] for _ in range(2)]
    (trail,) = ax.plot([], [], color="black", linewidth=0.9)
    body = ax.add_patch(Polygon(outline if size > 0.02 else outline + 0.01, facecolor="0.85", edgecolor="black"))
    (mark,) = ax.plot([], [], "o", color="black", markersize=3)
    clock = ax.text(0.5, 0.97, "", transform=ax.transAxes, ha="center", va="top", fontsize="small")

    def move(now: float) -> Iterable[Artist]:
        at = run.at(now)
        sine, cosine = np.sin(at.theta), np.cos(at.theta)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        centre = np.array([at.x, at.y])
        body.set_xy(outline @ turn.T + centre)
        mark.set_data([at.x], [at.y])
        behind = path[path.t <= now]
        trail.set_data(behind.x, behind.y)
        for k, line in enumerate(lines):
            end = turn @ fairleads[k] + centre
            line.set_data(*np.column_stack([anchors[k], end]))
            struck = bool(np.any((cables == k + 1) & (now - flash < t) & (t <= now)))
            taut = at[f"T{k + 1}"] > 0
            colour, _ = CABLES[k + 1]
            line.set(color=colour, linewidth=2.4 if taut or struck else 0.9, linestyle="-" if taut or struck else "--")
        clock.set_text(f"$t$ = {now:.2f}")
        return [*lines, trail, body, mark, clock]

    return move
