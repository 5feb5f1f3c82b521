"""Every quantity of every result has a unit, and is converted to SI once."""

from __future__ import annotations

import copy
import inspect
import math
import pickle

import numpy as np
import pytest
import snapload
import xarray
from snapload._schema import attributes, units

SCALES = snapload.Scales(length=5.0, mass=800.0, force=1000.0)
#: A point mass with an orbit of one period, and a body that reaches its rotation limit.
VOLLEY = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1)
CAPSIZES = snapload.Case(f_o=0.31)
PLANE = dict(x="-0.3:0.3:7", y="0.05:0.65:7")
ROPE, WEIGHT = snapload.Cable(anchor=(0, 0), length=1), snapload.Forcing((0, -1))
SWING = snapload.System(snapload.Body(), [ROPE], WEIGHT, 0.5, y=-1, vx=1.8, t_end=5)


def basin(case=CAPSIZES, trust=False, **window):
    return snapload.safe_basin(case.replace(t_end=20), trust=trust, progress=False, **window)


def erosion(over=None, case=CAPSIZES, **window):
    over, case = over or {"f_o": [0, 0.3, 0.6]}, case.replace(t_end=20)
    return snapload.erosion(case, over=over, trust=False, progress=False, **window)


def branch():
    return snapload.continuation(VOLLEY.orbit(progress=False), "f_o", (1.3, 1.75), step=0.02, progress=False)


#: Everything that is a dataset or an array of xarray, of cases.
DATASETS = {
    "section": lambda: snapload.section(VOLLEY, periods=60, keep=20, progress=False),
    "section, impacts": lambda: snapload.section(VOLLEY, periods=60, keep=20, at="impacts", progress=False),
    "section, stopped": lambda: snapload.section(CAPSIZES.replace(f_o=0.5, y=0.3), keep=400, progress=False),
    "orbit_diagram": lambda: snapload.orbit_diagram(VOLLEY, f_o="1.4:1.5:3", periods=60, keep=20, progress=False),
    "safe_basin": lambda: basin(**PLANE),
    "safe_basin, trust": lambda: basin(trust=True, x="-0.3:0.3:3", y="0.05:0.65:3"),
    "safe_basin, velocities": lambda: basin(CAPSIZES.replace(y=0), vx="-0.9:0.9:7", vy="-0.9:0.9:7"),
    "safe_basin, keys": lambda: basin(e="0.5:0.9:3", f_o="0.1:0.5:3"),
    "basins_of_attraction": lambda: snapload.basins_of_attraction(
        VOLLEY, x="-0.2:0.2:3", y="0.2:0.4:2", transient=60, progress=False
    )[0],
    "erosion": lambda: erosion(**PLANE),
    "erosion, e": lambda: erosion({"e": [0.5, 0.9]}, **PLANE),
    "critical_force": lambda: snapload.critical_force(snapload.Case(), over={"e": [0.8, 0.9]}, largest=0.5),
    "sweep": lambda: snapload.sweep(CAPSIZES, f_o=[0.3, 0.31], max_impacts=[5, 50], progress=False),
    "sweep, points": lambda: snapload.sweep(CAPSIZES, random=3, f_o=(0.1, 0.6), progress=False),
    "branch": lambda: branch().points,
}
#: Every table.
TABLES = {
    "impacts": lambda: CAPSIZES.run().impacts,
    "modes": lambda: CAPSIZES.run().modes,
    "exponents": lambda: CAPSIZES.run().exponents,
    "orbit": lambda: VOLLEY.orbit(progress=False).events,
    "branch": lambda: branch().events,
    "certificate": lambda: CAPSIZES.run().certify().impacts,
}


def has_unit(name, attrs):
    """A scale or unit, or the schema says that there is none."""
    return "scale" in attrs or "units" in attrs or units().get(name) == ""


def si_unit(attrs):
    """The unit of a quantity after its conversion, as a library of units reads it."""
    from cf_xarray.units import units as registry

    return registry.Unit(attrs["units"])


