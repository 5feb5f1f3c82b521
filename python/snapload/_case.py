"""Cases, and the built-in cases."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cache
from html import escape
from os import PathLike
from typing import TYPE_CHECKING, Any, Self, Unpack

from . import _engine
from ._arguments import Uncertainty, case_text, flag, number, uncertainty_for_engine, utf8_text, whole_number
from ._case_mapping import CaseMapping, UnknownKeyError
from ._keys import OPTIONAL, PARAMETERS, Keys, KeyValues
from ._orbit import HasOrbits
from ._run import Options, Run
from ._signature import with_keys

#: Keys in which the built-in cases differ.
_SHOWN_KEYS = ("r", "e", "a", "b", "f_o", "nu", "omega")


class Case(CaseMapping, KeyValues, HasOrbits):
    """A breakwater moored by two cables: body, cables, waves, start and stop rules.

    Parameters
    ----------
    code : str, optional
        The built-in case to start from (see :data:`snapload.cases`); the standard case if left out.
    {parameters}

    Raises
    ------
    ValueError
        If a key is unknown or its value is not allowed, with the message of the command line.

    See Also
    --------
    snapload.cases : The built-in cases.
    snapload.sweep : Runs many cases.
    snapload.System : Describes other bodies, cables and forces.

    Notes
    -----
    The manual describes the model and its sources under "The model". Lengths are in L, half the distance between the
    anchors; masses in m, the mass of the body; forces in F, its net buoyancy; times in T = sqrt(m L / F).

    All values are checked when the case is created. A case is a mapping of all keys in effect: ``case["f_o"]``,
    ``case.items()``, ``dict(case)`` and ``Case(**case)`` work.

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
        self._engine: _engine.Case
        if code is None:
            self._engine = _engine.Case("standard case", _given(keys))
        elif isinstance(code, str):
            self._engine = _engine.named_case(code).replace(_given(keys))
        else:
            allowed = "the code of a built-in case as a str; keys are given by name, such as Case(f_o=0.31)"
            raise TypeError(f"code = {code!r} is not allowed; allowed: {allowed}")

    if not TYPE_CHECKING:
        # A type checker knows the attributes, and would accept any with this method.
        def __setattr__(self, name: str, value: object) -> None:
            if not name.startswith("_"):
                raise AttributeError(f"a case does not change; case.replace({name}=...) gives another one")
            super().__setattr__(name, value)

    @classmethod
    def _from_engine(cls, engine: _engine.Case) -> Self:
        case = cls.__new__(cls)
        case._engine = engine
        return case

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Self:
        """Read a case from a TOML file with one ``key = value`` per line, as the command line does.

        Parameters
        ----------
        path : path-like
            The file to read.

        Returns
        -------
        Case
            The case, whose name is the path of the file.

        Raises
        ------
        ValueError
            If the file is not TOML, or a key in it is wrong.
        OSError
            If the file can not be read.

        See Also
        --------
        to_file : Writes such a file.

        Examples
        --------
        >>> import snapload
        >>> from pathlib import Path
        >>> from tempfile import mkdtemp
        >>> path = Path(mkdtemp()) / "mooring.toml"
        >>> _ = path.write_text("f_o = 0.31")
        >>> snapload.Case.from_file(path)
        Case(f_o=0.31)
        """
        import tomllib

        # A path need not be text; what is no letter is shown by a mark.
        name = os.fsencode(path).decode("utf-8", "replace")
        with open(path, "rb") as file:
            contents = file.read()
        text = utf8_text(name, contents)
        try:
            return cls._from_engine(_engine.Case(name, tomllib.loads(text)))
        except ValueError as error:
            # Errors of TOML are of this kind, too.
            raise ValueError(f"{name}: {error}") from None

    def to_file(self, path: str | PathLike[str]) -> None:
        """Write the given keys to a TOML file, which :meth:`from_file` and the command line can read.

        Parameters
        ----------
        path : path-like
            The file to write; an existing file is overwritten.

        Raises
        ------
        OSError
            If the file can not be written.

        See Also
        --------
        from_file : Reads such a file.

        Examples
        --------
        >>> import snapload
        >>> from pathlib import Path
        >>> from tempfile import mkdtemp
        >>> path = Path(mkdtemp()) / "mooring.toml"
        >>> snapload.Case(f_o=0.31, a=0.2).to_file(path)
        >>> print(path.read_text(), end="")
        f_o = 0.31
        a = 0.2
        >>> snapload.Case.from_file(path) == snapload.Case(f_o=0.31, a=0.2)
        True
        """
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            file.write(case_text(self._engine))

    def replace(self, **keys: Unpack[Keys]) -> Self:
        """Return a case with some keys changed; derived values, such as the inertia, are computed again.

        Parameters
        ----------
        **keys
            Keys to change, as for :class:`Case`; ``inertia=None`` means the natural inertia.

        Returns
        -------
        Case
            A new case; this one does not change. ``copy.replace`` does the same.

        Raises
        ------
        ValueError
            As for :class:`Case`.

        See Also
        --------
        snapload.sweep : Runs all combinations of the values of some keys.

        Examples
        --------
        >>> import snapload
        >>> case = snapload.Case(a=0.2, inertia=0.05)
        >>> case.replace(a=0.3).inertia, case.replace(a=0.3, inertia=None).inertia == 0.3 * 0.3
        (0.05, True)
        """
        given = _given(keys)
        if len(given) == len(keys):
            return self._from_engine(self._engine.replace(given))
        return self._from_engine(_engine.Case(self.name, _given({**self._engine.given(), **keys})))

    __replace__ = replace

    @property
    def name(self) -> str:
        """The code of a built-in case, the name of a file, or ``standard case``.

        See Also
        --------
        snapload.cases : The built-in cases by code.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).name
        'standard case'
        """
        return self._engine.name

    def run(
        self,
        *,
        trust: bool = True,
        uncertainty: Uncertainty = None,
        tolerance: float = 1e-3,
        members: int | None = None,
        seed: int = 1,
    ) -> Run:
        """Run the case to its end, and compute how far the run can be trusted.

        Parameters
        ----------
        trust : bool
            Whether to compute how far the run can be trusted. The motion is the same to the bit; the manual states the
            cost under "How far to trust a result".
        uncertainty : float or dict of str to float, optional
            Uncertainty of the start in either direction: one size for every start value, or a size for each key. If
            left out, only rounding is uncertain; neighbours are then drawn from 1e-12 about every start value.
        tolerance : float
            Error of state and time, relative to values above 1, above which a result counts as not known.
        members : int, optional
            Number of neighbours to run if the end is past the horizon of trust; 0 for none. If left out, 1000, or 200
            if those end alike.
        seed : int
            Seed of the neighbours.

        Returns
        -------
        Run
            The finished run with its end, impacts, modes, norms, trust and motion.

        Raises
        ------
        ValueError
            If an option is out of its range, or a key can not be uncertain.

        See Also
        --------
        snapload.ensemble : Runs neighbours of a case, wherever its horizon is.
        snapload.sweep : Runs many cases.

        Notes
        -----
        Python's lock is released during the computation, and Ctrl-C interrupts it.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run()
        <Run of Case(f_o=0.31): rotation_limit at t = 3.4522, 12 impacts>
        >>> snapload.Case(f_o=0.31).run(trust=False).end.reason
        'rotation_limit'
        """
        if not flag("trust", trust):
            if uncertainty is not None or members:
                raise ValueError("trust=False runs no neighbours; leave out uncertainty and members, or trust=False")
            return Run(self, None, _engine.run_alone(self._engine))
        options: Options = (
            uncertainty_for_engine(uncertainty),
            number("tolerance", tolerance),
            members if members is None else whole_number("members", members),
            whole_number("seed", seed),
        )
        return Run(self, options, _engine.run(self._engine, *options))

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
        arguments = [*name, *(f"{key}={value!r}" for key, value in given.items())]
        return f"{type(self).__name__}({', '.join(arguments)})"

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


