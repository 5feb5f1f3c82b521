"""The standard case, its geometry and its impact law, for the peers written in Python.

Equations and names are those of docs/model.md. Peers differ in how they move the body and find events;
what they move, and what an impact does, is the same for all and stands here once.
"""

import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

R, A, E = 1.5, 0.1, 0.9
F_O, NU, OMEGA = 0.3, 0.5, 0.9
INERTIA = A * A
HEIGHT = math.sqrt(R * R - (1.0 - A) ** 2)
START = (0.0, 0.1, 0.0, 0.0, 0.0, 0.0)  # x, y, theta and their rates
V_STICK = 1e-6
SETTLING_HEIGHT = 0.05
ROTATION_LIMIT = math.pi / 2
T_END = 10.0
MAX_IMPACTS = 2000  # a guard: the true run has 290

State = tuple[float, ...]

SIDES = (1.0, -1.0)  # cable 1 is anchored at x = +1, cable 2 at x = -1


@dataclass
class Run:
    """What a peer reports."""

    impacts: list[tuple[float, int, float]] = field(default_factory=list)  # t, cable, v_n
    kind: str = "end_time"
    t: float = T_END


@dataclass(frozen=True)
class Contact:
    """A cable at its full length: its normal, lever arm and normal velocity."""

    n: tuple[float, float]
    arm: float
    v_n: float

    @property
    def inverse_mass(self) -> float:
        return 1.0 + self.arm**2 / INERTIA


def gap(q: State, cable: int) -> float:
    """g = |P - A|^2 - r^2 of cable 0 or 1, in the order x, y, theta."""
    side = SIDES[cable]
    dx = q[0] + side * A * math.cos(q[2]) - side
    dy = q[1] + side * A * math.sin(q[2]) - HEIGHT
    return dx * dx + dy * dy - R * R


def contact_at(state: State, cable: int) -> Contact:
    x, y, theta, vx, vy, spin = state
    side = SIDES[cable]
    lever = (side * A * math.cos(theta), side * A * math.sin(theta))
    n = ((x + lever[0] - side) / R, (y + lever[1] - HEIGHT) / R)
    arm = lever[0] * n[1] - lever[1] * n[0]
    return Contact(n, arm, n[0] * vx + n[1] * vy + arm * spin)


def reflect(state: State, contact: Contact) -> State:
    """Newton's law of impact in the mass metric: v_n becomes -e v_n."""
    impulse = (1.0 + E) * contact.v_n / contact.inverse_mass
    x, y, theta, vx, vy, spin = state
    vx -= impulse * contact.n[0]
    vy -= impulse * contact.n[1]
    return (x, y, theta, vx, vy, spin - impulse * contact.arm / INERTIA)


def place_inside(state: State, cable: int, inside: float) -> State:
    """Moves the body along the cable until its gap is -inside: a restart on the slack side for certain."""
    contact = contact_at(state, cable)
    distance = (gap(state, cable) + inside) / (2.0 * R)
    return (state[0] - distance * contact.n[0], state[1] - distance * contact.n[1], *state[2:])


def carries_tension(t: float, state: State, cable: int) -> bool:
    """Whether the cable would be pulled if it stayed taut."""
    contact = contact_at(state, cable)
    _, _, theta, vx, vy, spin = state
    side = SIDES[cable]
    lever = (side * A * math.cos(theta), side * A * math.sin(theta))
    ax = F_O * math.cos(OMEGA * t) - spin**2 * lever[0]
    ay = NU * F_O * math.sin(OMEGA * t) - 1.0 - spin**2 * lever[1]
    px, py = vx - spin * lever[1], vy + spin * lever[0]
    return (px * px + py * py) / R + contact.n[0] * ax + contact.n[1] * ay > 0.0


def end_at_sticking(t: float, state: State, cable: int, v_n: float) -> str | None:
    """The end, if an impact this slow lets its cable stick."""
    if v_n >= V_STICK or not carries_tension(t, state, cable):
        return None
    # A run that slides on is beyond these programs; the true one never does.
    return "settled" if state[1] < SETTLING_HEIGHT else "sliding_start"


def report(version: str, solve: Callable[[], Run], repeats: int) -> None:
    """Runs once to warm up, then takes the best of `repeats`, and prints JSON.

    Time is the processor's: the runs are long enough for others to interrupt them.
    """
    run = solve()
    seconds = []
    for _ in range(repeats):
        begin = time.process_time()
        run = solve()
        seconds.append(time.process_time() - begin)
    row = {
        "version": version,
        "impacts": run.impacts,
        "end": {"kind": run.kind, "t": run.t},
        "seconds": min(seconds),
    }
    print(json.dumps(row))
