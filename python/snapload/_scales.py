"""Conversion between SI units and the scales of a case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar, Unpack

import numpy as np

from . import _engine
from ._arguments import number
from ._case import Case
from ._keys import Keys
from ._lazy_import import LazyModule
from ._products import powers
from ._signature import with_keys
from ._system_parts import set_fields
from ._table import Table

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")

#: What can be converted to SI.
Convertible = TypeVar("Convertible", Table, "xarray.Dataset", "xarray.DataArray", "np.recarray[Any, Any]")


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
    A ring of 1 m across between anchors 10 m apart, in waves of 0.45 rad/s that push with 310 N:

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
            The product, such as ``"L/T"``, ``"m L^2"`` or ``"L^(1/2)/T"``.

        Returns
        -------
        float
            The factor by which a number in these scales is multiplied.

        Raises
        ------
        ValueError
            If it is not such a product.
        TypeError
            If it is no str.

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
        try:
            for name, power in powers(scale):
                value *= sizes.get(name, 1.0) ** power
        except OverflowError:
            raise ValueError(f"scale = {scale!r} is not allowed; allowed: a product below 1e308 in SI units") from None
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
        TypeError
            If `base` is not a case.

        See Also
        --------
        si : Converts results to SI units.

        Examples
        --------
        >>> import snapload
        >>> snapload.Scales(length=5.0, mass=800.0, force=1000.0).case(t_end=60.0, e=0.7).t_end
        30.0
        """
        if base is not None and not isinstance(base, Case):
            allowed = "a snapload.Case; keys are given by name, such as f_o=310"
            raise TypeError(f"base = {base!r} is not allowed; allowed: {allowed}")
        units = {key["name"]: key["unit"] for key in _engine.keys()}
        converted: dict[str, Any] = {}
        for key, value in keys.items():
            unit = units.get(key, "")
            has_unit = unit not in ("", "1", "rad") and value is not None
            converted[key] = number(key, value) / self.factor(unit) if has_unit else value  # type: ignore[arg-type]
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
            Numbers among the attributes of a dataset, such as ``lim`` of a safe basin, are converted, too: their scale
            is in another attribute, ``lim_scale``, instead of which there is ``lim_units`` afterwards. What is in SI
            units already does not change. Convert first, and compute afterwards: what xarray computes from a variable
            keeps its metadata and often its name, as ``rho1**2`` does, and is then converted as ``rho1`` itself.

        Raises
        ------
        TypeError
            If the result is something else.
        ValueError
            If it is a result of a :class:`snapload.System`, which is in your own units; if it has numbers of unknown
            unit, or with metadata of a variable of another name, as those that are computed from results may have; or
            if numbers have no single unit, as in the table of :func:`snapload.sensitivities`.

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
        from ._conversion import converted_array, converted_dataset, converted_motion, converted_table
        from ._motion import Motion

        if isinstance(result, Table):
            return converted_table(self, result)
        if isinstance(result, Motion):
            return converted_motion(self, result)
        # xarray is loaded already if the result is one of its own.
        if type(result).__module__.startswith("xarray."):
            if isinstance(result, xarray.Dataset):
                return converted_dataset(self, result)
            if isinstance(result, xarray.DataArray):
                return converted_array(self, result)
        allowed = "a Table, a Dataset or DataArray of xarray, or a motion of a run or an orbit"
        raise TypeError(f"result, a {type(result).__name__}, is not allowed; allowed: {allowed}")


with_keys(Scales.case, defaults=False)
