"""Results of the analysis of structures, with units."""

from __future__ import annotations

import json
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from . import _engine
from ._lazy_import import LazyModule
from ._structure_base import RepeatableResult, StructureResult
from ._structure_datasets import COLUMNS, attributes_of, finite_row, motion_dataset, rows_dataset

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")


class Assessment(RepeatableResult[_engine.Assessment]):
    """The response of a structure to one regular wave or one record of a sea.

    Attributes
    ----------
    data : dict
        Everything that ``snapload assess --json`` writes. Each key ends in the SI unit of its value.

    See Also
    --------
    snapload.Structure.assess : Runs a structure and returns its assessment.

    Examples
    --------
    >>> import snapload
    >>> answer = snapload.Structure.example().assess(neighbours=0)
    >>> answer.standing
    'open'
    >>> answer.lines["slack_fraction"].dims
    ('line',)
    """

    def _repeat(self) -> _engine.Assessment:
        (neighbours,) = self._options
        return self._structure._engine.assess(neighbours, None)

    @property
    def standing(self) -> str:
        """The verdict in one word: ``holds``, ``breaks``, ``exceeds``, ``open`` or ``unknown``.

        ``exceeds`` means that the body turned over or reached the sea floor. ``open`` means that the tensions are not
        reliable, that a line would break before anything is judged, in a neighbour or in a wave that differs by one
        percent, or that the run is one record of a sea, in which no line breaks.

        See Also
        --------
        snapload.Assessment.verdict : The verdict in a sentence.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().assess(neighbours=0).standing
        'open'
        """
        return str(self.data["verdict"]["standing"])

    @property
    def verdict(self) -> str:
        """The verdict in a sentence or two.

        See Also
        --------
        snapload.Assessment.standing : The verdict in one word.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().assess(neighbours=0).verdict[:24]
        'Lines go slack and snap,'
        """
        return str(self.data["verdict"]["words"])

    @property
    def lines(self) -> xarray.Dataset:
        """Results of each line: tensions [N], snaps, fraction of the time in which it is slack, utilisation.

        See Also
        --------
        snapload.Assessment.snaps : Results of each snap.

        Examples
        --------
        >>> import snapload
        >>> lines = snapload.Structure.example().assess(neighbours=0).lines
        >>> lines["held_tension_n"].attrs["units"], lines["line"].values.tolist()
        ('N', [1, 2])
        """
        return rows_dataset(self.data["lines"], "line", index="line")

    @property
    def snaps(self) -> xarray.Dataset:
        """Every snap, and every impact of a taut line, of 1 cm/s or more, in order of time.

        See Also
        --------
        snapload.Assessment.lines : Results of each line.

        Examples
        --------
        >>> import snapload
        >>> snaps = snapload.Structure.example().assess(neighbours=0).snaps
        >>> snaps["impulse_n_s"].attrs["units"]
        'N s'
        """
        return rows_dataset(self.data["snaps"], "snap", COLUMNS["snaps"])

    @property
    def checks(self) -> xarray.Dataset:
        """Design checks by the rule in the table ``[design]``; empty without that table.

        See Also
        --------
        snapload.Assessment.verdict : The verdict without safety factors.

        Examples
        --------
        >>> import snapload
        >>> structure = snapload.Structure.example().replace({"design.least_share": 0})
        >>> structure.assess(neighbours=0).checks["answer"].values.tolist()
        ['fails', 'fails']
        """
        return rows_dataset(self.data["checks"], "check", COLUMNS["checks"])

    def motion(self, times: ArrayLike) -> xarray.Dataset:
        """Return position, rotation and tensions at given times.

        Parameters
        ----------
        times : array_like, shape (n,)
            Times within the run [s], from 0 to ``data["end"]["t_s"]``.

        Returns
        -------
        xarray.Dataset
            ``x_m``, ``z_m`` and ``theta_rad`` along ``t_s``, and ``tension_n`` along ``t_s`` and ``line``. The tension
            of a slack line is 0.

        Raises
        ------
        ValueError
            If a time is before the start or after the end of the run, or not a number.

        See Also
        --------
        snapload.Elastic.motion : The motion with elastic lines.

        Examples
        --------
        >>> import snapload
        >>> motion = snapload.Structure.example().assess(neighbours=0).motion([0, 1, 2])
        >>> dict(motion.sizes)
        {'t_s': 3, 'line': 2}
        """
        return motion_dataset(self._engine.motion(finite_row(times)), len(self.data["lines"]))

    def to_html(self, path: str | PathLike[str]) -> None:
        """Write the results as an HTML page for a design note.

        Parameters
        ----------
        path : str or path
            The file to write.

        See Also
        --------
        snapload.Seas.to_html : Writes the page of many records.

        Examples
        --------
        >>> import snapload, tempfile
        >>> answer = snapload.Structure.example().assess(neighbours=0)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     answer.to_html(f"{folder}/note.html")
        """
        Path(path).write_text(self._engine.page(), encoding="utf-8", newline="\n")

    def __repr__(self) -> str:
        return f"<Assessment: {self.standing}>"


