"""Reproduction of chapter 6 of the thesis."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from . import _engine
from ._progress import progress_bar


def reproduce(out: str | PathLike[str] = "reproduction", *, progress: bool = True) -> Path:
    """Compute the tables, figures and claims of chapter 6 as one report, as ``snapload reproduce`` does.

    Parameters
    ----------
    out : path-like
        Directory of the report, created if absent; files of an earlier report are overwritten.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    pathlib.Path
        The path of ``report.html``, a self-contained page. The tables as CSV and the figures as SVG are in the same
        directory.

    Raises
    ------
    OSError
        If the files can not be written.

    See Also
    --------
    snapload.cases : The cases of the report.

    Examples
    --------
    >>> import snapload
    >>> snapload.reproduce("chapter-6")  # doctest: +SKIP
    PosixPath('chapter-6/report.html')
    """
    target = Path(fspath(out))
    (target / "figures").mkdir(parents=True, exist_ok=True)
    with progress_bar("report", 1000, progress) as report_progress:
        files = _engine.reproduce(report_progress)
    for name, contents in files:
        (target / name).write_bytes(contents)
    return target / "report.html"
