"""The common part of the results of structures: data, words, equality, and pickling."""

from __future__ import annotations

import json
from html import escape
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from ._engine import __version__

if TYPE_CHECKING:
    from ._structure import Structure


class _EngineRun(Protocol):
    """What the runs of the engine have in common."""

    def json(self) -> str: ...
    def summary(self) -> str: ...


_EngineResult = TypeVar("_EngineResult", bound=_EngineRun)


class StructureResult:
    """The common part of all results. Results are equal if their data are, without the time that they took."""

    def __init__(self, data: dict[str, Any], summary: str) -> None:
        #: Everything that the command writes as JSON. Each key ends in the SI unit of its value.
        self.data = data
        self._summary = summary

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, StructureResult):
            return NotImplemented
        return bool(_without_durations(self.data) == _without_durations(other.data))

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        return self._summary

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self._summary)}</pre>"


class RepeatableResult(StructureResult, Generic[_EngineResult]):
    """A result that needs the run of the engine for its motion or its page.

    The run does not travel to other processes, where it is repeated with the same options if it is needed.
    """

    def __init__(
        self,
        structure: Structure,
        options: tuple[Any, ...],
        engine: _EngineResult | None = None,
        stored: tuple[dict[str, Any], str] | None = None,
    ) -> None:
        self._structure = structure
        self._options = options
        if stored is None:
            engine = engine or self._repeat()
            stored = json.loads(engine.json()), engine.summary()
        self._engine_object: _EngineResult | None = engine
        super().__init__(*stored)

    def _repeat(self) -> _EngineResult:
        """Runs the structure with the options."""
        raise NotImplementedError

    @property
    def _engine(self) -> _EngineResult:
        engine = self._engine_object
        if engine is None:
            engine = self._repeat()
            if _without_durations(json.loads(engine.json())) != _without_durations(self.data):
                raise ValueError(
                    f"the motion and the page of this result can not be computed again: snapload {__version__} "
                    "gives other results for its structure than those in its data; run the structure again"
                )
            self._engine_object = engine
        return engine

    def __eq__(self, other: object) -> bool:
        equal = super().__eq__(other)
        if equal is not True or not isinstance(other, RepeatableResult):
            return equal
        return self._structure == other._structure and self._options == other._options

    __hash__ = None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._structure, self._options, None, (self.data, self._summary))


def _without_durations(data: Any) -> Any:
    """The data without the time that the computation took, which differs between equal computations."""
    if not isinstance(data, dict):
        return data
    return {key: _without_durations(value) for key, value in data.items() if key != "took_s"}