def _given(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Keys that are given. No inertia is the natural one, or none at all."""
    return {key: value for key, value in keys.items() if not (key in OPTIONAL and value is None)}


def _restore(cls: type[Case], name: str, given: dict[str, Any]) -> Case:
    return cls._from_engine(_engine.Case(name, given))


class Cases(Mapping[str, Case]):
    """The built-in cases by code: the cases of Table 6.1 of the thesis and the examples of its section 6.5.

    See Also
    --------
    snapload.Case : Can start from one of them, as in ``Case("sliding-example", e=0.7)``.

    Examples
    --------
    >>> import snapload
    >>> snapload.cases["sliding-example"].f_o
    0.27
    """

    @staticmethod
    @cache
    def _all() -> dict[str, tuple[str, Case]]:
        return {code: (description, Case._from_engine(case)) for code, description, case in _engine.named_cases()}

    def __getitem__(self, code: str) -> Case:
        if not isinstance(code, str):
            raise TypeError(f"code = {code!r} is not allowed; allowed: the code of a built-in case as a str")
        try:
            return Case._from_engine(_engine.named_case(code))
        except ValueError as error:
            raise UnknownKeyError(str(error)) from None

    def __contains__(self, code: object) -> bool:
        return code in self._all()

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def _table(self) -> list[list[str]]:
        rows = [["code", *_SHOWN_KEYS, "series"]]
        for code, (description, case) in self._all().items():
            keys = case.keys()
            rows.append([code, *(f"{keys[key]:g}" for key in _SHOWN_KEYS), description])
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
