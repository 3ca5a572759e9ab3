"""snowshed: snow that slides off solar panels and down slopes, simulated.

A scene is set value by value and run event after event; the stack below the panel is measured.

Examples
--------
>>> scene = Scene.preset("lab-50").set("snow.density", 250)
>>> scene.panel.tilt
50.0
"""

import os
from typing import TYPE_CHECKING as _TYPE_CHECKING

# The solver's threads meet twice a step. By default OpenMP's runtime makes the early ones spin for
# a long time, which on a busy machine takes the processor from the thread they wait for. The
# runtime reads this once, when the core is loaded; a setting of the user's own stands.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "2000")

from snowshed._core import InputError, SimulationError
from snowshed._core import version as __version__
from snowshed.analysis.dimension_ratio import dimension_ratio
from snowshed.io.renamed import renamed as _renamed
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.methods.mpm import MpmSettings
from snowshed.methods.mps import MpsSettings
from snowshed.methods.slide import SlideSettings
from snowshed.run.events import run_events
from snowshed.run.interrupt import Interrupted
from snowshed.run.progress import Progress
from snowshed.run.results import read_events
from snowshed.run.results_reader import Results
from snowshed.run.simulation import Simulation
from snowshed.scene.components import (
    Area,
    Body,
    Domain,
    Events,
    Ground,
    Layer,
    Motion,
    Obstacle,
    Output,
    Panel,
    Seeding,
    Slab,
    Snow,
    Terrain,
)
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.scene.shape import Shape
from snowshed.snow.stack.measure import Extent, StackMeasure, level, measure_stack

__all__ = [
    "Area",
    "Body",
    "Cone",
    "Domain",
    "Events",
    "Extent",
    "GrainsSettings",
    "Ground",
    "InputError",
    "Interrupted",
    "Layer",
    "LoadingStage",
    "Motion",
    "MpmSettings",
    "MpsSettings",
    "Obstacle",
    "Output",
    "Panel",
    "Progress",
    "ResolvedScene",
    "Results",
    "Sample",
    "Scene",
    "Seeding",
    "Shape",
    "Simulation",
    "SimulationError",
    "Slab",
    "SlideSettings",
    "Snow",
    "StackMeasure",
    "Terrain",
    "__version__",
    "dimension_ratio",
    "level",
    "measure_stack",
    "read_events",
    "run_events",
]

if not _TYPE_CHECKING:
    __getattr__ = _renamed(__name__, {"InitialisedScene": ResolvedScene, "Numerics": MpmSettings})
