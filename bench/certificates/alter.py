#!/usr/bin/env python3
"""Alters certificates in 28 ways, and counts what the two checkers accept: they must accept none.

usage: alter.py SNAPLOAD [COUNT]      SNAPLOAD is the program; needs python-flint for tools/certificate_check.py

Alterations that leave the statement true are not made: keys without effect on the case, v_stick moved where no impact's speed
lies between, and digits past the last that is printed.
"""

import copy
import json
import random
import subprocess
import sys
import tempfile
from collections import Counter
from decimal import Decimal
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))
import certificate_check

CASES = (["--set", "e=0.5"], ["--set", "f_o=0.31"], ["--case", "1910001000-559"], ["--set", "body=point"],
         ["--set", "e=0.7", "--set", "a=0.2", "--set", "b=0.1"], ["--set", "t_end=1.5"],
         ["--set", "max_impacts=12"], ["--case", "1921001000-559"])


def shifted(text, step):
    """A decimal with a decimal step added, exactly."""
    return format(Decimal(text) + step, "f")


def unit(text):
    return Decimal(1).scaleb(Decimal(text).as_tuple().exponent)


def random_impact(rng, c):
    return rng.randrange(len(c["impacts"]))


def time_by(size):
    def alter(rng, c):
        k = random_impact(rng, c)
        c["impacts"][k][1] = shifted(c["impacts"][k][1], Decimal(size) * rng.choice((1, -1)))
    return alter


def digit(place):
    def alter(rng, c):
        line = c["impacts"][random_impact(rng, c)]
        line[place] = str(Decimal(line[place]) + unit(line[place]) * rng.choice((1, -1)))
        line[place] = line[place].lower().replace("e+", "e")
    return alter


def speed(rng, c):
    line = c["impacts"][random_impact(rng, c)]
    line[2] = str(Decimal(line[2]) * (1 + Decimal(rng.choice(("1e-3", "-1e-6", "1e-12"))))).lower()[:60]


def cable(rng, c):
    line = c["impacts"][random_impact(rng, c)]
    line[0] = 3 - line[0]


def drop(rng, c):
    c["impacts"].pop(random_impact(rng, c))


def drop_last(rng, c):
    c["impacts"].pop()


def add(rng, c):
    k = random_impact(rng, c)
    c["impacts"].insert(k, [rng.choice((1, 2)), shifted(c["impacts"][k][1], Decimal("-1e-4")), "1.25e-2"])


def append(rng, c):
    c["impacts"].append([rng.choice((1, 2)), shifted(c["end"]["t"], Decimal("1e-3")), "1.25e-2"])


def double(rng, c):
    k = random_impact(rng, c)
    c["impacts"].insert(k, list(c["impacts"][k]))


def exchange(rng, c):
    k = rng.randrange(max(len(c["impacts"]) - 1, 1))
    lines = c["impacts"]
    lines[k], lines[(k + 1) % len(lines)] = lines[(k + 1) % len(lines)], lines[k]


def effective(c):
    keys = ["r", "e", "f_o", "nu", "omega", "x", "y", "vx", "vy"]
    return keys if c["case"]["body"] == "point" else keys + ["a", "theta", "vtheta"]


def parameter_last(rng, c):
    key = rng.choice(effective(c))
    c["case"][key] = shifted(c["case"][key], unit(c["case"][key]) / 1000)


def parameter_tiny(rng, c):
    key = rng.choice(effective(c))
    c["case"][key] = shifted(c["case"][key], Decimal("1e-16") * rng.choice((1, -1)))


def half_height(rng, c):
    c["case"]["b"] = shifted(c["case"]["b"], Decimal("1e-9"))


def inertia(rng, c):
    a, b = Decimal(c["case"]["a"]), Decimal(c["case"]["b"])
    natural = a * a if b == 0 else (a * a + b * b) / 3
    c["case"]["inertia"] = format(natural * (1 + Decimal("1e-14")), "f")[:60]


def reason(rng, c):
    others = certificate_check.REASONS - {c["end"]["reason"]}
    c["end"]["reason"] = rng.choice(sorted(others))


def end_time(rng, c):
    c["end"]["t"] = shifted(c["end"]["t"], unit(c["end"]["t"]) * rng.choice((1, -1)))


def end_state(rng, c):
    k = rng.randrange(6)
    c["end"]["state"][k] = shifted(c["end"]["state"][k], unit(c["end"]["state"][k]))


