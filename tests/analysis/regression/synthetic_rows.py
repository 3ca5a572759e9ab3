"""Synthetic rows with the thesis's inputs and similar quartiles: a smooth formula plus noise."""

import numpy as np
import pandas as pd

from snowshed.analysis.regression import stack_rows

HEIGHTS = (1, 1.5, 2, 2.5, 3, 3.5, 4)
LENGTHS = (0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 6, 8, 10)
EVENTS = range(1, 6)


def thesis_inputs():
    """Return the inputs of section 5.2.2: 385 and 225 rows of event, height, length, tilt."""
    at_40 = [(e, h, length, 40) for e in EVENTS for h in HEIGHTS for length in LENGTHS]
    steeper = [
        (e, h, length, tilt)
        for tilt in (50, 60, 70)
        for e in EVENTS
        for h in (2, 3, 4)
        for length in (0.5, 1.5, 2, 4, 8)
    ]
    return np.array(at_40 + steeper, dtype=float)


def smooth_ratio(inputs):
    """Return height over length: logarithmic in the panel's length, linear in its height."""
    event, height, length, tilt = inputs.T
    growth = np.log1p(event) ** 0.8 * (1 + 0.4 * np.log(length + 0.5))
    return 0.056 * growth * (1.35 - 0.13 * height) * (1 - 0.003 * (tilt - 40))


def smooth_length(inputs):
    event, height, length, _ = inputs.T
    return (1 + 0.2 * height) * event**0.3 * length**0.4


def synthetic_rows(inputs=None, noise=0.003, seed=1):
    """Return stacks whose ratio deviates from the formula by noise of this standard deviation."""
    inputs = thesis_inputs() if inputs is None else inputs
    deviations = np.random.default_rng(seed).normal(0, noise, len(inputs))
    ratio = np.maximum(smooth_ratio(inputs) + deviations, 0.005)
    length = smooth_length(inputs)
    return stack_rows(inputs, ratio * length, length)


def few_inputs():
    """Return 96 rows: 3 events, 4 heights, 4 lengths, 2 tilts."""
    return np.array(
        [
            (e, h, length, t)
            for e in (1, 2, 3)
            for h in (1, 2, 3, 4)
            for length in (1, 2, 4, 8)
            for t in (40, 60)
        ],
        dtype=float,
    )


def write_table(rows, file, **columns):
    """Write rows as `snowshed study export` does."""
    event, height, length, tilt = rows.inputs.T
    table = pd.DataFrame(
        {
            "hash": "0123",
            "panel.tilt": tilt,
            "panel.height": height,
            "panel.length": length,
            "seed": 1,
            "event": event.astype(int),
            "height_m": rows.targets["height"],
            "length_m": rows.targets["length"],
            "body_height_m": rows.targets["height"] * 0.9,
            "body_length_m": rows.targets["length"] * 0.8,
            "ended": "rest",
            "error": "",
            "version": "0.1.0",
            "dimension": 2,
            "dx": 0.01,
            **columns,
        }
    )
    table.to_csv(file, index=False)
    return table