class Seas(StructureResult):
    """The response of a structure to many records of a sea.

    Attributes
    ----------
    data : dict
        Everything that ``snapload seas --json`` writes.

    See Also
    --------
    snapload.Structure.seas : Runs the records and returns this result.

    Examples
    --------
    >>> import snapload
    >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
    >>> snapload.Structure.example().without("wave").replace(sea).seas(seeds=4).largest_tensions_n.size
    4
    """

    def __init__(self, engine_results: tuple[str, str, str]) -> None:
        text, summary, self._page = engine_results
        super().__init__(json.loads(text), summary)

    @property
    def standing(self) -> str:
        """The verdict in one word.

        It is ``holds``, ``breaks`` (in at least one record a line does, or the mooring fails), ``unknown``, or ``open``
        if tensions are not reliable, a line would break before anything is judged, or records are too short or few to
        tell whether one breaks in three hours.

        See Also
        --------
        snapload.Seas.words : The result in a sentence or two.

        Examples
        --------
        >>> import snapload
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
        >>> snapload.Structure.example().without("wave").replace(sea).seas(seeds=4).standing
        'breaks'
        """
        return str(self.data["standing"])

    @property
    def words(self) -> str:
        """The result in a sentence or two.

        See Also
        --------
        snapload.Seas.largest_tensions_n : The largest tensions, on which it is based.

        Examples
        --------
        >>> import snapload
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
        >>> "of 4 records" in snapload.Structure.example().without("wave").replace(sea).seas(seeds=4).words
        True
        """
        return str(self.data["words"])

    @property
    def checks(self) -> xarray.Dataset:
        """Design checks by the rule in the table ``[design]`` over all records; empty without that table.

        See Also
        --------
        snapload.Assessment.checks : The checks of one record.

        Examples
        --------
        >>> import snapload
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600, "design.least_share": 0}
        >>> seas = snapload.Structure.example().without("wave").replace(sea).seas(seeds=4)
        >>> seas.checks["passing"].values.tolist()
        [0, 0]
        """
        return rows_dataset(self.data["checks"], "check", COLUMNS["checks of seas"])

    @property
    def largest_tensions_n(self) -> xarray.DataArray:
        """The largest tension of each record [N], in a snap or in a taut line; empty if tensions are not known.

        It is NaN for a record that ended before the judged time.

        See Also
        --------
        snapload.Seas.words : The result in words.

        Examples
        --------
        >>> import snapload
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
        >>> seas = snapload.Structure.example().without("wave").replace(sea).seas(seeds=4)
        >>> seas.largest_tensions_n.attrs["units"]
        'N'
        """
        values = np.array(self.data["largest_tensions_n"] or [], dtype=np.float64)
        return xarray.DataArray(
            values, dims="record", name="largest_tensions_n", attrs=attributes_of("largest_tensions_n")
        )

    def to_html(self, path: str | PathLike[str]) -> None:
        """Write the results as an HTML page.

        Parameters
        ----------
        path : str or path
            The file to write.

        See Also
        --------
        snapload.Assessment.to_html : Writes the page of one record.

        Examples
        --------
        >>> import snapload, tempfile
        >>> sea = {"sea.hs": 2, "sea.tp": 6, "run.duration": 600}
        >>> seas = snapload.Structure.example().without("wave").replace(sea).seas(seeds=4)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     seas.to_html(f"{folder}/seas.html")
        """
        Path(path).write_text(self._page, encoding="utf-8", newline="\n")

    def __repr__(self) -> str:
        return f"<Seas: {self.standing}, {self.data['records']} records>"


