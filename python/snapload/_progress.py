"""A progress bar for terminals and notebooks."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress_bar(label: str, total: int, visible: bool, initial: int = 0) -> Iterator[Callable[[int], object] | None]:
    """A bar that appears after half a second; yields a function that is called with the number done."""
    if not visible:
        yield None
        return
    with warnings.catch_warnings():
        # In a notebook without widgets a bar of text is acceptable.
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm
    # Without `disable` there would be a bar in log files, too.
    with tqdm(total=total, initial=initial, desc=label, delay=0.5, leave=False, disable=None) as progress:
        yield lambda done: progress.update(done - progress.n)
