#!/usr/bin/env python3
"""Checks certificates of snapload (docs/certificate.md) in another language and another arithmetic, Arb by python-flint.
usage: certificate_check.py FILE.cert ...     exit status 0 proved, 1 refused, 2 undecided, 3 no certificate (the largest)
It knows slack flight, impacts and stops; where a cable stays taut a certificate ends with the reason `sticks`. Only the case is
taken as given: times are guesses, and are compared. Second derivatives are bounded by power series over intervals of time,
the Jacobian of an impact by power series along each coordinate."""
import json, re, sys
from math import hypot
from pathlib import Path
from flint import arb, arb_mat, arb_series, ctx, fmpq
MAX_BITS, MAX_PIECES = 3000, 4000
ctx.cap = 3  # terms of power series
COORDINATES = ("x", "y", "theta", "vx", "vy", "vtheta")
NUMBERS = {"r", "e", "a", "b", "f_o", "nu", "omega", "t_end", "v_stick", *COORDINATES}
KEYS = {"format", "model", "bits", "case", "impacts", "end"}
OTHERS = {"inertia", "body", "stop_when_settled", "stop_when_sliding", "max_impacts"}
REASONS = {"settled", "sliding_start", "sticks", "impact_limit", "rotation_limit", "upper_bound", "end_time"}
# A claim is true to half a unit of its last place: times and states have 20 decimals or more, speeds 14 digits.
LARGEST_HALF, LEAST_SHARE = fmpq(1, 2 * 10**20), 2 * 10**13
DECIMAL = re.compile(r"(-?)([0-9]+)(?:\.([0-9]*))?(?:e([+-]?[0-9]{1,3}))?", re.ASCII)

class CheckFailure(Exception):
    """A proof that fails, with an exit status and why: 1 false, 2 open, 3 no certificate."""
def decimal(text):
    """The number that a decimal is, and half a unit of its last place, as fractions."""
    found = DECIMAL.fullmatch(text) if isinstance(text, str) and len(text) < 400 else None
    if not found:
        raise CheckFailure(3, f"{text!r} is not a decimal")
    sign, whole, fraction, power = found.groups()
    places = len(fraction or "") - int(power or 0)
    unit = fmpq(1, 10**places) if places >= 0 else fmpq(10**-places)
    return unit * int(sign + whole + (fraction or "")), unit / 2

def is_positive(what, ball):
    """Whether a ball is above zero; undecided where it is not all of it on one side."""
    if ball > 0 or ball < 0:
        return bool(ball > 0)
    raise CheckFailure(2, f"the sign of {what}")

def check_decimal(what, ball, text):
    """The printed number is the true one to half a unit of its last place."""
    value, half = decimal(text)
    if not (error := abs(ball - arb(value))) <= arb(half):
        raise CheckFailure(1 if error > arb(half) else 2, f"{what}: {text} is claimed, the true value is {ball.str(25)}")

def spread(ball):
    return arb(0, ball.abs_upper())
class Model:
    """The numbers of a case; sections 2 to 7 of docs/model.md."""
    def __init__(self, case):
        q = {key: decimal(case[key])[0] for key in NUMBERS}
        size = q["a"] ** 2 if q["b"] == 0 else (q["a"] ** 2 + q["b"] ** 2) / 3
        inertia = size if case["inertia"] is None else decimal(case["inertia"])[0]
        is_point = case["inertia"] is None and not any(q[key] for key in ("a", "b", "theta", "vtheta"))
        legal = (is_point if case["body"] == "point" else inertia > 0) and 0 <= q["e"] <= 1 and q["a"] >= 0 <= q["b"]
        if not (legal and q["v_stick"] > 0 < q["t_end"] and q["r"] > abs(1 - q["a"])):
            raise CheckFailure(3, "a case that is not legal")
        self.spin = arb(0) if case["body"] == "point" else arb(1 / inertia)
        self.exact, self.rules = q, case
        self.r, self.e, self.a, self.b = (arb(q[key]) for key in ("r", "e", "a", "b"))
        self.f, self.nu, self.omega = (arb(q[key]) for key in ("f_o", "nu", "omega"))
        self.constant_force = q["omega"] == 0 or q["f_o"] == 0
        self.anchor_height = self.b + arb(q["r"] ** 2 - (1 - q["a"]) ** 2).sqrt()
        self.right_angle = arb.pi() / 2
    def force(self, t):
        """Force without the weight, and sine and cosine of its phase."""
        s, c = (arb(0), arb(1)) if self.constant_force else (self.omega * t).sin_cos()
        return self.f * c, arb(0) if self.constant_force else self.nu * self.f * s, s, c
    def fairlead(self, side, theta):
        """From the body's centre to the end of the cable of a side, 1 or -1; of balls or of series alike."""
        sine, cosine = theta.sin(), theta.cos()
        return cosine * (side * self.a) - sine * self.b, sine * (side * self.a) + cosine * self.b

