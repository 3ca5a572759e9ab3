"""The laboratory's stacks over many seedings, recorded: ``python -m tests.running.laboratory``."""

import datetime
import json
import sys
from pathlib import Path

import numpy as np
from validation.laboratory.lab_stack import run_lab

from snowshed import _core

FILE = Path(__file__).with_name("laboratory_stacks.json")
SETTINGS = {"dimension": 2, "dx": 0.01, "events": 4}
MEASURES = ("height", "length")
#: Seeds of the recorded means; the tests use others.
SEEDS = range(101, 125)
ABOUT = (
    "Mean and standard deviation between seedings of the laboratory's stack after each event, in "
    "m: preset lab-50 in 2D, panel friction 0.3, all else as by default. Made by "
    "python -m tests.running.laboratory; made again where a change of the method is meant to "
    "move them."
)


def stacks(seeds):
    """Height and length after each event, m, for each seed: shape (seeds, events) each."""
    runs = [run_lab({**SETTINGS, "seed": seed}) for seed in seeds]
    return {name: np.array([run.series(name) for run in runs]) for name in MEASURES}


def record():
    results = stacks(SEEDS)
    data = {
        "about": ABOUT,
        "version": _core.version,
        "date": datetime.date.today().isoformat(),
        "settings": SETTINGS,
        "seeds": [SEEDS.start, SEEDS.stop - 1],
        "mean": {name: values.mean(axis=0).round(5).tolist() for name, values in results.items()},
        "deviation": {
            name: values.std(axis=0, ddof=1).round(5).tolist() for name, values in results.items()
        },
    }
    FILE.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(record())
