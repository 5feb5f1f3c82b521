"""A progress bar for terminals and notebooks."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bar(what: str, whole: int, shown: bool, begun: int = 0) -> Iterator[Callable[[int], object] | None]:
    """A bar that appears after half a second; yields a function that is called with the number done."""
    if not shown:
        yield None
        return
    with warnings.catch_warnings():
        # In a notebook without widgets a bar of text is acceptable.
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm
    # Without `disable` there would be a bar in log files, too.
    with tqdm(total=whole, initial=begun, desc=what, delay=0.5, leave=False, disable=None) as shown_bar:
        yield lambda done: shown_bar.update(done - shown_bar.n)
