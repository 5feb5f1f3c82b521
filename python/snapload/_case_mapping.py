"""A case as a mapping of its keys."""

from __future__ import annotations

from collections.abc import ItemsView, Iterator, Mapping, ValuesView
from typing import Any

from . import _engine


class CaseMapping(Mapping[str, Any]):
    """The methods of a mapping; its keys and values are those of a case."""

    _engine: _engine.Case

    def keys(self) -> dict[str, Any]:  # type: ignore[override]
        """Return every key in effect with its value.

        Returns
        -------
        dict
            Keys and values in the order of the schema; ``inertia`` is None for a point mass.

        See Also
        --------
        replace : Changes some of them.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).keys()["f_o"]
        0.31
        """
        return self._engine.values()

    def values(self) -> ValuesView[Any]:
        """Return the value of every key in effect.

        Returns
        -------
        ValuesView
            The values in the order of the schema.

        See Also
        --------
        keys : Returns keys and values.

        Examples
        --------
        >>> import snapload
        >>> 0.31 in snapload.Case(f_o=0.31).values()
        True
        """
        return self.keys().values()

    def items(self) -> ItemsView[str, Any]:
        """Return every key in effect with its value, as pairs.

        Returns
        -------
        ItemsView
            The pairs in the order of the schema.

        See Also
        --------
        keys : Returns them as a dict.

        Examples
        --------
        >>> import snapload
        >>> [key for key, value in snapload.Case(f_o=0.31).items() if value == 0.31]
        ['f_o']
        """
        return self.keys().items()

    def get(self, key: str, default: Any = None) -> Any:
        """Return the value of a key, or a default if there is no such key.

        Parameters
        ----------
        key : str
            The key.
        default : object, optional
            What is returned if there is no such key.

        Returns
        -------
        object
            The value of the key, or the default.

        See Also
        --------
        keys : Returns all keys.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).get("f_o"), snapload.Case().get("depth", 8.0)
        (0.31, 8.0)
        """
        return self.keys().get(key, default)

    def __getitem__(self, key: str) -> Any:
        keys = self.keys()
        if key not in keys:
            raise UnknownKeyError(f"there is no key {key!r}; the keys are {', '.join(keys)}")
        return keys[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())


class UnknownKeyError(KeyError):
    """An unknown key or code; its message has no quotes, which a KeyError would add."""

    def __str__(self) -> str:
        return Exception.__str__(self)
