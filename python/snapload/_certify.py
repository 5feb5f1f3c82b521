"""The proof of a run."""

from __future__ import annotations

import json
from dataclasses import dataclass
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._result import Result
from ._table import Table

if TYPE_CHECKING:
    from ._run import Run


@dataclass(frozen=True, repr=False, eq=False)
class Certificate(Result):
    """What is proved about a run, and how many digits of the run in doubles it confirms.

    Attributes
    ----------
    proved : bool
        Whether the proof reaches the end of the run.
    end : str or None
        How the run ends, as in :attr:`End.reason <snapload.End>`; None if the proof does not reach the end.
    t : str
        The time of the last proved event [T], which is the end or the last impact, as a decimal of which each digit is
        right.
    undecided : str or None
        The reason why the proof stopped before the end of the run.
    bits : int
        Number of bits of the numbers in the proof.
    impacts : Table
        The proved impacts: ``cable``; ``t`` [T] and ``v_n`` [L/T] as the nearest doubles, and as decimals in
        ``t_exact`` and ``v_n_exact``, which `decimal.Decimal` reads.
    digits : numpy.ndarray, shape (number of rows of the run's impacts,)
        The number of confirmed digits of the time of each impact of the run. NaN if no such impact is proved, from the
        first impact in a different cable on, and for impulses that are transmitted to a taut cable.
    departure : int or None
        The first impact of the run, from 1, that differs from the proved one within five digits; None if there is none.
    text : str
        The certificate, which ``snapload certify --check`` can check.

    See Also
    --------
    snapload.Run.certify : Proves a run.

    Examples
    --------
    >>> import snapload
    >>> proof = snapload.Case(f_o=0.31).run().certify()
    >>> proof.t, proof.impacts[0]["t_exact"][:12]
    ('3.4521852165981283230485970', '0.4055014592')
    """

    proved: bool
    end: str | None
    t: str
    undecided: str | None
    bits: int
    impacts: Table
    digits: NDArray[np.float64]
    departure: int | None
    text: str
    _summary: str

    def to_file(self, path: str | PathLike[str]) -> None:
        """Write the certificate.

        Parameters
        ----------
        path : str or path
            The file to write.

        See Also
        --------
        snapload.Run.certify : Creates the certificate.

        Examples
        --------
        >>> import snapload, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     snapload.Case(f_o=0.31).run().certify().to_file(f"{folder}/run.cert")
        """
        Path(path).write_text(self.text, encoding="utf-8", newline="\n")

    def __str__(self) -> str:
        return self._summary

    def __repr__(self) -> str:
        how = self.end or "undecided"
        return f"<Certificate: {len(self.impacts)} impacts, {how} at t = {self.t}, {self.bits} bits>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def certify(run: Run) -> Certificate:
    """The proof of a run."""
    found: dict[str, Any] = json.loads(_engine.certify(run._engine, None))
    row, departure = found["certificate"], found["certificate"]["departure"]
    impacts = Table._from_columns(
        [
            ("cable", "", "number of the cable", np.array(found["cable"], dtype=np.int64)),
            ("t", "T", "time, the nearest double", np.array(found["t"], dtype=np.float64)),
            ("v_n", "L/T", "normal velocity, the nearest double", np.array(found["v_n"], dtype=np.float64)),
            ("t_exact", "", "time as a decimal [T]", np.array(found["t_exact"], dtype=np.str_)),
            ("v_n_exact", "", "normal velocity as a decimal [L/T]", np.array(found["v_n_exact"], dtype=np.str_)),
        ]
    )
    return Certificate(
        proved=row["proved"],
        end=row["reason"],
        t=row["t"],
        undecided=row["undecided"],
        bits=row["bits"],
        impacts=impacts,
        digits=np.array([np.nan if digits is None else digits for digits in found["digits"]], dtype=np.float64),
        departure=None if departure is None else departure["impact"],
        text=found["text"],
        _summary=found["words"],
    )
