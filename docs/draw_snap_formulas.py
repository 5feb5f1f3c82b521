"""Draws images/snap-formulas.svg: estimates of the tension in a snap beside the exact elastic line.

A mass at a speed and a load that pulls on tighten an elastic line that is fixed at its other end. Its largest tension
follows from the waves that run to and fro in it; each map shows an estimate over it. Run
``python docs/draw_snap_formulas.py`` after an estimate was changed.
"""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import pyplot
from matplotlib.colors import BoundaryNorm, ListedColormap

TARGET = Path(__file__).parent / "images" / "snap-formulas.svg"
STEPS = 80  #: of a wave's way along the line and back
RATIOS = np.logspace(-1, 3, 61)  #: mass of the body over that of the line
LOADS = np.logspace(-2, 1.5, 71)  #: load over v sqrt(k M)


def exact_peaks(ratio: float, loads: np.ndarray) -> np.ndarray:
    """Largest tensions of a line of unit impedance, mass and length, struck at speed 1 under these loads.

    With the speed v of the mass and the wave f' that it sends out v(t) = f'(t) - f'(t - 2); the pull on it is
    f'(t) + f'(t - 2), and at the fixed end the tension is 2 f'(t - 1).
    """
    step = 2.0 / STEPS
    half = 0.5 * step / ratio
    speed, peak = np.ones_like(loads), np.zeros_like(loads)
    taut = np.full(loads.shape, True)
    sent = [np.zeros_like(loads)] * STEPS
    for _ in range(int(2 * np.pi * np.sqrt(ratio + 1) / step) + 2 * STEPS):
        back, next_back = sent[-STEPS], sent[1 - STEPS]
        now = speed + back
        taut &= now + back >= 0
        if not taut.any():
            break
        peak = np.where(taut, np.maximum(peak, np.maximum(now + back, 2 * now)), peak)
        speed = (speed * (1 - half) - 2 * half * (back + next_back) + 2 * half * loads) / (1 + half)
        sent.append(now)
        del sent[0]
    return peak


def draw() -> None:
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "snap-formulas", "font.size": 9})
    exact, estimates = [], {name: [] for name in ("v √(k M)", "$T_0$ + v √(k M)", "snapload")}
    for ratio in RATIOS:
        load = LOADS * np.sqrt(ratio)
        exact.append(exact_peaks(ratio, load))
        estimates["v √(k M)"].append(np.sqrt(ratio) + 0 * load)
        estimates["$T_0$ + v √(k M)"].append(np.sqrt(ratio) + load)
        estimates["snapload"].append(load + 1 + np.hypot(load, np.sqrt(ratio + 1)))
    figure, axes = pyplot.subplots(1, 3, figsize=(7.2, 2.9), sharey=True, layout="constrained")
    levels = [0, 0.25, 0.5, 0.75, 0.9, 0.95, 1.05, 1.15]
    colours = [*pyplot.get_cmap("Oranges")(np.linspace(0.95, 0.25, 5)), "white", pyplot.get_cmap("Purples")(0.45)]
    look = {"cmap": ListedColormap(colours), "norm": BoundaryNorm(levels, len(colours))}
    for ax, (name, found) in zip(axes, estimates.items(), strict=True):
        part = (np.array(found) / np.array(exact)).T
        map_ = ax.pcolormesh(RATIOS, LOADS, part, shading="nearest", rasterized=True, **look)
        ax.set(xscale="log", yscale="log", title=name, xlabel="mass of the body / of the line")
        ax.title.set_fontsize(10)
    axes[0].set_ylabel("load / (v √(k M))")
    bar = figure.colorbar(map_, ax=axes, ticks=levels, format="%g")
    bar.set_label("estimate / exact; below 1 unsafe")
    figure.savefig(TARGET, metadata={"Date": None})


if __name__ == "__main__":
    draw()
