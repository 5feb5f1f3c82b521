"""A case, and the built-in ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from html import escape
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from . import _engine
from ._check import Uncertainty, plain, whole
from ._keys import PARAMETERS, Keys, KeyValues
from ._run import Run
from ._signature import with_keys

if TYPE_CHECKING:
    from typing import Self

    from typing_extensions import Unpack

#: Keys in which the built-in cases differ.
_SHOWN = ("r", "e", "a", "b", "f_o", "nu", "omega")


class Case(KeyValues):
    """A breakwater on two cables: body, cables, waves, start and stop rules, checked once.

    Parameters
    ----------
    code : str, optional
        A built-in case to begin with (see :data:`snapload.cases`); the standard case if left out.
    {parameters}

    Raises
    ------
    ValueError
        If a key is unknown or can not take its value; the words are those of the command line.

    Notes
    -----
    The model and its sources are told in the manual, under "The model". Lengths are in L, half the distance of
    the anchors; masses in m, the body's; forces in F, its net buoyancy; times in T = sqrt(m L / F).

    Examples
    --------
    >>> import snapload
    >>> case = snapload.Case(f_o=0.31)
    >>> case.r, case.inertia == 0.1 * 0.1
    (1.5, True)
    >>> case.replace(a=0.2)
    Case(f_o=0.31, a=0.2)
    >>> snapload.Case(e=1.5)
    Traceback (most recent call last):
        ...
    ValueError: e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1
    """

    def __init__(self, code: str | None = None, /, **keys: Unpack[Keys]) -> None:
        if code is None:
            self._engine = _engine.Case("standard case", dict(keys))
        else:
            self._engine = _engine.named_case(code).replace(dict(keys))

    @classmethod
    def _of(cls, engine: _engine.Case) -> Self:
        case = cls.__new__(cls)
        case._engine = engine
        return case

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Self:
        """A case from a TOML file, one ``key = value`` a line, as the command line reads it.

        Parameters
        ----------
        path : path-like
            The file.

        Raises
        ------
        ValueError
            If it is not TOML, or a key in it is wrong.
        OSError
            If it can not be read.
        """
        import tomllib

        with open(path, "rb") as file:
            try:
                keys = tomllib.load(file)
            except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
                raise ValueError(f"{fspath(path)}: {error}") from None
        try:
            return cls._of(_engine.Case(fspath(path), keys))
        except ValueError as error:
            raise ValueError(f"{fspath(path)}: {error}") from None

    def replace(self, **keys: Unpack[Keys]) -> Self:
        """The same case with some keys changed; what follows from them, such as the inertia, follows anew.

        Raises
        ------
        ValueError
            As for :class:`Case`.
        """
        return self._of(self._engine.replace(dict(keys)))

    @property
    def name(self) -> str:
        """Code of a built-in case, name of a file, or ``standard case``."""
        return self._engine.name

    def keys(self) -> dict[str, Any]:
        """Every key in effect with its value, in the order of the schema; ``inertia`` is None for a point mass."""
        return self._engine.values()

    def run(
        self,
        *,
        uncertainty: Uncertainty = None,
        tolerance: float = 1e-3,
        members: int | None = None,
        seed: int = 1,
    ) -> Run:
        """Runs the case to its end, and says how far the run can be trusted.

        Parameters
        ----------
        uncertainty : float or dict of str to float, optional
            How far the start may be off, either way: one size for every start value, or a size for each key.
            Nothing but rounding if left out.
        tolerance : float
            Error of state and time above which a result counts as not known.
        members : int, optional
            Neighbours to run where the end is past the horizon; 0 for none. If left out, 1000, or 200 if those
            end alike.
        seed : int
            Which neighbours.

        Returns
        -------
        Run
            The finished run: how it ended, impacts, modes, norms, trust, motion.

        Raises
        ------
        ValueError
            If an option is out of its range, or a key can not be in doubt.

        Notes
        -----
        Python's lock is released meanwhile, and Ctrl-C ends it.
        """
        members = members if members is None else whole("members", members, 0, 10**9)
        seed = whole("seed", seed, 0, 2**64 - 1)
        return Run(_engine.run(self._engine, plain(uncertainty), tolerance, members, seed), self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.keys() == other.keys()

    def __hash__(self) -> int:
        return hash(tuple(self.keys().values()))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self.name, self._engine.given())

    def __repr__(self) -> str:
        given, name = self._engine.given(), []
        if self.name in cases:
            base = cases[self.name]._engine.given()
            given = {key: value for key, value in given.items() if base.get(key) != value}
            name = [repr(self.name)]
        words = [*name, *(f"{key}={value!r}" for key, value in given.items())]
        return f"{type(self).__name__}({', '.join(words)})"

    def _repr_html_(self) -> str:
        meanings = {key["name"]: key for key in _engine.keys()}
        rows = "".join(
            f"<tr><td><code>{key}</code></td><td>{escape(str(value))}</td>"
            f"<td>{escape(meanings[key]['unit'])}</td><td style='text-align:left'>"
            f"{escape(meanings[key]['meaning'])}</td></tr>"
            for key, value in self.keys().items()
        )
        head = "<tr><th>key</th><th>value</th><th>unit</th><th></th></tr>"
        return (
            f"<details open><summary>{escape(self._engine.in_words())}</summary>"
            f"<table><thead>{head}</thead><tbody>{rows}</tbody></table></details>"
        )


Case.__doc__ = (Case.__doc__ or "").replace("{parameters}", PARAMETERS.strip())
with_keys(Case, defaults=True)
with_keys(Case.replace, defaults=False)


def _restore(cls: type[Case], name: str, given: dict[str, Any]) -> Case:
    return cls._of(_engine.Case(name, given))


class _UnknownCase(KeyError):
    """No such code, told without the quotes that a KeyError puts about its words."""

    def __str__(self) -> str:
        return Exception.__str__(self)


class Cases(Mapping[str, Case]):
    """The built-in cases by code: those of Table 6.1 of the thesis, and the examples of its section 6.5.

    Examples
    --------
    >>> import snapload
    >>> snapload.cases["sliding-example"].f_o
    0.27
    """

    @staticmethod
    @cache
    def _all() -> dict[str, tuple[str, Case]]:
        return {code: (about, Case._of(case)) for code, about, case in _engine.named_cases()}

    def __getitem__(self, code: str) -> Case:
        try:
            return Case._of(_engine.named_case(code))
        except ValueError as error:
            raise _UnknownCase(str(error)) from None

    def __contains__(self, code: object) -> bool:
        return code in self._all()

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def _table(self) -> list[list[str]]:
        rows = [["code", *_SHOWN, "series"]]
        for code, (about, case) in self._all().items():
            keys = case.keys()
            rows.append([code, *(f"{keys[key]:g}" for key in _SHOWN), about])
        return rows

    def __repr__(self) -> str:
        return "\n".join(
            f"{row[0]:<16}" + "".join(f"  {word:<5}" for word in row[1:-1]) + f"  {row[-1]}" for row in self._table()
        )

    def _repr_html_(self) -> str:
        head, *rows = (
            "".join(f"<td style='text-align:left'>{escape(word)}</td>" for word in row) for row in self._table()
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody><tr>{'</tr><tr>'.join(rows)}</tr></tbody></table>"


#: The built-in cases by code.
cases = Cases()
