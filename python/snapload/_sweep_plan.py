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
from ._arguments import engine_case, existing_file, flag, whole_number
from ._axes import axis_values, cases_csv, range_ends
from ._case import Case


@dataclass(frozen=True)
class SweepPlan:
    """A case, and a grid, a box with random points in it, or a table of cases."""

    case: Case
    trust: bool
    #: Sides of a box or axes of a grid.
    axes: list[tuple[str, Any]] = field(default_factory=list)
    #: Number of random points in the box, and their seed.
    random: tuple[int, int] | None = None
    #: Name and contents of the file with one case per row, and its name in errors.
    table: tuple[str, bytes, str] | None = None

    @cached_property
    def study(self) -> _engine.Study:
        """The study of the engine."""
        case = self.case._engine
        if self.table is not None:
            # The file is read while the study runs.
            folder = tempfile.mkdtemp(prefix="snapload-")
            finalize(self, rmtree, folder, ignore_errors=True)
            name, contents, display_name = self.table
            file = Path(folder) / name
            file.write_bytes(contents)
            return _engine.Study.listed(case, file, display_name, self.trust)
        if self.random is not None:
            return _engine.Study.random(case, self.axes, *self.random, self.trust)
        return _engine.Study.grid(case, self.axes, self.trust)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "study"}


def make_plan(
    case: Case, trust: bool, axes: Mapping[str, Any], random: int | None, seed: int | None, cases: Any
) -> SweepPlan:
    """The plan of a call of ``sweep``, after checks."""
    engine_case(case)
    trust = flag("trust", trust)
    if cases is not None:
        if axes or random is not None:
            raise ValueError("cases determines what varies; leave out random, seed and the values of keys, or cases")
        if isinstance(cases, (str, PathLike)):
            path = Path(existing_file(fspath(cases)))
            return SweepPlan(case, trust, table=(path.name, path.read_bytes(), str(path)))
        return SweepPlan(case, trust, table=("cases.csv", cases_csv(cases), "the list of cases"))
    if random is None:
        if seed is not None:
            raise ValueError(f"seed = {seed!r} selects random points, and there are none; add random, or leave it out")
        return SweepPlan(case, trust, [(key, axis_values(key, values)) for key, values in axes.items()])
    points = whole_number("random", random), whole_number("seed", 0 if seed is None else seed)
    sides = [(key, range_ends(key, ends, " with random")) for key, ends in axes.items()]
    return SweepPlan(case, trust, sides, random=points)
