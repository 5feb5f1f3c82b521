"""The standard case in SciPy: `solve_ivp` with terminal events, restarted after every impact."""

import math
import sys

import scipy
from scipy.integrate import solve_ivp

from standard import (
    F_O,
    HEIGHT,
    MAX_IMPACTS,
    NU,
    OMEGA,
    ROTATION_LIMIT,
    START,
    T_END,
    A,
    Run,
    State,
    contact_at,
    end_at_sticking,
    gap,
    place_inside,
    reflect,
    report,
)


def rates(t: float, u: State) -> State:
    force = F_O * math.cos(OMEGA * t), NU * F_O * math.sin(OMEGA * t) - 1.0
    return (u[3], u[4], u[5], *force, 0.0)


def first_cable(_t: float, u: State) -> float:
    return gap(u, 0)


def second_cable(_t: float, u: State) -> float:
    return gap(u, 1)


def rotation(_t: float, u: State) -> float:
    return abs(u[2]) - ROTATION_LIMIT


def top(_t: float, u: State) -> float:
    return u[1] + A - HEIGHT


EVENTS = (first_cable, second_cable, rotation, top)
for event_function in EVENTS:
    event_function.terminal = True  # type: ignore[attr-defined]
    event_function.direction = 1.0  # type: ignore[attr-defined]


def solve(method: str, tolerance: float, inside: float) -> Run:
    run = Run()
    t, u = 0.0, START
    while len(run.impacts) < MAX_IMPACTS:
        flight = solve_ivp(
            rates, (t, T_END), u, events=EVENTS, method=method, rtol=tolerance, atol=tolerance / 1000
        )
        if flight.status != 1:
            return run
        event = next(i for i, hits in enumerate(flight.t_events) if hits.size)
        t, u = float(flight.t[-1]), tuple(flight.y[:, -1].tolist())
        if event > 1:
            run.kind, run.t = ("rotation_limit", "upper_bound")[event - 2], t
            return run
        contact = contact_at(u, event)
        if contact.v_n <= 0.0:
            # The root that is found is the restart itself, and would be for ever: the step went past the
            # whole bounce, and the search began where the gap is zero, too.
            run.kind, run.t = "stuck", t
            return run
        run.impacts.append((t, event + 1, contact.v_n))
        u = reflect(u, contact)
        if kind := end_at_sticking(t, u, event, contact.v_n):
            run.kind, run.t = kind, t
            return run
        if inside > 0.0:
            u = place_inside(u, event, inside)
    run.kind = "impact_limit"
    return run


if __name__ == "__main__":
    way, number, distance = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    report(scipy.__version__, lambda: solve(way, number, distance), repeats=3)
