"""The parts of a scene, field by field as the core reads them.

Every field defaults to None, "not given": the core's default holds. Defaults, units in full and
limits are in the JSON Schema (``snowshed schema``). Vectors are (x, y, z), in 2D (x, z).
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import List, Optional, Union

from snowshed import _core
from snowshed.io.record import Record
from snowshed.scene.shape import Shape, Vector


@dataclass
class Snow(Record):
    """Cohesive Modified Cam-Clay snow (thesis 1.2.5-1.2.7), or a purely elastic body."""

    model: Optional[str] = None  # cam_clay, elastic
    density: Optional[float] = None  # kg/m3
    youngs_modulus: Optional[float] = None  # E, Pa
    poissons_ratio: Optional[float] = None  # nu
    critical_state_slope: Optional[float] = None  # M
    preconsolidation_pressure: Optional[float] = None  # p0, Pa, initial
    cohesion: Optional[float] = None  # beta
    hardening_factor: Optional[float] = None  # xi

    @classmethod
    def preset(cls, name: str) -> Snow:
        """Return a snow of the thesis: "calibrated" (Table 4.3.1) or "reference" (Table 3.2.1).

        Examples
        --------
        >>> Snow.preset("calibrated").critical_state_slope
        0.5
        """
        return cls.from_data(json.loads(_core.snow_preset(name)))


@dataclass
class Panel(Record):
    """The panel of Figure 3.1.1. x points down the slide direction from the panel's centre."""

    height: Optional[float] = None  # m, of the lower edge above the ground
    length: Optional[float] = None  # m, along the slope
    width: Optional[float] = None  # m, 3D only
    tilt: Optional[float] = None  # degrees from horizontal
    thickness: Optional[float] = None  # m, below the sliding face
    condition: Optional[str] = None  # sticky, slip, separate
    friction: Optional[float] = None  # Coulomb coefficient


@dataclass
class Layer(Record):
    """A layer of the slab, over its whole length and width."""

    thickness: Optional[float] = None  # m
    snow: Optional[Snow] = None  # what it leaves out is as in the scene's snow
    event: Optional[int] = None  # at whose start it is laid; 0: of every event


@dataclass
class Slab(Record):
    """The slab laid on the panel at the start of every event: one snow, or layer by layer."""

    thickness: Optional[float] = None  # m
    length: Optional[float] = None  # m
    width: Optional[float] = None  # m, 3D only
    layers: Optional[List[Layer]] = None  # in place of a thickness, from the panel upwards


@dataclass
class Ground(Record):
    """An inclined plane through the origin; positive tilt falls in the slide direction."""

    tilt: Optional[float] = None  # degrees
    condition: Optional[str] = None  # sticky, slip, separate
    friction: Optional[float] = None


@dataclass
class Motion(Record):
    """Prescribed rigid motion of an obstacle between two times."""

    velocity: Optional[Vector] = None  # m/s
    angular_velocity: Union[Vector, float, None] = None  # rad/s; in 2D a number, about +y
    pivot: Optional[Vector] = None  # m, moves with the velocity
    start: Optional[float] = None  # s
    end: Optional[float] = None  # s


@dataclass
class Obstacle(Record):
    """Something snow collides with."""

    name: Optional[str] = None
    shape: Optional[Shape] = None
    condition: Optional[str] = None  # sticky, slip, separate
    friction: Optional[float] = None
    motion: Optional[Motion] = None


@dataclass
class Body(Record):
    """A body of snow that appears at the start of an event (0: of every event)."""

    shape: Optional[Shape] = None
    velocity: Optional[Vector] = None  # m/s
    event: Optional[int] = None
    snow: Optional[Snow] = None  # what it leaves out is as in the scene's snow


@dataclass
class Domain(Record):
    """The box the snow may not leave; its sides are sticky walls."""

    min: Optional[Vector] = None  # m
    max: Optional[Vector] = None  # m


@dataclass
class Seeding(Record):
    """How solids of snow are filled with particles (thesis A.3.2)."""

    particles_per_voxel: Optional[float] = None
    pattern: Optional[str] = None  # regular, jittered, poisson
    seed: Optional[int] = None
    allow_sparse: Optional[bool] = None


@dataclass
class Numerics(Record):
    """Grid, transfer and time step."""

    dx: Optional[float] = None  # m, grid and voxel size
    precision: Optional[str] = None  # float, double
    transfer: Optional[str] = None  # flip, apic
    flip_ratio: Optional[float] = None
    basis: Optional[str] = None  # quadratic, cubic
    step_factor: Optional[float] = None
    strain_limit: Optional[float] = None
    sleep_speed: Optional[float] = None
    sleep_time: Optional[float] = None
    threads: Optional[int] = None


@dataclass
class Events(Record):
    """How many slide-offs, what happens between them, and when one has come to rest."""

    count: Optional[int] = None
    between: Optional[str] = None  # carry, reseed
    max_time: Optional[float] = None  # s
    rest_speed: Optional[float] = None  # m/s
    rest_time: Optional[float] = None  # s


@dataclass
class Output(Record):
    """What a run writes besides its tables."""

    snapshot_interval: Optional[float] = None  # s of simulated time
    energy: Optional[bool] = None
    checkpoint_interval: Optional[float] = None  # s of wall time
