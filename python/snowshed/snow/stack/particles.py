"""Measuring the stack of a simulation: its fallen snow, and the ground below."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Booleans, Floats
from snowshed.snow.stack.measure import StackMeasure, measure_stack
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING

MAX_CONTACT_GAP = 1.5  # largest distance between a structure and snow that lies on it, cells
GROUND_TOLERANCE = 0.01  # distance from the ground at which the search ends, cells
MAX_STEPS = 200


@dataclass(frozen=True)
class Surroundings:
    """Surroundings of particles; a field is None if the scene lacks the object.

    Attributes
    ----------
    structures : (n,)
        Mask of particles that touch the panel's board or an obstacle other than the ground.
    ground : (n,)
        z of the ground below each particle, m, if the ground is not the scene's plane.
    """

    structures: Optional[Booleans] = None
    ground: Optional[Floats] = None


def surroundings(
    simulation: _core.Simulation, scene: Mapping[str, Any], positions: Floats
) -> Surroundings:
    """Return the structures and the ground around particles.

    Obstacles of a scene with a plane ground are structures. In a scene without a plane, obstacles
    and terrain are the ground.

    Parameters
    ----------
    simulation, scene
        A simulation of the complete scene, and the scene's data.
    positions : (n, 3)
        Positions of the particles, m.
    """
    if len(positions) == 0:
        return Surroundings()
    gap = _board_distance(simulation, positions)
    ground = None
    if scene.get("obstacles"):
        if scene.get("ground"):
            gap = np.minimum(gap, simulation.resolved_distance(positions))
        else:
            ground = _ground_below(simulation, positions)
    return Surroundings(gap < MAX_CONTACT_GAP * simulation.resolution, ground)


def measure_particles(
    simulation: _core.Simulation,
    scene: Mapping[str, Any],
    positions: Floats,
    masses: Floats,
    densities: Floats,
    on_panel: Booleans,
    trimming: str = DEFAULT_TRIMMING,
) -> StackMeasure:
    """Return the measure of the stack that particles of a simulation's scene form.

    Parameters
    ----------
    simulation, scene
        A simulation of the complete scene, and the scene's data.
    positions, masses, densities, on_panel : (n, 3) or (n,)
        Positions, m; masses, kg; densities, kg/m3; and mask of the particles on the panel.
    trimming
        As for `measure_stack`.
    """
    around = surroundings(simulation, scene, positions)
    return measure_stack(
        positions,
        masses,
        densities,
        dimension=simulation.dimension,
        dx=simulation.resolution,
        ground_tilt_deg=simulation.ground_tilt_deg,
        exclude=on_panel,
        structures=around.structures,
        ground=around.ground,
        trimming=trimming,
    )


def _board_distance(simulation: _core.Simulation, positions: Floats) -> Floats:
    """Return the distances of particles from the panel's board, m; infinite without a panel."""
    frame = simulation.panel_frame()
    if frame is None:
        return np.full(len(positions), np.inf)
    away = positions - np.asarray(frame["center"])
    half_board = 0.5 * frame["board_thickness"]
    outside = [
        np.abs(away @ np.asarray(frame["slope"])) - 0.5 * frame["length"],
        np.abs(away @ np.asarray(frame["normal"]) + half_board) - half_board,
    ]
    if simulation.dimension == 3:
        outside.append(np.abs(away[:, 1]) - 0.5 * frame["width"])
    distance: Floats = np.linalg.norm(np.maximum(outside, 0.0), axis=0)
    return distance


def _ground_below(simulation: _core.Simulation, positions: Floats) -> Floats:
    """Return z of the first solid below each particle, m; its own z if there is no solid.

    A point moves down by its distance to the solid until it arrives (sphere tracing, Hart 1996).
    """
    dx = simulation.resolution
    points = np.array(positions, dtype=float)
    left = np.arange(len(points))
    lowest = float(points[:, 2].min()) - np.ptp(points, axis=0).max() - 100.0 * dx
    for _ in range(MAX_STEPS):
        distance = simulation.resolved_distance(points[left])
        points[left, 2] -= distance  # upward if a particle lies slightly inside the solid
        left = left[(np.abs(distance) > GROUND_TOLERANCE * dx) & (points[left, 2] > lowest)]
        if len(left) == 0:
            break
    points[left, 2] = positions[left, 2]
    lost = points[:, 2] <= lowest
    points[lost, 2] = positions[lost, 2]
    ground: Floats = points[:, 2]
    return ground
