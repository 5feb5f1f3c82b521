"""Structures in metres, kilograms and newtons: do the lines go slack, how hard do they snap, do they break?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path

import numpy as np

from . import _engine
from ._assessed import Assessment, Elastic, Seas
from ._check import number, whole
from ._progress import bar


def _written(value: object) -> str:
    """A value as a case writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return value
    if isinstance(value, Sequence) or isinstance(value, np.ndarray):
        return f"[{', '.join(_written(one) for one in value)}]"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    raise TypeError(f"a number, a text, True or False, or [x, z] expected, not {type(value).__name__}")


def _changes(changes: Mapping[str, object] | None) -> list[str]:
    return [f"{key}={_written(value)}" for key, value in (changes or {}).items()]


class Structure:
    """A moored structure in SI units, read from a case as ``snapload assess`` takes it.

    The keys stand in the manual, under structures. Make one with :meth:`from_toml`, :meth:`parse`,
    :meth:`from_moordyn` or :meth:`example`.

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
        #: What of MoorDyn's file was left out or taken otherwise, a sentence each.
        self.notes = tuple(notes)

    @classmethod
    def from_toml(cls, path: str | PathLike[str], changes: Mapping[str, object] | None = None) -> Structure:
        """Read a case file.

        Parameters
        ----------
        path : str or path
            The file.
        changes : mapping, optional
            Keys with other values, such as ``{"wave.height": 2}``.

        Returns
        -------
        Structure
            The structure, checked.

        See Also
        --------
        snapload.Structure.parse : The same from a text.

        Examples
        --------
        >>> import snapload, tempfile, pathlib
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     file = pathlib.Path(folder) / "pontoon.toml"
        ...     _ = file.write_text(snapload.Structure.example().to_toml())
        ...     snapload.Structure.from_toml(file).assess(neighbours=0).standing
        'open'
        """
        return cls.parse(Path(path).read_text(encoding="utf-8"), changes, name=fspath(path))

    @classmethod
    def parse(cls, text: str, changes: Mapping[str, object] | None = None, name: str = "structure") -> Structure:
        """Read the text of a case.

        Parameters
        ----------
        text : str
            TOML.
        changes : mapping, optional
            Keys with other values.
        name : str, optional
            What errors and pages call it.

        Returns
        -------
        Structure
            The structure, checked.

        See Also
        --------
        snapload.Structure.from_toml : The same from a file.

        Examples
        --------
        >>> import snapload
        >>> text = snapload.Structure.example().to_toml()
        >>> snapload.Structure.parse(text, {"run.duration": 60}, name="short")
        <Structure short>
        """
        return cls(_engine.Structure.parse(name, text, _changes(changes)))

    @classmethod
    def example(cls) -> Structure:
        """The submerged cylinder of the manual.

        Returns
        -------
        Structure
            A cylinder of 3 m on two chains in 10 m of water, in waves of 2 m and 6 s.

        See Also
        --------
        snapload.Structure.from_toml : One of your own.

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

        Parameters
        ----------
        path : str or path
            The file.
        changes : mapping, optional
            What the file does not have, such as ``body.width``, ``run.restitution`` and waves.

        Returns
        -------
        Structure
            The structure; :attr:`notes` says what of the file was left out or taken otherwise.

        See Also
        --------
        snapload.Structure.to_moordyn : The other way.

        Examples
        --------
        >>> import snapload, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     snapload.Structure.example().to_moordyn(f"{folder}/lines.txt")
        ...     snapload.Structure.from_moordyn(f"{folder}/lines.txt").assess(neighbours=0).standing
        'open'
        """
        text = Path(path).read_text(encoding="utf-8")
        return cls(*_engine.Structure.from_moordyn(fspath(path), text, _changes(changes)))

    def to_moordyn(self, path: str | PathLike[str], segments: int = 1) -> None:
        """Write an input file for MoorDyn version 2.

        Parameters
        ----------
        path : str or path
            Where to.
        segments : int, optional
            Of each line; one is the spring that :meth:`elastic` takes.

        See Also
        --------
        snapload.Structure.from_moordyn : The other way.

        Examples
        --------
        >>> import snapload, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     snapload.Structure.example().to_moordyn(f"{folder}/lines.txt", segments=20)
        """
        text = self._engine.to_moordyn(whole("segments", segments))
        Path(path).write_text(text, encoding="utf-8", newline="\n")

    def replace(self, changes: Mapping[str, object]) -> Structure:
        """The same with other values of keys.

        Parameters
        ----------
        changes : mapping
            Keys such as ``wave.height``, ``line.length`` (of every line) or ``line.2.length``.

        Returns
        -------
        Structure
            Another one, checked; this one stays.

        See Also
        --------
        snapload.Structure.without : Leave out a whole table.

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
        """The same without a table that may be left out.

        Parameters
        ----------
        table : {'wave', 'sea', 'design', 'project'}
            The table.

        Returns
        -------
        Structure
            Another one; in still water without waves.

        See Also
        --------
        snapload.Structure.replace : Other values of keys.

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
        kept, inside = [], False
        for row in self.to_toml().splitlines():
            inside = row.strip() == f"[{table}]" if row.startswith("[") else inside
            kept += [] if inside else [row]
        return Structure(_engine.Structure.parse(self._engine.name, "\n".join(kept), []), self.notes)

    def to_toml(self) -> str:
        """The case as TOML.

        Returns
        -------
        str
            Every key that was given.

        See Also
        --------
        snapload.Structure.parse : The other way.

        Examples
        --------
        >>> import snapload
        >>> "[[line]]" in snapload.Structure.example().to_toml()
        True
        """
        return self._engine.to_toml()

    def assess(self, neighbours: int = 40, progress: bool = True) -> Assessment:
        """Run it, to tell whether the lines go slack, how hard they snap, and whether one breaks.

        Parameters
        ----------
        neighbours : int, optional
            Neighbours of the run, 1e-6 of the wave height away, that show how far it can be trusted.
        progress : bool, optional
            Whether to show a bar.

        Returns
        -------
        Assessment
            Verdict, tensions, snaps, checks and motion.

        See Also
        --------
        snapload.Structure.seas : Many records of a sea.
        snapload.Structure.elastic : Lines that stretch.

        Examples
        --------
        >>> import snapload
        >>> answer = snapload.Structure.example().assess(neighbours=4)
        >>> answer
        <Assessment: holds>
        """
        neighbours = whole("neighbours", neighbours)
        with bar("assess", neighbours, progress) as shown:
            return Assessment(self._engine.assess(neighbours, shown))

    def seas(self, seeds: int = 20, elastic: bool = False, progress: bool = True) -> Seas:
        """Run it in many records of its sea.

        Parameters
        ----------
        seeds : int, optional
            How many records.
        elastic : bool, optional
            Whether the lines are springs.
        progress : bool, optional
            Whether to show a bar.

        Returns
        -------
        Seas
            The distribution of the largest tension, and what the records come to.

        See Also
        --------
        snapload.Structure.assess : One record.

        Examples
        --------
        >>> import snapload
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
        >>> snapload.Structure.example().without("wave").replace(sea).seas(seeds=4)
        <Seas: 4 records>
        """
        seeds = whole("seeds", seeds)
        with bar("seas", seeds, progress) as shown:
            return Seas(self._engine.seas(seeds, elastic, shown))

    def elastic(self, stiffer: float = 1.0, every: float = 0.01, progress: bool = True) -> Elastic:
        """Run it on lines that stretch, and on lines that do not.

        Parameters
        ----------
        stiffer : float, optional
            Take the lines so many times as stiff as they are.
        every : float, optional
            Time between two states that are kept [s].
        progress : bool, optional
            Whether to show a bar.

        Returns
        -------
        Elastic
            Pulls, tensions and motion.

        See Also
        --------
        snapload.Structure.assess : Lines that do not stretch.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().replace({"run.duration": 5}).elastic()
        <Elastic: 2 pulls>
        """
        stiffer, every = number("stiffer", stiffer), number("every", every)
        with bar("elastic", 100, progress) as shown:
            return Elastic(self._engine.elastic(stiffer, every, shown))

    def __repr__(self) -> str:
        return f"<Structure {self._engine.name}>"
