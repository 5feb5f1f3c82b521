"""Studies of many cases."""

from __future__ import annotations

import tempfile
import warnings
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _engine
from ._check import whole
from ._progress import bar
from ._signature import with_keys
from ._table import Table

if TYPE_CHECKING:
    import xarray
    from distributed import Client
    from typing_extensions import Unpack

    from ._case import Case
    from ._keys import Axes


def sweep(
    case: Case,
    *,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    trust: bool = True,
    threads: int | None = None,
    client: Client | None = None,
    progress: bool = True,
    **axes: Unpack[Axes],
) -> xarray.Dataset:
    """Runs every combination of the values of some keys, a row a case, as ``snapload sweep`` does.

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
        Whether to say how far each run can be trusted, which takes about as long again.
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
        The results over the keys that vary, with long names and units. ``end`` holds words, ``end_code`` the same
        as numbers for maps; what is no legal case has NaN, and words in ``error``.

    Raises
    ------
    ValueError
        If a key is unknown or can not take a value, if something else stands where `out` is to be, or if nothing
        can be made there.
    OSError
        If rows can not be written once the study runs, as on a full disk.

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
    """
    spec = [(key, values if isinstance(values, str) else np.ravel(np.asarray(values))) for key, values in axes.items()]
    if threads is not None:
        threads, fewer = _engine.threads_for(asked := whole("threads", threads, 1, 65535))
        if fewer:
            warnings.warn(f"threads={asked}: {fewer}", stacklevel=2)
    study = _engine.Study(case._engine, spec, trust)
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

                        sweep_on(client, case, spec, trust, store, tell)
            finally:
                # Whoever looks at a traceback does not hold the file.
                store.close()
        return open_study(path)


with_keys(sweep, defaults=False)


def open_study(path: str | PathLike[str]) -> xarray.Dataset:
    """A Parquet file of ``snapload sweep``, of the command line or of :func:`snapload.sweep`, as a dataset.

    Parameters
    ----------
    path : path-like
        The file.

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
    """
    from ._dataset import dataset, part

    engine_table, identity = _engine.read(fspath(path))
    if identity is None:
        raise ValueError(f"{fspath(path)}: not a file of snapload sweep")
    description, version, cases, start = identity
    table = Table(engine_table)
    if len(table) < cases:
        return part(table, description, version, start)
    return dataset(table, description, version)


def evenly(first: float | str, last: float | str, count: int) -> NDArray[np.float64]:
    """Evenly spaced values, each the double nearest to the decimal that one would write.

    Parameters
    ----------
    first, last : float or str
        The first and the last value.
    count : int
        How many, both among them.

    Returns
    -------
    numpy.ndarray, shape (count,)
        The values; ``numpy.linspace`` gives 0.30000000000000004 where this gives 0.3, and long runs of the two
        differ.

    Raises
    ------
    ValueError
        If they are no range.

    Examples
    --------
    >>> import snapload
    >>> snapload.evenly(0.1, 0.5, 5)[2]
    np.float64(0.3)
    """
    words = [str(bound) if isinstance(bound, str) else repr(float(bound)) for bound in (first, last)]
    return np.array(_engine.evenly(words[0], words[1], whole("count", count, 1, 10**9)))
