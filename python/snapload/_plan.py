"""The cases of a study, in a form that can be sent to other processes."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike, fspath
from pathlib import Path
from shutil import rmtree
from typing import Any
from weakref import finalize

from . import _engine
from ._axes import listed, side, table_of
from ._case import Case
from ._check import engine_of, there, whole


@dataclass(frozen=True)
class Plan:
    """A case, and a grid, a box with random points in it, or a table of cases."""

    case: Case
    trust: bool
    #: Sides of a box or axes of a grid.
    axes: list[tuple[str, Any]] = field(default_factory=list)
    #: How many points in the box, and which.
    random: tuple[int, int] | None = None
    #: Name and contents of the file with a row a case, and what errors call it.
    table: tuple[str, bytes, str] | None = None

    @cached_property
    def study(self) -> _engine.Study:
        """The study of the engine."""
        case = self.case._engine
        if self.table is not None:
            # The file is read while the study runs.
            room = tempfile.mkdtemp(prefix="snapload-")
            finalize(self, rmtree, room, ignore_errors=True)
            name, contents, called = self.table
            path = Path(room) / name
            path.write_bytes(contents)
            return _engine.Study.listed(case, path, called, self.trust)
        if self.random is not None:
            return _engine.Study.random(case, self.axes, *self.random, self.trust)
        return _engine.Study.grid(case, self.axes, self.trust)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "study"}


def plan(case: Case, trust: bool, axes: Mapping[str, Any], random: int | None, seed: int | None, cases: Any) -> Plan:
    """The plan of a call of ``sweep``, after checks."""
    engine_of(case)
    if cases is not None:
        if axes or random is not None:
            raise ValueError("cases determines what varies; leave out random, seed and the values of keys, or cases")
        if isinstance(cases, (str, PathLike)):
            path = Path(there(fspath(cases)))
            return Plan(case, trust, table=(path.name, path.read_bytes(), str(path)))
        return Plan(case, trust, table=("cases.csv", table_of(cases), "the list of cases"))
    if random is None:
        if seed is not None:
            raise ValueError(f"seed = {seed!r} selects random points, and there are none; add random, or leave it out")
        return Plan(case, trust, [(key, listed(key, values)) for key, values in axes.items()])
    points = whole("random", random), whole("seed", 0 if seed is None else seed)
    return Plan(case, trust, [(key, side(key, ends)) for key, ends in axes.items()], random=points)
