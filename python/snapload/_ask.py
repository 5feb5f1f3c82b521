"""Questions about one case, which the engine identifies by name."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from . import _engine
from ._case import Case
from ._check import engine_of


def ask(
    question: str, case: Case, tell: Callable[[int], object] | None = None, /, **options: object
) -> tuple[Any, str]:
    """The answer to a question, as JSON and in words; `tell` is called with the progress.

    The engine checks the options, and has defaults for those that are left out.
    """
    found = json.loads(_engine.answer(question, engine_of(case), options, tell))
    return found["answer"], found["words"]
