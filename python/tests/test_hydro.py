"""Coefficients of floating bodies: as xarray in and out, the same as the command's."""

from __future__ import annotations

import copy
import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import snapload
import xarray
from snapload import _engine

PONTOON = Path(__file__).parents[2] / "docs" / "examples" / "pontoon.nc"
TESTED = Path(__file__).parents[2] / "crates" / "snapload-hydro" / "tests" / "data"


def test_file_and_dataset_are_the_same_body() -> None:
    of_file = snapload.Hydro.from_file(PONTOON, pairs=4)
    with xarray.open_dataset(PONTOON) as apart:
        of_dataset = snapload.Hydro.from_dataset(apart, pairs=4)
        # As Capytaine has it before it is written: complex numbers, axes in another order.
        names = ["diffraction_force", "Froude_Krylov_force"]
        whole = apart.drop_vars([*names, "excitation_force", "complex"])
        for name in names:
            part = apart[name]
            whole[name] = (part.sel(complex="re") + 1j * part.sel(complex="im")).T
        of_complex = snapload.Hydro.from_dataset(whole, pairs=4)
    for other in (of_dataset, of_complex):
        xarray.testing.assert_identical(other.dataset, of_file.dataset)
        assert other.natural == of_file.natural
    assert [motion["freedom"] for motion in of_file.natural] == ["pitch", "heave"]
    assert of_file.natural[1]["period_s"] == pytest.approx(3.253867029, rel=1e-9)
    units = {name: of_file.dataset[name].attrs["units"] for name in ("omega", "added_mass", "response")}
    assert units == {"omega": "rad s-1", "added_mass": "kg", "response": "m m-1"}


def test_results_are_those_of_the_command(tmp_path: Path) -> None:
    line = [(6, -10, 2, -1.2, 9.666436778876), (-6, -10, -2, -1.2, 9.666436778876)]
    pontoon = snapload.Hydro.from_file(PONTOON, mass=80000, pairs=4, lines=line)
    out = tmp_path / "all.json"
    message = ["--line=" + ",".join(str(number) for number in each) for each in line]
    status = _engine.command(
        ["snapload", "hydro", str(PONTOON), "--mass", "80000", "--pairs", "4", *message, "--json", str(out)]
    )
    assert status == 0
    command = json.loads(out.read_text())
    assert pontoon.answer == command
    assert pontoon.rest is not None
    assert pontoon.rest["taut"] == [1, 2]


def test_dataset_has_all_of_the_memory() -> None:
    # The memory of heave of this file is passive only with damping that is added.
    poor = snapload.Hydro.from_file(TESTED / "pontoon-poor.nc")
    data, body = poor.dataset, poor.answer["floating"]
    assert data["added_damping"].values[1, 1] > 0
    assert data["added_damping"].attrs == data["radiation_damping"].attrs
    mass = np.array(body["mass_matrix"]) + data["added_mass_inf"].values
    stiffness = np.array(body["stiffness"])
    for k, omega in enumerate(data["omega"].values):
        poles = data["pole"].values[:, None, None]
        residues = data["residue"].values
        of_poles = residues / (1j * omega - poles) + residues.conj() / (1j * omega - poles.conj())
        memory = 0.5 * of_poles.sum(axis=0) + data["added_damping"].values
        # Motions go as exp(-iωt), the memory's transform is that of exp(iωt).
        whole = stiffness - omega**2 * mass - 1j * omega * memory.conj()
        expected = np.linalg.solve(whole, data["excitation_force"].values[0, k])
        found = data["response_of_the_memory"].values[0, k]
        assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def test_memory_is_that_of_the_damping() -> None:
    pontoon = snapload.Hydro.from_file(PONTOON)
    omega = pontoon.dataset["omega"].values
    damping = pontoon.dataset["radiation_damping"].values[:, 1, 1]
    t = np.linspace(0, 8, 30)
    expected = 2 / np.pi * np.trapezoid(damping * np.cos(np.multiply.outer(t, omega)), omega, axis=-1)
    found = pontoon.kernel(t)
    assert found.shape == (30, 3, 3)
    assert np.abs(found[:, 1, 1] - expected).max() < 0.02 * expected[0]
    # A force depends on no motion that comes after it.
    for wrong in (-1e-9, [1, -2], np.nan, np.inf):
        with pytest.raises(ValueError, match="t = .* is not allowed; allowed: finite times in s from 0 on"):
            pontoon.kernel(wrong)
    assert pontoon.kernel([]).shape == (0, 3, 3)
    assert "passive" in repr(pontoon)
    assert "<table>" in pontoon._repr_html_()


@pytest.mark.parametrize("depth", [np.inf, "inf"])
def test_deep_water_can_be_given(depth: float) -> None:
    """WAMIT's files do not say that the water is deep; those of Capytaine do, and the body is the same."""
    beside = Path(__file__).parents[2] / "crates" / "snapload-hydro" / "tests" / "data"
    options = {"density": 1025, "gravity": 9.81, "unit_length": 1, "reference": (0, 0), "inertia": 173_953.1}
    options |= {"displaced_mass": 98_400, "file_centre": (0, -0.2), "depth": depth, "pairs": 4}
    wamit = snapload.Hydro.from_file(beside / "pontoon-deep.1", **options)  # type: ignore[arg-type]
    capytaine = snapload.Hydro.from_file(beside / "pontoon-deep.nc", pairs=4)
    assert wamit.answer["water"]["depth_m"] is None
    for mode, same in zip(wamit.natural, capytaine.natural, strict=True):
        assert mode["period_s"] == pytest.approx(same["period_s"], rel=1e-6)


