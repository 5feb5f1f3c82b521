"""Studies of many cases."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from . import _engine
from ._case import Case
from ._check import there, threads_for
from ._keys import Axes
from ._later import Later
from ._plan import plan
from ._progress import bar
from ._signature import with_keys

if TYPE_CHECKING:
    import distributed
    import xarray
else:
    distributed, xarray = Later("distributed"), Later("xarray")


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
    """Run every combination of the values of some keys, a row a case, as ``snapload sweep`` does.

    Parameters
    ----------
    case : Case
        What all cases have in common.
    out : path-like, optional
        A Parquet file to write, the same to the byte as that of the command line. Until it is complete its rows are
        kept beside it in ``OUT.parts``, a chunk of a few seconds each.
    resume : bool
        Whether to go on with what an earlier call, killed or interrupted, has left of `out`; right for a first
        call, too.
    trust : bool
        Whether to say how far each run can be trusted. The manual tells what it costs, under "How far to trust a
        result".
    random : int, optional
        Run so many random points instead of a grid: Sobol points in the box whose sides are the values of the keys,
        such as ``e=(0.5, 0.9)``.
    seed : int, optional
        Which random points; 0 if left out.
    cases : DataFrame, dict of str to array_like, or path-like, optional
        Run these cases instead of a grid: a column a key and a row a case, of pandas, Polars or PyArrow, or as a CSV or
        Parquet file. A cell that is missing leaves the key to `case`.
    chunks : dict, int or "auto", optional
        With `out`, open the file lazily, in such chunks of Dask, as :func:`snapload.open_study` does.
    threads : int, optional
        Threads to use; as many as the machine has if left out, and at the most four times as many.
    client : distributed.Client, optional
        A client of Dask whose workers compute the rows instead of this machine: the same rows, bits and `resume`.
        A worker that dies costs its chunk, which another one computes again.
    progress : bool
        Whether to show a bar if it takes long.
    **axes : array_like or str
        The values of each key that varies, or ``"first:last:n"`` for evenly spaced ones that are the decimals one
        would write (see :func:`snapload.evenly`). The first key is the slowest.

    Returns
    -------
    xarray.Dataset
        The results over the keys that vary, or over ``row`` for random points and tables of cases. ``end`` holds
        words, ``end_code`` the same as numbers for maps. What is no legal case has NaN, is not ``certain``, and has
        words in ``error``. Quantities are in the model's own units: ``units`` is 1 after CF, and ``scale`` says by
        what to multiply.

    Raises
    ------
    ValueError
        If a key is unknown or can not take a value, if something else stands where `out` is to be, or if nothing
        can be made there.
    OSError
        If rows can not be written once the study runs, as on a full disk.

    See Also
    --------
    snapload.open_study : Opens such a file.
    snapload.merge : Joins the parts that several machines swept.
    snapload.evenly : Values for an axis.
    snapload.System.sweep : The same of a system of one's own.

    Notes
    -----
    Python's lock is released meanwhile. Ctrl-C ends it within a second; with `out` what was saved is safe.

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
    asked_for = plan(case, trust, axes, random, seed, cases)
    study = asked_for.study
    with tempfile.TemporaryDirectory(prefix="snapload-", ignore_cleanup_errors=True) as scratch:
        path = Path(scratch) / "study.parquet" if out is None else Path(fspath(out))
        store = _engine.Store.open(study, path, resume)
        if store is not None:
            try:
                with bar("sweep", len(study), progress, store.safe()) as tell:
                    if client is None:
                        study.sweep(store, threads, tell)
                    else:
                        from ._dask import sweep_on

                        sweep_on(client, asked_for, store, tell)
            finally:
                # A traceback must not keep the file open.
                store.close()
        return open_study(path, chunks=chunks)


with_keys(sweep, defaults=False)


def open_study(path: str | PathLike[str], *, chunks: Any = None) -> xarray.Dataset:
    """Open a Parquet file of ``snapload sweep``, of the command line or of :func:`snapload.sweep`, as a dataset.

    Parameters
    ----------
    path : path-like
        The file.
    chunks : dict, int or "auto", optional
        Open it lazily, in such chunks of Dask along the dimensions: rows are read when they are asked for. All is read
        at once if left out.

    Returns
    -------
    xarray.Dataset
        Over the axes of a grid. Random points, lists of cases and parts of a study (``--shard``) have the dimension
        ``row`` instead, and the keys among their variables.

    Raises
    ------
    ValueError
        If it is not a file of a study.
    OSError
        If it can not be read.

    See Also
    --------
    snapload.sweep : Makes such a file.
    snapload.merge : Makes one of the parts of several machines.

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

    identity = _engine.identity(there(fspath(path)))
    if identity is None:
        raise ValueError(f"{fspath(path)}: not a file of snapload sweep")
    return dataset(fspath(path), *identity, chunks)


def merge(parts: Iterable[str | PathLike[str]], out: str | PathLike[str]) -> xarray.Dataset:
    """Join the parts of a study that several machines swept, as ``snapload merge`` does.

    Parameters
    ----------
    parts : iterable of path-like
        The files that ``snapload sweep --shard`` wrote, all of them, in any order.
    out : path-like
        The file to write, the same to the byte as that of one sweep.

    Returns
    -------
    xarray.Dataset
        The whole study, as :func:`snapload.open_study` gives it.

    Raises
    ------
    ValueError
        If they are no parts of one study, if one is missing, or if something stands where `out` is to be.
    OSError
        If a part can not be read, or the file can not be written.

    See Also
    --------
    snapload.sweep : Makes a file on one machine.
    snapload.open_study : Opens a file.

    Examples
    --------
    Two machines sweep a half each, by the command that comes with the package:

    >>> import subprocess, sys, tempfile
    >>> import snapload
    >>> room = tempfile.mkdtemp()
    >>> half = f"sweep --vary e=0.5,0.9 --shard {{k}}/2 --out {room}/part-{{k}}.parquet"
    >>> for k in (1, 2):
    ...     words = [sys.executable, "-m", "snapload", *half.format(k=k).split()]
    ...     _ = subprocess.run(words, check=True, capture_output=True)
    >>> snapload.merge([f"{room}/part-1.parquet", f"{room}/part-2.parquet"], f"{room}/whole.parquet").e.values.tolist()
    [0.5, 0.9]
    """
    if isinstance(parts, (str, PathLike)):
        raise TypeError(f"parts = {fspath(parts)!r} is not allowed; allowed: a list of files")
    files = [there(fspath(part)) for part in parts]
    target = Path(fspath(out))
    if target.exists():
        raise ValueError(f"{target} is there already; choose another out, or remove it")
    with tempfile.TemporaryDirectory(prefix=".snapload-", dir=target.parent, ignore_cleanup_errors=True) as scratch:
        _engine.merge(files, joined := Path(scratch) / target.name)
        joined.replace(target)
    return open_study(target)
