"""Stacks from closed formulas instead of simulations, in the stores of a reproduction."""

import json
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from reproductions.common.report import write_report
from reproductions.frischholz2023.publication import REPRODUCTION
from reproductions.frischholz2023.settings import QUICK

from snowshed.analysis.regression.folds import CrossValidation
from snowshed.results.folder import WORDS
from snowshed.snow.stack.trimming import TRIMMINGS
from snowshed.study.database import MEASURED_TYPES
from snowshed.study.outcome import RunOutcome
from snowshed.study.store import Store

#: Fewer values and folds than in the quick reproduction, and two seedings.
TINY = replace(
    QUICK,
    fixation_seeds=2,
    grid_seeds=2,
    grid_events=2,
    slopes=(0.5, 0.7),
    pressures=(4e3, 7e3),
    cohesions=(0.1, 0.2),
    steps=100,
    folds=CrossValidation(rounds=1, folds=2, inner_folds=2),
)
#: The same, with panels to simulate instead of the rows of the package.
TINY_WITH_PANELS = replace(TINY, simulates_panels=True)


@contextmanager
def few_fits(*, figures=False):
    """Let regressions choose among few hyper-parameters and draw no figures."""
    from snowshed.analysis.regression import grid_kinds, pipeline

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(grid_kinds, "EPSILON", (1e-2, 1e-1))
        patch.setattr(grid_kinds, "C", (1.0, 1e2))
        patch.setattr(grid_kinds, "GAMMA", (1e-2, 1e-1))
        if not figures:
            patch.setattr(pipeline._Output, "_draw", lambda *_: None)
        yield


def report(computation):
    """Write the report of a computation of the quick size."""
    return write_report(
        REPRODUCTION, REPRODUCTION.size("quick"), computation.folder.path, computation
    )


def stack(scene, event):
    """Height, length and head of a scene's stack, m, as the thesis describes them."""
    snow, panel = scene["snow"], scene["panel"]
    noise = 1 + 0.002 * np.sin(97.0 * scene["seeding"]["seed"] + 13.0 * event)
    height = 0.05 * event**0.75 * (1 + 2 * (snow["cohesion"] - 0.1))
    height *= 1 + 0.2 * (snow["critical_state_slope"] - 0.5)
    height *= 1 + 2e-5 * (snow["preconsolidation_pressure"] - 5e3)
    height *= (2 / 3 if scene["dimension"] == 3 else 1) * (1 - 0.05 * (panel["height"] - 1))
    length = 0.2 * panel["length"] ** 0.2 * (2 - 0.6**event) * (1.1 - snow["cohesion"])
    length *= 1.1 - 0.2 * snow["critical_state_slope"]
    length *= 1 + 1e-6 * snow["preconsolidation_pressure"]
    head = 0.2 - 0.02 * event + 0.002 * (panel["tilt"] - 40)
    return height * noise, length * noise, head


def fill(computation, stages=None, *, fail_one=False):
    """Put made-up stacks into the store, for some stages or all; the last run may have failed."""
    chosen = [computation.study_stages[name] for name in stages or computation.study_stages]
    studies = [study for stage in chosen for study in stage._register_studies()]
    with Store.open(computation.folder.runs) as store:
        runs = {run.hash: run for study in studies for run in store.runs(study)}
        pending = [run for run in runs.values() if run.status == "pending"]
        for run in pending:
            if fail_one and run is pending[-1]:
                store.record(RunOutcome(run.hash, "failed", [], {}, "made up"))
            else:
                store.record(RunOutcome(run.hash, "done", _events(json.loads(run.scene)), {}))


def _events(scene):
    stays = scene["panel"]["friction"] > np.tan(np.radians(scene["panel"]["tilt"]))
    rows = []
    for event in range(1, scene["events"]["count"] + 1):
        height, length, head = stack(scene, event)
        row = {name: "rest" if name in WORDS else 1.0 for name in MEASURED_TYPES}
        row.update(event=event, wall_s=0.1, steps=10, mass_kg=float(not stays))
        row.update(on_panel_kg=float(stays))
        row.update(height_m=height, length_m=length, head_m=head, tail_m=head + length)
        for name in TRIMMINGS:
            row.update({f"{name}_height_m": height, f"{name}_length_m": length})
        rows.append(row)
    return rows


def geometry_table(file):
    """A table of panels whose H/L is a logarithm of the length and falls with the height."""
    rows = []
    for tilt in (40.0, 50.0):
        for height in (1.0, 2.0, 3.0):
            for length in (1.0, 2.0, 4.0, 8.0):
                for event in (1, 2, 3):
                    ratio = 0.1 * event**0.5 * (1 + 0.3 * np.log(length)) * (1.2 - 0.1 * height)
                    ratio *= 1 + 0.01 * np.sin(height * 7 + length * 3 + tilt)
                    rows.append((tilt, height, length, event, ratio * height, height))
    names = ["panel.tilt", "panel.height", "panel.length", "event", "height_m", "length_m"]
    settings = {"panel.friction": 0.8, "events.between": "reseed", "dx": 0.02, "seed": 1}
    pd.DataFrame(rows, columns=names).assign(**settings).to_csv(file, index=False)
    return file
