"""Modules that are imported when they are first used."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class LazyModule:
    """A placeholder for a module.

    Annotations name types of libraries that the package does not load by itself. With this placeholder
    ``typing.get_type_hints`` finds the types, and the libraries are not loaded otherwise.
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
