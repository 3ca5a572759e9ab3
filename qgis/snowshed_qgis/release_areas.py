"""The algorithm "Candidate release areas"."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterVectorDestination,
)

from .algorithm import FURTHER, PROGRAM, SnowshedAlgorithm
from .command_lines import release_areas_command


class ReleaseAreasAlgorithm(SnowshedAlgorithm):
    """Finds candidate release areas, which the slide takes as its release."""

    NAME, TITLE = "release_areas", "Candidate release areas"
    HELP = (
        "Finds the parts of the terrain whose shape allows the release of slabs (snowshed "
        "release-areas). They are candidates, not a hazard assessment: the rules know neither snow "
        "nor wind. Delete those that you do not want, and use the others as the release areas of a "
        "slide."
    )

    def initAlgorithm(self, configuration: Any = None) -> None:
        """Declare the parameters."""
        self.addParameter(QgsProcessingParameterRasterLayer("TERRAIN", "Terrain: elevations"))
        self.addParameter(
            QgsProcessingParameterFeatureSource(
                "FOREST", "Forest", [QgsProcessing.TypeVectorPolygon], optional=True
            )
        )
        self.add_number("MIN_SLOPE", "Smallest slope (degrees)", 28.0, highest=90.0)
        self.add_number("MAX_SLOPE", "Largest slope (degrees)", 60.0, highest=90.0)
        self.add_number("MIN_AREA", "Smallest area (m2)", 500.0)
        self.add_number("MAX_GAP", "Largest gap to fill (m2)", 0.0)
        self.add_number("SECTORS", "Sectors of the compass", 8, highest=72, whole=True)
        self.add_number("THICKNESS", "Thickness of the snow (m)")
        self.add_program()
        self.addParameter(QgsProcessingParameterVectorDestination("OUTPUT", "Candidates"))

    def processAlgorithm(self, parameters: Any, context: Any, feedback: Any) -> dict[str, Any]:
        """Find the candidates."""
        file = self.parameterAsOutputLayer(parameters, "OUTPUT", context)
        command = release_areas_command(
            self.terrain(parameters, "TERRAIN", context),
            file,
            slopes=(
                self.parameterAsDouble(parameters, "MIN_SLOPE", context),
                self.parameterAsDouble(parameters, "MAX_SLOPE", context),
            ),
            smallest=self.parameterAsDouble(parameters, "MIN_AREA", context),
            gap=self.parameterAsDouble(parameters, "MAX_GAP", context),
            sectors=self.parameterAsInt(parameters, "SECTORS", context),
            thickness=self.number(parameters, "THICKNESS", context),
            forest=self.polygons(parameters, "FOREST", context, feedback),
            further=self.parameterAsString(parameters, FURTHER, context),
            program=self.parameterAsString(parameters, PROGRAM, context),
        )
        self.run_command(command, feedback)
        return {"OUTPUT": file}
