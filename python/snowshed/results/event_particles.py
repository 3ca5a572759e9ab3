"""The particles after an event in few bytes: the quantities from which a stack is measured.

A results folder holds all quantities of the particles. A study of thousands of runs stores only
these, so that a new measure needs no new run.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.damage import DAMAGED
from snowshed.base.paths import PathLike
from snowshed.io.array_archive import open_archive
from snowshed.io.vtk.vtp import read_particles
from snowshed.results.folder import RunFolder
from snowshed.scene.scene import ResolvedScene
from snowshed.snow.stack.measure import StackMeasure, measure_stack
from snowshed.snow.stack.particles import Surroundings, surroundings
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING

Singles = NDArray[np.float32]


@dataclass(frozen=True)
class EventParticles:
    """The particles after an event.

    Attributes
    ----------
    positions : (n, 3)
        Positions, m, in single precision like all other arrays.
    masses, densities : (n,)
        Masses, kg (in 2D per metre of width), and densities, kg/m3.
    on_panel : (n,)
        Booleans: True for snow that lies on the panel.
    dimension, dx, ground_tilt_deg
        Dimension, 2 or 3; size of the grid cells, m; tilt of the ground, degrees.
    around
        The structures that particles touch, and ground that is not plane.
    """

    positions: Singles
    masses: Singles
    densities: Singles
    on_panel: NDArray[np.bool_]
    dimension: int
    dx: float
    ground_tilt_deg: float
    around: Surroundings = field(default_factory=Surroundings)

    def measure(self, trimming: str = DEFAULT_TRIMMING) -> StackMeasure:
        """Measure the stack by a trimming rule of A.4.2; see `snowshed.measure_stack`."""
        return measure_stack(
            self.positions,
            self.masses,
            self.densities,
            dimension=self.dimension,
            dx=self.dx,
            ground_tilt_deg=self.ground_tilt_deg,
            exclude=self.on_panel,
            structures=self.around.structures,
            ground=self.around.ground,
            trimming=trimming,
        )

    def packed(self) -> bytes:
        """Return the particles as a compressed NumPy archive, which `unpacked` reads.

        Examples
        --------
        >>> ones = np.ones(3, dtype=np.float32)
        >>> some = EventParticles(np.eye(3, dtype=np.float32), ones, ones, ones > 1, 3, 0.1, 0.0)
        >>> EventParticles.unpacked(some.packed()).positions[0].tolist()
        [1.0, 0.0, 0.0]
        """
        stream = io.BytesIO()
        around: dict[str, Any] = {}
        if self.around.structures is not None:
            around["structures"] = np.packbits(self.around.structures)
        if self.around.ground is not None:
            around["ground"] = self.around.ground.astype(np.float32)
        axes = [0, 2] if self.dimension == 2 else [0, 1, 2]
        np.savez_compressed(
            stream,
            places=np.ascontiguousarray(self.positions[:, axes].T),  # similar numbers side by side
            masses=self.masses,
            densities=self.densities,
            on_panel=np.packbits(self.on_panel),
            scene=np.array([self.dimension, self.dx, self.ground_tilt_deg]),
            **around,
        )
        return stream.getvalue()

    @classmethod
    def unpacked(cls, data: bytes) -> EventParticles:
        """Return the particles that `packed` has packed.

        Raises
        ------
        InputError
            If the bytes are damaged, or do not come from `packed`.
        """
        try:
            with open_archive(data) as archive:
                return cls._from_archive(archive)
        except (OSError, *DAMAGED) as error:
            raise InputError(f"not particles that snowshed stored: {error}") from None

    @classmethod
    def _from_archive(cls, archive: Any) -> EventParticles:
        dimension, dx, tilt = archive["scene"].tolist()
        coordinates, masses = archive["places"], archive["masses"]
        positions = np.zeros((len(masses), 3), dtype=np.float32)
        positions[:, [0, 2] if dimension == 2 else [0, 1, 2]] = coordinates.T
        on_panel, *structures = (
            np.unpackbits(archive[name], count=len(masses)).astype(bool)
            for name in ("on_panel", "structures")
            if name in archive
        )
        around = Surroundings(
            structures[0] if structures else None,
            archive["ground"].astype(float) if "ground" in archive else None,
        )
        densities = archive["densities"]
        return cls(positions, masses, densities, on_panel, int(dimension), dx, tilt, around)


def read_event_particles(folder: PathLike) -> Iterator[tuple[int, EventParticles]]:
    """Yield each event in a results folder, with the particles after it.

    Raises
    ------
    InputError
        If the folder is damaged, or of a version that did not record the events.
    """
    results = RunFolder(folder)
    scene = ResolvedScene.load(results.scene)
    simulation = _core.Simulation(scene.core, scene.base_dir)
    for facts in results.read_run().get("finished_events", ()):
        event, laid = facts.get("event"), facts.get("laid_height_m")
        if event is None or laid is None:
            raise InputError(f"{results.run}: damaged: an event without its number or laid height")
        particles = read_particles(results.particles_of(event))
        positions = particles["position"].astype(float)
        yield (
            event,
            EventParticles(
                particles["position"],
                particles["mass"],
                particles["density"],
                simulation.on_panel_at(positions, laid),
                simulation.dimension,
                simulation.resolution,
                simulation.ground_tilt_deg,
                surroundings(simulation, scene.data, positions),
            ),
        )


def last_stack(folder: PathLike) -> StackMeasure:
    """Return the measure of the stack after the last event of a results folder.

    It is computed from the stored particles, in single precision.

    Raises
    ------
    InputError
        If no event has ended, or the folder is damaged.
    """
    events = list(read_event_particles(folder))
    if not events:
        raise InputError(f"{folder}: no event has ended; there is no stack to measure")
    return events[-1][1].measure()
