"""Modules that are imported when something of them is used."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class Later:
    """Stands for a module.

    Annotations name types of libraries that the package does not load by itself. With this in their place
    ``typing.get_type_hints`` finds them, and nobody else pays for them.
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        module = import_module(self._name, __package__)
        try:
            return getattr(module, name)
        except AttributeError:
            return import_module(f"{module.__name__}.{name}")