class Elastic(RepeatableResult[_engine.Elastic]):
    """A structure with elastic lines, compared with the same structure with inextensible lines.

    Attributes
    ----------
    data : dict
        Everything that ``snapload elastic --json`` writes. How far the motion is known is under ``trust``.

    See Also
    --------
    snapload.Structure.elastic : Runs both models and returns this result.

    Examples
    --------
    >>> import snapload
    >>> both = snapload.Structure.example().replace({"run.duration": 30}).elastic()
    >>> both.lines["peak_n"].attrs["units"]
    'N'
    """

    def _repeat(self) -> _engine.Elastic:
        stiffer, every, neighbours = self._options
        return self._structure._engine.elastic(stiffer, every, neighbours, None)

    @property
    def standing(self) -> str:
        """The verdict with elastic lines in one word: ``holds``, ``breaks``, ``exceeds``, ``open`` or ``unknown``.

        See Also
        --------
        snapload.Elastic.verdict : The verdict in a sentence.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().replace({"run.duration": 30}).elastic().standing
        'open'
        """
        return str(self.data["verdict"]["standing"])

    @property
    def verdict(self) -> str:
        """The verdict in a sentence or two.

        See Also
        --------
        snapload.Elastic.standing : The verdict in one word.

        Examples
        --------
        >>> import snapload
        >>> snapload.Structure.example().replace({"run.duration": 30}).elastic().verdict[:14]
        'Lines go slack'
        """
        return str(self.data["verdict"]["words"])

    @property
    def checks(self) -> xarray.Dataset:
        """Design checks of the elastic lines by the rule in the table ``[design]``; empty without that table.

        See Also
        --------
        snapload.Assessment.checks : The checks of inextensible lines.

        Examples
        --------
        >>> import snapload
        >>> structure = snapload.Structure.example().replace({"run.duration": 30, "design.least_share": 0})
        >>> structure.elastic().checks["answer"].values.tolist()
        ['fails', 'fails']
        """
        return rows_dataset(self.data["checks"], "check", COLUMNS["checks"])

    @property
    def lines(self) -> xarray.Dataset:
        """Results of each line: spring, damper, largest tension, fraction of the time in which it is slack.

        See Also
        --------
        snapload.Elastic.pulls : Results of each pull.

        Examples
        --------
        >>> import snapload
        >>> both = snapload.Structure.example().replace({"run.duration": 30}).elastic()
        >>> both.lines["line"].values.tolist()
        [1, 2]
        """
        return rows_dataset(self.data["lines"], "line", index="line")

    @property
    def pulls(self) -> xarray.Dataset:
        """Every pull, in the order in which the lines became taut.

        See Also
        --------
        snapload.Elastic.lines : Results of each line.

        Examples
        --------
        >>> import snapload
        >>> both = snapload.Structure.example().replace({"run.duration": 30}).elastic()
        >>> both.pulls["peak_n"].dims
        ('pull',)
        """
        return rows_dataset(self.data["pulls"], "pull", COLUMNS["pulls"])

    @property
    def motion(self) -> xarray.Dataset:
        """Position, rotation and tensions with elastic lines, every ``every`` seconds.

        See Also
        --------
        snapload.Assessment.motion : The motion with inextensible lines.

        Examples
        --------
        >>> import snapload
        >>> both = snapload.Structure.example().replace({"run.duration": 30}).elastic(every=0.5)
        >>> sorted(both.motion.data_vars)
        ['tension_n', 'theta_rad', 'x_m', 'z_m']
        """
        return motion_dataset(self._engine.motion(), len(self.data["lines"]))

    def __repr__(self) -> str:
        return f"<Elastic: {len(self.data['pulls'])} pulls>"
