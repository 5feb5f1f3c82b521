"""The standard case in heyoka: an adaptive Taylor integrator, terminal events, the impact in their callback."""

import sys

import heyoka as hy

from standard import (
    F_O,
    HEIGHT,
    MAX_IMPACTS,
    NU,
    OMEGA,
    ROTATION_LIMIT,
    SIDES,
    START,
    T_END,
    A,
    R,
    Run,
    contact_at,
    end_at_sticking,
    reflect,
    report,
)

# Those without a callback, by their place among the events.
STOPS = {2: "rotation_limit", 3: "upper_bound"}


class Impact:
    """What happens where a cable closes; tells the integrator whether to go on."""

    def __init__(self, cable: int) -> None:
        self.cable = cable
        self.run = Run()

    def __call__(self, integrator: hy.taylor_adaptive, _sign: int) -> bool:
        t, state = integrator.time, tuple(integrator.state.tolist())
        contact = contact_at(state, self.cable)
        self.run.impacts.append((t, self.cable + 1, contact.v_n))
        state = reflect(state, contact)
        integrator.state[:] = state
        if kind := end_at_sticking(t, state, self.cable, contact.v_n):
            self.run.kind, self.run.t = kind, t
            return False
        if len(self.run.impacts) >= MAX_IMPACTS:
            self.run.kind = "impact_limit"
            return False
        return True

    def __deepcopy__(self, _memo: object) -> "Impact":
        return self  # the integrator copies its callbacks, and the run has to stay ours


def integrator(impacts: list[Impact], tolerance: float) -> hy.taylor_adaptive:
    """A tolerance of 0 is the default, the rounding of doubles; the cooldown of events is left at its default."""
    x, y, theta, vx, vy, spin = hy.make_vars("x", "y", "theta", "vx", "vy", "spin")
    phase = OMEGA * hy.time
    system = [
        (x, vx),
        (y, vy),
        (theta, spin),
        (vx, F_O * hy.cos(phase)),
        (vy, NU * F_O * hy.sin(phase) - 1.0),
        (spin, 0.0 * spin),
    ]

    def gap(side: float) -> hy.expression:
        dx = x + side * A * hy.cos(theta) - side
        dy = y + side * A * hy.sin(theta) - HEIGHT
        return dx * dx + dy * dy - R * R

    upward = hy.event_direction.positive
    events = [
        hy.t_event(gap(side), callback=impact, direction=upward)
        for side, impact in zip(SIDES, impacts, strict=True)
    ]
    events.append(hy.t_event(theta * theta - ROTATION_LIMIT**2, direction=upward))
    events.append(hy.t_event(y + A - HEIGHT, direction=upward))
    return hy.taylor_adaptive(system, list(START), t_events=events, tol=tolerance)


def solve(motion: hy.taylor_adaptive, impacts: list[Impact]) -> Run:
    run = Run()
    for impact in impacts:
        impact.run = run
    motion.reset_cooldowns()
    motion.time = 0.0
    motion.state[:] = START
    outcome = int(motion.propagate_until(T_END)[0])
    stop = -outcome - 1  # a terminal event i that stops is told as -i - 1
    if stop in STOPS:
        run.kind, run.t = STOPS[stop], motion.time
    return run


if __name__ == "__main__":
    both = [Impact(0), Impact(1)]
    compiled = integrator(both, float(sys.argv[1]))
    report(hy.__version__, lambda: solve(compiled, both), repeats=20)
