"""The standard case in MuJoCo: two tendons of limited length, stepped through their soft limits.

MuJoCo has no impact law and no event location. A limit is a spring and damper, which is given here the
damping that leaves a restitution of 0.9, and a stiffness that ends a contact within a given number of steps.
"""

import math
import sys

import mujoco

from standard import (
    F_O,
    HEIGHT,
    INERTIA,
    NU,
    OMEGA,
    ROTATION_LIMIT,
    SETTLING_HEIGHT,
    SIDES,
    T_END,
    A,
    E,
    R,
    Run,
    report,
)

# A cable that has been closed for this many contact times sticks.
STICKING_CONTACTS = 10


def damping_ratio() -> float:
    """Of a spring and damper that only push, the damping that returns E of the velocity."""

    def returned(zeta: float) -> float:
        root = math.sqrt(1.0 - zeta * zeta)
        turn = math.pi - math.atan2(2.0 * zeta * root, 1.0 - 2.0 * zeta * zeta)
        return math.exp(-zeta / root * turn)

    low, high = 0.0, 0.5
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if returned(middle) > E else (low, middle)
    return low


def model(step: float, steps_a_contact: float) -> mujoco.MjModel:
    frequency = math.pi / (steps_a_contact * step)
    stiffness, damping = frequency**2, 2.0 * damping_ratio() * frequency
    sites = "".join(f'<site name="anchor{i}" pos="{side} {HEIGHT} 0"/>' for i, side in enumerate(SIDES))
    fairleads = "".join(f'<site name="fairlead{i}" pos="{side * A} 0 0"/>' for i, side in enumerate(SIDES))
    cables = "".join(
        f'<spatial limited="true" range="0 {R}" solreflimit="-{stiffness} -{damping}"'
        ' solimplimit="0.9999 0.9999 1">'
        f'<site site="anchor{i}"/><site site="fairlead{i}"/></spatial>'
        for i in range(2)
    )
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="{step}" gravity="0 -1 0" integrator="Euler" tolerance="1e-14"/>
          <worldbody>
            {sites}
            <body>
              <joint type="slide" axis="1 0 0"/>
              <joint type="slide" axis="0 1 0"/>
              <joint type="hinge" axis="0 0 1"/>
              <inertial pos="0 0 0" mass="1" diaginertia="1 1 {INERTIA}"/>
              {fairleads}
            </body>
          </worldbody>
          <tendon>{cables}</tendon>
        </mujoco>""")


def solve(compiled: mujoco.MjModel, steps_a_contact: float) -> Run:
    data = mujoco.MjData(compiled)
    data.qpos[1] = 0.1
    step = compiled.opt.timestep
    force, length, velocity, place = data.qfrc_applied, data.ten_length, data.ten_velocity, data.qpos
    sticking_time = STICKING_CONTACTS * steps_a_contact * step
    closed_since: list[float | None] = [None, None]
    run = Run()
    while (t := data.time) < T_END:
        force[0] = F_O * math.cos(OMEGA * t)
        force[1] = NU * F_O * math.sin(OMEGA * t)
        mujoco.mj_step(compiled, data)
        for cable in range(2):
            over = length[cable] - R  # at t, where the step began
            if over <= 0.0:
                closed_since[cable] = None
            elif (since := closed_since[cable]) is None:
                v_n = float(velocity[cable])
                run.impacts.append((t - float(over) / v_n, cable + 1, v_n))
                closed_since[cable] = t
            elif t - since > sticking_time:
                run.kind = "settled" if place[1] < SETTLING_HEIGHT else "sliding_start"
                run.t = t
                return run
        if abs(place[2]) >= ROTATION_LIMIT or place[1] + A >= HEIGHT:
            run.kind = "rotation_limit" if abs(place[2]) >= ROTATION_LIMIT else "upper_bound"
            run.t = t
            return run
    return run


if __name__ == "__main__":
    time_step, contact = float(sys.argv[1]), float(sys.argv[2])
    compiled_model = model(time_step, contact)
    report(mujoco.__version__, lambda: solve(compiled_model, contact), repeats=1)
