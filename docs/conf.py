"""Configuration of the manual as a site."""

import importlib
import os
from pathlib import Path
from typing import Any

import snapload
from docutils import nodes
from sphinx.util import logging
from sphinx.util.fileutil import copy_asset

project = "snapload"
author = "The snapload developers"
copyright = author
release = version = snapload.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
if "READTHEDOCS" in os.environ:
    # Types of other libraries link to their manuals, if these can be downloaded.
    extensions.append("sphinx.ext.intersphinx")
    intersphinx_mapping = {
        "python": ("https://docs.python.org/3", None),
        "numpy": ("https://numpy.org/doc/stable", None),
        "matplotlib": ("https://matplotlib.org/stable", None),
        "pandas": ("https://pandas.pydata.org/docs", None),
        "xarray": ("https://docs.xarray.dev/en/stable", None),
    }
exclude_patterns = ["README.md", "_build"]
# All warnings are reported, and the tests treat them as errors.
nitpicky = True
nitpick_ignore_regex = [("py:.*", r"^(?!snapload\.(?!_engine)).*")]
# A type variable and the keyword arguments of a call have no page.
nitpick_ignore = [("py:class", "snapload._scales.Convertible"), ("py:class", "snapload._hydro.HydroOptions")]

# Formulas are typeset in the browser by files of the site itself, without a network.
mathjax_path = "mathjax/tex-chtml.js"
# Wide formulas scroll on narrow screens.
html_static_path = ["static"]
html_css_files = ["manual.css"]

myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]

# The notebooks are run when the site is built, so that they show the results of this version.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_merge_streams = True

napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88

html_theme = "furo"
html_title = f"snapload {release}"
html_show_sphinx = False
html_copy_source = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0072B2", "color-brand-content": "#0072B2"},
    "dark_css_variables": {"color-brand-primary": "#56B4E9", "color-brand-content": "#56B4E9"},
}


def setup(app: Any) -> None:
    """Registers the steps of our own."""
    app.connect("doctree-read", _check_descriptions)
    app.connect("build-finished", _copy_mathjax)


def _check_descriptions(app: Any, doctree: nodes.document) -> None:
    """Checks that every picture has a description, for those who do not see it."""
    for picture in doctree.findall(nodes.image):
        # The name of a file, which notebooks have by default, is none.
        if picture.get("alt", "") in picture["uri"]:
            logging.getLogger(__name__).warning("a picture has no description (alt)", location=picture)


def _copy_mathjax(app: Any, error: Exception | None) -> None:
    """Copies the parts of MathJax that the pages need: program, fonts and extensions."""
    if error is None and app.builder.format == "html":
        source = Path(importlib.import_module("sphinx-mathjax-offline").__path__[0]) / "static" / "mathjax"
        for part in ("tex-chtml.js", "output/chtml/fonts/woff-v2", "input/tex/extensions"):
            target = Path(app.outdir) / "_static" / "mathjax" / part
            target.parent.mkdir(parents=True, exist_ok=True)
            copy_asset(source / part, target if (source / part).is_dir() else target.parent)
