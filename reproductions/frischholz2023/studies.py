"""The studies of the thesis's chapters, by their names in the store."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

from reproductions.frischholz2023.deviations import (
    ALL,
    DEVIATIONS,
    THESIS_DX,
    deviating_settings,
    deviations_named,
)
from reproductions.frischholz2023.settings import MEASURED_FRICTION, Settings
from snowshed import Scene
from snowshed.analysis.calibration.grid_study import calibration_study
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.calibration.parameter_grid import COHESION, PRESSURE, SLOPE
from snowshed.analysis.regression.dataset import MODEL_BETWEEN
from snowshed.analysis.regression.geometry import (
    DAMPING_RATE,
    FRICTION,
    GRIDS,
    geometry_study,
)
from snowshed.analysis.sensitivity.designs import sensitivity_study
from snowshed.scene.components import Snow
from snowshed.study import Factor, Study
from snowshed.study.factors import SEED

#: Studies of the laboratory, by dimension.
LABORATORIES = {2: "lab-2d", 3: "lab-3d"}
RELEASE = "lab-30-degrees"
INDEX, FIXATION = "sensitivity-s", "sensitivity-fixation"
GRID, TRUTH = "calibration", "calibration-truth"
PANELS, TILTS = "geometry", "geometry-tilts"
#: The variants of the deviations: none undone, then each, then all.
DEFAULTS, THESIS = "defaults", "thesis"
VARIANTS: Mapping[str, Sequence[str]] = {
    DEFAULTS: (),
    **{deviation.name: (deviation.name,) for deviation in DEVIATIONS.values()},
    THESIS: (ALL,),
}
#: Settings of our own, varied one by one on the same sample. The cell size is a factor on the
#: default.
COARSE_CELLS = 4 / 3
VARIATIONS: Mapping[str, Mapping[str, float]] = {
    "coarse-cells": {"numerics.dx": COARSE_CELLS},
    "half-damping": {"numerics.damping_rate": DAMPING_RATE / 2},
    "double-damping": {"numerics.damping_rate": DAMPING_RATE * 2},
    "short-steps": {"numerics.courant_factor": 0.6},
    "short-steps-damped-each": {"numerics.courant_factor": 0.6, "numerics.flip_ratio": 0.99},
}
PANEL = ("panel.tilt", "panel.height", "panel.length")
#: Seed of the synthetic truth; no run of the grid has it.
TRUTH_SEED = 101
#: Tilts of the laboratory's panel from which snow slid in chapters 2 and 4, degrees.
LAB_TILTS = (40.0, 50.0)
RELEASE_TILT = 30.0
LAB_EVENTS = 5


def lab(settings: Settings) -> list[Study]:
    """Return the laboratory experiment (Table 2.3.1) in 2D and 3D, and at 30 degrees.

    At 30 degrees the slab slides or stays, depending on the friction.

    Examples
    --------
    >>> from reproductions.frischholz2023.settings import QUICK
    >>> [(study.name, len(study.runs())) for study in lab(QUICK)]
    [('lab-2d', 8), ('lab-3d', 8), ('lab-30-degrees', 2)]
    """
    seeds = list(range(1, settings.lab_seeds + 1))
    axes = {"panel.tilt": list(LAB_TILTS), "panel.friction": list(settings.frictions)}
    grown = [
        Study.product(_lab_scene(settings, d), axes, name=LABORATORIES[d], seeds=seeds)
        for d in settings.lab_dimensions
    ]
    scene = _lab_scene(settings, settings.dimension).set("panel.tilt", RELEASE_TILT)
    frictions = {"panel.friction": list(settings.release_frictions)}
    return [*grown, Study.product(scene, frictions, name=RELEASE)]


def index(settings: Settings) -> list[Study]:
    """Return the study of section 3.3."""
    return [_sensitivity("s", INDEX, settings, settings.index_seeds)]


def fixation(settings: Settings) -> list[Study]:
    """Return the study of section 3.4."""
    return [_sensitivity("fixation", FIXATION, settings, settings.fixation_seeds)]


def calibration(settings: Settings) -> list[Study]:
    """Return the grid of chapter 4, and the runs that replace its measurements.

    Examples
    --------
    >>> from reproductions.frischholz2023.settings import FULL, QUICK
    >>> [[len(study.runs()) for study in calibration(settings)] for settings in (QUICK, FULL)]
    [[24, 2], [192, 2]]
    """
    last = [Measurement(tilt, settings.grid_events, 1, "height", 1.0, 1.0) for tilt in LAB_TILTS]
    scene = _scene_with_size(calibration_study(last, seeds=1), settings)
    axes = {
        "panel.tilt": list(LAB_TILTS),
        SLOPE: list(settings.slopes),
        PRESSURE: list(settings.pressures),
        COHESION: list(settings.cohesions),
    }
    seeds = list(range(1, settings.grid_seeds + 1))
    grid = Study.product(scene, axes, name=GRID, seeds=seeds)
    snow = {"snow": Snow.preset("calibrated").to_data()}
    true_scene = _scene_with_size(calibration_study(last, seeds=1), settings).update(snow)
    tilts = {"panel.tilt": list(LAB_TILTS)}
    return [grid, Study.product(true_scene, tilts, name=TRUTH, seeds=[TRUTH_SEED])]


def geometry(settings: Settings) -> list[Study]:
    """Return the panels of chapter 5, and the panels of Table 5.1.1 that the data set lacks."""
    panels = geometry_study(MODEL_BETWEEN)
    scene = _with_choices(panels.scene, settings)
    panels = Study(scene, panels.parts, PANELS, panels.seeds)
    others: dict[str, list[Any]] = {
        "panel.friction": [FRICTION],
        "events.between": [MODEL_BETWEEN],
        "panel.height": [2.0],
        "panel.length": [2.0],
        "panel.tilt": [45.0, 55.0, 65.0],
    }
    return [panels, Study.product(panels.scene, others, name=TILTS)]


def deviations(settings: Settings) -> list[Study]:
    """Return a sample of the panels: with our settings, with each deviation undone, and all undone.

    A deviation that changes only the measuring needs no additional runs.

    Examples
    --------
    >>> from reproductions.frischholz2023.settings import QUICK
    >>> [study.name for study in deviations(QUICK)][:3]
    ['deviations-defaults', 'deviations-slip', 'deviations-damping']
    """
    return [
        _variant(settings, name, names)
        for name, names in VARIANTS.items()
        if name not in DEVIATIONS or DEVIATIONS[name].simulated
    ]


def variations(settings: Settings) -> list[Study]:
    """Return the sample of panels of `deviations`, with our settings varied one by one.

    Examples
    --------
    >>> from reproductions.frischholz2023.settings import QUICK
    >>> [study.name for study in variations(QUICK)][:2]
    ['variations-coarse-cells', 'variations-half-damping']
    """
    studies = []
    for name, varied in VARIATIONS.items():
        ours = _variant(settings, DEFAULTS, ())
        cells = varied.get("numerics.dx", 1.0) * settings.deviation_dx[0]
        scene = ours.scene.update({**varied, "numerics.dx": cells})
        studies.append(Study(scene, ours.parts, study_of(name), ours.seeds))
    return studies


def deviating_panels(names: Sequence[str], *, dx: float = THESIS_DX) -> Study:
    """Return the panels of chapter 5 with deviations undone.

    Parameters
    ----------
    names
        Names of the deviations, or "all".
    dx
        Size of the grid cells, m, unless the deviation ``grid`` is undone.

    Examples
    --------
    >>> deviating_panels(["all"]).name
    'geometry-thesis'
    """
    named = deviations_named(names)
    settings = deviating_settings(5, names)
    between = str(settings.get("events.between", MODEL_BETWEEN))
    others = [item.name for item in named if item.simulated and item.name != between]
    parts = [THESIS] if len(named) == len(DEVIATIONS) else [between, *others]
    return geometry_study(between, dx=dx, settings=settings, name="-".join(["geometry", *parts]))


def study_of(variant: str) -> str:
    """Return the name of the study that has the runs of a variant or a variation."""
    if variant in VARIATIONS:
        return f"variations-{variant}"
    measured_only = variant in DEVIATIONS and not DEVIATIONS[variant].simulated
    return f"deviations-{DEFAULTS if measured_only else variant}"


def sampled_panels(settings: Settings) -> dict[str, list[Any]]:
    """Return the panels for the deviations: every n-th panel of the data set, after sorting.

    The choice depends on the geometry of the panels alone.
    """
    panels = sorted(panel for grid in GRIDS for panel in product(*grid))
    few = [panel for panel in panels if panel[2] <= settings.deviation_max_length]
    chosen = few[min(settings.deviation_panels, len(few)) // 2 :: settings.deviation_panels]
    return {path: list(values) for path, values in zip(PANEL, zip(*chosen))}


def _variant(settings: Settings, name: str, names: Sequence[str]) -> Study:
    study = deviating_panels(names)
    ours, thesis = settings.deviation_dx
    finer = "grid" in names or ALL in names
    scene = study.scene.set("numerics.dx", thesis if finer else ours)
    common = [factor for factor in study.parts[0] if not {*PANEL, SEED} & set(factor.columns)]
    seeds = list(range(1, settings.deviation_seeds + 1))
    panels = Factor(sampled_panels(settings))
    return Study(scene, [[*common, panels]], f"deviations-{name}", seeds)


def _lab_scene(settings: Settings, dimension: int) -> Scene:
    scene = Scene.preset("lab-50").update({"dimension": dimension, "numerics.dx": settings.dx})
    return _with_choices(scene.set("events.count", LAB_EVENTS), settings)


def _sensitivity(method: str, name: str, settings: Settings, seeds: int) -> Study:
    study = sensitivity_study(method, seeds=seeds)
    return Study(_scene_with_size(study, settings), study.parts, name, study.seeds)


def _scene_with_size(study: Study, settings: Settings) -> Scene:
    numerics = {"dimension": settings.dimension, "numerics.dx": settings.dx}
    scene = study.scene.update({**numerics, "panel.friction": MEASURED_FRICTION})
    return _with_choices(scene, settings)


def _with_choices(scene: Scene, settings: Settings) -> Scene:
    """Return the scene with the condition of the panel, and with a scheme and its damping."""
    choices: dict[str, Any] = {"panel.condition": settings.condition}
    if settings.scheme != "thesis":
        choices.update({"numerics.damping_rate": None, "numerics.scheme": settings.scheme})
    return scene.with_(choices)