@pytest.fixture(scope="module", params=DATASETS)
def dataset(request):
    made = DATASETS[request.param]()
    return made if hasattr(made, "data_vars") else made.to_dataset()


def test_every_variable_has_a_scale_or_no_dimension(dataset):
    for name, variable in dataset.variables.items():
        if variable.dtype.kind in "fc":
            scale = units().get(name, "")
            assert has_unit(name, variable.attrs), name
            assert scale in ("", "1", "rad") or variable.attrs["scale"] == scale, name
    for name, value in dataset.attrs.items():
        if np.asarray(value).dtype.kind == "f":
            # A knee is a value of the key that varies.
            schema = units()[next(iter(dataset.dims))] if name.startswith("knee") else units().get(name)
            assert f"{name}_scale" in dataset.attrs or schema in ("", "1"), name


def test_a_dataset_is_converted_once_and_completely(dataset):
    brought = SCALES.si(dataset)
    assert "scale" not in {key for variable in brought.variables.values() for key in variable.attrs}
    assert not [key for key in brought.attrs if key.endswith("_scale")]
    for name, variable in dataset.variables.items():
        factor = SCALES.factor(variable.attrs.get("scale", "1"))
        if variable.dtype.kind == "f":
            np.testing.assert_allclose(brought[name], variable * factor, rtol=1e-15)
            if factor != 1:
                assert si_unit(brought[name].attrs).dimensionality, name
        else:
            assert brought[name].variable.equals(variable)
    assert SCALES.si(brought).identical(brought)
    for name in dataset.data_vars:
        # A variable by itself is converted as within the dataset.
        assert SCALES.si(dataset[name]).identical(brought[name]), name


@pytest.mark.parametrize("table", TABLES)
def test_every_table_has_units_and_is_converted_once(table):
    given = TABLES[table]()
    for name, kind, attrs, _ in given._table.parts():
        assert kind != "float64" or has_unit("", attrs), name
    brought = SCALES.si(given)
    for name, kind, attrs, _ in given._table.parts():
        if kind == "float64":
            np.testing.assert_allclose(brought[name], given[name] * SCALES.factor(attrs.get("scale", "1")))
    assert SCALES.si(brought) == brought


def test_the_value_of_an_event_is_in_the_unit_of_its_key():
    events = branch().events
    brought = SCALES.si(events)
    np.testing.assert_allclose(brought["value"], events["value"] * 1000.0)
    np.testing.assert_allclose(brought["sqrt_coefficient"], events["sqrt_coefficient"] * math.sqrt(5.0) / 2.0)
    metadata = {name: attrs for name, _, attrs, _ in brought._table.parts()}
    assert metadata["value"]["units"] == "N" and metadata["sqrt_coefficient"]["units"] == "m0.5 s-1"


def test_every_function_that_returns_a_dataset_is_tested_here():
    with_xarray = {
        name
        for name in snapload.__all__
        if inspect.isfunction(thing := getattr(snapload, name)) and "xarray" in str(inspect.signature(thing))
    }
    drawn = {name for name in with_xarray if name.startswith("plot_")}
    # These return what a sweep returned.
    assert with_xarray - drawn - {"open_study", "merge"} == {name.split(",")[0] for name in DATASETS} - {"branch"}


def test_impacts_of_a_section_are_those_of_a_run_in_si():
    """Each of a lap's snaps, as the orbit has it by itself."""
    section = SCALES.si(DATASETS["section, impacts"]())
    orbit = VOLLEY.orbit(progress=False)
    for cable, v_n, impulse in zip(*(orbit.events[name] for name in ("cable", "v_n", "impulse")), strict=True):
        at = section.isel(impact=section.cable.values == cable)
        np.testing.assert_allclose(at.v_n, v_n * 2.5, rtol=1e-6)
        np.testing.assert_allclose(at.impulse, impulse * 800 * 2.5, rtol=1e-6)
        np.testing.assert_allclose(np.diff(at.t), math.tau / 3.1 * 2.0, rtol=1e-6)
        # A snap of a point mass turns its velocity by the impulse along the cable.
        jump = np.hypot(at.vx_after - at.vx_before, at.vy_after - at.vy_before)
        np.testing.assert_allclose(jump, at.impulse / 800, rtol=1e-9)
    assert section.exponent.attrs["units"] == section.exponent_se.attrs["units"] == "s-1"


