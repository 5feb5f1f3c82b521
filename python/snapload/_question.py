"""Questions about one case, which the engine identifies by name."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from . import _engine
from ._arguments import engine_case
from ._case import Case


def ask(
    question: str, case: Case, report_progress: Callable[[int], object] | None = None, /, **options: object
) -> tuple[Any, str]:
    """The answer to a question, as JSON and as text; `report_progress` is called with the progress.

    The engine checks the options, and has defaults for those that are left out.
    """
    reply = json.loads(_engine.answer(question, engine_case(case), options, report_progress))
    return reply["answer"], reply["words"]
