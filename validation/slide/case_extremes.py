"""Slides at the extremes of ground, thickness, steps, bonds and friction, with sound results."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.slide.site import Height, Site, rectangle, slide_drive

SLOPE = math.tan(math.radians(38.0))
STEPS = 300
CASE_SETTINGS = frozenset({"ground", "thickness", "steps_to_take"})

GROUNDS: Mapping[str, Height] = {
    "slope": lambda x, y: -SLOPE * x,
    "flat": lambda x, y: 0.0 * x,
    "cliff": lambda x, y: np.where(x < 20.0, 100.0 - SLOPE * x, -SLOPE * x),
    "steps": lambda x, y: -SLOPE * 8.0 * np.floor(x / 8.0),
    "pit": lambda x, y: np.where(np.hypot(x - 24.0, y) < 8.0, -100.0, -SLOPE * x),
    "gully": lambda x, y: -SLOPE * x - 6.0 * (np.abs(y) < 1.0),
    "ridge": lambda x, y: -np.abs(x) * 3.0,
}

DEFAULTS: CaseSettings = {
    "ground": "slope",
    "thickness": 0.5,
    "cell": 2.0,
    "time_step": 0.01,
    "friction_law": "voellmy",
    "mixing_rate": 8.0,
    "bonds": True,
}
#: Variations of the settings on the slope.
EXTREMES: tuple[CaseSettings, ...] = (
    {"time_step": 1e-5},
    {"time_step": 1.0, "bonds": False},
    {"bond_modulus": 0.0},
    {"bond_modulus": 1e7},
    {"max_strain": 1e-6},
    {"max_strain": 10.0},
    {"turbulence": 1e-3},
    {"turbulence": 1e6},
    {"friction": 0.0},
    {"friction": 2.0},
    {"mixing_rate": 0.0},
    {"mixing_rate": 1000.0},
    {"layer_thickness": 0.01},
    {"layer_thickness": 100.0},
    {"density": 1000.0},
)


def measure(settings: CaseSettings) -> Outcome:
    """Take steps, and measure the values that are not finite, the mass error and the creep."""
    height = GROUNDS[str(settings["ground"])]
    settings = {"layer_thickness": float(settings["thickness"]) / 2, **settings}
    snow = rectangle(-12.3, -12.3, 12.3, 12.3, float(settings["thickness"]))
    drive = slide_drive(Site(height, -30.0, -30.0, 60.0, 30.0, [snow]), settings, CASE_SETTINGS)
    released = drive.masses.sum()
    while drive.core.total_steps < int(settings["steps_to_take"]) and drive.core.particle_count:
        drive.step()
    facts = drive.core.slide_facts()
    speeds = np.linalg.norm(drive.core.velocities(), axis=1)
    not_finite = np.count_nonzero(~np.isfinite(drive.core.positions()))
    mass = (drive.core.masses().sum() + facts["left_terrain_kg"]) / released - 1
    measured = [
        Measured("unsound", float(not_finite), 0.0, float(not_finite)),
        Measured("mass", float(mass), 0.0, float(mass)),
    ]
    if settings.get("friction") == 2.0:
        middle = float(np.median(speeds))
        measured.append(Measured("creep", middle, 0.0, middle))
    return drive.outcome(measured)


def matrix(full: bool) -> list[CaseSettings]:
    """Return every ground with several thicknesses, and settings at their extremes."""
    steps = 3000 if full else STEPS
    thicknesses = (0.001, 0.05, 0.5, 10.0) if full else (0.001, 10.0)
    base: CaseSettings = {**DEFAULTS, "steps_to_take": steps}
    settings_list: list[CaseSettings] = [
        {**base, "ground": ground, "thickness": thickness}
        for ground in GROUNDS
        for thickness in thicknesses
    ]
    return settings_list + [{**base, **extreme} for extreme in EXTREMES]


CASE = Case(
    name="slide_extremes",
    title="Slides at the extremes",
    source="conservation of mass; Coulomb's law; all numbers are finite",
    description="""
    A slab, 1 mm to 10 m thick, slides over cliffs, steps, pits, a gully of one cell, level ground
    and a sharp ridge. In addition, it slides down a slope with time steps, bonds, friction,
    viscosity and particles at the extremes of their allowed ranges. All numbers must be finite, and
    the mass on and beyond the terrain must be conserved. With μ = 2, snow on a slope of 38 degrees
    must not move.
    """,
    quantities=(
        Quantity("unsound", "coordinates that are not finite", limit=0.0, relative=False),
        Quantity("mass", "change of mass", limit=1e-12),
        Quantity("creep", "median speed that friction holds, m/s", limit=0.0, relative=False),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    Bonds that are too stiff for the time step shorten it. If a step would be divided into more than
    a hundred, an error gives the required step. Without shorter steps the slab would oscillate
    until it breaks up.
    """,
)
