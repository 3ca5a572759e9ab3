"""The plugin, and its provider of algorithms."""

from __future__ import annotations

from qgis.core import QgsApplication, QgsProcessingProvider

from .release_areas import ReleaseAreasAlgorithm
from .slide import SlideAlgorithm


class SnowshedProvider(QgsProcessingProvider):
    """The group of snowshed in the Processing toolbox."""

    def id(self) -> str:
        """Return the name in identifiers such as "snowshed:slide"."""
        return "snowshed"

    def name(self) -> str:
        """Return the name that people read."""
        return "snowshed"

    def loadAlgorithms(self) -> None:
        """Add the algorithms."""
        for algorithm in (SlideAlgorithm(), ReleaseAreasAlgorithm()):
            self.addAlgorithm(algorithm)


class SnowshedPlugin:
    """Adds the provider while the plugin is active."""

    def __init__(self) -> None:
        self.provider = SnowshedProvider()

    def initProcessing(self) -> None:
        """Add the provider; qgis_process calls this without a window."""
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self) -> None:
        """Add the provider; QGIS calls this."""
        self.initProcessing()

    def unload(self) -> None:
        """Remove the provider."""
        QgsApplication.processingRegistry().removeProvider(self.provider)
