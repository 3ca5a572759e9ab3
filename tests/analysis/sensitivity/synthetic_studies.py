"""Studies whose stacks follow a formula of the parameters instead of simulations."""

import functools
import itertools
import json

import numpy as np
import pandas as pd

from snowshed.analysis.sensitivity import StudyRuns, sensitivity_study
from snowshed.analysis.sensitivity.sampling import SAMPLERS
from snowshed.study.table import value_at

M, P0, BETA, XI, E = (
    "snow.critical_state_slope",
    "snow.preconsolidation_pressure",
    "snow.cohesion",
    "snow.hardening_factor",
    "snow.youngs_modulus",
)
SEED = "seeding.seed"
REFERENCE = {M: 0.5, P0: 5e3, BETA: 0.1, XI: 0.1, E: 1e6}


def study_runs(points, height, length=lambda snow, event: 0.3, events=(1, 2, 3)):
    """Return a study with these points; its stacks are functions of point and event."""
    points = pd.DataFrame(points).copy()
    if SEED not in points:
        points[SEED] = 1
    axes = [name for name in points if name not in ("hash", SEED)]
    if points[SEED].nunique() > 1 and not points.duplicated(SEED).any():
        axes = [name for name in points if name != "hash"]
    points.insert(0, "hash", [f"run{number}" for number in range(len(points))])
    rows = [
        {**point, "event": event, "height": height(point, event), "length": length(point, event)}
        for point, event in itertools.product(points.to_dict("records"), events)
    ]
    return StudyRuns("synthetic", axes, points, pd.DataFrame(rows))


def designed_runs(method, height, length=lambda snow, event: 0.3, events=(1, 2, 3), **options):
    """Return the study that a method designs, with synthetic stacks and its own order of axes."""
    axes, points = designed_points(method, **options)
    study = study_runs(points, height, length, events)
    return StudyRuns(study.name, axes, study.points, study.rows)


@functools.cache
def designed_points(method, **options):
    if method in SAMPLERS:
        points = pd.DataFrame(SAMPLERS[method](options["samples"]))
        return tuple(points), points
    study = sensitivity_study(method, **options)
    scenes = [json.loads(run.scene) for run in study.runs()]
    paths = [*study.axes, SEED]
    return tuple(study.axes), pd.DataFrame(
        {path: [value_at(scene, path) for scene in scenes] for path in paths}
    )


def noisy(function, noise, random=0):
    """Return a function whose values get a random relative error in every call."""
    generator = np.random.default_rng(random)
    return lambda snow, event: function(snow, event) * (1 + noise * generator.normal())