def test_attributes_with_a_dimension_are_converted():
    stopped = snapload.section(CAPSIZES.replace(f_o=0.5, y=0.3), keep=400, progress=False)
    brought = SCALES.si(stopped)
    assert brought.attrs["y_max"] == stopped.attrs["y_max"] * 5.0 and brought.attrs["y_max_units"] == "m"
    assert brought.attrs["stop_t"] == stopped.attrs["stop_t"] * 2.0 and brought.attrs["stop_t_units"] == "s"
    assert brought.attrs["theta_max"] == stopped.attrs["theta_max"] and brought.attrs["theta_max_units"] == "rad"
    window = basin(**PLANE)
    brought = SCALES.si(window)
    for name in ("lim", "if"):
        assert brought.attrs[name] == window.attrs[name] * 5.0 > 0 and brought.attrs[f"{name}_units"] == "m"
    # What undecided cells leave open is known if neighbours were run.
    assert math.isnan(window.attrs["lim_at_least"])
    trusted = basin(trust=True, **PLANE)
    for name in ("lim_at_least", "if_at_least"):
        assert SCALES.si(trusted).attrs[name] == trusted.attrs[name] * 5.0 > 0, name
    np.testing.assert_allclose(brought.attrs["cell"], [0.5, 0.5])
    assert brought.attrs["cell_units"] == "m, m" and brought.attrs["gim"] == window.attrs["gim"]
    np.testing.assert_allclose(brought.t, window.t * 2.0)
    velocities = basin(CAPSIZES.replace(y=0), vx="-0.9:0.9:7", vy="-0.9:0.9:7")
    brought = SCALES.si(velocities)
    assert brought.attrs["lim"] == velocities.attrs["lim"] * 2.5 > 0 and brought.attrs["lim_units"] == "m s-1"
    # Either velocity has its own.
    assert math.isnan(velocities.attrs["iim"])


def test_a_knee_is_in_the_unit_of_the_key():
    eroded = erosion(**PLANE)
    brought = SCALES.si(eroded)
    assert brought.attrs["knee"] == eroded.attrs["knee"] * 1000.0 and brought.attrs["knee_units"] == "N"
    assert brought.attrs["knee"] in brought.f_o.values
    np.testing.assert_allclose(brought.lim, eroded.lim * 5.0)
    assert brought.lim.attrs["units"] == "m" and brought.gim.equals(eroded.gim.assign_coords(f_o=brought.f_o))
    assert "knee_scale" not in erosion({"e": [0.5, 0.9]}, **PLANE).attrs


def test_a_distance_between_a_length_and_a_velocity_has_no_unit():
    window = basin(CAPSIZES.replace(y=0), x="-0.3:0.3:7", vx="-0.9:0.9:7")
    assert window.attrs["lim_scale"] == "L and L/T" and window.attrs["cell_scale"] == "L, L/T"
    with pytest.raises(ValueError, match="lim is not allowed, as its scale, L and L/T, is no single unit"):
        SCALES.si(window)
    without = window.copy()
    for name in ("lim", "if", "lim_at_least", "if_at_least"):
        del without.attrs[name], without.attrs[f"{name}_scale"]
    brought = SCALES.si(without)
    np.testing.assert_allclose(brought.attrs["cell"], [0.5, 0.75])
    assert brought.attrs["iim"] == window.attrs["iim"] * 2.5 > 0 and brought.attrs["iim_units"] == "m s-1"
    # Where the plane does not hold the equilibrium there is no distance, and nothing to convert.
    aside = basin(trust=False, x="-0.3:0.3:7", vx="-0.9:0.9:7")
    assert math.isnan(aside.attrs["lim"]) and math.isnan(aside.attrs["iim"])