def end_sign(rng, c):
    k = rng.choice([k for k in range(6) if Decimal(c["end"]["state"][k])])
    c["end"]["state"][k] = shifted(c["end"]["state"][k], -2 * Decimal(c["end"]["state"][k]))


def no_digits(rng, c):
    # True of every number up to 5e9, as half a unit of its last place is that much.
    nothing, line = "0e10", c["impacts"][random_impact(rng, c)]
    place = rng.choice((1, 2, "t", "state"))
    if place == "state":
        c["end"]["state"] = [nothing] * 6
    elif place == "t":
        c["end"]["t"] = nothing
    else:
        line[place] = nothing


def settle_flag(rng, c):
    if c["end"]["reason"] != "settled":
        return reason(rng, c)
    c["case"]["stop_when_settled"] = False


def slide_flag(rng, c):
    if c["end"]["reason"] != "sticks":
        return end_time(rng, c)
    c["case"]["stop_when_sliding"] = True


def fewer(rng, c):
    # At the impact that ends a run by sticking, the limit is looked at last.
    c["case"]["max_impacts"] = rng.randrange(1, max(len(c["impacts"]) - 1, 2))
    if c["case"]["max_impacts"] >= len(c["impacts"]) - 1:
        end_time(rng, c)


def sooner(rng, c):
    c["case"]["t_end"] = shifted(c["end"]["t"], -Decimal(rng.choice(("0.01", "0.1"))))


def faster_stick(rng, c):
    speeds = [Decimal(line[2]) for line in c["impacts"]]
    c["case"]["v_stick"] = format(sorted(speeds)[len(speeds) // 2] * 2, "f")
    end_time(rng, c)  # an impact without tension would only graze


KINDS = {
    "a time by 1e-12": time_by("1e-12"), "a time by 1e-9": time_by("1e-9"), "a time by 1e-6": time_by("1e-6"),
    "a time by 1e-3": time_by("1e-3"), "a time's last digit": digit(1), "v_n": speed, "v_n's last digit": digit(2),
    "a cable": cable, "an impact dropped": drop, "the last dropped": drop_last, "an impact added": add,
    "an impact appended": append, "an impact doubled": double, "two exchanged": exchange,
    "a parameter's last decimal": parameter_last, "a parameter by 1e-16": parameter_tiny, "half-height": half_height,
    "inertia": inertia, "reason": reason, "end time": end_time, "end state": end_state, "a sign of the end": end_sign,
    "settling flag": settle_flag, "sliding flag": slide_flag, "fewer impacts allowed": fewer, "t_end": sooner,
    "v_stick": faster_stick, "no digits": no_digits,
}


def check_with_program(binary, text):
    with tempfile.NamedTemporaryFile("w", suffix=".cert") as file:
        file.write(text)
        file.flush()
        result = subprocess.run([binary, "certify", "--check", file.name], capture_output=True, text=True, check=False)
        return result.returncode


def main(binary, count):
    rng = random.Random(1)
    certificates = []
    for arguments in CASES:
        result = subprocess.run([binary, "certify", *arguments, "--json", "-"], capture_output=True, text=True, check=True)
        certificate = json.loads(result.stdout)
        assert check_with_program(binary, result.stdout) == 0 and certificate_check.check(result.stdout)[0] == 0, arguments
        certificates.append(certificate)
    accepted, statuses = [], Counter()
    for n in range(count):
        kind = list(KINDS)[n % len(KINDS)]
        certificate = copy.deepcopy(rng.choice([c for c in certificates if len(c["impacts"]) > 2]))
        before = json.dumps(certificate)
        if kind in ("half-height", "inertia") and certificate["case"]["body"] == "point":
            certificate["case"]["a"] = "0.1"
        KINDS[kind](rng, certificate)
        text = json.dumps(certificate)
        assert text != before, kind
        verdicts = check_with_program(binary, text), certificate_check.check(text)[0]
        statuses.update([("program", verdicts[0]), ("Python", verdicts[1])])
        if 0 in verdicts:
            accepted.append((kind, verdicts, certificate["case"]))
    print(f"{count} altered certificates of {len(KINDS)} kinds")
    for (checker, status), count in sorted(statuses.items()):
        print(f"  {checker}: exit status {status}: {count}")
    for kind, verdicts, case in accepted:
        print(f"ACCEPTED {kind} {verdicts} {case}")
    return 1 if accepted else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 1000))
