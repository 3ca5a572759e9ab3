"""The algorithm "Snow slide"."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterRasterLayer,
    QgsRasterLayer,
)

from .algorithm import FURTHER, PROGRAM, SnowshedAlgorithm
from .command_lines import MAPS, slide_command

STYLES = Path(__file__).with_name("styles")


class SlideAlgorithm(SnowshedAlgorithm):
    """Runs a slide, and loads its maps."""

    NAME, TITLE = "slide", "Snow slide"
    HELP = (
        "Runs a small snow slide (snowshed slide) and loads the maps of its largest thickness, "
        "speed and pressure. The report slide.html is in the results folder; it says when the "
        "results are valid. The terrain and the release areas need the same coordinate system in "
        "metres."
    )

    def initAlgorithm(self, configuration: Any = None) -> None:
        """Declare the parameters."""
        polygons = [QgsProcessing.TypeVectorPolygon]
        self.addParameter(QgsProcessingParameterRasterLayer("TERRAIN", "Terrain: elevations"))
        self.addParameter(QgsProcessingParameterFeatureSource("RELEASE", "Release areas", polygons))
        self.addParameter(
            QgsProcessingParameterFeatureSource("RESISTANCE", "Forest", polygons, optional=True)
        )
        self.add_number("THICKNESS", "Thickness of the snow (m), unless the polygons have it")
        self.add_number("FRICTION", "Friction mu")
        self.add_number("TURBULENCE", "Turbulence xi (m/s2)")
        self.add_program()
        self.addParameter(QgsProcessingParameterFolderDestination("OUTPUT", "Results folder"))

    def processAlgorithm(
        self, parameters: Any, context: QgsProcessingContext, feedback: Any
    ) -> dict[str, Any]:
        """Run the slide in a new folder."""
        folder = Path(self.parameterAsString(parameters, "OUTPUT", context))
        if folder.is_dir() and any(folder.iterdir()):
            raise QgsProcessingException(f"{folder}: not empty; choose a new results folder")
        command = slide_command(
            self.terrain(parameters, "TERRAIN", context),
            self.polygons(parameters, "RELEASE", context, feedback),
            str(folder),
            thickness=self.number(parameters, "THICKNESS", context),
            friction=self.number(parameters, "FRICTION", context),
            turbulence=self.number(parameters, "TURBULENCE", context),
            resistance=self.polygons(parameters, "RESISTANCE", context, feedback),
            further=self.parameterAsString(parameters, FURTHER, context),
            program=self.parameterAsString(parameters, PROGRAM, context),
        )
        self.run_command(command, feedback)
        for name, style, title in MAPS:
            _load(folder / name, style, title, context)
        return {"OUTPUT": str(folder)}


def _load(file: Path, style: str, title: str, context: QgsProcessingContext) -> None:
    """Load a map with its style into the project when the algorithm ends."""
    layer = QgsRasterLayer(str(file), title)
    if not layer.isValid():
        raise QgsProcessingException(f"{file}: cannot be loaded")
    layer.loadNamedStyle(str(STYLES / style))
    context.temporaryLayerStore().addMapLayer(layer)
    details = QgsProcessingContext.LayerDetails(title, context.project(), title)
    context.addLayerToLoadOnCompletion(layer.id(), details)
