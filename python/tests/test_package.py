"""The package as a whole: light, typed, documented, true to the schema."""

from __future__ import annotations

import copy
import doctest
import functools
import importlib
import inspect
import operator
import pickle
import pkgutil
import re
import runpy
import subprocess
import sys

import pytest
import snapload
from conftest import ROOT
from mypy import api
from numpydoc.validate import validate


def test_import_loads_nothing_heavy():
    code = "import sys, snapload; snapload.Case(f_o=0.31).run().end; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    heavy = {"matplotlib", "xarray", "pandas", "dask", "distributed", "tqdm", "pyarrow", "polars", "IPython"}
    assert "snapload" in loaded and not heavy & set(loaded)


def test_keys_are_those_of_the_schema():
    generated = runpy.run_path(str(ROOT / "python" / "generate_keys.py"))
    assert generated["TARGET"].read_text() == generated["generate"]()


def test_the_drawing_of_the_mooring_has_every_key():
    """Those of how a run ends are no part of a mooring."""
    drawn = (ROOT / "docs" / "images" / "mooring.svg").read_text(encoding="utf-8")
    words = set(re.findall(r"\w+", " ".join(re.findall(r">([^<>]+)<", drawn))))
    keys = {key["name"] for key in snapload._engine.keys() if key["group"] != "stops"}
    assert len(keys) > 10 and keys <= words


def test_types_hold():
    files = [str(ROOT / "python" / place) for place in ("snapload", "tests/typed_example.py")]
    out, errors, status = api.run(["--strict", "--config-file", str(ROOT / "pyproject.toml"), *files])
    assert status == 0, out + errors


def test_wrong_types_are_found(tmp_path):
    (tmp_path / "wrong.py").write_text('import snapload\nsnapload.Case(e="x")\nsnapload.Case(omgea=1.0)\n')
    out, _, _ = api.run(["--strict", "--config-file", str(ROOT / "pyproject.toml"), str(tmp_path / "wrong.py")])
    assert 'wrong.py:2: error: Argument "e"' in out and 'wrong.py:3: error: Unexpected keyword argument "omgea"' in out


@pytest.mark.parametrize("module", [m.name for m in pkgutil.iter_modules(snapload.__path__) if m.name != "_engine"])
def test_examples_in_docstrings_are_true(module):
    assert doctest.testmod(importlib.import_module(f"snapload.{module}")).failed == 0


#: Of numpydoc's checks those of style: on which line the text begins, and that there is more than a summary.
STYLE = {"GL01", "GL02", "GL03", "ES01"}
#: Functions make these, so that their contents are documented as attributes. Their constructors are not called.
RESULTS = {"Certificate", "CriticalForce", "End", "Ensemble", "Norms", "Outcome", "Run", "Share", "SystemRun", "Table"}
RESULTS |= {"Admissible", "Branch", "LyapunovSpectrum", "Orbit", "SystemOrbit"}
RESULTS |= {"Hydro", "Trust", "Verification", "_animate.Animation", "Assessment", "Elastic", "Seas", "Structure"}
#: Their ``**keys`` are documented as such, while the signature names every key.
WITH_KEYS = {"Case.replace", "Scales.case", "sweep", "Hydro.from_file", "Hydro.from_dataset"}
WITH_KEYS |= {"orbit_diagram", "safe_basin", "basins_of_attraction", "erosion"}


def public():
    """Names of all that is public, methods and properties among them, but for the keys of a case."""
    keys = {key["name"] for key in snapload._engine.keys()}
    for name in snapload.__all__:
        thing = getattr(snapload, name)
        if inspect.isclass(thing):
            yield name
            if issubclass(thing, Exception):
                continue
            for member, value in inspect.getmembers(thing):
                is_public_kind = inspect.isroutine(value) or isinstance(value, (property, functools.cached_property))
                if is_public_kind and not member.startswith("_") and member not in keys:
                    yield f"{name}.{member}"
        elif inspect.isfunction(thing):
            yield name
    yield from ("_case.Cases", "_animate.Animation", "_animate.Animation.save")


#: Those of functions are run with their modules.
CLASSES_AND_MEMBERS = [name for name in public() if "." in name or inspect.isclass(getattr(snapload, name))]


@pytest.mark.parametrize("name", CLASSES_AND_MEMBERS)
def test_examples_of_public_classes_are_true(name, tmp_path, monkeypatch):
    """Doctest itself looks neither at methods of classes that a package imports nor at properties that are kept."""
    monkeypatch.chdir(tmp_path)
    thing = operator.attrgetter(name)(snapload)
    examples = doctest.DocTestParser().get_doctest(inspect.getdoc(thing), {}, name, None, 0)
    assert examples.examples or inspect.isclass(thing)
    assert doctest.DocTestRunner().run(examples).failed == 0


