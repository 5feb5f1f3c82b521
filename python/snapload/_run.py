"""A finished run of a case."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _engine
from ._base_run import BaseRun
from ._certify import Certificate, certify
from ._geometry import Geometry

if TYPE_CHECKING:
    from ._case import Case

#: What a run was asked for: uncertainty, tolerance, members, seed.
Options: TypeAlias = tuple[dict[str, float] | float | None, float, int | None, int]


class Run(BaseRun):
    """A finished run: how it ended, its impacts and modes, its norms, and how far it can be trusted.

    Made by :meth:`snapload.Case.run`.

    Attributes
    ----------
    case : Case
        The case that was run.

    See Also
    --------
    snapload.Case.run : Makes it.
    snapload.sweep : Runs many cases, and keeps what they come to.

    Examples
    --------
    >>> import snapload
    >>> run = snapload.Case(f_o=0.31).run()
    >>> run.end.reason, round(run.end.t, 4)
    ('rotation_limit', 3.4522)
    >>> run.outcome.certain
    True
    """

    def __init__(self, case: Case, options: Options | None, engine: _engine.Run | None) -> None:
        self.case = case
        self._options = options
        self._trusted = options is not None
        self._made = engine

    def _again(self) -> _engine.Run:
        case, options = self.case._engine, self._options
        return _engine.run_alone(case) if options is None else _engine.run(case, *options)

    def _geometry(self) -> Geometry:
        return Geometry.of_case(self.case)

    def to_json(self, dt: float | None = None) -> str:
        """Write the run as the line of JSON that ``snapload run --json -`` writes.

        Parameters
        ----------
        dt : float, optional
            Step of the motion [T], which is left out without it.

        Returns
        -------
        str
            One line.

        Raises
        ------
        ValueError
            If dt is not allowed, or the run was made without trust.

        See Also
        --------
        motion : The motion as an array.

        Examples
        --------
        >>> import json, snapload
        >>> json.loads(snapload.Case(f_o=0.31).run().to_json())["end"]["reason"]
        'rotation_limit'
        """
        return self._engine.to_json(dt)

    def certify(self) -> Certificate:
        """Prove the run in exact arithmetic: which impacts the motion has, when, and how it ends.

        The case counts as the decimals that its keys are written in, the shortest of each double. Where cables stay
        taut the proof goes on with them; that can take minutes.

        Returns
        -------
        Certificate
            What is proved, and how many digits of this run it confirms.

        Raises
        ------
        ValueError
            If the decimals of the case make no legal case or start.

        See Also
        --------
        snapload.verify : The same run with many digits, without a proof.

        Notes
        -----
        Python's lock is released meanwhile, and Ctrl-C ends it.

        Examples
        --------
        >>> import snapload
        >>> proof = snapload.Case(f_o=0.31).run().certify()
        >>> proof.proved, len(proof.impacts), proof.end
        (True, 12, 'rotation_limit')
        """
        return certify(self)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Run):
            return NotImplemented
        return self.case == other.case and self._head == other._head and self.impacts == other.impacts

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        told = {name: getattr(self, name) for name in ("_head", "_words", "impacts", "modes")}
        return _restore, (self.case, self._options, told)

    @cached_property
    def _words(self) -> tuple[str, list[tuple[str, str]]]:
        """What the command prints, and the same as labels and texts."""
        if self._options is None:
            lines = [("End", f"{self.end.reason.replace('_', ' ')} at t = {self.end.t:.4f}")]
            return repr(self), lines
        return self._engine.summary().rstrip("\n"), self._engine.summary_lines()

    def __repr__(self) -> str:
        return self._in_short(repr(self.case))


def _restore(case: Case, options: Options | None, told: dict[str, Any]) -> Run:
    run = Run(case, options, None)
    # These are stored here once they are computed.
    run.__dict__.update(told)
    return run
