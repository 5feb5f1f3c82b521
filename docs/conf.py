"""The manual as a site: one for the command line, Rust and Python."""

import os

import snapload

project = "snapload"
author = "The snapload developers"
copyright = author
release = version = snapload.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
if "READTHEDOCS" in os.environ:
    # Types of other libraries lead to their manuals, where these can be asked for.
    extensions.append("sphinx.ext.intersphinx")
    intersphinx_mapping = {
        "python": ("https://docs.python.org/3", None),
        "numpy": ("https://numpy.org/doc/stable", None),
        "matplotlib": ("https://matplotlib.org/stable", None),
        "pandas": ("https://pandas.pydata.org/docs", None),
        "xarray": ("https://docs.xarray.dev/en/stable", None),
    }
exclude_patterns = ["README.md", "_build"]
# Everything that is wrong is told, and the tests make an error of it.
nitpicky = True
nitpick_ignore_regex = [("py:.*", r"^(?!snapload\.(?!_engine)).*")]

myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]

# The notebooks are run when the site is built, so what they show is what the package says.
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
