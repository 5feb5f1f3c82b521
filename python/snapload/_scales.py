"""Conversion between SI units and the scales of a case."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar, Unpack

import numpy as np

from . import _engine
from ._case import Case
from ._keys import Keys
from ._lazy_import import LazyModule
from ._signature import with_keys
from ._system_parts import set_fields
from ._table import Table

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")

#: What can be converted to SI.
Convertible = TypeVar("Convertible", Table, "xarray.Dataset", "xarray.DataArray", "np.recarray[Any, Any]")

#: The scales of which products consist, and the SI unit of each.
_UNITS = {"L": "m", "m": "kg", "F": "N", "T": "s", "rad": "rad"}

#: The scales of the fields of a motion, except tensions.
MOTION_SCALES = {
    "t": "T",
    "x": "L",
    "y": "L",
    "theta": "rad",
    "vx": "L/T",
    "vy": "L/T",
    "vtheta": "rad/T",
    "energy": "F L",
}


@dataclass(frozen=True)
class Scales:
    """The scales of length, mass and force of a case, in SI units.

    Parameters
    ----------
    length : float
        Half the distance between the anchors, L [m].
    mass : float
        The mass of the body including its added mass, m [kg].
    force : float
        The net buoyancy of the body, F [N].

    Raises
    ------
    ValueError
        If one of them is not above 0.

    See Also
    --------
    snapload.Case : The case whose quantities have these scales.

    Notes
    -----
    Use :class:`snapload.Structure` for structures that are given by depth, waves and lines.

    Examples
    --------
    A ring of 1 m across between anchors 10 m apart, in waves of 0.4 rad/s that push with 310 N:

    >>> import snapload
    >>> scales = snapload.Scales(length=5.0, mass=800.0, force=1000.0)
    >>> scales.time
    2.0
    >>> case = scales.case(r=7.5, a=0.5, f_o=310.0, omega=0.45, y=0.5)
    >>> case.r, case.f_o, case.omega
    (1.5, 0.31, 0.9)
    >>> run = case.run()
    >>> round(float(scales.si(run.impacts)["v_n"].max()), 4), round(run.end.t * scales.time, 3)
    (1.2302, 6.904)
    """

    length: float
    mass: float
    force: float

    def __post_init__(self) -> None:
        from ._arguments import number

        for name in ("length", "mass", "force"):
            value = number(name, given := getattr(self, name))
            if not 0 < value < np.inf:
                raise ValueError(f"{name} = {given!r} is not allowed; allowed: a number above 0")
            set_fields(self, **{name: value})

    @property
    def time(self) -> float:
        """The time scale T = sqrt(m L / F) [s].

        See Also
        --------
        factor : Returns the value of any product of scales.

        Examples
        --------
        >>> import snapload
        >>> snapload.Scales(length=5.0, mass=800.0, force=1000.0).time
        2.0
        """
        return float(np.sqrt(self.mass * self.length / self.force))

    def factor(self, scale: str) -> float:
        """Return the SI value of a product of scales, in the notation of the metadata of results.

        Parameters
        ----------
        scale : str
            The product, such as ``"L/T"`` or ``"m L^2"``.

        Returns
        -------
        float
            The factor by which a number in these scales is multiplied.

        Raises
        ------
        ValueError
            If it is not such a product.

        See Also
        --------
        si : Converts whole results.

        Examples
        --------
        >>> import snapload
        >>> snapload.Scales(length=5.0, mass=800.0, force=1000.0).factor("L/T")
        2.5
        """
        sizes = {"L": self.length, "m": self.mass, "F": self.force, "T": self.time}
        value = 1.0
        for name, power in _powers(scale):
            value *= sizes.get(name, 1.0) ** power
        return float(value)

    def case(self, base: Case | None = None, /, **keys: Unpack[Keys]) -> Case:
        """Create a case from keys in SI units.

        Parameters
        ----------
        base : Case, optional
            The case from which all other keys are taken, in scales as any case; the standard case if left out.
        **keys
            Keys to change, as for :class:`snapload.Case`, but in m, kg, N, s, and products of them. Keys without a
            unit, such as ``e``, are not converted.

        Returns
        -------
        Case
            The case in the scales.

        Raises
        ------
        ValueError
            As for :class:`snapload.Case`; the message has values in scales.

        See Also
        --------
        si : Converts results to SI units.

        Examples
        --------
        >>> import snapload
        >>> snapload.Scales(length=5.0, mass=800.0, force=1000.0).case(t_end=60.0, e=0.7).t_end
        30.0
        """
        units = {key["name"]: key["unit"] for key in _engine.keys()}
        converted: dict[str, Any] = {}
        for key, value in keys.items():
            unit = units.get(key, "")
            has_unit = unit not in ("", "1", "rad") and value is not None
            converted[key] = float(value) / self.factor(unit) if has_unit else value  # type: ignore[arg-type]
        return (Case() if base is None else base).replace(**converted)

    def si(self, result: Convertible) -> Convertible:
        """Convert a result from scales to SI units.

        Parameters
        ----------
        result : Table, xarray.Dataset, xarray.DataArray, or numpy.recarray
            A table of a run, a study or a variable of one, or a motion.

        Returns
        -------
        Table, xarray.Dataset, xarray.DataArray, or numpy.recarray
            The same result with values in m, kg, N, s and rad, and with units in the metadata after the CF conventions.

        Raises
        ------
        TypeError
            If the result is something else.
        ValueError
            If a column has no single unit, as in the table of :func:`snapload.sensitivities`.

        See Also
        --------
        factor : Returns the factor for single numbers.

        Examples
        --------
        >>> import snapload
        >>> scales = snapload.Scales(length=5.0, mass=800.0, force=1000.0)
        >>> study = scales.si(snapload.sweep(snapload.Case(), f_o=[0.3, 0.31]))
        >>> study.f_o.values.tolist(), study.rho1.attrs["units"]
        ([300.0, 310.0], 'm s-1')
        """
        converted: Convertible = self._converted(result)
        return converted

    def _converted(self, result: Any) -> Any:
        if isinstance(result, Table):
            return self._table(result)
        if isinstance(result, np.recarray):
            return self._motion(result)
        if type(result).__module__.startswith("xarray."):
            if not hasattr(result, "data_vars"):
                return result._from_temp_dataset(self._converted(result._to_temp_dataset()))
            return result.assign({name: self._variable(variable) for name, variable in result.variables.items()})
        allowed = "a Table, a Dataset or DataArray of xarray, or a motion"
        raise TypeError(f"result, a {type(result).__name__}, is not allowed; allowed: {allowed}")

    def _table(self, table: Table) -> Table:
        parts = []
        for name, kind, attrs, values in table._table.parts():
            if scale := attrs.get("scale"):
                factor = self.factor(scale)
                values = bytearray((np.frombuffer(values) * factor).tobytes())
                attrs = {key: text for key, text in attrs.items() if key != "scale"} | {"units": unit_of(scale)}
            parts.append((name, kind, attrs, values))
        return Table(_engine.Table.of(parts))

    def _motion(self, motion: np.recarray[Any, Any]) -> np.recarray[Any, Any]:
        converted = motion.copy()
        for name in motion.dtype.names or ():
            converted[name] *= self.factor(MOTION_SCALES.get(name, "F"))
        return converted

    def _variable(self, variable: Any) -> Any:
        scale = variable.attrs.get("scale")
        if not scale:
            return variable
        converted = variable.copy(data=variable.data * self.factor(scale))
        converted.attrs = {key: text for key, text in variable.attrs.items() if key != "scale"}
        # Long names end in the scale of the number.
        name = str(converted.attrs.get("long_name", "")).removesuffix(f", in {scale}")
        converted.attrs |= {"units": unit_of(scale), "long_name": name}
        return converted


with_keys(Scales.case, defaults=False)


def unit_of(scale: str) -> str:
    """The SI unit of a product of scales, after the CF conventions: ``m s-1``."""
    return " ".join(f"{_UNITS[name]}{power if power != 1 else ''}" for name, power in _powers(scale)) or "1"


def _powers(scale: str) -> list[tuple[str, int]]:
    """The scales in a product, each with its power."""
    numerator, _, denominator = scale.partition("/")
    powers = []
    for factors, sign in ((numerator, 1), (denominator, -1)):
        for factor in factors.split():
            match = re.fullmatch(r"(L|m|F|T|rad|1)(?:\^(\d+))?", factor)
            if match is None:
                raise ValueError(f"scale = {scale!r} is not allowed; allowed: a product such as 'L/T' or 'm L^2'")
            if match[1] != "1":
                powers.append((match[1], sign * int(match[2] or 1)))
    return powers
