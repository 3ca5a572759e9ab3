"""A slide in a bent gully, with coarser and finer steps, cells and particles."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import TimedEventDriver, relative
from validation.slide.site import Site, maps_of, node_axes, rectangle, slide_drive

WEST, EAST, HALF_WIDTH = -120.0, 900.0, 200.0  # m
STEEP, FLAT_FROM = math.tan(math.radians(35.0)), 750.0  # slope at x = 0; level from here on, m
BEND, WAVE = 40.0, 500.0  # m, amplitude and length of the thalweg's bends
THICKNESS = 1.5  # m
DURATION = 60.0  # s
MIN_THICKNESS = 0.1  # m; thinner snow does not count for area and run-out

DEFAULTS: CaseSettings = {
    "cell": 5.0,
    "time_step": 0.02,
    "layer_thickness": 0.25,
    "friction_law": "voellmy",
    "friction": 0.2,
    "turbulence": 2000.0,
    "mixing_rate": 8.0,
    "stop_ratio": 0.01,
}


def ground(x: Floats, y: Floats) -> Floats:
    """Return the height (m) of a gully with bends, whose floor becomes level and wide."""
    flat = np.clip(x, 0.0, FLAT_FROM)
    fall = STEEP * (np.minimum(x, 0.0) + flat - flat**2 / (2 * FLAT_FROM))
    narrow = 1 - 0.9 * np.clip((x - 500.0) / 250.0, 0.0, 1.0)
    bends = BEND * np.sin(2 * np.pi * np.maximum(x, 0.0) / WAVE)
    side = np.abs(y - bends)
    return np.asarray(narrow * (0.006 * np.minimum(side, 60.0) ** 2 + 0.3 * side) - fall)


class Readings(NamedTuple):
    """Peak speed, m/s; area, m2; run-out, m."""

    speed: float
    area: float
    run_out: float


def _run(settings: CaseSettings) -> tuple[TimedEventDriver, Readings]:
    snow = rectangle(-60.0, -25.0, 0.0, 25.0, THICKNESS)
    site = Site(ground, WEST, -HALF_WIDTH, EAST, HALF_WIDTH, [snow])
    drive = slide_drive(site, settings)
    drive.run_to(DURATION)
    maps = maps_of(drive)
    reached = maps.peak_thickness > MIN_THICKNESS
    last = np.flatnonzero(reached.any(axis=0))[-1]
    return drive, Readings(
        float(np.nanmax(maps.peak_speed)),
        float(reached.sum() * maps.cell**2),
        float(node_axes(maps)[0][last]) - WEST,
    )


@cache
def _reference() -> Readings:
    return _run(DEFAULTS)[1]


def measure(settings: CaseSettings) -> Outcome:
    """Compare a slide with the one of the usual settings."""
    drive, readings = _run(settings)
    pairs = zip(Readings._fields, readings, _reference())
    return drive.outcome([relative(name, value, usual) for name, value, usual in pairs])


def matrix(full: bool) -> list[CaseSettings]:
    """Return longer and shorter steps; if full, also other cells and sizes of particles."""
    changes: list[CaseSettings] = [{"time_step": dt} for dt in (0.1, 0.05)]
    if full:
        changes += [{"time_step": 0.01}]
        changes += [{"cell": cell} for cell in (10.0, 2.5)]
        changes += [{"layer_thickness": layer} for layer in (0.5, 0.125, 0.0625)]
        changes += [{"mixing_rate": rate} for rate in (0.0, 2.0, 4.0, 16.0)]
        changes += [{"columns": "across_flow"}]
    return [{**DEFAULTS, **change} for change in changes]


def _of_steps(name: str, title: str) -> Quantity:
    same = {key: DEFAULTS[key] for key in ("cell", "layer_thickness", "mixing_rate")}
    return Quantity(name, title, limit=0.01, limit_for={**same, "columns": None})


CASE = Case(
    name="slide_gully",
    title="A slide in a bent gully, with other steps, cells and particles",
    source="results may not depend on the time step; other settings show what their choice changes",
    description="""
    A slab 1.5 m thick slides through a gully with two bends onto level ground, with Voellmy's
    friction, without bonds. Peak speed, area (peak thickness above 0.1 m) and run-out are compared
    with those of the usual settings: cells of 5 m, steps of 0.02 s, particles of 0.25 m, mixing at
    8 1/s. Steps from 0.01 to 0.1 s may change speed and run-out by 1 %.
    """,
    quantities=(
        _of_steps("speed", "peak speed"),
        Quantity("area", "area"),
        _of_steps("run_out", "run-out"),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    Cells change more than steps and particles: a gully is only a few cells wide.
    """,
)
