"""A run beside its proof: the command's, which other code confirms."""

from __future__ import annotations

import subprocess
import sys
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
import snapload


@pytest.fixture(scope="module")
def proof():
    return snapload.Case().run(members=0).certify()


def test_the_proof_is_that_of_the_command(proof, command_json, command, tmp_path: Path):
    data = command_json("run", "--certify", "--ensemble", "0")["certificate"]
    assert (proof.proved, proof.end, proof.t) == (data["proved"], data["reason"], data["t"])
    assert (proof.bits, proof.undecided) == (data["bits"], data["undecided"])
    assert (len(proof.impacts), proof.departure) == (data["impacts"], data["departure"]["impact"])
    mine, theirs = tmp_path / "mine.cert", tmp_path / "theirs.cert"
    proof.to_file(mine)
    command("certify", "--out", str(theirs))
    assert mine.read_bytes() == theirs.read_bytes()
    command("certify", "--check", str(mine))


def test_its_impacts_are_those_of_a_run_with_many_digits(proof):
    # Other code: the run over numbers of 76 digits, of which more than 17 are left at the end.
    exact = snapload.verify(snapload.Case(), digits=120).exact
    assert len(exact) == len(proof.impacts)
    for one, other in zip(proof.impacts, exact, strict=True):
        assert one["cable"] == other["cable"]
        assert abs(Decimal(one["t_exact"]) - Decimal(other["t"])) <= Decimal("0.5e-25")
        assert abs(Decimal(one["v_n_exact"]) / Decimal(other["v_n"]) - 1) <= Decimal("1e-16")
        assert (one["t"], one["v_n"]) == (float(one["t_exact"]), float(one["v_n_exact"]))


def test_digits_are_those_that_the_proof_confirms(proof):
    run = snapload.Case().run(members=0)
    assert len(proof.digits) == len(run.impacts)
    known = np.isfinite(proof.digits)
    # Up to the first impact of another cable, which comes after the first that differs at all.
    count = int(known.sum())
    assert known[:count].all() and proof.departure - 1 <= count <= len(proof.impacts)
    assert (run.impacts["cable"][:count] == proof.impacts["cable"][:count]).all()
    error = np.abs(run.impacts["t"][:count] - proof.impacts["t"][:count])
    scale = np.maximum(1.0, proof.impacts["t"][:count])
    assert (error <= 1.001 * scale * 10.0 ** -proof.digits[:count] + 1e-16).all()
    assert proof.digits[0] > 15 > proof.digits[count - 1]


def test_an_unproved_run_reports_why():
    # Its own mirror image: both cables snap at one instant.
    proof = snapload.Case(f_o=0).run(members=0).certify()
    assert (proof.proved, proof.end, len(proof.impacts)) == (False, None, 0)
    assert proof.undecided.startswith("the length of cable 1 and the length of cable 2: ")
    assert "all at one instant" in proof.undecided
    assert "then undecided: the length of cable 1" in str(proof)
    assert repr(proof).startswith("<Certificate: 0 impacts, undecided at t = 0")


def test_a_run_without_trust_has_a_proof_too():
    proof = snapload.Case(f_o=0.31).run(trust=False).certify()
    assert proof.proved and proof.departure is None
    assert proof == snapload.Case(f_o=0.31).run().certify()
    assert str(proof).startswith("12 impacts, rotation limit at t = 3.4521852165981")


ENDLESS = """
import signal, threading, snapload
run = snapload.Case(stop_when_settled=False).run(trust=False)
threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
try:
    run.certify()
except KeyboardInterrupt:
    print("interrupted")
"""


def test_a_proof_can_be_interrupted():
    result = subprocess.run([sys.executable, "-c", ENDLESS], capture_output=True, text=True, timeout=60)
    assert result.stdout == "interrupted\n", result.stderr
