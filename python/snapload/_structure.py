"""Moored structures in SI units: do the lines go slack, how hard do they snap, do they break?"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np

from . import _engine
from ._arguments import flag, number, utf8_text, whole_number
from ._progress import progress_bar
from ._structure_results import Assessment, Elastic, Seas


def _toml_value(value: object) -> str:
    """A value in the notation of a case file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        # A string of JSON is a string of TOML, which also forbids an unescaped delete character.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence) or isinstance(value, np.ndarray):
        return f"[{', '.join(_toml_value(item) for item in value)}]"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    raise TypeError(f"a number, a text, True or False, or [x, z] expected, not {type(value).__name__}")


def _changes(changes: Mapping[str, object] | None) -> list[str]:
    if not isinstance(changes or {}, Mapping):
        raise TypeError(f"changes = {changes!r} is not allowed; allowed: a dict such as {{'wave.height': 2}}")
    return [f"{key}={_toml_value(value)}" for key, value in (changes or {}).items()]


class Structure:
    """A moored structure in SI units, described by a case for ``snapload assess``.

    The manual lists the keys under structures. Use :meth:`from_toml`, :meth:`parse`, :meth:`from_moordyn` or
    :meth:`example` to create a structure. Structures are equal if all their keys have equal values, given or by
    default, and the files that they name had equal contents. A structure that was pickled is read again, with the
    files in the same folder.

    See Also
    --------
    snapload.Case : A case of two cables in nondimensional units.

    Examples
    --------
    >>> import snapload
    >>> structure = snapload.Structure.example()
    >>> structure.replace({"wave.height": 2.5, "line.2.length": 6.1})
    <Structure cylinder.toml>
    """

    def __init__(self, engine: _engine.Structure, notes: Sequence[str] = ()) -> None:
        self._engine = engine
        #: Parts of the MoorDyn file that were left out or interpreted differently, one sentence each.
        self.notes = tuple(notes)

    @classmethod
    def from_toml(cls, path: str | PathLike[str], changes: Mapping[str, object] | None = None) -> Structure:
        """Read a case file.

        Files that the case names, such as ``float.file``, are read from the folder of the case file.

        Parameters
        ----------
        path : str or path
            The file.
        changes : mapping, optional
            Keys to change and their new values, such as ``{"wave.height": 2}``.

        Returns
        -------
        Structure
            The structure, after all keys have been checked.

        See Also
        --------
        snapload.Structure.parse : Reads a case from a string.

        Examples
        --------
        >>> import snapload, tempfile, pathlib
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     file = pathlib.Path(folder) / "pontoon.toml"
        ...     _ = file.write_text(snapload.Structure.example().to_toml())
        ...     snapload.Structure.from_toml(file).assess(neighbours=0).standing
        'open'
        """
        text = utf8_text(fspath(path), Path(path).read_bytes())
        return cls(_engine.Structure.parse(fspath(path), _folder_of(path), text, _changes(changes)))

    @classmethod
    def parse(cls, text: str, changes: Mapping[str, object] | None = None, name: str = "structure") -> Structure:
        """Read a case from a string.

        Files that the case names, such as ``float.file``, are read from the current working directory, as a string
        has no folder of its own.

        Parameters
        ----------
        text : str
            The case as TOML.
        changes : mapping, optional
            Keys to change and their new values.
        name : str, optional
            The name of the structure in error messages and on pages.

        Returns
        -------
        Structure
            The structure, after all keys have been checked.

        See Also
        --------
        snapload.Structure.from_toml : Reads a case from a file.

        Examples
        --------
        >>> import snapload
        >>> text = snapload.Structure.example().to_toml()
        >>> snapload.Structure.parse(text, {"run.duration": 60}, name="short")
        <Structure short>
        """
        return cls(_engine.Structure.parse(name, Path.cwd(), text, _changes(changes)))

    @classmethod
    def example(cls) -> Structure:
        """Return the submerged cylinder of the manual.

        Returns
        -------
        Structure
            A cylinder of 3 m, moored by two chains in 10 m of water, in waves of 2 m and 6 s.

        See Also
        --------
        snapload.Structure.from_toml : Reads your own structure.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example()
        <Structure cylinder.toml>
        """
        return cls.parse(_engine.Structure.example(), name="cylinder.toml")

    @classmethod
    def from_moordyn(cls, path: str | PathLike[str], changes: Mapping[str, object] | None = None) -> Structure:
        """Read an input file of MoorDyn version 2.

        Files that the changes name, such as ``float.file``, are read from the folder of this file.

        Parameters
        ----------
        path : str or path
            The file.
        changes : mapping, optional
            Keys that the file does not contain, such as ``body.width``, ``run.restitution`` and waves.

        Returns
        -------
        Structure
            The structure; :attr:`notes` lists what was left out of the file or interpreted differently.

        See Also
        --------
        snapload.Structure.to_moordyn : Writes such a file.

        Examples
        --------
        >>> import snapload, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     snapload.Structure.example().to_moordyn(f"{folder}/lines.txt")
        ...     snapload.Structure.from_moordyn(f"{folder}/lines.txt").assess(neighbours=0).standing
        'open'
        """
        text = utf8_text(fspath(path), Path(path).read_bytes())
        return cls(*_engine.Structure.from_moordyn(fspath(path), _folder_of(path), text, _changes(changes)))

    def to_moordyn(self, path: str | PathLike[str], segments: int = 1) -> None:
        """Write an input file for MoorDyn version 2.

        Parameters
        ----------
        path : str or path
            The file to write.
        segments : int, optional
            Number of segments of each line; one segment is the spring of :meth:`elastic`.

        See Also
        --------
        snapload.Structure.from_moordyn : Reads such a file.

        Examples
        --------
        >>> import snapload, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     snapload.Structure.example().to_moordyn(f"{folder}/lines.txt", segments=20)
        """
        text = self._engine.to_moordyn(whole_number("segments", segments))
        Path(path).write_text(text, encoding="utf-8", newline="\n")

    def replace(self, changes: Mapping[str, object]) -> Structure:
        """Return a copy with other values of some keys.

        Parameters
        ----------
        changes : mapping
            Keys and their new values, such as ``wave.height``, ``line.length`` (of every line) or ``line.2.length``.

        Returns
        -------
        Structure
            A new structure, after all keys have been checked; this one does not change.

        See Also
        --------
        snapload.Structure.without : Removes a whole table.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().replace({"wave.height": 60})
        Traceback (most recent call last):
            ...
        ValueError: wave.height = 60 is not allowed; allowed: a number in m, 0 <= height <= 50
        """
        return Structure(self._engine.replace(_changes(changes)), self.notes)

    def without(self, table: str) -> Structure:
        """Return a copy without one of the optional tables.

        Parameters
        ----------
        table : {'wave', 'sea', 'design', 'project'}
            The table to remove.

        Returns
        -------
        Structure
            A new structure; without waves it is in still water.

        See Also
        --------
        snapload.Structure.replace : Changes values of keys.

        Examples
        --------
        >>> import snapload
        >>> still = snapload.Structure.example().without("wave")
        >>> still.assess(neighbours=0).lines["snaps"].values.tolist()
        [0, 0]
        """
        optional = ("wave", "sea", "design", "project")
        if table not in optional:
            raise ValueError(f"table = {table!r} is not allowed; allowed: one of {', '.join(optional)}")
        return Structure(self._engine.without(table), self.notes)

    def to_toml(self) -> str:
        """Return the case as TOML.

        Returns
        -------
        str
            All keys that were given.

        See Also
        --------
        snapload.Structure.parse : Reads such a text.

        Examples
        --------
        >>> import snapload
        >>> "[[line]]" in snapload.Structure.example().to_toml()
        True
        """
        return self._engine.to_toml()

    def assess(self, neighbours: int = 40, progress: bool = True) -> Assessment:
        """Find out whether the lines go slack, how hard they snap, and whether one breaks.

        Parameters
        ----------
        neighbours : int, optional
            Number of neighbours of the run, 1e-6 of the wave height away, that show how far it can be trusted.
        progress : bool, optional
            Whether to show a progress bar.

        Returns
        -------
        Assessment
            Verdict, tensions, snaps, checks and motion.

        See Also
        --------
        snapload.Structure.seas : Runs many records of a sea.
        snapload.Structure.elastic : Runs the structure with elastic lines.

        Examples
        --------
        >>> import snapload
        >>> answer = snapload.Structure.example().assess(neighbours=4)
        >>> answer
        <Assessment: open>
        """
        neighbours = whole_number("neighbours", neighbours)
        with progress_bar("assess", neighbours, progress) as report_progress:
            return Assessment(self, (neighbours,), self._engine.assess(neighbours, report_progress))

    def seas(self, seeds: int = 20, elastic: bool = False, progress: bool = True) -> Seas:
        """Run the structure in many records of its irregular sea.

        Parameters
        ----------
        seeds : int, optional
            Number of records.
        elastic : bool, optional
            Whether to model the lines as springs.
        progress : bool, optional
            Whether to show a progress bar.

        Returns
        -------
        Seas
            The distribution of the largest tension and the other results of the records.

        See Also
        --------
        snapload.Structure.assess : Runs one record.

        Examples
        --------
        >>> import snapload
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
        >>> snapload.Structure.example().without("wave").replace(sea).seas(seeds=4)
        <Seas: breaks, 4 records>
        """
        seeds, elastic = whole_number("seeds", seeds), flag("elastic", elastic)
        with progress_bar("seas", seeds, progress) as report_progress:
            return Seas(self._engine.seas(seeds, elastic, report_progress))

    def elastic(
        self, stiffer: float = 1.0, every: float = 0.01, neighbours: int = 10, progress: bool = True
    ) -> Elastic:
        """Run the structure with elastic lines and with inextensible lines.

        Parameters
        ----------
        stiffer : float, optional
            Factor by which the stiffness of all lines is multiplied.
        every : float, optional
            Time step at which states are stored [s].
        neighbours : int, optional
            Number of neighbours of the motion with elastic lines, 1e-6 of the wave height away, that show how far it
            can be trusted. Each takes as long as the motion itself.
        progress : bool, optional
            Whether to show a progress bar.

        Returns
        -------
        Elastic
            Pulls, tensions and motion.

        See Also
        --------
        snapload.Structure.assess : Runs only inextensible lines.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().replace({"run.duration": 5}).elastic()
        <Elastic: 3 pulls>
        """
        options = number("stiffer", stiffer), number("every", every), whole_number("neighbours", neighbours)
        # The motion is integrated twice.
        with progress_bar("elastic", 2 + options[2], progress) as report_progress:
            return Elastic(self, options, self._engine.elastic(*options, report_progress))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Structure) and self._engine == other._engine

    def __hash__(self) -> int:
        return hash(self._engine)

    def __reduce__(self) -> tuple[Any, ...]:
        engine = self._engine
        return _restore, (engine.name, fspath(engine.folder), engine.to_toml(), self.notes)

    def __repr__(self) -> str:
        return f"<Structure {self._engine.name}>"


def _folder_of(path: str | PathLike[str]) -> Path:
    """The folder of a file, which stays the same if the working directory changes."""
    return Path(path).absolute().parent


def _restore(name: str, folder: str, text: str, notes: tuple[str, ...]) -> Structure:
    return Structure(_engine.Structure.parse(name, Path(folder), text, []), notes)
