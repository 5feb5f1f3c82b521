"""Draws images/mooring.svg: the mooring, with the keys of a case where they belong.

Run ``python docs/draw_mooring.py`` after a key was added; a test fails where one is missing in the picture.
"""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.patches import Ellipse, Polygon

TARGET = Path(__file__).parent / "images" / "mooring.svg"
BLUE, VERMILION, GREEN = "#0072B2", "#D55E00", "#009E73"
#: What is drawn: length of the cables, half-width and half-height of the body, where it is, how it is turned.
R, A, B, X, Y, THETA = 1.5, 0.3, 0.17, 0.36, 0.3, 0.35
#: Keys that have no place in a picture.
BESIDE = (
    "body: rigid or point (a = b = 0); inertia: of the body about its centre\n"
    "e: a snap leaves −e times v_n; v_stick: a slower snap may stick\n"
    "t_end, and the other keys of the stops: when a run ends"
)


def arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], style: str = "-|>", **look: object) -> None:
    props = {"arrowstyle": style, "color": "black", "lw": 1.0, "shrinkA": 0, "shrinkB": 0, **look}
    ax.annotate("", end, start, arrowprops=props)


def measure(
    ax: Axes, start: tuple[float, float], end: tuple[float, float], words: str, place: tuple[float, float]
) -> None:
    arrow(ax, start, end, "<|-|>", lw=0.7, mutation_scale=7)
    ax.text(*place, words, ha="center", va="center", backgroundcolor="white")


def draw() -> None:
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "mooring", "font.size": 9})
    figure, ax = pyplot.subplots(figsize=(6.4, 4.9), layout="constrained")
    height = np.sqrt(R**2 - (1 - A) ** 2)
    top = height + B
    turn = np.array([[np.cos(THETA), -np.sin(THETA)], [np.sin(THETA), np.cos(THETA)]])
    centre = np.array([X, Y])
    corners = np.array([[A, B], [-A, B], [-A, -B], [A, -B]]) @ turn.T + centre

    # The sea floor, and where the body rests.
    ax.plot([-1.35, 1.35], [top, top], color="black", lw=1)
    ax.text(0, top + 0.03, "sea floor, and upper bound of the body", fontsize=8, ha="center")
    ax.add_patch(Polygon([[A, B], [-A, B], [-A, -B], [A, -B]], fill=False, ls=":", lw=0.9))
    arrow(ax, (0, 0), (0.24, 0), color="dimgrey", lw=0.8)
    arrow(ax, (0, 0), (0, 0.24), color="dimgrey", lw=0.8)
    ax.text(-0.02, -0.045, "at rest: x = y = 0", ha="center", va="top", fontsize=8)

    # Body, cables, anchors.
    ax.add_patch(Polygon(corners, facecolor="white", edgecolor="black", lw=1.3, zorder=3))
    for side, corner, colour in ((1, corners[0], BLUE), (-1, corners[1], VERMILION)):
        anchor = np.array([side, top])
        away = corner - anchor
        slack = R - np.hypot(*away)
        s = np.linspace(0, 1, 60)[:, None]
        aside = np.array([-away[1], away[0]]) / np.hypot(*away)
        line = anchor + s * away + side * 1.3 * np.sqrt(max(slack, 0) / 8) * np.sin(np.pi * s) * aside
        ax.plot(*line.T, color=colour, lw=1.6)
        ax.plot(*anchor, "^", color="black", ms=8)
    ax.text(1.14, 0.98, "cable 1,\nslack", color=BLUE)
    ax.text(-0.4, 0.9, "cable 2, of length r", color=VERMILION)
    measure(ax, (-1, top - 0.13), (0, top - 0.13), "1", (-0.5, top - 0.13))
    measure(ax, (0, top - 0.13), (1, top - 0.13), "1", (0.5, top - 0.13))
    ax.plot([0, 0], [top, top - 0.2], color="black", lw=0.6)

    # Size and place of the body.
    half = turn @ np.array([A, 0]) + centre
    up = turn @ np.array([0, B]) + centre
    arrow(ax, tuple(centre), tuple(half), "-", lw=0.8, zorder=4)
    arrow(ax, tuple(centre), tuple(up), "-", lw=0.8, zorder=4)
    ax.text(X + 0.15, Y + 0.005, "a", zorder=5)
    ax.text(X - 0.075, Y + 0.06, "b", zorder=5)
    measure(ax, (0, -0.21), (X, -0.21), "x", (X / 2, -0.21))
    ax.plot([X, X], [-0.25, Y], color="black", lw=0.5, ls="--")
    measure(ax, (1.0, 0), (1.0, Y), "y", (1.0, Y / 2))
    ax.plot([0.3, 1.05], [0, 0], color="black", lw=0.5, ls="--")
    ax.plot([X, 1.05], [Y, Y], color="black", lw=0.5, ls="--")
    ax.text(X + 0.34, Y + 0.045, "theta", ha="left")

    # The start, and the forces.
    arrow(ax, (X, Y), (X - 0.42, Y), color=GREEN)
    ax.text(X - 0.44, Y - 0.015, "vx", color=GREEN, ha="right")
    arrow(ax, (X, Y), (X, Y + 0.36), color=GREEN)
    ax.text(X + 0.02, Y + 0.34, "vy", color=GREEN)
    ax.annotate(
        "",
        (X - 0.16, Y - 0.27),
        (X + 0.2, Y - 0.2),
        arrowprops={"arrowstyle": "<|-", "color": GREEN, "connectionstyle": "arc3,rad=-0.35"},
    )
    ax.text(X + 0.22, Y - 0.22, "vtheta", color=GREEN)
    arrow(ax, (0, -0.3), (0, -0.55), lw=1.4)
    ax.text(0.03, -0.47, "net buoyancy F = 1")
    waves = np.array([-0.95, 0.14])
    ax.add_patch(Ellipse(waves, 0.56, 0.28, fill=False, lw=0.9))
    arrow(ax, tuple(waves), (waves[0] + 0.28, waves[1]), lw=0.9)
    arrow(ax, tuple(waves), (waves[0], waves[1] + 0.14), lw=0.9)
    ax.text(waves[0] + 0.08, waves[1] - 0.065, "f_o")
    ax.text(waves[0] - 0.025, waves[1] + 0.045, "nu f_o", ha="right")
    ax.text(waves[0], waves[1] - 0.29, "force of the waves,\nturning with omega", ha="center", fontsize=8)
    ax.text(-1.34, -0.64, BESIDE, fontsize=8, va="top", linespacing=1.5)

    ax.set_xlim(-1.4, 1.42)
    ax.set_ylim(-0.9, top + 0.1)
    ax.set_aspect("equal")
    ax.axis("off")
    figure.savefig(TARGET, metadata={"Date": None}, facecolor="white")


if __name__ == "__main__":
    draw()