def test_what_is_computed_from_results_is_not_taken_for_a_result():
    study = snapload.sweep(CAPSIZES, f_o=[0.3, 0.31], progress=False)
    squared = study.rho1**2
    squared.attrs.clear()
    for array in (squared, squared.rename("energy"), squared.rename(None)):
        with pytest.raises(ValueError, match="its unit is unknown; allowed: quantities whose metadata have units"):
            SCALES.si(array)
    told = squared.assign_attrs(units="1", scale="L^2/T^2", quantity="rho1")
    np.testing.assert_allclose(SCALES.si(told), squared * 2.5**2)


@pytest.mark.parametrize(
    "compute",
    [
        lambda study: study.rho1 * study.t,
        lambda study: study.rho1 / study.rho2,
        # Both have one scale, which is not that of the product.
        lambda study: study.rho1 * study.rho2,
        lambda study: (0.5 * study.rho1**2).rename("energy"),
        lambda study: study.assign(energy=0.5 * study.rho1**2),
        lambda study: study.assign(product=study.rho1 * study.rho2),
        lambda study: study.assign(quotient=study.rho1 / study.t),
        lambda study: study.assign_coords(product=study.f_o * study.rho1),
    ],
)
@pytest.mark.parametrize("keep", [True, False, "default"])
def test_metadata_that_arithmetic_keeps_are_not_taken_for_those_of_the_result(compute, keep):
    study = snapload.sweep(CAPSIZES, f_o=[0.3, 0.31], progress=False)
    with xarray.set_options(keep_attrs=keep):
        computed = compute(study)
    with pytest.raises(ValueError, match="is not allowed, as its (metadata are|unit is unknown)"):
        SCALES.si(computed)


@pytest.mark.parametrize(
    "choose",
    [
        lambda study: study.where(study.rho1 > 1),
        lambda study: study.rho1.where(study.rho1 > 1),
        lambda study: study.isel(f_o=0),
        lambda study: study.rho1.sel(f_o=slice(0.3, 0.4)),
        lambda study: study[["rho1", "t"]].mean("f_o"),
        lambda study: study.rho1.max("f_o"),
        lambda study: study[["rho1", "t"]].isel(e=0, drop=True).sortby("rho1"),
        lambda study: xarray.concat([study, study], "again"),
        lambda study: study.rho1.rolling(f_o=2).mean(),
        lambda study: study.stack(case=("f_o", "e")).reset_index("case"),
        lambda study: study.rho1.to_dataset(),
        lambda study: copy.deepcopy(study),
    ],
)
def test_what_is_chosen_from_a_result_is_converted(choose):
    study = snapload.sweep(CAPSIZES, f_o=[0.3, 0.31, 0.5], e=[0.9, 0.8], progress=False)
    chosen = choose(study)
    brought = SCALES.si(chosen)
    if not isinstance(chosen, xarray.DataArray):
        np.testing.assert_allclose(brought.rho1, chosen.rho1 * 2.5)
    else:
        np.testing.assert_allclose(brought, chosen * 2.5)
    if "f_o" in chosen.coords:
        np.testing.assert_allclose(brought.f_o, chosen.f_o * 1000.0)


def test_gaps_can_be_made_in_every_dataset(dataset):
    # Whole numbers and flags become floats where xarray puts NaN between them.
    gaps = dataset.where(dataset.coords[next(iter(dataset.dims))] != math.inf)
    for name, variable in SCALES.si(gaps).data_vars.items():
        if dataset[name].dtype.kind in "iu":
            np.testing.assert_array_equal(variable, dataset[name])


