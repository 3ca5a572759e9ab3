"""Sphinx configuration: Markdown pages (MyST) and the Python API from its docstrings."""

import snowshed

project = "snowshed"
author = copyright = "snowshed contributors"
release = snowshed.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
napoleon_google_docstring = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
html_theme = "furo"
html_title = f"snowshed {release}"