def test_dataset_is_read_again() -> None:
    """The phases of a body away from the origin, whose file has the crest there, are not shifted twice."""
    options = {"density": 1025, "gravity": 9.81, "unit_length": 1, "depth": 12, "reference": (3.5, -1), "pairs": 4}
    first = snapload.Hydro.from_file(TESTED / "pontoon-deep.1", **options)  # type: ignore[arg-type]
    again = snapload.Hydro.from_dataset(first.dataset, pairs=4)
    for key in ("omega_rad_s", "added_mass", "radiation_damping", "excitation", "water", "reference_m"):
        assert again.answer[key] == first.answer[key], key
    data = first.dataset
    assert data["rotation_center"].values.tolist() == [3.5, 0, -1]
    assert [float(data[name]) for name in ("rho", "g", "water_depth", "crest_x")] == [1025, 9.81, 12, 3.5]
    # Beside the reference point the file's phases are those of a crest at x = 0, k x later (deep-water k at 12 m
    # is exact to 1e-9 for the last frequency).
    here = {**options, "reference": (0, -1)}
    origin = snapload.Hydro.from_file(TESTED / "pontoon-deep.1", **here)  # type: ignore[arg-type]
    number = data["omega"].values[-1] ** 2 / 9.81
    phase = np.exp(-1j * number * 3.5)
    found, expected = (each.dataset["excitation_force"].values[0, -1, :2] for each in (first, origin))
    assert np.abs(found - expected * phase).max() < 1e-6 * np.abs(found).max()


def test_copies_are_equal() -> None:
    pontoon = snapload.Hydro.from_file(PONTOON, pairs=4)
    assert pontoon.dataset.sizes["omega"] > 0
    for other in (
        pickle.loads(pickle.dumps(pontoon)),
        copy.deepcopy(pontoon),
        snapload.Hydro.from_file(PONTOON, pairs=4),
    ):
        assert other == pontoon and not other != pontoon and repr(other) == repr(pontoon)
    assert pontoon != snapload.Hydro.from_file(PONTOON, pairs=4, mass=80000) and pontoon != 1


def test_one_direction_may_be_selected() -> None:
    with xarray.open_dataset(PONTOON) as pontoon:
        whole = snapload.Hydro.from_dataset(pontoon, pairs=4)
        selected = snapload.Hydro.from_dataset(pontoon.isel(wave_direction=0), pairs=4)
    assert selected.answer["excitation"] == whole.answer["excitation"][:1]


def test_a_dimension_without_coordinates_is_not_one_of_zeros(tmp_path: Path) -> None:
    """A netCDF file has numbers for such a dimension, too: zeros, which are not data."""
    for name in ("wave_direction", "radiating_dof"):
        with xarray.open_dataset(PONTOON) as pontoon:
            pontoon.drop_vars(name).to_netcdf(tmp_path / "without.nc", engine="h5netcdf")
        with pytest.raises(ValueError, match=f"{name} is missing"):
            snapload.Hydro.from_file(tmp_path / "without.nc")


def test_bad_datasets_are_refused() -> None:
    with xarray.open_dataset(PONTOON) as pontoon, pytest.raises(ValueError, match="positive damping"):
        snapload.Hydro.from_dataset(pontoon.assign(radiation_damping=-pontoon["radiation_damping"]))
    with pytest.raises(ValueError, match="1025 in the file and 1000 in the options"):
        snapload.Hydro.from_file(PONTOON, density=1000)
    for options, message in (
        ({"centre": (1,)}, r"centre = \[1.0\] is not allowed; allowed: an array of length 2"),
        ({"damping": (1, 2, 3, 4)}, "damping = .* is not allowed; allowed: fewer numbers"),
        ({"mass": "heavy"}, 'mass = "heavy" is not allowed; allowed: a number'),
    ):
        with pytest.raises(ValueError, match=message):
            snapload.Hydro.from_file(PONTOON, **options)  # type: ignore[arg-type]
    for depth in ("deep", np.nan, -np.inf, (1, 2)):
        with pytest.raises(ValueError, match="depth = .* is not allowed"):
            snapload.Hydro.from_file(PONTOON, depth=depth)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="unit_length is given in the options"):
        snapload.Hydro.from_file(PONTOON, unit_length=7)
    with pytest.raises(ValueError, match="the damping of heave .* = -1"):
        snapload.Hydro.from_file(PONTOON, damping=(0, -1, 0))
    with pytest.raises(FileNotFoundError):
        snapload.Hydro.from_file("nowhere.nc")
    with pytest.raises(ValueError, match="first_column"):
        snapload.Hydro.from_file(PONTOON, first_column="rows")  # type: ignore[typeddict-item]
