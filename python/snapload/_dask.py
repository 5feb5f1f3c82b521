"""Computation of a study on Dask workers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, cast

from . import _engine
from ._sweep_plan import SweepPlan

if TYPE_CHECKING:
    from distributed import Client

#: The number of chunks for each thread, so that no thread waits long for the last chunk.
_CHUNKS_PER_THREAD = 16
#: The least and the most rows of a chunk.
_MIN_ROWS, _MAX_ROWS = 16, 4096
#: The number of chunks that wait at each thread while one is computed.
_QUEUED_PER_THREAD = 2
#: The number of workers that may die in computing one chunk.
_RETRIES = 10


def compute_chunk(plan: SweepPlan, start: int, stop: int) -> bytes:
    """Some rows of a study as a Parquet file, computed by a worker on the one thread of a task."""
    return plan.study.chunk(start, stop, 1)


def sweep_on(
    client: Client,
    plan: SweepPlan,
    store: _engine.Store,
    report_progress: Callable[[int], object] | None,
) -> None:
    """Computes the missing rows on the workers, stores each chunk when it arrives, and completes the file."""
    import distributed

    # Dask has no type annotations.
    dask: Any = client
    completed: Any = cast(Any, distributed).as_completed()

    threads = max(1, sum(dask.nthreads().values()))
    missing = sum(stop - start for start, stop in store.gaps())
    size = min(max(missing // (_CHUNKS_PER_THREAD * threads), _MIN_ROWS), _MAX_ROWS)
    ranges = _ranges(store.gaps(), size)
    submitted: dict[Any, tuple[int, int]] = {}

    def submit() -> None:
        row_range = next(ranges, None)
        if row_range is not None:
            future = dask.submit(compute_chunk, plan, *row_range, pure=False, retries=_RETRIES)
            submitted[future] = row_range
            completed.add(future)

    try:
        for _ in range((1 + _QUEUED_PER_THREAD) * threads):
            submit()
        for future in completed:
            start, stop = submitted.pop(future)
            store.keep(start, stop, future.result())
            submit()
            if report_progress is not None:
                report_progress(store.safe())
        store.finish()
    finally:
        dask.cancel(list(submitted), force=True)


def _ranges(gaps: list[tuple[int, int]], size: int) -> Iterator[tuple[int, int]]:
    for start, stop in gaps:
        for first in range(start, stop, size):
            yield first, min(first + size, stop)
