"""snowshed: snow that slides off solar panels and down slopes, simulated.

A scene is set value by value and run event after event; the stack below the panel is measured.

Examples
--------
>>> from snowshed import Scene
>>> scene = Scene.preset("lab-50").set("snow.density", 250)
>>> scene.panel.tilt
50.0
"""

import importlib as _importlib
import os
import sys as _sys
from importlib import machinery as _machinery
from importlib.abc import Loader as _Loader
from importlib.abc import MetaPathFinder as _MetaPathFinder
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

# The solver's threads meet twice a step. By default OpenMP's runtime makes the early ones spin for
# a long time, which on a busy machine takes the processor from the thread they wait for. The
# runtime reads this once, when the core is loaded; a setting of the user's own stands.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "2000")

if _TYPE_CHECKING:
    from snowshed._core import InputError, SimulationError
    from snowshed._core import version as __version__
    from snowshed.analysis import photovoltaics as pv
    from snowshed.base.interrupt import Interrupted
    from snowshed.base.notes import SnowshedNote
    from snowshed.base.progress import Progress
    from snowshed.methods.grains.settings import GrainsSettings
    from snowshed.methods.mpm.settings import MpmSettings
    from snowshed.methods.mps.settings import MpsSettings
    from snowshed.methods.slide.settings import SlideSettings
    from snowshed.results.dimension_ratio import dimension_ratio
    from snowshed.results.folder import read_events
    from snowshed.results.reader import Results
    from snowshed.running.run import run, run_events
    from snowshed.running.simulation import Simulation
    from snowshed.scene.components import (
        Area,
        Body,
        Domain,
        Events,
        Ground,
        Layer,
        Motion,
        Obstacle,
        Panel,
        Seeding,
        Slab,
        Snow,
        Terrain,
    )
    from snowshed.scene.loading import Cone, LoadingStage, Sample
    from snowshed.scene.output import Output
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
    "SnowshedNote",
    "StackMeasure",
    "Terrain",
    "__version__",
    "dimension_ratio",
    "level",
    "measure_stack",
    "pv",
    "read_events",
    "run",
    "run_events",
]

#: Where each name comes from. They are imported when they are used: commands start at once, and an
#: interrupt meanwhile meets the command line's own code.
_MODULES = {
    "Area": "snowshed.scene.components",
    "Body": "snowshed.scene.components",
    "Cone": "snowshed.scene.loading",
    "Domain": "snowshed.scene.components",
    "Events": "snowshed.scene.components",
    "Extent": "snowshed.snow.stack.measure",
    "GrainsSettings": "snowshed.methods.grains.settings",
    "Ground": "snowshed.scene.components",
    "InputError": "snowshed._core",
    "Interrupted": "snowshed.base.interrupt",
    "Layer": "snowshed.scene.components",
    "LoadingStage": "snowshed.scene.loading",
    "Motion": "snowshed.scene.components",
    "MpmSettings": "snowshed.methods.mpm.settings",
    "MpsSettings": "snowshed.methods.mps.settings",
    "Obstacle": "snowshed.scene.components",
    "Output": "snowshed.scene.output",
    "Panel": "snowshed.scene.components",
    "Progress": "snowshed.base.progress",
    "ResolvedScene": "snowshed.scene.scene",
    "Results": "snowshed.results.reader",
    "Sample": "snowshed.scene.loading",
    "Scene": "snowshed.scene.scene",
    "Seeding": "snowshed.scene.components",
    "Shape": "snowshed.scene.shape",
    "Simulation": "snowshed.running.simulation",
    "SimulationError": "snowshed._core",
    "Slab": "snowshed.scene.components",
    "SlideSettings": "snowshed.methods.slide.settings",
    "Snow": "snowshed.scene.components",
    "SnowshedNote": "snowshed.base.notes",
    "StackMeasure": "snowshed.snow.stack.measure",
    "Terrain": "snowshed.scene.components",
    "dimension_ratio": "snowshed.results.dimension_ratio",
    "level": "snowshed.snow.stack.measure",
    "measure_stack": "snowshed.snow.stack.measure",
    "read_events": "snowshed.results.folder",
    "run": "snowshed.running.run",
    "run_events": "snowshed.running.run",
}
#: Modules by a shorter name.
_MODULE_NAMES = {"pv": "snowshed.analysis.photovoltaics"}
_FORMER = {"InitialisedScene": "ResolvedScene", "Numerics": "MpmSettings"}


class _ShortNames(_MetaPathFinder, _Loader):
    """Lets modules be imported by their shorter names, as in ``from snowshed.pv import ...``."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> _Any:
        """Return how a shorter name is imported; None for all other names."""
        root, _, short = name.partition(".")
        if root != __name__ or short not in _MODULE_NAMES:
            return None
        return _machinery.ModuleSpec(name, self)

    def create_module(self, spec: _Any) -> _Any:
        """Return the module that a shorter name stands for."""
        module = _importlib.import_module(_MODULE_NAMES[spec.name.partition(".")[2]])
        self._own = module.__spec__
        return module

    def exec_module(self, module: _Any) -> None:
        """Leave the module as it is: it was executed under its own name."""
        module.__spec__ = self._own


_sys.meta_path.append(_ShortNames())


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


if not _TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        if name == "__version__":
            return _importlib.import_module("snowshed._core").version
        if name in _FORMER:
            from snowshed.base.renamed import renamed

            former = {name: _imported(_FORMER[name])}
            return renamed(__name__, former, stacklevel=3)(name)
        if name in _MODULE_NAMES:
            return _importlib.import_module(_MODULE_NAMES[name])
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return _imported(name)

    def _imported(name: str) -> _Any:
        found = getattr(_importlib.import_module(_MODULES[name]), name)
        globals()[name] = found
        return found
