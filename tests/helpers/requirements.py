"""The requirements of snowshed and its extras in pyproject.toml, and their modules."""

import re
import sys

from helpers.paths import ROOT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


#: The module of each required package except NumPy.
MODULE_BY_PACKAGE = {
    "allpairspy": "allpairspy",
    "arviz": "arviz",
    "click": "click",
    "corner": "corner",
    "dask": "dask",
    "distributed": "distributed",
    "edt": "edt",
    "emcee": "emcee",
    "ipywidgets": "ipywidgets",
    "jinja2": "jinja2",
    "imageio-ffmpeg": "imageio_ffmpeg",
    "lazy-loader": "lazy_loader",
    "lupa": "lupa",
    "matplotlib": "matplotlib",
    "pandas": "pandas",
    "pillow": "PIL",
    "pvlib": "pvlib",
    "openpyxl": "openpyxl",
    "pyarrow": "pyarrow",
    "pyogrio": "pyogrio",
    "rasterio": "rasterio",
    "rich": "rich",
    "SALib": "SALib",
    "scikit-image": "skimage",
    "scikit-learn": "sklearn",
    "scipy": "scipy",
    "shapely": "shapely",
    "threadpoolctl": "threadpoolctl",
    "tifffile": "tifffile",
    "tomli": "tomli",
    "tqdm": "tqdm",
    "xarray": "xarray",
}


#: Extras whose libraries the compiled core opens; Python imports nothing of them.
OF_THE_CORE = {"gpu"}


def required() -> tuple[set[str], dict[str, set[str]]]:
    """Return the required packages of snowshed and of each extra of Python modules.

    Extras that combine others are left out, and so are required packages whose version an extra
    narrows.
    """
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    always = {_name(requirement) for requirement in project["dependencies"]}
    extras = {
        extra: {_name(requirement) for requirement in listed} - always
        for extra, listed in project["optional-dependencies"].items()
        if extra not in OF_THE_CORE
        and not any(requirement.startswith("snowshed[") for requirement in listed)
    }
    return always, extras


def _name(requirement: str) -> str:
    return re.match(r"[\w-]+", requirement)[0]