def test_a_file_without_the_names_of_quantities_is_converted():
    """One that was written with an earlier version."""
    study = snapload.sweep(CAPSIZES, f_o=[0.3, 0.31], progress=False)
    brought = SCALES.si(study)
    for variable in study.variables.values():
        variable.attrs.pop("quantity", None)
    np.testing.assert_array_equal(SCALES.si(study).rho1, brought.rho1)


def test_a_motion_is_converted_once():
    motion = CAPSIZES.run().motion(0.1)
    once = SCALES.si(motion)
    np.testing.assert_allclose(once.x, motion.x * 5.0)
    np.testing.assert_allclose(once.T2, motion.T2 * 1000.0)
    for same in (once, once[2:5], once[["t", "x"]], copy.deepcopy(once), pickle.loads(pickle.dumps(once))):
        assert SCALES.si(same).tobytes() == same.tobytes()
    for part in (motion[2:5], pickle.loads(pickle.dumps(motion))[2:5], CAPSIZES.run().at(motion.t[2:5])):
        assert SCALES.si(part).tobytes() == once[2:5].tobytes()
    assert SCALES.si(CAPSIZES.run().at(0.1)).y == once.y[1]
    with pytest.raises(TypeError, match="a recarray, is not allowed; allowed: .* a motion of a run or an orbit"):
        SCALES.si(np.concatenate([motion, motion]).view(np.recarray))


def test_the_curve_of_an_orbit_is_a_motion():
    lap = VOLLEY.orbit(progress=False).curve(40)
    brought = SCALES.si(lap)
    assert brought.leg.tolist() == lap.leg.tolist() and brought.taut.tolist() == lap.taut.tolist()
    np.testing.assert_allclose(brought.vx, lap.vx * 2.5)


def test_results_of_a_system_are_in_units_of_the_user():
    run = SWING.run()
    shaken = snapload.Sinusoid((0, 1.2), 3, phase=(0, -math.pi / 2))
    ball = snapload.System(snapload.Body(), [snapload.Cable((0, 5), 5)], snapload.Forcing((0, -1), [shaken]), 0.5)
    orbit = ball.orbit({"y": 0.2, "vy": -1.3})
    study = SWING.sweep(vx=[1.0, 1.8], progress=False)
    results = (run.motion(0.1), run.at(0.5), run.impacts, run.modes, run.exponents, orbit.curve(40), orbit.events)
    for result in (*results, pickle.loads(pickle.dumps(run.motion(0.1))), study, study.rho1):
        with pytest.raises(ValueError, match=r"in your own units, as all results of a snapload\.System"):
            SCALES.si(result)
    attrs = {name: attrs for name, _, attrs, _ in run.impacts._table.parts()}
    assert attrs["v_n"]["dimension"] == study.rho1.attrs["dimension"] == "L/T"
    assert not {"units", "scale"} & {*attrs["v_n"], *study.rho1.attrs}


def test_pictures_of_converted_results_have_their_units():
    made = {name: DATASETS[name]() for name in ("orbit_diagram", "safe_basin", "erosion")}
    for bring, force, length, velocity in (
        (lambda results: results, "F", "L", "L/T"),
        (SCALES.si, "N", "m", "m s-1"),
    ):
        found, eroded = bring(made["orbit_diagram"]), bring(made["erosion"])
        ax = snapload.plot_diagram(found, "vx")
        assert (ax.get_xlabel(), ax.get_ylabel()) == (f"$f_o$ [{force}]", f"$\\dot x$ [{velocity}]")
        ax = snapload.plot_basin(bring(made["safe_basin"]))
        assert (ax.get_xlabel(), ax.get_ylabel()) == (f"$x$ [{length}]", f"$y$ [{length}]")
        ax = snapload.plot_erosion(eroded)
        assert ax.get_xlabel() == f"$f_o$ [{force}]"
        right = [axes for axes in ax.figure.axes if axes is not ax]
        assert [axes.get_ylabel() for axes in right] == [f"distance in the window [{length}]"]


def test_the_long_name_of_body_is_of_both_kinds():
    long_name = attributes()["body"]["long_name"]
    assert long_name == "kind of body"
