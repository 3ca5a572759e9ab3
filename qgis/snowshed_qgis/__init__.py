"""A QGIS plugin that runs the program snowshed."""

from __future__ import annotations

from typing import Any


def classFactory(iface: Any) -> Any:
    """Return the plugin; QGIS calls this."""
    from .plugin import SnowshedPlugin

    return SnowshedPlugin()