class Flight:
    """Free motion from a state at the time t0, in closed form."""
    def __init__(self, model, t0, state):
        self.model, self.t0, self.state = model, t0, state
        _, _, self.sine, self.cosine = model.force(t0)
    def series(self, tau):
        """x, y and θ about the time t0 + τ, as power series of three terms; over a ball τ they hold all of them."""
        m, (x, y, theta, vx, vy, spin) = self.model, self.state
        fx, fy, s, c = m.force(self.t0 + tau)
        ux, uy, x, y = vx, vy - tau, x + tau * vx, y + tau * (vy - tau / 2)
        if m.constant_force:
            ux, x = ux + tau * fx, x + tau * tau * fx / 2
        else:
            k, sines, cosines = m.f / m.omega, s - self.sine, c - self.cosine
            ux, x = ux + k * sines, x - k * (cosines / m.omega + tau * self.sine)
            uy, y = uy - m.nu * k * cosines, y + m.nu * k * (tau * self.cosine - sines / m.omega)
        return arb_series([x, ux, fx / 2]), arb_series([y, uy, (fy - 1) / 2]), arb_series([theta + spin * tau, spin])
    def state_at(self, tau):
        return [q[k] for k in (0, 1) for q in self.series(tau)]
    def constraints(self, tau):
        """What stays below zero, gaps and tops' heights over the anchors: itself, its rate, half its second derivative."""
        m, (x, y, theta) = self.model, self.series(tau)
        arms = [m.fairlead(side, theta) for side in (1, -1)]
        ends = [(x + px - side, y + py - m.anchor_height) for side, (px, py) in zip((1, -1), arms)]
        tops = [dy for _, dy in ends] if m.exact["b"] else [y + (m.a - m.anchor_height)]
        return [[f[0], f[1], f[2]] for f in [dx * dx + dy * dy - m.r * m.r for dx, dy in ends] + tops]

def prove_clear(flight, lo, hi, zero_first, zero_last):
    """All constraints are below zero after `lo` and up to `hi`, but `zero_first`, which is known to be at most zero at `lo`,
    and `zero_last`, at `hi`. With f'' >= -K on a piece of length H and f <= 0 at its ends, f is at most its chord plus
    K t (H - t) / 2: below zero if K < 0, or if f < -K H^2 / 8 at both ends, or if f < -K H^2 / 2 at one."""

    def is_clear(begin, end, first, last, is_first, is_last):
        for k, (_, _, half_bend) in enumerate(flight.constraints((begin + end) / 2 + spread((end - begin) / 2))):
            bound, known = -half_bend * (end - begin) ** 2, (is_first and k == zero_first, is_last and k == zero_last)
            depths = [-f for given, f in zip(known, (first[k][0], last[k][0])) if not given]
            one, both = any(f > bound for f in depths), not any(known) and all(f > bound / 4 for f in depths)
            if not (all(f > 0 for f in depths) and (half_bend > 0 or one or both)):
                return False
        return True

    pieces, divisions = [(lo, hi, flight.constraints(lo), flight.constraints(hi), True, True)], 0
    while pieces:
        begin, end, first, last, is_first, is_last = piece = pieces.pop()
        if is_clear(*piece):
            continue
        divisions, middle = divisions + 1, ((begin + end) / 2).mid()
        inner = flight.constraints(middle)
        if any(f > 0 for f, _, _ in inner) or divisions > MAX_PIECES or not begin < middle < end:
            raise CheckFailure(1 if any(f > 0 for f, _, _ in inner) else 2, f"another event comes first, about {begin.str(12)} later")
        pieces += [(middle, end, inner, last, False, is_last), (begin, middle, first, inner, is_first, False)]

