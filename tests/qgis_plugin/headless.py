"""Runs both algorithms of the plugin in QGIS without a window; prints facts as JSON.

Arguments: the folder of the plugin, a terrain, an empty folder for results, the program snowshed.
"""

import json
import sys
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
    QgsRasterLayer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

plugins, terrain, folder, program = sys.argv[1], sys.argv[2], Path(sys.argv[3]), sys.argv[4]
application = QgsApplication([], False)
application.initQgis()
sys.path.insert(0, plugins)
import snowshed_qgis  # noqa: E402

plugin = snowshed_qgis.classFactory(None)
plugin.initProcessing()
registry = QgsApplication.processingRegistry()
facts = {"algorithms": sorted(a.id() for a in registry.providerById("snowshed").algorithms())}


def run(name, parameters):
    """Run an algorithm; return its outputs, the loaded layers and the texts."""
    context, feedback = QgsProcessingContext(), QgsProcessingFeedback()
    context.setProject(QgsProject.instance())
    algorithm = registry.createAlgorithmById(f"snowshed:{name}")
    outputs, done = algorithm.run({**parameters, "PROGRAM": program}, context, feedback)
    store = context.temporaryLayerStore()
    layers = [store.mapLayer(key) for key in context.layersToLoadOnCompletion()]
    context.setProject(None)
    return outputs, [store.takeMapLayer(layer) for layer in layers if layer], feedback, done


areas = str(folder / "areas.gpkg")
outputs, _, feedback, done = run(
    "release_areas",
    {"TERRAIN": terrain, "THICKNESS": 0.5, "MIN_SLOPE": 34.0, "OUTPUT": areas},
)
facts["release_areas"] = [done, QgsVectorLayer(areas, "areas", "ogr").featureCount()]
outputs, layers, feedback, done = run(
    "slide",
    {
        "TERRAIN": terrain, "RELEASE": areas, "FURTHER": "--max-time 8",
        "OUTPUT": str(folder / "slide"),
    },
)  # fmt: skip
facts["slide"] = [done, feedback.progress()]
facts["layers"] = {
    layer.name(): [
        layer.crs().authid(),
        [
            [item.value, item.color.name(), item.label]
            for item in layer.renderer().shader().rasterShaderFunction().colorRampItemList()
        ],
    ]
    for layer in layers
}
_, _, feedback, done = run("slide", {"TERRAIN": terrain, "RELEASE": areas, "OUTPUT": str(folder)})
facts["refused"] = [done, "not empty" in feedback.textLog()]

ground = QgsRasterLayer(terrain, "terrain")
outlines = QgsVectorLayer(areas, "areas", "ogr")
outlines.renderer().symbol().setColor(QColor(31, 78, 121, 60))
for layer in layers:
    settings = QgsMapSettings()
    settings.setLayers([layer, outlines, ground])
    settings.setDestinationCrs(ground.crs())
    settings.setExtent(ground.extent())
    settings.setOutputSize(QSize(900, 560))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    job.renderedImage().save(str(folder / f"{layer.name().split(' (')[0]}.png"))
print("FACTS " + json.dumps(facts))
plugin.unload()
sys.stdout.flush()
import os  # noqa: E402

os._exit(0)  # QGIS may crash while Python takes its objects apart
