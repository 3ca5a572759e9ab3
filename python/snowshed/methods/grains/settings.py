"""Settings of the grains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, Optional

from snowshed.base.record import default
from snowshed.methods.settings import MethodSettings

GrainSides = Literal["walls", "periodic"]


@dataclass
class GrainsSettings(MethodSettings):
    """Contact law, bonds and time step of the grains; see Hagenmuller et al. (2015).

    Attributes
    ----------
    elastic_modulus : float
        Young's modulus of the contact law [Pa]. 0 < value <= 1e+12; default 1e+09.
    stiffness_ratio : float
        Shear over normal stiffness of a contact. 0 < value <= 10; default 0.3.
    tensile_strength : float
        Tensile strength of bonds [Pa]. 0 <= value <= 1e+12; default 1e+06.
    shear_strength : float
        Shear strength of bonds [Pa]. 0 <= value <= 1e+12; default 1e+06.
    friction : float
        Coulomb coefficient between grains, and between grains and plates. 0 <= value <= 100;
        default 0.2.
    density : float
        Density of ice [kg/m3]. 0 < value <= 100000; default 917.
    density_scaling : float
        Factor on the grains' inertia, for longer steps; their weight stays. 1 <= value <= 1e+09;
        default 1.
    damping : float
        Local damping: share of the unbalanced force that opposes the motion. 0 <= value < 1;
        default 0.2.
    courant_factor : float
        Time step relative to sqrt(m/k), the smallest of all grains. 0 < value <= 1; default 0.3.
    sides : {"walls", "periodic"}
        The vertical sides: rigid and frictionless, or periodic. Default "walls".
    bonded_plates : bool
        Whether the snow is frozen to the plates. Default False.
    threads : int
        Threads; 0: all. 0 <= value <= 4096; default 0.
    """

    elastic_modulus: Optional[float] = default(1e9)
    stiffness_ratio: Optional[float] = default(0.3)
    tensile_strength: Optional[float] = default(1e6)
    shear_strength: Optional[float] = default(1e6)
    friction: Optional[float] = default(0.2)
    density: Optional[float] = default(917.0)
    density_scaling: Optional[float] = default(1.0)
    damping: Optional[float] = default(0.2)
    courant_factor: Optional[float] = default(0.3)
    sides: Optional[GrainSides] = default("walls")
    bonded_plates: Optional[bool] = default(False)
    threads: Optional[int] = default(0)

    RESOLUTION: ClassVar[str] = ""  # that of the sample's image

    @property
    def resolution(self) -> Optional[float]:
        """None: the image decides."""
        return None
