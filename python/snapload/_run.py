"""A finished run of a case."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _engine
from ._certify import Certificate, certify
from ._geometry import Geometry
from ._run_base import BaseRun

if TYPE_CHECKING:
    from ._case import Case

#: The options of a run: uncertainty, tolerance, members, seed.
Options: TypeAlias = tuple[dict[str, float] | float | None, float, int | None, int]


class Run(BaseRun):
    """A finished run with its end, impacts, modes and norms, and how far it can be trusted.

    Returned by :meth:`snapload.Case.run`.

    Attributes
    ----------
    case : Case
        The case that was run.

    See Also
    --------
    snapload.Case.run : Runs a case.
    snapload.sweep : Runs many cases, and stores their results.

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
        self._engine_object = engine

    def _rerun(self) -> _engine.Run:
        case, options = self.case._engine, self._options
        return _engine.run_alone(case) if options is None else _engine.run(case, *options)

    def _geometry(self) -> Geometry:
        return Geometry.of_case(self.case)

    def to_json(self, dt: float | None = None) -> str:
        """Return the run as the line of JSON that ``snapload run --json -`` writes.

        Parameters
        ----------
        dt : float, optional
            Time step of the motion [T]; without it the motion is left out.

        Returns
        -------
        str
            One line of JSON.

        Raises
        ------
        ValueError
            If `dt` is not allowed, or the run was made without trust.

        See Also
        --------
        motion : Returns the motion as an array.

        Examples
        --------
        >>> import json, snapload
        >>> json.loads(snapload.Case(f_o=0.31).run().to_json())["end"]["reason"]
        'rotation_limit'
        """
        return self._engine.to_json(dt)

    def certify(self) -> Certificate:
        """Prove in exact arithmetic which impacts the motion has, when they happen, and how it ends.

        The values of the keys count as decimals, each the shortest one of its double. Where cables stay taut, the proof
        continues with the taut motion, which can take minutes.

        Returns
        -------
        Certificate
            The result of the proof, and how many digits of this run it confirms.

        Raises
        ------
        ValueError
            If the decimals of the case do not give a legal case or start.

        See Also
        --------
        snapload.verify : Repeats the run with many digits, without a proof.

        Notes
        -----
        Python's lock is released during the computation, and Ctrl-C interrupts it.

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
        cached = {name: getattr(self, name) for name in ("_head", "_summary", "impacts", "modes")}
        return _restore, (self.case, self._options, cached)

    @cached_property
    def _summary(self) -> tuple[str, list[tuple[str, str]]]:
        """The summary that the command prints, and the same as pairs of label and text."""
        if self._options is None:
            lines = [("End", f"{self.end.reason.replace('_', ' ')} at t = {self.end.t:.4f}")]
            return repr(self), lines
        return self._engine.summary().rstrip("\n"), self._engine.summary_lines()

    def __repr__(self) -> str:
        return self._short_repr(repr(self.case))


def _restore(case: Case, options: Options | None, cached: dict[str, Any]) -> Run:
    run = Run(case, options, None)
    # These are stored here once they are computed.
    run.__dict__.update(cached)
    return run
