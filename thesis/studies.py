"""The studies of the thesis's chapters, by their names in the store."""

from __future__ import annotations

from typing import Any

from snowshed import Scene
from snowshed.analysis.calibration.design import calibration_study
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.regression.dataset import MODEL_BETWEEN
from snowshed.analysis.regression.geometry import FRICTION, geometry_study
from snowshed.analysis.sensitivity.designs import sensitivity_study
from snowshed.scene.components import Snow
from snowshed.scene.thesis_tables import (
    COHESION,
    LABORATORY_EVENTS,
    LABORATORY_TILTS,
    PRESSURE,
    SLOPE,
)
from snowshed.study import Study
from thesis.size import MEASURED_FRICTION, Size

LAB_2D, LAB_3D, RELEASE = "lab-2d", "lab-3d", "lab-30-degrees"
INDEX, FIXATION = "sensitivity-s", "sensitivity-fixation"
GRID, TRUTH = "calibration", "calibration-truth"
PANELS, TILTS = "geometry", "geometry-tilts"
#: Seed of the synthetic truth: one that no run of the grid has.
TRUTH_SEED = 101
LAB_TILTS = LABORATORY_TILTS
RELEASE_TILT = 30.0
LAB_EVENTS = LABORATORY_EVENTS


def lab(size: Size) -> list[Study]:
    """Return the laboratory experiment (Table 2.3.1) in 2D and 3D, and at 30 degrees.

    At 30 degrees the slab slides or stays, depending on the friction.

    Examples
    --------
    >>> from thesis.size import QUICK
    >>> [(study.name, len(study.runs())) for study in lab(QUICK)]
    [('lab-2d', 8), ('lab-3d', 8), ('lab-30-degrees', 2)]
    """
    seeds = list(range(1, size.lab_seeds + 1))
    axes = {"panel.tilt": list(LAB_TILTS), "panel.friction": list(size.frictions)}
    grown = [
        Study.product(_lab_scene(size, dimension), axes, name=name, seeds=seeds)
        for name, dimension in ((LAB_2D, 2), (LAB_3D, 3))
    ]
    scene = _lab_scene(size, size.dimension).set("panel.tilt", RELEASE_TILT)
    frictions = {"panel.friction": list(size.release_frictions)}
    return [*grown, Study.product(scene, frictions, name=RELEASE)]


def index(size: Size) -> list[Study]:
    """Return the study of section 3.3."""
    return [_sensitivity("s", INDEX, size, size.index_seeds)]


def fixation(size: Size) -> list[Study]:
    """Return the study of section 3.4."""
    return [_sensitivity("fixation", FIXATION, size, size.fixation_seeds)]


def calibration(size: Size) -> list[Study]:
    """Return the grid of chapter 4, and the runs that stand for its measurements.

    Examples
    --------
    >>> from thesis.size import FULL, QUICK
    >>> [[len(study.runs()) for study in calibration(size)] for size in (QUICK, FULL)]
    [[24, 2], [192, 2]]
    """
    last = [Measurement(tilt, size.grid_events, 1, "height", 1.0, 1.0) for tilt in LAB_TILTS]
    scene = _resized(calibration_study(last, seeds=1), size)
    axes = {
        "panel.tilt": list(LAB_TILTS),
        SLOPE: list(size.slopes),
        PRESSURE: list(size.pressures),
        COHESION: list(size.cohesions),
    }
    seeds = list(range(1, size.grid_seeds + 1))
    grid = Study.product(scene, axes, name=GRID, seeds=seeds)
    snow = {"snow": Snow.preset("calibrated").to_data()}
    known = _resized(calibration_study(last, seeds=1), size).update(snow)
    tilts = {"panel.tilt": list(LAB_TILTS)}
    return [grid, Study.product(known, tilts, name=TRUTH, seeds=[TRUTH_SEED])]


def geometry(size: Size) -> list[Study]:
    """Return the panels of chapter 5, and those that Table 5.1.1 has besides the data set."""
    panels = geometry_study(MODEL_BETWEEN)
    scene = panels.scene.set("panel.condition", size.condition)
    panels = Study(scene, panels.parts, PANELS, panels.seeds)
    others: dict[str, list[Any]] = {
        "panel.friction": [FRICTION],
        "events.between": [MODEL_BETWEEN],
        "panel.height": [2.0],
        "panel.length": [2.0],
        "panel.tilt": [45.0, 55.0, 65.0],
    }
    return [panels, Study.product(panels.scene, others, name=TILTS)]


def _lab_scene(size: Size, dimension: int) -> Scene:
    scene = Scene.preset("lab-50").update({"dimension": dimension, "numerics.dx": size.dx})
    return scene.update({"events.count": LAB_EVENTS, "panel.condition": size.condition})


def _sensitivity(method: str, name: str, size: Size, seeds: int) -> Study:
    study = sensitivity_study(method, seeds=seeds)
    return Study(_resized(study, size), study.parts, name, study.seeds)


def _resized(study: Study, size: Size) -> Scene:
    settings = {"dimension": size.dimension, "numerics.dx": size.dx}
    panel = {"panel.friction": MEASURED_FRICTION, "panel.condition": size.condition}
    return study.scene.update({**settings, **panel})