def crossing(centre, whole, k, guess):
    """When constraint k crosses zero: of the centre, and of the whole set, every member of which crosses once."""
    tau = guess
    for _ in range(ctx.prec.bit_length()):
        value, rate, _ = centre.constraints(tau)[k]
        if not (rate.mid() > 0 and abs(tau - guess) < arb(fmpq(1, 1000))):
            raise CheckFailure(1, "no event next to the claimed time")
        tau = (tau - value.mid() / rate.mid()).mid()
    value, rate, _ = whole.constraints(tau)[k]
    reach = tau + spread(abs(value) * 4 / rate.mid() + arb(2) ** (20 - ctx.prec))
    slope = whole.constraints(reach)[k][1]
    if not (slope > 0 and reach.contains_interior(tau - value / slope)):
        raise CheckFailure(2, "whether a cable or limit is reached or only touched")
    return tau - centre.constraints(tau)[k][0] / slope, tau - value / slope

def impact_velocities(model, side, state, share):
    """Velocities after an impact with `share` (1 + e; 1 takes v_n away), v_n, arm and normal; of balls or series alike."""
    x, y, theta, vx, vy, spin = state
    px, py = model.fairlead(side, theta)
    nx, ny = (x + px - side) / model.r, (y + py - model.anchor_height) / model.r
    arm = px * ny - py * nx
    vn = nx * vx + ny * vy + arm * spin
    p = vn / (1 + arm * arm * model.spin) * share
    return (vx - p * nx, vy - p * ny, spin - p * arm * model.spin), vn, (px, py), (nx, ny)

def jacobian(model, side, state, force, before, after):
    """Derivatives of the state at a fixed time after an impact by that at one before it, by power series of two terms along each
    coordinate. The instant moves by dt = -dg / g'."""
    acceleration, columns = (force[0], force[1] - 1, arb(0)), []
    _, vn, (px, py), (nx, ny) = impact_velocities(model, side, state, arb(1))
    for j in range(6):
        dv = [arb(i + 3 == j) for i in range(3)]
        dq = [arb(i == j) + before * v for i, v in enumerate(dv)]
        delay = -(nx * dq[0] + ny * dq[1] + (px * ny - py * nx) * dq[2]) / vn
        slopes = [q + v * delay for q, v in zip(dq, state[3:])] + [v + a * delay for v, a in zip(dv, acceleration)]
        new = impact_velocities(model, side, [arb_series([s, d]) for s, d in zip(state, slopes)], 1 + model.e)[0]
        rates = [v[1] - a * delay for v, a in zip(new, acceleration)]
        columns.append([q + after * d - v[0] * delay for q, d, v in zip(slopes, rates, new)] + rates)
    return arb_mat(columns).transpose()

def directions(matrix, sides):
    """Orthonormal columns along those of a matrix, the longest first; any invertible matrix would do."""
    columns = [[float(q.mid()) for q in column] for column in matrix.transpose().tolist()]
    longest = max(side.abs_upper() for side in sides)
    share = [float(side.abs_upper() / longest) if longest > 0 else 1.0 for side in sides]
    columns = [column for _, column in sorted(zip([-w * hypot(*v) for w, v in zip(share, columns)], columns))]
    basis = []
    for v in columns + [[float(i == j) for i in range(6)] for j in range(6)]:
        least = 1e-12 * hypot(*v)
        for u in basis * 2:
            along = sum(a * c for a, c in zip(u, v))
            v = [c - along * a for a, c in zip(u, v)]
        if len(basis) < 6 and hypot(*v) > least:
            basis.append([c / hypot(*v) for c in v])
    if len(basis) < 6:
        raise CheckFailure(2, "a set of states that has become degenerate")
    return arb_mat(basis).transpose()

def end_reason(model, count, k, state, force, vn, slow):
    """The reason for which a run ends at an impact, if it does."""
    reason, rules = None, model.rules
    slow[:] = [] if is_positive("v_n - v_stick", vn - arb(model.exact["v_stick"])) else [*slow, k]
    if slow or model.exact["e"] == 0:
        (vx, vy, spin), _, (px, py), (nx, ny) = impact_velocities(model, 1 - 2 * k, state, arb(1))
        ux, uy = vx - spin * py, vy + spin * px
        pull = (ux * ux + uy * uy) / model.r + nx * (force[0] - spin**2 * px) + ny * (force[1] - 1 - spin**2 * py)
        if is_positive("a tension", pull):
            high = is_positive("a height", state[1] - arb(fmpq(1, 20)))
            rule, stop = ("stop_when_sliding", "sliding_start") if high else ("stop_when_settled", "settled")
            reason = stop if rules[rule] else "sticks"
        elif len(slow) >= 5 and len(set(slow)) == 2:
            raise CheckFailure(2, "five slow snaps of two cables in turn")
    return "impact_limit" if count > rules["max_impacts"] and reason in (None, "sticks") else reason

