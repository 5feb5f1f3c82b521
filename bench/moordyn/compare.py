"""Lines that stretch in snapload and in MoorDyn, side by side; bench/moordyn/run calls this with the program.

Writes results.json beside it and the tables in docs/elastic.md.
"""

import contextlib
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import moordyn
import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
EXAMPLE = "docs/examples/cylinder.toml"
PAGE = ROOT / "docs" / "elastic.md"

# The example, let go off its place of rest, for the time of the first pulls.
OFF_EQUILIBRIUM = ["run.start=[0.3,-4.2]", "run.duration=4"]
STILL = [*OFF_EQUILIBRIUM, "wave.height=0", "run.restitution=1"]
STILL_OTHER_START = ["run.start=[-0.2,-4.4]", "run.duration=3", "wave.height=0", "run.restitution=1"]
WAVE = [*OFF_EQUILIBRIUM, "wave.height=1.5", "run.restitution=1"]
DAMPED = [*OFF_EQUILIBRIUM, "wave.height=1.5", "run.restitution=0.5"]
LIGHT = ["line.mass_per_length=0.1"]

Pull = tuple[int, float, float, float]  # line, from, to, largest tension


def snapload(program: str, verb: list[str], sets: list[str], *more: str) -> str:
    arguments = [part for item in sets for part in ("--set", item)]
    command = [program, *verb, EXAMPLE, *arguments, *more]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def elastic(program: str, sets: list[str], stiffer: float = 1.0) -> dict:
    return json.loads(snapload(program, ["elastic"], sets, "--stiffer", str(stiffer), "--json", "-"))


