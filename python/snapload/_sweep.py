"""Studies of many cases."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from . import _engine
from ._arguments import existing_file, threads_for
from ._case import Case
from ._keys import Axes
from ._lazy_import import LazyModule
from ._progress import progress_bar
from ._signature import with_keys
from ._sweep_plan import make_plan

if TYPE_CHECKING:
    import distributed
    import xarray
else:
    distributed, xarray = LazyModule("distributed"), LazyModule("xarray")


def sweep(
    case: Case,
    *,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    trust: bool = True,
    random: int | None = None,
    seed: int | None = None,
    cases: Mapping[str, Any] | str | PathLike[str] | Any | None = None,
    chunks: Any = None,
    threads: int | None = None,
    client: distributed.Client | None = None,
    progress: bool = True,
    **axes: Unpack[Axes],
) -> xarray.Dataset:
    """Run every combination of the values of some keys, as ``snapload sweep`` does.

    Parameters
    ----------
    case : Case
        The case with all keys that do not vary.
    out : path-like, optional
        A Parquet file to write, with one row per case, the same to the byte as that of the command line. Until it is
        complete, its rows are kept in ``OUT.parts`` in the same directory, in chunks of a few seconds each.
    resume : bool
        Whether to continue `out` from the rows that an earlier call computed before it was killed or interrupted; also
        allowed for a first call.
    trust : bool
        Whether to compute how far each run can be trusted. The manual states the cost under "How far to trust a
        result".
    random : int, optional
        The number of random points to run instead of a grid. They are Sobol points in the box whose sides are the
        values of the keys, such as ``e=(0.5, 0.9)``.
    seed : int, optional
        Seed of the random points; 0 if left out.
    cases : DataFrame, dict of str to array_like, or path-like, optional
        Cases to run instead of a grid, with one column per key and one row per case: a table of pandas, Polars or
        PyArrow, or a CSV or Parquet file. For a missing cell the key has the value of `case`. A named index is
        refused.
    chunks : dict, int or "auto", optional
        With `out`, open the file lazily in chunks of Dask of this size, as :func:`snapload.open_study` does.
    threads : int, optional
        Number of threads; if left out, as many as the machine has, and at most four times as many.
    client : distributed.Client, optional
        A Dask client whose workers compute the rows instead of this machine. The rows are the same to the bit, and
        `resume` works as well. If a worker dies, another one computes its chunk again.
    progress : bool
        Whether to show a progress bar if the computation takes long.
    **axes : array_like or str
        The values of each key that varies, or ``"first:last:n"`` for evenly spaced values, each the decimal that one
        would write (see :func:`snapload.evenly`). The first key varies slowest.

    Returns
    -------
    xarray.Dataset
        The results over the keys that vary, or over ``row`` for random points and tables of cases. ``end`` contains
        words, ``end_code`` the same as numbers for maps. A case that is not legal has NaN, is not ``certain``, and has
        a message in ``error``. Quantities are in the scales of the case: ``units`` is 1 after the CF conventions, and
        ``scale`` is the scale by which to multiply.

    Raises
    ------
    ValueError
        If a key is unknown or a value is not allowed, if none of the cases can be run, if another file exists at
        `out`, or if `out` can not be created.
    OSError
        If rows can not be written while the study runs, as on a full disk.

    See Also
    --------
    snapload.open_study : Opens such a file.
    snapload.merge : Joins the parts that several machines computed.
    snapload.evenly : Returns evenly spaced values for an axis.
    snapload.System.sweep : Runs a study of a user-defined system.

    Notes
    -----
    Python's lock is released during the computation. Ctrl-C interrupts it within a second; with `out` all rows that
    were saved are kept.

    Examples
    --------
    >>> import snapload
    >>> map = snapload.sweep(snapload.Case(), f_o=[0.3, 0.31], e=[0.5, 0.7, 0.9])
    >>> map.rho1.dims, map.rho1.shape
    (('f_o', 'e'), (2, 3))
    >>> str(map.end.sel(f_o=0.31, e=0.9).item())
    'rotation_limit'
    >>> box = snapload.sweep(snapload.Case(), random=8, f_o=(0.1, 0.6), e=(0.5, 0.9))
    >>> dict(box.sizes), bool((box.f_o < 0.6).all())
    ({'row': 8}, True)
    >>> snapload.sweep(snapload.Case(), cases={"f_o": [0.3, 0.31], "e": [0.9, 0.5]}).end.values.tolist()
    ['settled', 'settled']
    """
    if client is not None and threads is not None:
        raise ValueError("threads are those of this machine, and client computes on others; leave out one of them")
    if chunks is not None and out is None:
        raise ValueError("chunks opens the file lazily, and there is none; give out, such as out='study.parquet'")
    if threads is not None:
        threads = threads_for(threads, callers=1)
    sweep_plan = make_plan(case, trust, axes, random, seed, cases)
    study = sweep_plan.study
    with tempfile.TemporaryDirectory(prefix="snapload-", ignore_cleanup_errors=True) as scratch:
        path = Path(scratch) / "study.parquet" if out is None else Path(fspath(out))
        store = _engine.Store.open(study, path, resume)
        if store is not None:
            try:
                with progress_bar("sweep", len(study), progress, store.safe()) as report_progress:
                    if client is None:
                        study.sweep(store, threads, report_progress)
                    else:
                        from ._dask import sweep_on

                        sweep_on(client, sweep_plan, store, report_progress)
            finally:
                # A traceback must not keep the file open.
                store.close()
        opened = open_study(path, chunks=chunks)
        if "error" in opened and (reason := _reason_of_no_run(path, len(study))):
            raise ValueError(f"none of the {len(study)} cases could be run; the first: {reason}")
        return opened


with_keys(sweep, defaults=False)


def _reason_of_no_run(path: Path, count: int) -> str:
    """Why the first case was not run, if no case was run."""
    _, _, ends = _engine.read_column(path, "end", 0, count)
    if len(ends) > 1:
        return ""
    _, _, reasons = _engine.read_column(path, "error", 0, count)
    return reasons[1]


def open_study(path: str | PathLike[str], *, chunks: Any = None) -> xarray.Dataset:
    """Open a Parquet file of the command ``snapload sweep`` or of :func:`snapload.sweep` as a dataset.

    Parameters
    ----------
    path : path-like
        The file to open.
    chunks : dict, int or "auto", optional
        Open the file lazily in chunks of Dask of this size along the dimensions, so that rows are read when they are
        needed. If left out, the whole file is read at once.

    Returns
    -------
    xarray.Dataset
        The results over the axes of a grid. Random points, lists of cases and parts of a study (``--shard``) have the
        dimension ``row`` instead, and the keys are variables.

    Raises
    ------
    ValueError
        If the file is not that of a study.
    OSError
        If the file can not be read.

    See Also
    --------
    snapload.sweep : Writes such a file.
    snapload.merge : Joins the parts of several machines in one file.

    Examples
    --------
    >>> import snapload
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> path = Path(mkdtemp()) / "e.parquet"
    >>> study = snapload.sweep(snapload.Case(), out=path, e=[0.5, 0.9])
    >>> snapload.open_study(path).identical(study)
    True
    """
    from ._dataset import dataset

    identity = _engine.identity(existing_file(fspath(path)))
    if identity is None:
        raise ValueError(f"{fspath(path)}: not a Parquet file of snapload sweep")
    return dataset(fspath(path), *identity, chunks)


def merge(parts: Iterable[str | PathLike[str]], out: str | PathLike[str]) -> xarray.Dataset:
    """Join the parts of a study that several machines computed, as ``snapload merge`` does.

    Parameters
    ----------
    parts : iterable of path-like
        All files that ``snapload sweep --shard`` wrote, in any order.
    out : path-like
        The file to write, the same to the byte as that of a single sweep.

    Returns
    -------
    xarray.Dataset
        The whole study, as :func:`snapload.open_study` returns it.

    Raises
    ------
    ValueError
        If the files are not parts of one study, if a part is missing, or if a file exists at `out`.
    OSError
        If a part can not be read, or the file can not be written.

    See Also
    --------
    snapload.sweep : Runs a study on one machine.
    snapload.open_study : Opens a file.

    Examples
    --------
    Two machines compute one half each, with the command that comes with the package:

    >>> import subprocess, sys, tempfile
    >>> import snapload
    >>> folder = tempfile.mkdtemp()
    >>> half = f"sweep --vary e=0.5,0.9 --shard {{k}}/2 --out {folder}/part-{{k}}.parquet"
    >>> for k in (1, 2):
    ...     command = [sys.executable, "-m", "snapload", *half.format(k=k).split()]
    ...     _ = subprocess.run(command, check=True, capture_output=True)
    >>> parts = [f"{folder}/part-1.parquet", f"{folder}/part-2.parquet"]
    >>> snapload.merge(parts, f"{folder}/whole.parquet").e.values.tolist()
    [0.5, 0.9]
    """
    if isinstance(parts, (str, PathLike)):
        raise TypeError(f"parts = {fspath(parts)!r} is not allowed; allowed: a list of files")
    files = [existing_file(fspath(part)) for part in parts]
    target = Path(fspath(out))
    if target.exists():
        raise ValueError(f"{target} exists already; choose another out, or remove it")
    _engine.check_place(target)
    with tempfile.TemporaryDirectory(prefix=".snapload-", dir=target.parent, ignore_cleanup_errors=True) as scratch:
        _engine.merge(files, joined := Path(scratch) / target.name)
        joined.replace(target)
    return open_study(target)
