"""The chapter of the thesis, reproduced."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from . import _engine
from ._progress import bar


def reproduce(out: str | PathLike[str] = "reproduction", *, progress: bool = True) -> Path:
    """Compute the tables, figures and claims of the chapter as one report, as ``snapload reproduce`` does.

    Parameters
    ----------
    out : path-like
        Directory of the report, created if absent; files of an earlier one are written over.
    progress : bool
        Whether to show a bar if it takes long.

    Returns
    -------
    pathlib.Path
        ``report.html``, one page that needs nothing else; the tables as CSV and the figures as SVG stand beside it.

    Raises
    ------
    OSError
        If the files can not be written.

    See Also
    --------
    snapload.cases : The cases that it runs.

    Examples
    --------
    >>> import snapload
    >>> snapload.reproduce("chapter-6")  # doctest: +SKIP
    PosixPath('chapter-6/report.html')
    """
    target = Path(fspath(out))
    (target / "figures").mkdir(parents=True, exist_ok=True)
    with bar("report", 1000, progress) as tell:
        files = _engine.reproduce(tell)
    for name, contents in files:
        (target / name).write_bytes(contents)
    return target / "report.html"
