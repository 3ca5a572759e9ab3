"""Stack dimensions from a formula in place of simulations, and synthetic measurements of them.

As in simulations, height grows with every parameter and with the events, and length falls with M
and beta. Otherwise the formula is arbitrary.
"""

import itertools
import json

import numpy as np
import pandas as pd

from snowshed.analysis.calibration.measurements import Measurement
from snowshed.results.folder import WORDS
from snowshed.study.database import MEASURED_TYPES
from snowshed.study.outcome import RunOutcome
from snowshed.study.store import Store

SLOPE, PRESSURE, COHESION = (
    "snow.critical_state_slope",
    "snow.preconsolidation_pressure",
    "snow.cohesion",
)
PARAMETERS = (SLOPE, PRESSURE, COHESION)
LOW = np.array([0.4, 4e3, 0.05])
HIGH = np.array([0.7, 7e3, 0.2])
TILTS, EVENTS, MEASURED_EVENTS = (40.0, 50.0), (1, 2, 3, 4, 5), (1, 3, 5)


def stack(snow, tilt, event):
    """Return height and length, m."""
    slope, pressure, cohesion = (np.asarray(snow, float) - LOW) / (HIGH - LOW)
    height = 0.035 * event**0.75 * (1 + 0.25 * slope + 0.2 * pressure**2 + 0.45 * cohesion)
    height *= 1 + 0.1 * slope * cohesion - 0.004 * (tilt - 40)
    length = 0.2 * event**0.4 * (1 - 0.25 * slope + 0.15 * pressure - 0.2 * cohesion)
    length *= 1 + 0.005 * (tilt - 40)
    return float(height), float(length)


def thesis_triplets():
    return list(itertools.product([0.4, 0.5, 0.6, 0.7], [4e3, 5e3, 6e3, 7e3], [0.05, 0.1, 0.2]))


def study_table(triplets, noise=0.02, seeds=(1, 2), random=0):
    """Return a study's table of stacks; every seed has its own noise (a share of the value)."""
    generator = np.random.default_rng(random)
    rows = []
    for snow, tilt, seed in itertools.product(triplets, TILTS, seeds):
        for event in EVENTS:
            height, length = stack(snow, tilt, event) * (1 + noise * generator.normal(size=2))
            head = 0.12 - 0.01 * event
            stacks = {"height_m": height, "length_m": length, "head_m": head}
            stacks["tail_m"] = head + length
            body = {f"body_{name}": value for name, value in stacks.items()}
            at = {"panel.tilt": tilt, **dict(zip(PARAMETERS, snow)), "seed": seed, "event": event}
            rows.append({"hash": f"{snow}{tilt}{seed}", **at, **stacks, **body})
    return pd.DataFrame(rows)


def measured(snow, uncertainty=0.05, noise=0.02, random=0, quantities=("height", "length")):
    """Return synthetic measurements: stacks with seeding noise and an error of measurement."""
    generator = np.random.default_rng(random)
    measurements = []
    for tilt, event in itertools.product(TILTS, MEASURED_EVENTS):
        dimensions = dict(zip(("height", "length"), stack(snow, tilt, event)))
        for quantity in quantities:
            run = dimensions[quantity] * (1 + noise * generator.normal())
            deviation = uncertainty * dimensions[quantity]
            value = run + deviation * generator.normal()
            measurements.append(
                Measurement(tilt, event, 1, quantity, value, deviation, len(measurements) + 2)
            )
    return measurements


def fill(folder, study, pending=0):
    """Store stacks as results of a study's runs, except for the last `pending` runs."""
    with Store.create(folder) as store:
        store.register(study.name, study.axes, study.runs())
        for number, run in enumerate(study.runs()[: len(study.runs()) - pending]):
            scene = json.loads(run.scene)
            names = ("critical_state_slope", "preconsolidation_pressure", "cohesion")
            snow = tuple(scene["snow"][name] for name in names)
            table = study_table([snow], seeds=(scene["seeding"]["seed"],), random=number)
            table = table[table["panel.tilt"] == scene["panel"]["tilt"]]
            rows = []
            for stacks in table.to_dict("records"):
                row = {name: "rest" if name in WORDS else 1.0 for name in MEASURED_TYPES}
                row.update({name: stacks[name] for name in stacks if name in MEASURED_TYPES})
                rows.append({**row, "event": stacks["event"], "wall_s": 0.1, "steps": 10})
            store.record(RunOutcome(run.hash, "done", rows, {}))


def write_measurements(measurements, file):
    """Write a measurements file with a row for each measured value."""
    names = ["tilt_deg", "event", "round"]
    names += [f"{q}{end}" for q in ("height", "length") for end in ("_m", "_std_m")]
    lines = [",".join(names)]
    for number, measurement in enumerate(measurements, 1):
        cells = dict.fromkeys(names, "")
        cells.update(tilt_deg=measurement.tilt, event=measurement.event, round=number)
        cells.update(
            {
                f"{measurement.quantity}_m": measurement.value,
                f"{measurement.quantity}_std_m": measurement.uncertainty,
            }
        )
        lines.append(",".join(str(cells[name]) for name in names))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
