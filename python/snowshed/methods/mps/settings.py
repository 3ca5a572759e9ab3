"""Settings of the moving particle semi-implicit method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, Optional

from snowshed.base.record import default
from snowshed.methods.settings import MethodSettings

MpsRheology = Literal["newtonian", "bingham", "bingham_dilatant"]
MpsYield = Literal["papanastasiou", "bi_viscous"]
MpsWalls = Literal["mirrors", "particles"]
MpsSource = Literal["published", "compensated"]
MpsGradient = Literal["published", "conservative", "corrected"]
MpsSplitting = Literal["viscosity_first", "pressure_first"]
MpsCoupling = Literal["none", "stiff", "always"]
MpsSurface = Literal["published", "mirrored"]
MpsOrder = Literal["published", "single_move"]
MpsStress = Literal["published", "elastoplastic"]
MpsSpacing = Literal["none", "collision", "shifting"]
MpsPreconditioner = Literal["jacobi", "incomplete_cholesky", "multigrid"]


@dataclass
class MpsSettings(MethodSettings):
    """Particles, rheology, erosion and solvers of the moving particle semi-implicit method.

    Attributes
    ----------
    spacing : float
        Distance between particles, l0 [m]. 0 < value <= 1e+06; default 0.01.
    radius : float
        Radius of the weight function over l0. 1.5 <= value <= 4.5; default 2.1.
    max_time_step : float
        Longest step [s]. 0 < value <= 1; default 0.01.
    courant_factor : float
        Longest displacement of a particle in a step, over l0. 0 < value <= 0.4; default 0.2.
    density : float
        Density, which is constant [kg/m3]. 0 < value <= 10000; default 200.
    rheology : {"newtonian", "bingham", "bingham_dilatant"}
        Law of the shear stress. Default "bingham_dilatant".
    regularisation : {"papanastasiou", "bi_viscous"}
        Form of the yield stress at small shear rates. Default "papanastasiou".
    viscosity : float
        Plastic viscosity [Pa s]. 0 <= value <= 1e+06; default 0.012.
    cohesion : float
        Yield stress without pressure (adhesive force) [Pa]. 0 <= value <= 1e+06; default 0.
    friction_angle : float
        Inner friction angle: the yield stress grows with its tangent times the pressure [degrees].
        0 <= value < 90; default 24.
    stress_growth : float
        Coefficient m with which the yield stress is approached [s]. 0 < value <= 1e+06; default
        10000.
    yield_strain : float
        Shear strain at which snow with an elastoplastic stress yields. 0 < value <= 0.1; default
        0.0003.
    dilatant_rate : float
        Shear rate above which the stress grows as a power of the rate [1/s]. 0 < value <= 1e+09;
        default 100.
    dilatant_exponent : float
        Exponent of the stress above dilatant_rate. 1 <= value <= 5; default 1.5.
    yield_iterations : int
        Largest number of iterations for the apparent viscosity in a step. 1 <= value <= 1000;
        default 50.
    erosion : bool
        Whether snow is eroded and deposited. Default False.
    erodible_thickness : float
        Snow nearer to obstacles than this is erodible at the start [m]. 0 <= value <= 1e+06;
        default 0.
    erosion_pressure : float
        Pressure above which erodible snow begins to move [Pa]. 0 <= value <= 1e+09; default 50.
    erosion_speed : float
        Speed of a neighbour above which erodible snow begins to move [m/s]. 0 <= value <= 10000;
        default 0.1.
    deposition_pressure : float
        Pressure below which moving snow is deposited [Pa]. 0 <= value <= 1e+09; default 25.
    deposition_speed : float
        Speed below which moving snow is deposited [m/s]. 0 <= value <= 10000; default 0.05.
    walls : {"mirrors", "particles"}
        Walls: mirror images of the snow, or particles. Default "mirrors".
    stress : {"published", "elastoplastic"}
        Shear stress: viscous as published, or elastic until the snow yields. Default
        "elastoplastic".
    source : {"published", "compensated"}
        Right-hand side of the pressure equation. Default "compensated".
    compensation : float
        Share of the density's error that a step removes. 0 <= value <= 1; default 0.1.
    gradient : {"published", "conservative", "corrected"}
        Gradient of the pressure. Default "corrected".
    splitting : {"viscosity_first", "pressure_first"}
        Whether viscosity acts before the pressure or after it. Default "pressure_first".
    coupling : {"none", "stiff", "always"}
        Steps in which pressure and viscosity are solved together. Default "stiff".
    surface : {"published", "mirrored"}
        Position of zero pressure at the free surface. Default "mirrored".
    surface_ratio : float
        Number density over that of a lattice, below which a particle is at the surface. 0.5 <=
        value <= 1; default 0.97.
    order : {"published", "single_move"}
        Order of the stages of a step: particles move as published, or once. Default "single_move".
    spacing_law : {"none", "collision", "shifting"}
        Law that keeps particles apart besides the pressure. Default "shifting".
    preconditioner : {"jacobi", "incomplete_cholesky", "multigrid"}
        Preconditioner of the pressure equation. Default "multigrid".
    pressure_tolerance : float
        Residual of the pressure equation over its right-hand side. 0 < value <= 0.1; default
        0.0001.
    viscosity_tolerance : float
        Residual of the viscous equation over the change by gravity in a step. 0 < value <= 0.1;
        default 0.0001.
    max_iterations : int
        Iterations after which a run ends with an error. 1 <= value <= 100000; default 1000.
    threads : int
        Threads; 0: all. 0 <= value <= 4096; default 0.
    """

    spacing: Optional[float] = default(0.01)
    radius: Optional[float] = default(2.1)
    max_time_step: Optional[float] = default(0.01)
    courant_factor: Optional[float] = default(0.2)
    density: Optional[float] = default(200.0)
    rheology: Optional[MpsRheology] = default("bingham_dilatant")
    regularisation: Optional[MpsYield] = default("papanastasiou")
    viscosity: Optional[float] = default(0.012)
    cohesion: Optional[float] = default(0.0)
    friction_angle: Optional[float] = default(24.0)
    stress_growth: Optional[float] = default(10000.0)
    yield_strain: Optional[float] = default(0.0003)
    dilatant_rate: Optional[float] = default(100.0)
    dilatant_exponent: Optional[float] = default(1.5)
    yield_iterations: Optional[int] = default(50)
    erosion: Optional[bool] = default(False)
    erodible_thickness: Optional[float] = default(0.0)
    erosion_pressure: Optional[float] = default(50.0)
    erosion_speed: Optional[float] = default(0.1)
    deposition_pressure: Optional[float] = default(25.0)
    deposition_speed: Optional[float] = default(0.05)
    walls: Optional[MpsWalls] = default("mirrors")
    stress: Optional[MpsStress] = default("elastoplastic")
    source: Optional[MpsSource] = default("compensated")
    compensation: Optional[float] = default(0.1)
    gradient: Optional[MpsGradient] = default("corrected")
    splitting: Optional[MpsSplitting] = default("pressure_first")
    coupling: Optional[MpsCoupling] = default("stiff")
    surface: Optional[MpsSurface] = default("mirrored")
    surface_ratio: Optional[float] = default(0.97)
    order: Optional[MpsOrder] = default("single_move")
    spacing_law: Optional[MpsSpacing] = default("shifting")
    preconditioner: Optional[MpsPreconditioner] = default("multigrid")
    pressure_tolerance: Optional[float] = default(0.0001)
    viscosity_tolerance: Optional[float] = default(0.0001)
    max_iterations: Optional[int] = default(1000)
    threads: Optional[int] = default(0)

    RESOLUTION: ClassVar[str] = "spacing"
    ELEMENTS: ClassVar[str] = "spacings"
