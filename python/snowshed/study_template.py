"""Study files that come with snowshed, with places in braces for what the caller decides."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import resources
from typing import Union

from snowshed.number_words import exact


def filled(package: str, name: str, values: Mapping[str, Union[str, float]]) -> str:
    """Return a study file of a package's folder ``studies``, its places filled.

    Parameters
    ----------
    package
        The package.
    name
        The file, without its ending.
    values
        What stands in ``{key}``: text as it is, numbers so that the same number is read.

    Examples
    --------
    >>> values = {"between": "carry", "friction": 0.8, "dx": 0.01, "seeds": 2}
    >>> "panel.friction = 0.8" in filled("snowshed.regression", "geometry", values)
    True
    """
    file = resources.files(package) / "studies" / f"{name}.toml"
    text = file.read_text(encoding="utf-8")
    for key, value in values.items():
        text = text.replace(f"{{{key}}}", value if isinstance(value, str) else exact(value))
    return text
