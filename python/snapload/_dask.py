"""Computation of a study on Dask workers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, cast

from . import _engine
from ._plan import Plan

if TYPE_CHECKING:
    from distributed import Client

#: The number of chunks for each thread, so that no thread waits long for the last chunk.
_CHUNKS_A_THREAD = 16
#: The least and the most rows of a chunk.
_LEAST, _MOST = 16, 4096
#: The number of chunks that wait at each thread while one is computed.
_QUEUED = 2
#: The number of workers that may die in computing one chunk.
_DEATHS = 10


def chunk(plan: Plan, start: int, stop: int) -> bytes:
    """Some rows of a study as a Parquet file, computed by a worker on the one thread of a task."""
    return plan.study.chunk(start, stop, 1)


def sweep_on(
    client: Client,
    plan: Plan,
    store: _engine.Store,
    tell: Callable[[int], object] | None,
) -> None:
    """Computes the missing rows on the workers, stores each chunk when it arrives, and completes the file."""
    import distributed

    # Dask has no type annotations.
    dask: Any = client
    waiting: Any = cast(Any, distributed).as_completed()

    threads = max(1, sum(dask.nthreads().values()))
    missing = sum(stop - start for start, stop in store.gaps())
    size = min(max(missing // (_CHUNKS_A_THREAD * threads), _LEAST), _MOST)
    ranges = _ranges(store.gaps(), size)
    places: dict[Any, tuple[int, int]] = {}

    def submit() -> None:
        place = next(ranges, None)
        if place is not None:
            future = dask.submit(chunk, plan, *place, pure=False, retries=_DEATHS)
            places[future] = place
            waiting.add(future)

    try:
        for _ in range((1 + _QUEUED) * threads):
            submit()
        for future in waiting:
            start, stop = places.pop(future)
            store.keep(start, stop, future.result())
            submit()
            if tell is not None:
                tell(store.safe())
        store.finish()
    finally:
        dask.cancel(list(places), force=True)


def _ranges(gaps: list[tuple[int, int]], size: int) -> Iterator[tuple[int, int]]:
    for start, stop in gaps:
        for first in range(start, stop, size):
            yield first, min(first + size, stop)
