"""Signatures that name the keys, for ``help()`` and for the tooltips of notebooks."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from . import _engine


def with_keys(function: Callable[..., Any], *, defaults: bool) -> None:
    """Replaces ``**keys`` by one optional keyword for each key, whose default is shown, or dots."""
    signature = inspect.signature(function)
    keywords = [
        inspect.Parameter(
            key["name"], inspect.Parameter.KEYWORD_ONLY, default=_ShownDefault(_default(key) if defaults else "")
        )
        for key in _engine.keys()
    ]
    kept = [p for p in signature.parameters.values() if p.kind is not inspect.Parameter.VAR_KEYWORD]
    function.__signature__ = signature.replace(parameters=[*kept, *keywords])  # type: ignore[attr-defined]


def _default(key: dict[str, Any]) -> str:
    """The default of a key as Python writes it; words if it depends on other keys."""
    return repr(key["standard"]) if key["kind"] == "bool" else str(key["default"])


class _ShownDefault:
    """The default of a key, as shown in a signature."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text if self._text and " " not in self._text else "..."