@pytest.mark.parametrize("name", list(public()))
def test_public_names_are_documented_in_numpydoc_style(name):
    """Summary, Parameters, Returns, See Also and Examples, among others."""
    left = STYLE | ({"PR01"} if name in RESULTS else set()) | ({"PR01", "PR02"} if name in WITH_KEYS else set())
    wrong = [error for error in validate(f"snapload.{name}")["errors"] if error[0] not in left]
    assert not wrong


def test_everything_public_is_documented():
    for name in snapload.__all__:
        thing = getattr(snapload, name)
        if name.startswith("__"):
            continue
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for method, member in vars(thing).items():
                if not method.startswith("_") and (callable(member) or isinstance(member, property)):
                    assert inspect.getdoc(member), f"{name}.{method}"


def test_signatures_name_the_keys():
    parameters = inspect.signature(snapload.Case).parameters
    names = [key["name"] for key in snapload._engine.keys()]
    assert list(parameters) == ["code", *names] and repr(parameters["f_o"].default) == "0.3"
    assert "Frequency of the forcing [rad/T]; allowed: ``-1000 <= omega <= 1000``;" in inspect.getdoc(snapload.Case)
    assert set(names) < set(inspect.signature(snapload.sweep).parameters)
    assert list(inspect.signature(snapload.Case.replace).parameters) == ["self", *names]


def test_cases_compare_copy_and_pickle():
    case = snapload.Case("1920001000-359", e=0.7)
    assert repr(case) == "Case('1920001000-359', e=0.7)" and case.inertia == 0.2 * 0.2
    for other in (copy.deepcopy(case), pickle.loads(pickle.dumps(case)), eval(repr(case), vars(snapload).copy())):
        assert other == case and hash(other) == hash(case) and repr(other) == repr(case)
    assert case.replace(a=0.3).inertia == 0.3 * 0.3 and case != case.replace(e=0.8)
    assert case.replace(body="point", a=0.0).inertia is None


def test_the_built_in_cases_are_a_mapping():
    assert len(snapload.cases) == 29 and next(iter(snapload.cases)) == "1910001000-359"
    assert "nothing" not in snapload.cases and snapload.cases.get("nothing") is None
    with pytest.raises(KeyError, match='there is no built-in case "1910001000-495"; the nearest are 1910001000-459'):
        snapload.cases["1910001000-495"]
    with pytest.raises(ValueError, match="the nearest are 1910001000-459"):
        snapload.Case("1910001000-495")


def test_notebooks_get_tables():
    run = snapload.Case(f_o=0.31).run()
    assert (
        "rotation limit at t = 3.4522" in run._repr_html_() and "<td><code>omega</code></td>" in run.case._repr_html_()
    )
    assert snapload.cases._repr_html_().count("<tr>") == 30
    assert "0.31 to 0.39" in snapload.critical_force(snapload.Case(), largest=0.5)._repr_html_()
    assert "100.0 %" in snapload.ensemble(run.case, 10)._repr_html_()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (dict(uncertainty=-1), "uncertainty: x = -1 is not allowed"),
        (dict(uncertainty={"foo": 1}), 'uncertainty: there is no key "foo"'),
        (dict(uncertainty={"t_end": 1}), "an uncertainty of one of the keys"),
        (dict(tolerance=0), "tolerance = 0 is not allowed; allowed: a number above 0"),
        (dict(members=-1), "members = -1 is not allowed; allowed: a whole number, 0 <= members"),
        (dict(seed=1.5), "seed = 1.5 is not allowed"),
    ],
)
def test_options_are_checked(options, message):
    with pytest.raises(ValueError, match=message):
        snapload.Case().run(**options)


def test_other_options_are_checked():
    with pytest.raises(ValueError, match="digits = 999 is not allowed; allowed: a whole number, 1 <= digits <= 307"):
        snapload.verify(snapload.Case(), 999)
    with pytest.raises(ValueError, match="step = 0 is not allowed"):
        snapload.critical_force(snapload.Case(), step=0)
    with pytest.raises(ValueError, match="give members"):
        snapload.critical_force(snapload.Case(), uncertainty=1e-3)
    with pytest.raises(ValueError, match="uncertainty: theta = .*this case has no such quantity"):
        snapload.Case(body="point").run(uncertainty={"theta": 1e-3})
