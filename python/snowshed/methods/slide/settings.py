"""Settings of the snow slide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, Optional

from snowshed.base.record import default
from snowshed.methods.settings import MethodSettings

SlideMode = Literal["improved", "compatible"]
SlideFriction = Literal["voellmy", "coulomb"]


@dataclass
class SlideSettings(MethodSettings):
    """Particles, friction and bonds of the snow slide; the defaults are AvaFrame's com5SnowSlide.

    Attributes
    ----------
    mode : {"improved", "compatible"}
        Improved, without the known faults of com5SnowSlide, or compatible with AvaFrame 2.1 step
        by step. Default "improved".
    cell : float
        Cells of the computing grid; 0: those of the terrain's raster [m]. 0 <= value <= 1e+06;
        default 0.
    time_step : float
        Length of a step [s]. 0 < value <= 1; default 0.01.
    density : float
        Density of the sliding snow [kg/m3]. 0 < value <= 1000; default 300.
    layer_thickness : float
        Snow of this thickness over a whole cell makes one particle [m]. 0 < value <= 100; default
        0.25.
    friction_law : {"voellmy", "coulomb"}
        Friction with the ground. Default "voellmy".
    friction : float
        Coulomb coefficient mu. 0 <= value <= 100; default 0.325.
    turbulence : float
        Voellmy's xi [m/s2]. 0 < value <= 1e+06; default 58.
    explicit_friction : bool
        Friction from the speed before the step; in the compatible mode only. Default False.
    resistance : float
        Drag coefficient within resistance areas (forest, buildings). 0 <= value <= 1e+09; default
        30000.
    detrainment : float
        Detrainment coefficient K within resistance areas: snow of speed u loses the mass K/u per
        area and time; 0: none [Pa]. 0 <= value <= 1e+06; default 0.
    forest_min_speed : float
        With detrainment, forest takes mass from snow up to this speed, and resists faster snow
        [m/s]. 0 <= value <= 1000; default 6.
    forest_min_thickness : float
        With detrainment, forest takes mass from snow up to this thickness, and resists thicker
        snow [m]. 0 <= value <= 100; default 0.6.
    forest_max_speed : float
        With detrainment, faster snow destroys the forest [m/s]. 0 < value <= 1000; default 40.
    forest_max_thickness : float
        With detrainment, thicker snow destroys the forest [m]. 0 < value <= 100; default 10.
    ground_gains_stopped : bool
        The ground rises where snow has stopped, which then moves no more. Default False.
    ground_gains_detrained : bool
        The ground rises where forest takes snow. Default False.
    ground_loses_entrained : bool
        The ground falls where the slide takes up snow. Default False.
    ground_min_change : float
        The ground changes when the change at one node exceeds this depth [m]. 0 <= value <= 100;
        default 0.1.
    ground_rest_time : float
        Snow that rests as long as this is ground; in the improved mode only [s]. 0 <= value <=
        10000; default 1.
    artificial_viscosity : float
        AvaFrame's artificial viscosity; in the compatible mode only. 0 <= value <= 1e+06; default
        100.
    columns : {"vertical", "across_flow"}
        Direction of the columns of snow that press on the ground; in the improved mode only.
        Default "vertical".
    mixing_rate : float
        Rate at which particles take over the mean velocity around them; in the improved mode only
        [1/s]. 0 <= value <= 1000; default 8.
    bonds : bool
        Cohesive bonds; without them a plain depth-averaged avalanche. Default True.
    max_strain : float
        Strain at which a bond breaks, in tension or compression. 0 < value <= 10; default 0.2.
    bond_modulus : float
        Stiffness of the bonds (cohesive surface tension) [Pa]. 0 <= value <= 1e+12; default 50000.
    min_bond_length : float
        Length below which a bond exerts no force [m]. 0 <= value <= 1e+06; default 0.001.
    entrained_density : float
        Density of the entrained snow [kg/m3]. 0 < value <= 1000; default 100.
    erosion_energy : float
        Friction work that entrains a kilogram of snow; 0: all snow below the slide is entrained
        [J/kg]. 0 <= value <= 1e+12; default 5000.
    entrainment_shear : float
        Shear strength of the entrained snow [Pa]. 0 <= value <= 1e+12; default 0.
    entrainment_work : float
        Work that breaks up the entrained snow [J/kg]. 0 <= value <= 1e+12; default 0.
    split_ratio : float
        A particle splits when its mass exceeds this multiple of a fresh particle's. 1 < value <=
        1e+06; default 1.5.
    stop_ratio : float
        The slide stops at this share of its largest kinetic energy. 0 <= value <= 1; default 0.01.
    threads : int
        Threads; 0: all. 0 <= value <= 4096; default 0.
    """

    mode: Optional[SlideMode] = default("improved")
    cell: Optional[float] = default(0.0)
    time_step: Optional[float] = default(0.01)
    density: Optional[float] = default(300.0)
    layer_thickness: Optional[float] = default(0.25)
    friction_law: Optional[SlideFriction] = default("voellmy")
    friction: Optional[float] = default(0.325)
    turbulence: Optional[float] = default(58.0)
    explicit_friction: Optional[bool] = default(False)
    resistance: Optional[float] = default(30000.0)
    detrainment: Optional[float] = default(0.0)
    forest_min_speed: Optional[float] = default(6.0)
    forest_min_thickness: Optional[float] = default(0.6)
    forest_max_speed: Optional[float] = default(40.0)
    forest_max_thickness: Optional[float] = default(10.0)
    ground_gains_stopped: Optional[bool] = default(False)
    ground_gains_detrained: Optional[bool] = default(False)
    ground_loses_entrained: Optional[bool] = default(False)
    ground_min_change: Optional[float] = default(0.1)
    ground_rest_time: Optional[float] = default(1.0)
    artificial_viscosity: Optional[float] = default(100.0)
    columns: Optional[Literal["vertical", "across_flow"]] = default("vertical")
    mixing_rate: Optional[float] = default(8.0)
    bonds: Optional[bool] = default(True)
    max_strain: Optional[float] = default(0.2)
    bond_modulus: Optional[float] = default(50000.0)
    min_bond_length: Optional[float] = default(0.001)
    entrained_density: Optional[float] = default(100.0)
    erosion_energy: Optional[float] = default(5000.0)
    entrainment_shear: Optional[float] = default(0.0)
    entrainment_work: Optional[float] = default(0.0)
    split_ratio: Optional[float] = default(1.5)
    stop_ratio: Optional[float] = default(0.01)
    threads: Optional[int] = default(0)

    RESOLUTION: ClassVar[str] = "cell"