def next_event(model, flight, c, t0, slack, last, claim, end):
    """When the centre and the whole set meet the next claim, or the end, and which constraint is reached; proved to be first."""
    reason = None if claim else end["reason"]
    for k, (value, rate, _) in enumerate(flight.constraints(slack)):  # the flight begins somewhere in T + slack
        bound = arb(fmpq(-1, 10**9)) if last is None and k < 2 else arb(0)
        if not (rate < 0 if k == last else value < bound):
            raise CheckFailure(1 if last is None and value > -2 * bound else 2, "a closed cable, or a stop, at the beginning")
    at, k, (theta, spin) = None, None, flight.state[2::3]
    if reason == "end_time":
        tau = arb(model.exact["t_end"]) - t0
    elif reason == "rotation_limit":
        tau = ((model.right_angle if is_positive("the rotation", spin) else -model.right_angle) - theta) / spin
    elif claim or reason == "upper_bound":
        guess = (arb(decimal(claim[1] if claim else end["t"])[0]) - t0).mid()
        tops = {} if claim else {k: float(v[0]) for k, v in enumerate(flight.constraints(guess)) if k > 1}
        k = claim[0] - 1 if claim else max(tops, key=tops.get)
        at, tau = crossing(Flight(model, t0, c), flight, k, guess)
    else:
        raise CheckFailure(1, "the run does not end in this way")
    margins = [tau - slack, model.right_angle - abs(theta)] + [-f[0] for j, f in enumerate(flight.constraints(tau)) if j != k]
    margins += [model.exact["t_end"] - t0 - tau] if reason != "end_time" else []
    margins += [model.right_angle - abs(flight.state_at(tau)[2])] if reason != "rotation_limit" else []
    if not all(margin > 0 for margin in margins):
        raise CheckFailure(1 if any(margin < 0 for margin in margins) else 2, "another event comes first")
    prove_clear(flight, arb(slack.upper()), arb(tau.upper() if k is None else tau.lower()), last, k)
    return at, tau, k

def prove(certificate):
    """Raises `CheckFailure` unless every claim is proved with the present number of bits."""
    model, claims, end = Model(certificate["case"]), certificate["impacts"], certificate["end"]
    start = [arb(model.exact[key]) for key in COORDINATES]
    c, axes = [q.mid() for q in start], arb_mat([[int(i == j) for j in range(6)] for i in range(6)])
    sides, hull = [spread(q - m) for q, m in zip(start, c)], start
    t0, slack, last, slow, reason = arb(0), arb(0), None, [], None
    is_partial = end["reason"] == "undecided"
    if is_partial and not claims:
        return
    for count, claim in enumerate([*claims, None], 1):
        flight = Flight(model, t0, hull)
        at, tau, k = next_event(model, flight, c, t0, slack, last, claim, end)
        t, final, force = t0 + tau, flight.state_at(tau), model.force(t0 + tau)
        if claim is None:
            reason = end["reason"]
            break
        state, side = final, 1 - 2 * k
        start, new_t = Flight(model, t0, c).state_at(at), (t0 + at).mid()
        time_offset, acceleration = new_t - (t0 + at), (spread(model.f), spread(model.nu * model.f) - 1, arb(0))
        speeds = impact_velocities(model, side, start, 1 + model.e)[0]
        image = [q + time_offset * (v + time_offset * a / 2) for q, v, a in zip(start, speeds, acceleration)]
        image += [v + time_offset * a for v, a in zip(speeds, acceleration)]
        slack = spread(t - new_t)
        transformed = jacobian(model, side, state, force, tau, slack) * axes
        axes = directions(transformed, sides)
        inverse, c = axes.inv(), [q.mid() for q in image]
        offset = arb_mat(6, 1, [q - m for q, m in zip(image, c)])
        sides = [spread(q) for q in (inverse * transformed * arb_mat(6, 1, sides) + inverse * offset).entries()]
        hull = [m + d for m, d in zip(c, (axes * arb_mat(6, 1, sides)).entries())]
        velocity, vn, _, _ = impact_velocities(model, side, state, 1 + model.e)
        check_decimal(f"the time of impact {count}", t, claim[1])
        check_decimal(f"v_n of impact {count}", vn, claim[2])
        reason = end_reason(model, count, k, state, force, vn, slow)
        if is_partial and count == len(claims):
            return
        t0, last, final = new_t, k, [*state[:3], *velocity]
        if reason:
            break
    if reason != end["reason"] or count < len(claims):
        raise CheckFailure(1, f"the run ends as {reason} after {count} impacts")
    check_decimal("the time of the end", t, end["t"])
    for key, ball, text in zip(COORDINATES, final, end["state"]):
        check_decimal(f"{key} at the end", ball, text)