@contextlib.contextmanager
def silence_output():
    """MoorDyn prints the time at every step, from C++."""
    saved = os.dup(1), os.dup(2)
    with open(os.devnull, "w") as devnull:
        os.dup2(devnull.fileno(), 1)
        os.dup2(devnull.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(saved[0], 1)
            os.dup2(saved[1], 2)


class PullFinder:
    """Finds the pulls in tensions that come step by step."""

    def __init__(self, lines: int, threshold: float) -> None:
        self.open_pulls: list[list[float] | None] = [None] * lines
        self.threshold, self.closed_pulls = threshold, []

    def add(self, t: float, dt: float, tensions: list[float]) -> None:
        for line, tension in enumerate(tensions):
            pull = self.open_pulls[line]
            if tension > self.threshold:
                if pull is None:
                    self.open_pulls[line] = [t - dt, tension]
                else:
                    pull[1] = max(pull[1], tension)
            elif pull is not None:
                self.closed_pulls.append((line + 1, pull[0], t, pull[1]))
                self.open_pulls[line] = None

    def pulls(self, end: float) -> list[Pull]:
        left = [(i + 1, p[0], end, p[1]) for i, p in enumerate(self.open_pulls) if p is not None]
        return sorted([*self.closed_pulls, *left], key=lambda pull: pull[1])


def option(text: str, key: str) -> float:
    return float(next(line.split()[0] for line in text.splitlines() if line.split()[1:2] == [key]))


def table(text: str, header: str) -> list[list[str]]:
    block = re.split(r"-{3,} *" + header + r" *-{3,}\n", text)[1].split("---")[0]
    return [line.split() for line in block.strip().splitlines()[2:]]


def run_moordyn(text: str, end: float, dt: float, threshold: float) -> tuple[list[Pull], float]:
    """MoorDyn moves the body by itself, in still water."""
    lines = len(table(text, "LINES"))
    with tempfile.TemporaryDirectory() as folder, silence_output():
        file = Path(folder) / "lines.txt"
        file.write_text(text)
        system = moordyn.Create(str(file))
        moordyn.Init(system, [], [])
        handles = [moordyn.GetLine(system, i + 1) for i in range(lines)]
        pulls, t = PullFinder(lines, threshold), 0.0
        begin = time.process_time()
        while t < end - dt / 2:
            moordyn.Step(system, [], [], t, dt)
            t += dt
            pulls.add(t, dt, [moordyn.GetLineFairTen(line) for line in handles])
        seconds = time.process_time() - begin
        moordyn.Close(system)
    return pulls.pulls(end), seconds


def water_acceleration(
    depth: float, z: float, height: float, period: float, g: float
) -> tuple[float, float, float]:
    """ω, and the largest accelerations of the water in x and z by linear theory at the level z."""
    omega = 2 * math.pi / period
    k = omega**2 / g
    for _ in range(100):  # Newton's method
        tanh = math.tanh(k * depth)
        k -= (g * k * tanh - omega**2) / (g * tanh + g * k * depth * (1 - tanh**2))
    factor = omega**2 * height / 2 / math.sinh(k * depth)
    return omega, factor * math.cosh(k * (z + depth)), factor * math.sinh(k * (z + depth))


def run_coupled(
    text: str, end: float, dt: float, threshold: float, wave: tuple[float, float, float]
) -> tuple[list[Pull], float]:
    """MoorDyn has the lines, and a velocity Verlet scheme here moves the body in the wave."""
    body_row = table(text, "BODIES")[0]
    x, z = float(body_row[2]), float(body_row[4])
    mass, inertia, volume, added = (float(body_row[i]) for i in (8, 10, 11, 13))
    rho, g = option(text, "rho"), option(text, "g")
    moving = mass + added * rho * volume
    omega, a_x, a_z = wave
    points = {row[0]: row for row in table(text, "POINTS")}
    line_points = [row[3] for row in table(text, "LINES")]
    arms = [(float(points[p][2]), float(points[p][4])) for p in line_points]
    # The body is no object of the file any more; its points are moved instead.
    text = re.sub(r"-+ BODIES -+\n(.*\n){3}", "", text)
    for point, (a, b) in zip(line_points, arms, strict=True):
        row = points[point]
        new = [point, "Coupled", str(x + a), "0", str(z + b), *row[5:]]
        text = text.replace("  ".join(row), "  ".join(new))

    def free_acceleration(t: float) -> tuple[float, float]:
        per = rho * volume * (1 + added) / moving
        up = (rho * volume - mass) * g / moving
        return per * a_x * math.cos(omega * t), up - per * a_z * math.sin(omega * t)

    # Counter-clockwise with z up: x' = x cos θ − z sin θ, z' = x sin θ + z cos θ.
    def attachment_points(s: np.ndarray) -> tuple[list[float], list[float]]:
        cosine, sine = math.cos(s[2]), math.sin(s[2])
        place, speed = [], []
        for a, b in arms:
            u, w = a * cosine - b * sine, a * sine + b * cosine
            place += [s[0] + u, 0.0, s[1] + w]
            speed += [s[3] - w * s[5], 0.0, s[4] + u * s[5]]
        return place, speed

    with tempfile.TemporaryDirectory() as folder, silence_output():
        file = Path(folder) / "lines.txt"
        file.write_text(text)
        system = moordyn.Create(str(file))
        state = np.array([x, z, 0.0, 0.0, 0.0, 0.0])
        moordyn.Init(system, *attachment_points(state))
        handles = [moordyn.GetLine(system, i + 1) for i in range(len(arms))]
        pulls, t = PullFinder(len(arms), threshold), 0.0
        acceleration = np.array([*free_acceleration(0.0), 0.0])
        begin = time.process_time()
        while t < end - dt / 2:
            place, speed = attachment_points(state)
            force = np.array(moordyn.Step(system, place, speed, t, dt))
            state[:3] += dt * state[3:] + dt * dt / 2 * acceleration
            t += dt
            cosine, sine = math.cos(state[2]), math.sin(state[2])
            f_x, f_z = force[0::3].sum(), force[2::3].sum()
            turning = sum(
                (a * cosine - b * sine) * force[3 * i + 2] - (a * sine + b * cosine) * force[3 * i]
                for i, (a, b) in enumerate(arms)
            )
            u, w = free_acceleration(t)
            new = np.array([u + f_x / moving, w + f_z / moving, turning / inertia])
            state[3:] += dt / 2 * (acceleration + new)
            acceleration = new
            pulls.add(t, dt, [moordyn.GetLineFairTen(line) for line in handles])
        seconds = time.process_time() - begin
        moordyn.Close(system)
    return pulls.pulls(end), seconds


def overlap(one: Pull, other: Pull) -> float:
    return min(one[2], other[2]) - max(one[1], other[1]) if one[0] == other[0] else -math.inf


def compare(
    name: str,
    program: str,
    sets: list[str],
    dt: float,
    *,
    segments: int = 1,
    threshold: float = 1.0,
    by_itself: bool = False,
    finer: float = 1.0,
) -> dict:
    snapload_results = elastic(program, sets)
    text = snapload(program, ["moordyn", "write"], sets, "--segments", str(segments))
    inner = option(text, "dtM") / finer
    text = re.sub(r"\S+(  dtM)", rf"{inner:.3g}\1", text)
    end = float(next(s for s in sets if s.startswith("run.duration=")).split("=")[1])
    height = float(next(s for s in sets if s.startswith("wave.height=")).split("=")[1])
    rest = json.loads(snapload(program, ["assess"], sets, "--neighbours", "0", "--no-scan", "--json", "-"))
    z = rest["rest"]["z_m"] if "rest" in rest else float("nan")
    if by_itself:
        moordyn_pulls, seconds = run_moordyn(text, end, dt, threshold)
    else:
        wave = water_acceleration(option(text, "WtrDpth"), z, height, 6.0, option(text, "g"))
        moordyn_pulls, seconds = run_coupled(text, end, dt, threshold, wave)
    pulls = [(p["line"], p["from_s"], p["to_s"], p["peak_n"]) for p in snapload_results["pulls"]]
    rows = []
    for snapload_pull in pulls:
        moordyn_pull = max(moordyn_pulls, key=lambda pull: overlap(snapload_pull, pull), default=None)
        matched = moordyn_pull is not None and overlap(snapload_pull, moordyn_pull) > 0
        rows.append({"snapload": snapload_pull, "moordyn": moordyn_pull if matched else None})
    return {
        "name": name, "set": sets, "segments": segments, "step_s": dt, "alone": by_itself,
        "threshold_n": threshold, "dtM_s": option(text, "dtM"), "pulls": rows,
        "counts": {"snapload": len(pulls), "moordyn": len(moordyn_pulls)},
        "seconds": {"snapload": snapload_results["took_s"], "moordyn": seconds},
    }  # fmt: skip


def convergence(program: str) -> list[dict]:
    rows = []
    sets = [*OFF_EQUILIBRIUM, "wave.height=1.5", "run.restitution=1"]
    for stiffer in (1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6):
        report = elastic(program, sets, stiffer)
        snaps = report["inextensible"]["snaps"][:3]
        off = [
            (pull["from_s"] - snap["t_s"], pull["speed_m_s"] - snap["speed_m_s"], pull["line"] == snap["line"])
            for pull, snap in zip(report["pulls"], snaps, strict=False)
        ]
        rows.append({"stiffer": stiffer, "off": off, "seconds": report["took_s"]})
    return rows


def markdown(results: dict) -> tuple[str, str]:
    first = "| stiffness × | second snap: time, speed off by | third snap: time, speed off by | computed in |\n"
    first += "| --- | --- | --- | --- |\n"
    for row in results["convergence"]:
        cells = [f"{t:+.1e} s, {v:+.1e} m/s" if same else "of another line" for t, v, same in row["off"][1:3]]
        cells += ["not reached"] * (2 - len(cells))
        first += f"| {row['stiffer']:g} | {' | '.join(cells)} | {1e3 * row['seconds']:.1f} ms |\n"
    second = ""
    for case in results["cases"]:
        seconds, counts = case["seconds"], case["counts"]
        second += f"**{case['name']}** (steps of {case['step_s']:g} s, `dtM` {case['dtM_s']:g} s; computed in "
        second += f"{1e3 * seconds['snapload']:.1f} ms by snapload, {seconds['moordyn']:.2f} s by MoorDyn; "
        second += (
            f"{counts['snapload']} and {counts['moordyn']} pulls above {case['threshold_n'] / 1e3:g} kN)\n\n"
        )
        second += (
            "| line | pulls, snapload (s) | pulls, MoorDyn (s) | peak, snapload (kN) | peak, MoorDyn (kN) "
        )
        second += "| off by |\n| --- | --- | --- | --- | --- | --- |\n"
        for row in case["pulls"]:
            line, a0, a1, a = row["snapload"]
            second += f"| {line} | {a0:.3f} to {a1:.3f} | "
            if row["moordyn"] is None:
                second += f"none | {a / 1e3:.0f} | | |\n"
                continue
            _, b0, b1, b = row["moordyn"]
            second += f"{b0:.3f} to {b1:.3f} | {a / 1e3:.0f} | {b / 1e3:.0f} | {100 * (b / a - 1):+.1f} % |\n"
        second += "\n"
    return first, second


def insert_into_page(name: str, text: str) -> None:
    page = PAGE.read_text()
    pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
    filled = re.sub(pattern, lambda m: f"{m[1]}\n{text.strip()}\n\n{m[2]}", page, flags=re.DOTALL)
    PAGE.write_text(filled)


def main() -> None:
    program = sys.argv[1] if os.path.sep in sys.argv[1] else f"./{sys.argv[1]}"
    program = str(Path(program).resolve())
    results = {
        "moordyn": version("moordyn"),
        "convergence": convergence(program),
        "cases": [
            compare(
                "Still water, a spring each, MoorDyn by itself",
                program,
                [*STILL, *LIGHT],
                2e-4,
                by_itself=True,
            ),
            compare("A wave, a spring each", program, [*WAVE, *LIGHT], 2e-4),
            compare("The same with a tenth of MoorDyn's step", program, [*WAVE, *LIGHT], 1e-4, finer=10.0),
            compare(
                "Still water from beside, with a tenth of MoorDyn's step",
                program,
                [*STILL_OTHER_START, *LIGHT],
                1e-4,
                by_itself=True,
                finer=10.0,
            ),
            compare("A wave, the chain in ten segments", program, WAVE, 1e-4, segments=10, threshold=5e4),
            compare("A wave, a spring and damper each, e = 0.5", program, [*DAMPED, *LIGHT], 1e-4),
        ],
    }
    (HERE / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    if PAGE.exists():
        for name, text in zip(("convergence", "moordyn"), markdown(results), strict=True):
            insert_into_page(name, text)
    print("\n".join(markdown(results)))


if __name__ == "__main__":
    main()
