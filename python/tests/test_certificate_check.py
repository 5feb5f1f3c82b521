"""The checker of certificates in tools/ passes a true one and nothing that is altered."""

from __future__ import annotations

import copy
import importlib.util
import json
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
SPEC = importlib.util.spec_from_file_location("certificate_check", ROOT / "tools" / "certificate_check.py")
assert SPEC is not None
assert SPEC.loader is not None
certificate_check = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(certificate_check)

#: Written by `snapload certify --case 1510001000-359`.
TRUE_ONE = json.loads((Path(__file__).parent / "data" / "bounces.cert").read_text(encoding="utf-8"))


def status(certificate: Any) -> int:
    """The exit status for a certificate."""
    return certificate_check.check(json.dumps(certificate))[0]


def next_digit(text: str) -> str:
    """A decimal with its last digit one higher."""
    number = Decimal(text)
    return str(number + Decimal(1).scaleb(number.as_tuple().exponent)).lower().replace("e+", "e")


def test_a_true_certificate_is_proved() -> None:
    assert status(TRUE_ONE) == 0


@pytest.mark.parametrize("field", [1, 2])
@pytest.mark.parametrize("impact", [0, 10, 20])
def test_a_last_digit_is_refused(impact: int, field: int) -> None:
    altered = copy.deepcopy(TRUE_ONE)
    altered["impacts"][impact][field] = next_digit(altered["impacts"][impact][field])
    assert status(altered) == 1


@pytest.mark.parametrize("key", ["r", "e", "a", "f_o", "nu", "omega", "x", "y", "theta", "vx", "vy", "vtheta"])
def test_a_parameter_by_one_part_in_ten_to_the_16_is_refused(key: str) -> None:
    altered = copy.deepcopy(TRUE_ONE)
    altered["case"][key] = format(Decimal(altered["case"][key]) + Decimal("1e-16"), "f")
    assert status(altered) == 1


def test_lists_and_ends_are_compared() -> None:
    for change in ("dropped", "doubled", "cable", "reason", "end", "state"):
        altered = copy.deepcopy(TRUE_ONE)
        lines, end = altered["impacts"], altered["end"]
        if change == "dropped":
            lines.pop(5)
        elif change == "doubled":
            lines.insert(5, lines[5])
        elif change == "cable":
            lines[5][0] = 3 - lines[5][0]
        elif change == "reason":
            end["reason"] = "sticks"
        elif change == "end":
            end["t"] = next_digit(end["t"])
        else:
            end["state"][4] = next_digit(end["state"][4])
        assert status(altered) == 1, change


def test_an_exact_graze_is_undecided_and_its_neighbours_are_not() -> None:
    """Cable 1 of a point mass is touched at t = 1/2 without being struck; 1e-38 higher it is missed."""
    keys = {"a": "0", "b": "0", "r": "1.25", "f_o": "1", "omega": "0", "x": "-0.145", "vx": "-0.36", "vy": "0.02"}
    graze = copy.deepcopy(TRUE_ONE)
    graze["case"] |= keys | {"body": "point", "t_end": "0.6", "y": "0.515"}
    graze["impacts"] = []
    # x = -0.145 - 0.36 t + t²/2 and y + 0.02 t - t²/2 at t = 0.6.
    state = [f"{text}{'0' * 22}" for text in ("-0.181", "0.347", "0.000", "0.240", "-0.580", "0.000")]
    graze["end"] = {"reason": "end_time", "t": f"0.6{'0' * 24}", "state": state}
    assert status(graze) == 2
    zeros = "0" * 34
    graze["case"]["y"] = f"0.515{zeros}1"
    assert status(graze) == 0


def test_other_shapes_are_no_certificates() -> None:
    altered = copy.deepcopy(TRUE_ONE)
    del altered["case"]["inertia"]
    assert status(altered) == 3
    assert status(TRUE_ONE | {"more": 1}) == 3
    assert status(TRUE_ONE | {"format": "snapload-certificate-2"}) == 3
    assert status(TRUE_ONE | {"bits": 32}) == 3
    assert status([]) == 3
    assert certificate_check.check("{")[0] == 3
    twice = json.dumps(TRUE_ONE).replace('"bits"', '"bits": 256, "bits"', 1)
    assert certificate_check.check(twice) == (3, "no certificate: a key is given twice")


def claim_nothing(certificate: Any, place: str) -> None:
    """A claim that is true of every number, as half a unit of its last place is 5e9."""
    lines, end = certificate["impacts"], certificate["end"]
    if place == "state":
        end["state"] = ["0e10"] * 6
    elif place == "end":
        end["t"] = "0e10"
    else:
        for line in lines:
            line[1 if place == "time" else 2] = "0e10"


@pytest.mark.parametrize("place", ["time", "speed", "state", "end"])
def test_claims_of_no_digits_are_no_certificate(place: str) -> None:
    altered = copy.deepcopy(TRUE_ONE)
    claim_nothing(altered, place)
    assert status(altered) == 3


def partial(impacts: int) -> Any:
    """The true one with so many of its impacts, as `snapload certify --partial` ends what it can not decide."""
    return TRUE_ONE | {"impacts": copy.deepcopy(TRUE_ONE["impacts"][:impacts]), "end": {"reason": "undecided"}}


@pytest.mark.parametrize("impacts", [0, 3, len(TRUE_ONE["impacts"])])
def test_a_part_of_a_run_is_proved_in_part(impacts: int) -> None:
    status, words = certificate_check.check(json.dumps(partial(impacts)))
    assert status == 2
    assert words.startswith(f"proved in part: {impacts} impacts")


def test_a_false_part_is_refused() -> None:
    wrong = partial(3)
    wrong["impacts"][2][1] = next_digit(wrong["impacts"][2][1])
    assert status(wrong) == 1
    more = partial(len(TRUE_ONE["impacts"]))
    more["impacts"].append(more["impacts"][-1])
    assert status(more) == 1
    assert status(partial(3) | {"end": {"reason": "undecided", "t": TRUE_ONE["end"]["t"]}}) == 3


def test_a_file_that_can_not_be_read_is_no_certificate(tmp_path):
    other = tmp_path / "other.cert"
    other.write_bytes(b"\xff\xfe{")
    assert certificate_check.check(other)[0] == 3
    assert certificate_check.check(tmp_path / "missing.cert")[0] == 3