def well_formed(certificate):
    """Whether it has the shape of a certificate, with decimals that state enough where they belong."""
    case, end, lines = certificate["case"], certificate["end"], certificate["impacts"]
    is_partial = end["reason"] == "undecided"
    final = [] if is_partial else [end["t"], *end["state"]]
    end_keys = {key for key, value in end.items() if value is not None} ^ {"reason"}
    keys = (set(certificate), set(case), end_keys), (certificate["format"], certificate["model"])
    kinds = [type(v) for v in (lines, certificate["bits"], *(case[k] for k in sorted(OTHERS - {"body", "inertia"})))]
    rows = [(type(line), len(line), type(line[0]), line[0] in (1, 2)) for line in lines]
    known_end = is_partial or type(end["state"]) is list and len(end["state"]) == 6 and end["reason"] in REASONS
    return (
        keys == ((KEYS, NUMBERS | OTHERS, set() if is_partial else {"t", "state"}), ("snapload-certificate-1", "snapload model 1"))
        and kinds == [list, int, int, bool, bool] and set(rows) <= {(list, 3, int, True)} and known_end
        and 64 <= certificate["bits"] <= MAX_BITS and case["body"] in ("rigid", "point")
        and all(decimal(text)[1] <= LARGEST_HALF for text in [*final, *(line[1] for line in lines)])
        and all(abs(value) >= half * LEAST_SHARE for value, half in (decimal(line[2]) for line in lines))
    )
def keyed(pairs):
    """An object of JSON, no key of which is given twice."""
    if len(dict(pairs)) < len(pairs):
        raise CheckFailure(3, "a key is given twice")
    return dict(pairs)
def check(source):
    """Exit status and words for a certificate, or the file of one."""
    try:
        text = source.read_text(encoding="utf-8") if isinstance(source, Path) else source
        certificate = json.loads(text, object_pairs_hook=keyed)
        if not well_formed(certificate):
            raise CheckFailure(3, "not the shape of format 1, or too few digits (format 2, of taut motion, is not supported)")
        bits = ctx.prec = certificate["bits"]
        while True:
            try:
                prove(certificate)
                count, reason = len(certificate["impacts"]), certificate["end"]["reason"]
                if reason == "undecided":
                    return 2, f"proved in part: {count} impacts, and the certificate ends undecided ({bits} bits)"
                return 0, f"proved: {count} impacts, {reason} ({bits} bits)"
            except CheckFailure as failure:
                if failure.args[0] != 2 or bits * 4 // 3 > MAX_BITS:
                    raise
            bits = ctx.prec = bits * 4 // 3
    except CheckFailure as failure:
        return failure.args[0], f"{('', 'refused', 'undecided', 'no certificate')[failure.args[0]]}: {failure.args[1]}"
    except ZeroDivisionError:
        return 2, "undecided: a division"
    except (LookupError, TypeError, AttributeError):
        return 3, "no certificate: keys are missing, or values are of another type"
    except (OSError, ValueError, RecursionError) as error:
        return 3, f"no certificate: {error}"

if __name__ == "__main__":
    verdicts = [check(Path(name)) for name in sys.argv[1:]]
    print("\n".join(f"{name}: {words}" for name, (_, words) in zip(sys.argv[1:], verdicts)))
    sys.exit(max((status for status, _ in verdicts), default=3))
