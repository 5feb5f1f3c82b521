"""Hydrodynamic coefficients of floating bodies."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from ._arguments import whole_number
from ._lazy_import import LazyModule
from ._result import Result

if TYPE_CHECKING:
    import xarray
else:
    xarray = LazyModule("xarray")

_DOFS = ["Surge", "Heave", "Pitch"]
# A variable of a dataset: name, dimensions, lengths, values.
_Variable = tuple[str, list[str], list[int], list[float] | list[str]]


class HydroOptions(TypedDict, total=False):
    """Options of the analysis besides the coefficients; see :meth:`Hydro.from_file`."""

    mass: float | None
    centre: tuple[float, float] | None
    inertia: float | None
    damping: tuple[float, float, float] | None
    force: tuple[float, float, float] | None
    lines: Sequence[tuple[float, float, float, float, float]]
    pairs: int | None
    body: str | None
    density: float | None
    gravity: float | None
    depth: float | None
    reference: tuple[float, float] | None
    displaced_mass: float | None
    file_centre: tuple[float, float] | None
    unit_length: float | None
    first_column: Literal["period", "frequency", "infinite-depth-wavenumber", "wavenumber"]


@dataclass(frozen=True, repr=False, eq=False)
class Hydro(Result):
    """Hydrodynamic coefficients of a floating body, and the results that need no simulation.

    Use :meth:`from_file` or :meth:`from_dataset` to create it. All quantities are in kg, m, N, s and rad. Positive
    pitch turns z towards x, and the time dependence is exp(-iωt).

    Attributes
    ----------
    natural : list of dict
        Natural modes without lines: ``freedom``, ``period_s`` from the coefficients of the file, and
        ``damped_period_s`` (None if overdamped) and ``damping_ratio`` from the fitted memory.
    rest : dict or None
        The equilibrium with the lines, with tensions and the small motion about it.
    quality : dict
        The quality of the fitted memory: ``blocks``, ``entries``, ``least_eigenvalue``, ``states``.
    warnings : list of str
        Warnings about the file, the memory and the results.
    answer : dict
        All results, as ``snapload hydro --json`` writes them. ``sea`` is empty, as the command writes it without
        ``--hs`` and ``--tp``, which are options of the command only.

    See Also
    --------
    Hydro.from_file : Reads the file of a panel code.
    Hydro.from_dataset : Reads a dataset of Capytaine.

    Examples
    --------
    >>> import snapload
    >>> pontoon = snapload.Hydro.from_file("docs/examples/pontoon.nc")  # doctest: +SKIP
    >>> pontoon.natural[1]["freedom"], round(pontoon.natural[1]["period_s"], 3)  # doctest: +SKIP
    ('heave', 3.254)
    """

    natural: list[dict[str, Any]]
    rest: dict[str, Any] | None
    quality: dict[str, Any]
    warnings: list[str]
    answer: dict[str, Any]
    _summary: list[tuple[str, str]]

    @classmethod
    def from_file(cls, path: str | PathLike[str], **options: Unpack[HydroOptions]) -> Hydro:
        """
        Read the file of a panel code, fit the memory and compute all results.

        Parameters
        ----------
        path : str or os.PathLike
            Capytaine file (``.nc``), one of the WAMIT files ``.1``, ``.2``, ``.3`` and ``.hst`` with the others in the
            same folder, or Nemoh folder (for its memory alone, as it has no hydrostatic stiffness).
        **options
            Options of the analysis. By default each has the value of the file, or is not used:

            - ``mass``, ``centre`` (x, z), ``inertia``: mass, centre of gravity and moment of inertia about it;
            - ``damping``: linear damping of surge, heave and pitch in addition to wave radiation;
            - ``force``: a constant load in addition to weight and buoyancy;
            - ``lines``: each as (anchor x, anchor z, fairlead x, fairlead z, length), with fairleads relative to the
              reference point;
            - ``pairs``: number of pole pairs of the memory, by default as many as 1 % accuracy needs;
            - ``body``: the name of the body, if the file has several;
            - ``density``, ``gravity``, ``depth`` (``math.inf`` for deep water), ``reference``, ``displaced_mass``,
              ``file_centre``, and for WAMIT's files ``unit_length`` and ``first_column``: values that the file does
              not contain, as described in ``snapload hydro --help``; a value that the file does contain has to
              agree.

        Returns
        -------
        Hydro
            The coefficients and all results.

        Raises
        ------
        ValueError
            If a value is missing, breaks a convention or is not a number; the message says which.
        OSError
            If the file does not exist.

        See Also
        --------
        Hydro.from_dataset : Reads a dataset that Capytaine has just computed.

        Examples
        --------
        >>> import snapload
        >>> snapload.Hydro.from_file("docs/examples/pontoon.nc", mass=80_000).quality["states"]  # doctest: +SKIP
        48
        """
        name = fspath(path)
        Path(name).stat()
        return cls._analyse(name, None, options)

    @classmethod
    def from_dataset(cls, dataset: xarray.Dataset, **options: Unpack[HydroOptions]) -> Hydro:
        """
        Read a dataset of Capytaine, fit the memory and compute all results.

        Parameters
        ----------
        dataset : xarray.Dataset
            The result of ``assemble_dataset`` or ``fill_dataset``, with complex values or with their real and
            imaginary parts apart.
        **options
            As for :meth:`Hydro.from_file`.

        Returns
        -------
        Hydro
            The coefficients and all results.

        Raises
        ------
        ValueError
            If a value is missing, breaks a convention or is not a number; the message says which.
        TypeError
            If `dataset` is no dataset.

        See Also
        --------
        Hydro.from_file : Reads a file.

        Examples
        --------
        >>> import snapload
        >>> import xarray
        >>> with xarray.open_dataset("docs/examples/pontoon.nc") as dataset:  # doctest: +SKIP
        ...     snapload.Hydro.from_dataset(dataset).quality["states"]
        48
        """
        if not hasattr(dataset, "data_vars"):
            raise TypeError(f"dataset, a {type(dataset).__name__}, is not allowed; allowed: an xarray.Dataset")
        return cls._analyse("dataset", _variables(dataset), options)

    @classmethod
    def _analyse(cls, name: str, variables: list[_Variable] | None, options: HydroOptions) -> Hydro:
        given = {key: _json_value(key, value) for key, value in options.items() if value is not None}
        text, summary = _engine.hydro(name, variables, json.dumps(given))
        answer = json.loads(text) | {"sea": []}
        floating = answer["floating"] or {}
        return cls(
            natural=floating.get("natural", []),
            rest=floating.get("rest"),
            quality=answer["quality"],
            warnings=[f"{warning['what']}: {warning['words']}" for warning in answer["warnings"]],
            answer=answer,
            _summary=summary,
        )

    @cached_property
    def dataset(self) -> xarray.Dataset:
        """
        Coefficients, response and memory as an xarray dataset with units.

        ``added_mass``, ``radiation_damping`` and ``excitation_force`` over ``omega``; ``response`` and
        ``response_of_the_memory`` per metre of wave; the memory as ``pole`` and ``residue``, with the
        corresponding ``added_mass_inf`` and ``added_damping``. Phases are those of a wave with its crest over the
        reference point.

        The coordinates ``rho``, ``g``, ``water_depth``, ``rotation_center`` (the reference point) and ``crest_x``
        (that of the phases) are what :meth:`from_dataset` needs to read the same coefficients from it. Mass, centre
        of gravity and hydrostatic stiffness are not in it.

        See Also
        --------
        Hydro.kernel : The memory as a function of time.
        Hydro.from_dataset : Reads it, without options for the water or the reference point.

        Examples
        --------
        >>> import snapload
        >>> pontoon = snapload.Hydro.from_file("docs/examples/pontoon.nc")  # doctest: +SKIP
        >>> pontoon.dataset["added_mass"].sel(influenced_dof="Heave", radiating_dof="Heave")  # doctest: +SKIP
        """
        return _dataset(self.answer)

    def kernel(self, t: ArrayLike) -> NDArray[np.float64]:
        """
        Evaluate the memory function K(t) = Re Σ R exp(pt).

        Parameters
        ----------
        t : array_like
            Times [s], from 0 on.

        Returns
        -------
        numpy.ndarray
            K, of shape ``(*t.shape, 3, 3)``.

        Raises
        ------
        ValueError
            If a time is negative or not a finite number. The sum of exponentials is K only from 0 on; the memory of
            the future is 0.

        See Also
        --------
        Hydro.dataset : Has the poles and residues of the memory.

        Examples
        --------
        >>> import snapload
        >>> pontoon = snapload.Hydro.from_file("docs/examples/pontoon.nc")  # doctest: +SKIP
        >>> pontoon.kernel(0.0)[1, 1] > 0  # doctest: +SKIP
        np.True_
        """
        times = np.asarray(t, dtype=float)
        refused = times[~(np.isfinite(times) & (times >= 0))]
        if refused.size:
            raise ValueError(f"t = {refused[0]} is not allowed; allowed: finite times in s from 0 on")
        poles = _complex([term["pole"] for term in self.answer["memory"]])
        residues = _complex([term["residue"] for term in self.answer["memory"]])
        kernel = np.tensordot(np.exp(np.multiply.outer(times, poles)), residues, axes=1)
        return np.asarray(kernel.real, dtype=float)

    def __repr__(self) -> str:
        return "\n".join(f"{label:<10}{text}" for label, text in self._summary)

    def _repr_html_(self) -> str:
        rows = (f"<tr><td>{escape(label)}</td><td>{escape(text)}</td></tr>" for label, text in self._summary)
        return f"<table><tbody>{''.join(rows)}</tbody></table>"


def _json_value(key: str, value: Any) -> Any:
    """An option as JSON can represent it; JSON has only finite numbers, and the depth may be infinite."""
    if key == "pairs":
        return whole_number(key, value)
    if key == "depth" and np.ndim(value) == 0 and value == np.inf:
        return "inf"
    if isinstance(value, str):
        return value
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        numbers = np.array(np.nan)
    if not np.isfinite(numbers).all():
        raise ValueError(f"{key} = {value!r} is not allowed; allowed: finite numbers")
    return numbers.tolist()


def _variables(dataset: xarray.Dataset) -> list[_Variable]:
    """Every variable of a dataset; complex ones get an additional dimension for their parts."""
    variables: list[_Variable] = []
    for name, variable in dataset.variables.items():
        values, dims = np.asarray(variable.values), [str(dim) for dim in variable.dims]
        if values.dtype.kind in "OUS":
            flat: list[float] | list[str] = [str(word) for word in values.ravel()]
        elif values.dtype.kind == "c":
            values, dims = np.stack([values.real, values.imag]), ["complex", *dims]
            flat = values.ravel().tolist()
        elif values.dtype.kind in "fiub":
            flat = values.astype(float).ravel().tolist()
        else:
            continue
        variables.append((str(name), dims, list(values.shape), flat))
    if not any(name == "complex" for name, *_ in variables):
        variables.append(("complex", ["complex"], [2], ["re", "im"]))
    return variables


def _complex(pairs: object) -> NDArray[np.complex128]:
    parts = np.asarray(pairs, dtype=float)
    return parts[..., 0] + 1j * parts[..., 1]


def _dataset(answer: dict[str, Any]) -> xarray.Dataset:
    """The results as a dataset with the names of Capytaine."""
    matrix = ("influenced_dof", "radiating_dof")
    wave = ("wave_direction", "omega", "influenced_dof")
    excitation = answer["excitation"]
    # A row or a column of pitch is multiplied by a length.
    mass, damping, force, motion = (
        {"units": units, "units_of_pitch": pitch}
        for units, pitch in [("kg", "kg m, kg m2"), ("N s m-1", "N s, N m s"), ("N m-1", "N"), ("m m-1", "rad m-1")]
    )
    stiffness = {"units": "N m-1", "units_of_pitch": "N, N m"}
    poles = _complex([term["pole"] for term in answer["memory"]])
    residues = _complex([term["residue"] for term in answer["memory"]])
    variables: dict[str, Any] = {
        "added_mass": (("omega", *matrix), answer["added_mass"], mass),
        "radiation_damping": (("omega", *matrix), answer["radiation_damping"], damping),
        "excitation_force": (wave, _complex([each["force"] for each in excitation]), force),
        "added_mass_inf": (matrix, answer["added_mass_inf"], mass),
        "added_damping": (matrix, answer["added_damping"], damping),
        "pole": ("memory", poles, {"units": "s-1"}),
        "residue": (("memory", *matrix), residues, stiffness),
    }
    if answer["floating"]:
        responses = answer["floating"]["responses"]
        for name, key in [("response", "of_the_file"), ("response_of_the_memory", "of_the_memory")]:
            variables[name] = (wave, _complex([each[key] for each in responses]), motion)
    coordinates = {
        "omega": ("omega", answer["omega_rad_s"], {"units": "rad s-1"}),
        "influenced_dof": _DOFS,
        "radiating_dof": _DOFS,
        "wave_direction": (
            "wave_direction",
            [0.0 if each["direction"] > 0 else np.pi for each in excitation],
            {"units": "rad"},
        ),
        **_place(answer),
    }
    return xarray.Dataset(variables, coords=coordinates)


def _place(answer: dict[str, Any]) -> dict[str, Any]:
    """The water and the reference point as Capytaine has them, and where the crest of the phases is."""
    water, (x, z) = answer["water"], answer["reference_m"]
    depth = water["depth_m"]
    return {
        "rho": ((), water["density_kg_m3"], {"units": "kg m-3"}),
        "g": ((), water["gravity_m_s2"], {"units": "m s-2"}),
        "water_depth": ((), np.inf if depth is None else depth, {"units": "m"}),
        "space_coordinate": ["x", "y", "z"],
        "rotation_center": ("space_coordinate", [x, 0.0, z], {"units": "m"}),
        "crest_x": ((), x, {"units": "m", "long_name": "crest of the incident wave at t = 0"}),
    }
