"""Sphinx configuration: Markdown pages (MyST), notebooks and the Python API from its docstrings."""

import snowshed

project = "snowshed"
author = copyright = "snowshed contributors"
release = snowshed.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # formulas need no network
    "sphinx_design",  # cards
]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "cache"  # tutorials, again when they change
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_execution_in_temp = True
napoleon_google_docstring = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
html_theme = "furo"
html_title = f"snowshed {release}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
