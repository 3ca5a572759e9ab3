"""The components of a scene, field by field as the core reads them.

A field that was not given reads as the core's default, or as None if it has no default. Writing
None takes a value back. Vectors are (x, y, z), in 2D (x, z). Tables follow ``snowshed schema``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, List, Literal, Optional, Union

from snowshed._core import InputError, snow_preset
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.base.record import Alias, FieldsByField, Record, default
from snowshed.io.json_file import read_object
from snowshed.scene.shape import Shape, Vector

SnowModel = Literal["cam_clay", "elastic"]
Condition = Literal["sticky", "slip", "separate"]
Pattern = Literal["regular", "jittered", "poisson"]
Between = Literal["carry", "reseed"]
MisplacedSnow = Literal["refuse", "allow"]

PROVENANCE = "provenance"  # key under which a snow's file says where it comes from


@checked
@dataclass
class Snow(Record):
    """Cohesive Modified Cam-Clay snow (thesis 1.2.5-1.2.7), or a purely elastic body.

    Attributes
    ----------
    model : {"cam_clay", "elastic"}
        Law: cohesive Modified Cam-Clay, or elastic without yielding. Default "cam_clay".
    density : float
        Initial bulk density; sets E and p0 unless given [kg/m3]. 0 < value <= 1000; default 210.
    youngs_modulus : float
        Young's modulus E [Pa]. 0 < value <= 1e+12; default 1e+06.
    poissons_ratio : float
        Poisson's ratio nu. 0 <= value < 0.5; default 0.3.
    critical_state_slope : float
        Slope M of the critical state line (internal friction). 0 <= value <= 100; default 0.5.
    preconsolidation_pressure : float
        Initial preconsolidation pressure p0 [Pa]. 0 < value <= 1e+12; default 7000.
    cohesion : float
        Cohesion beta: tensile strength over p0. 0 <= value <= 1; default 0.2.
    hardening_factor : float
        Hardening factor xi. 0 < value <= 1000; default 0.1.
    """

    model: Optional[SnowModel] = default("cam_clay")
    density: Optional[float] = default(210.0)
    youngs_modulus: Optional[float] = default(1e6)
    poissons_ratio: Optional[float] = default(0.3)
    critical_state_slope: Optional[float] = default(0.5)
    preconsolidation_pressure: Optional[float] = default(7000.0)
    cohesion: Optional[float] = default(0.2)
    hardening_factor: Optional[float] = default(0.1)

    FOLLOWS: ClassVar[FieldsByField] = {"density": ("youngs_modulus", "preconsolidation_pressure")}

    @classmethod
    def preset(cls, name: str) -> Snow:
        """Return a snow of the thesis: "calibrated" (Table 4.3.1) or "reference" (Table 3.2.1).

        Examples
        --------
        >>> Snow.preset("calibrated").critical_state_slope
        0.5
        """
        return cls.from_data(json.loads(snow_preset(name)))

    @classmethod
    def load(cls, file: PathLike) -> Snow:
        """Read snow parameters from a JSON file; an optional ``provenance`` entry is ignored.

        Raises
        ------
        InputError
            If the file does not hold such an object, or unknown keys; the message names the file.
        OSError
            If it cannot be read.
        """
        data = read_object(Path(file))
        data.pop(PROVENANCE, None)
        try:
            return cls.from_data(data)
        except InputError as error:
            raise InputError(f"{file}: {error}") from None

    @classmethod
    def preset_or_file(cls, name: str) -> Snow:
        """Return the preset with this name, or the snow in this JSON file."""
        try:
            return cls.preset(name)
        except InputError as unknown:
            if Path(name).suffix != ".json":
                raise InputError(f"{unknown}; or a JSON file of a snow, NAME.json") from None
        return cls.load(name)


@dataclass
class Panel(Record):
    """The panel of Figure 3.1.1. x points down the slide direction from the panel's centre.

    Attributes
    ----------
    height : float
        Vertical distance of the lower edge above the ground [m]. 0 <= value <= 1e+06; required;
        also lower_edge_height.
    length : float
        Length along the slope [m]. 0 < value <= 1e+06; required; also slant_height.
    width : float
        Width across the slope; ignored in 2D (required in 3D) [m]. 0 <= value <= 1e+06.
    tilt : float
        Tilt from the horizontal [degrees]. 0 <= value <= 90; default 40; also surface_tilt.
    thickness : float
        Thickness, below the sliding face [m]. 0 <= value <= 1e+06; default 0.
    condition : {"sticky", "slip", "separate"}
        Snow in contact: sticks (sticky), slides and cannot leave (slip), slides and may leave
        (separate). Default "separate".
    friction : float
        Coulomb coefficient; unused when sticky. 0 <= value <= 100; default 0.3.
    """

    height: Optional[float] = None
    length: Optional[float] = None
    width: Optional[float] = None
    tilt: Optional[float] = default(40.0)
    thickness: Optional[float] = default(0.0)
    condition: Optional[Condition] = default("separate")
    friction: Optional[float] = default(0.3)

    # The words of pvlib.
    surface_tilt = Alias("tilt")
    slant_height = Alias("length")
    lower_edge_height = Alias("height")


@dataclass
class Layer(Record):
    """A layer of the slab, over its whole length and width.

    Attributes
    ----------
    thickness : float
        Thickness, normal to the panel [m]. 0 < value <= 1e+06; required.
    snow : Snow
        Snow of its own; values that are left out are those of the scene's snow.
    event : int
        Event at whose start it is laid, 1 the first; 0: at the start of every event. 0 <= value <=
        1000; default 0.
    """

    thickness: Optional[float] = None
    snow: Optional[Snow] = None
    event: Optional[int] = default(0)

    INHERITS: ClassVar[tuple[str, ...]] = ("snow",)


@dataclass
class Slab(Record):
    """The slab laid on the panel at the start of every event: one snow, or layer by layer.

    Attributes
    ----------
    thickness : float
        Thickness, normal to the panel; 0: that of the layers [m]. 0 <= value <= 1e+06; default 0.
    length : float
        Length; 0: as long as the panel [m]. 0 <= value <= 1e+06; default 0.
    width : float
        Width; 0: two thirds of the panel's; ignored in 2D [m]. 0 <= value <= 1e+06; default 0.
    layers : list of Layer
        Layers from the panel up, instead of a thickness.
    """

    thickness: Optional[float] = default(0.0)
    length: Optional[float] = default(0.0)
    width: Optional[float] = default(0.0)
    layers: Optional[List[Layer]] = None


@dataclass
class Ground(Record):
    """An inclined plane through the origin; positive tilt falls in the slide direction.

    Attributes
    ----------
    tilt : float
        Tilt; positive falls in the slide direction [degrees]. -60 < value < 60; default 0.
    condition : {"sticky", "slip", "separate"}
        Snow in contact: sticks (sticky), slides and cannot leave (slip), slides and may leave
        (separate). Default "sticky".
    friction : float
        Coulomb coefficient; unused when sticky. 0 <= value <= 100; default 0.3.
    """

    tilt: Optional[float] = default(0.0)
    condition: Optional[Condition] = default("sticky")
    friction: Optional[float] = default(0.3)


@dataclass
class Motion(Record):
    """Prescribed rigid motion of an obstacle between two times.

    Attributes
    ----------
    velocity : sequence of float
        Velocity [m/s]. -10000 <= value <= 10000; default (0, 0, 0).
    angular_velocity : float or sequence of float
        Angular velocity about the pivot; in 2D a single number, about +y [rad/s]. -10000 <= value
        <= 10000.
    pivot : sequence of float
        Centre of the rotation; moves with the velocity [m]. -1e+06 <= value <= 1e+06; default (0,
        0, 0).
    start : float
        Start of the motion, on the clock of the whole run [s]. 0 <= value <= 1e+09; default 0.
    end : float
        End of the motion [s]. 0 <= value <= 1e+09; default 1e+09.
    """

    velocity: Optional[Vector] = default((0.0, 0.0, 0.0))
    angular_velocity: Union[Vector, float, None] = None
    pivot: Optional[Vector] = default((0.0, 0.0, 0.0))
    start: Optional[float] = default(0.0)
    end: Optional[float] = default(1e9)


@dataclass
class Obstacle(Record):
    """Something snow collides with.

    Attributes
    ----------
    name : str
        Name in messages and results.
    shape : Shape
        The solid. Required.
    condition : {"sticky", "slip", "separate"}
        Snow in contact: sticks (sticky), slides and cannot leave (slip), slides and may leave
        (separate). Default "separate".
    friction : float
        Coulomb coefficient; unused when sticky. 0 <= value <= 100; default 0.3.
    motion : Motion
        Prescribed rigid motion; fixed without it.
    """

    name: Optional[str] = default("")
    shape: Optional[Shape] = None
    condition: Optional[Condition] = default("separate")
    friction: Optional[float] = default(0.3)
    motion: Optional[Motion] = None


@dataclass
class Body(Record):
    """A body of snow that appears at the start of an event (0: of every event).

    Attributes
    ----------
    shape : Shape
        The solid to fill with snow. Required.
    velocity : sequence of float
        Initial velocity [m/s]. -10000 <= value <= 10000; default (0, 0, 0).
    event : int
        Event at whose start it appears, 1 the first; 0: at the start of every event. 0 <= value <=
        1000; default 1.
    snow : Snow
        Snow of its own; values that are left out are those of the scene's snow.
    volume : float
        Volume of its undeformed snow, in 2D m2, from which its mass follows; 0: the solid's [m3].
        0 <= value <= 1e+09; default 0.
    """

    shape: Optional[Shape] = None
    velocity: Optional[Vector] = default((0.0, 0.0, 0.0))
    event: Optional[int] = default(1)
    snow: Optional[Snow] = None
    volume: Optional[float] = default(0.0)

    INHERITS: ClassVar[tuple[str, ...]] = ("snow",)


@dataclass
class Domain(Record):
    """The box the snow may not leave; its sides are sticky walls.

    Attributes
    ----------
    min : sequence of float
        Lowest corner [m]. -1e+06 <= value <= 1e+06; required.
    max : sequence of float
        Highest corner [m]. -1e+06 <= value <= 1e+06; required.
    """

    min: Optional[Vector] = None
    max: Optional[Vector] = None


@dataclass
class Seeding(Record):
    """The filling of solids of snow with particles (thesis A.3.2).

    Attributes
    ----------
    particles_per_voxel : float
        Particles per voxel of edge dx, at least 4 in 2D and 6 in 3D; 0: 6 in 2D, 8 in 3D. 0 <=
        value <= 1000; default 0.
    pattern : {"regular", "jittered", "poisson"}
        Arrangement of the particles. Default "poisson".
    seed : int
        Seed of the random numbers. 0 <= value; default 1.
    allow_sparse : bool
        Accept fewer particles per voxel. Default False.
    """

    particles_per_voxel: Optional[float] = default(0.0)
    pattern: Optional[Pattern] = default("poisson")
    seed: Optional[int] = default(1)
    allow_sparse: Optional[bool] = default(False)


@dataclass
class Events(Record):
    """The number of slide-offs, the treatment of the stack between them, and their end.

    Attributes
    ----------
    count : int
        Number of slide-off events. 1 <= value <= 1000; default 1.
    between : {"carry", "reseed"}
        Treatment of the stack between events: keep its particles, or reseed its volume. Default
        "carry".
    max_time : float
        Longest duration of an event [s]. 0 < value <= 1e+09; default 10.
    rest_speed : float
        Speed below which the snow counts as resting [m/s]. 0 < value <= 10000; default 0.02.
    rest_time : float
        Duration of rest that ends the event [s]. 0 <= value <= 1e+09; default 0.05.
    """

    count: Optional[int] = default(1)
    between: Optional[Between] = default("carry")
    max_time: Optional[float] = default(10.0)
    rest_speed: Optional[float] = default(0.02)
    rest_time: Optional[float] = default(0.05)
