"""Study files that come with snowshed, with places in braces for what the caller decides."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import resources


def filled(package: str, name: str, values: Mapping[str, str]) -> str:
    """Return a study file of a package's folder ``studies``, its places filled.

    Parameters
    ----------
    package
        The package.
    name
        The file, without its ending.
    values
        What stands in ``{key}``, as TOML.

    Examples
    --------
    >>> study = filled("snowshed.analysis.regression", "geometry", {"friction": "0.8"})
    >>> "panel.friction = 0.8" in study
    True
    """
    file = resources.files(package) / "studies" / f"{name}.toml"
    text = file.read_text(encoding="utf-8")
    for key, value in values.items():
        text = text.replace(f"{{{key}}}", value)
    return text
