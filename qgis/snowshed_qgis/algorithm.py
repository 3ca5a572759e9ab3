"""The base of both algorithms: their names, the path of the program, the files of layers."""

from __future__ import annotations

from typing import Any, Optional

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from .command_lines import Polygons
from .process import ProgramError, run_program

PROGRAM, FURTHER = "PROGRAM", "FURTHER"
FORMATS = ["gpkg", "shp", "geojson"]


class SnowshedAlgorithm(QgsProcessingAlgorithm):
    """An algorithm that runs the program snowshed.

    Subclasses give `NAME`, `TITLE` and `HELP`.
    """

    NAME, TITLE, HELP = "", "", ""

    def name(self) -> str:
        """Return the name in identifiers."""
        return self.NAME

    def displayName(self) -> str:
        """Return the name that people read."""
        return self.TITLE

    def shortHelpString(self) -> str:
        """Return the help beside the dialog."""
        return self.HELP

    def createInstance(self) -> SnowshedAlgorithm:
        """Return another object of the same algorithm."""
        return type(self)()

    def add_number(
        self,
        name: str,
        title: str,
        default: Optional[float] = None,
        *,
        highest: float = 1e9,
        whole: bool = False,
    ) -> None:
        """Add a number from 0; without a default it is optional."""
        kinds = QgsProcessingParameterNumber
        self.addParameter(
            kinds(
                name,
                title,
                kinds.Integer if whole else kinds.Double,
                default,
                default is None,
                0.0,
                highest,
            )
        )

    def add_program(self) -> None:
        """Add the advanced parameters: further options, and the program."""
        for parameter in (
            QgsProcessingParameterString(FURTHER, "Further options", "", optional=True),
            QgsProcessingParameterString(PROGRAM, "Program", "snowshed"),
        ):
            parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
            self.addParameter(parameter)

    def number(self, parameters: Any, name: str, context: Any) -> Optional[float]:
        """Return an optional number."""
        if parameters.get(name) is None:
            return None
        return self.parameterAsDouble(parameters, name, context)

    def terrain(self, parameters: Any, name: str, context: Any) -> str:
        """Return the file of a raster layer."""
        return self.parameterAsRasterLayer(parameters, name, context).source()

    def polygons(self, parameters: Any, name: str, context: Any, feedback: Any) -> Any:
        """Return the file of an optional vector layer; other formats are converted."""
        if not parameters.get(name):
            return None
        file, layer = self.parameterAsCompatibleSourceLayerPathAndLayerName(
            parameters, name, context, FORMATS, "gpkg", feedback
        )
        return Polygons(file, layer if file.lower().endswith(".gpkg") else "")

    def run_command(self, command: list[str], feedback: Any) -> None:
        """Run a command line; its error ends the algorithm."""
        try:
            run_program(command, feedback)
        except ProgramError as error:
            raise QgsProcessingException(str(error)) from None
