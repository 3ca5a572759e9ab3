"""Settings of the material point method."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal, Optional

from snowshed.base.arguments import checked
from snowshed.base.record import Alias, default
from snowshed.methods.settings import MethodSettings

Precision = Literal["float", "double"]
Transfer = Literal["flip", "apic", "affine_flip"]
Scheme = Literal["thesis", "objective"]
Contact = Literal["kernel", "touch"]
Fields = Literal["one", "events"]
Basis = Literal["quadratic", "cubic"]


@checked
@dataclass
class MpmSettings(MethodSettings):
    """Grid, transfer, time step and sleep of the material point method.

    Attributes
    ----------
    dx : float
        Size of grid cells and voxels [m]. 0 < value <= 1e+06; default 0.01.
    scheme : {"thesis", "objective"}
        Mechanisms that belong together: objective sets transfer affine_flip, damping_rate 380 1/s,
        damping_length and crack_band_length 0.01 m, contact touch and fields of events, unless
        they are given; thesis keeps the defaults of these settings. Default "thesis".
    precision : {"float", "double"}
        Floating-point type of the particles and the grid. Default "float".
    transfer : {"flip", "apic", "affine_flip"}
        Transfer of velocities between particles and grid. Default "flip".
    flip_ratio : float
        Share of FLIP in FLIP/PIC in each step, so that shorter steps damp more; 0 is pure PIC. 0
        <= value <= 1; default 0.99.
    damping_rate : float
        Rate of the damping, independent of the time step, in place of flip_ratio [1/s]. 0 <= value
        <= 1e+09.
    damping_length : float
        Length over which affine_flip averages velocities to damp them at the damping rate,
        independent of the grid; 0: the damping is PIC's, over dx [m]. 0 <= value <= 1e+06; default
        0.
    crack_band_length : float
        Width of a crack: dilating snow softens dx/width times as fast as its law, so that a crack
        takes the same energy per area on any grid; 0: the law itself [m]. 0 <= value <= 1e+06;
        default 0.
    relaxation_time : float
        Time in which stress beyond the yield surface relaxes, a viscosity of snow that yields; 0:
        at once, the law itself [s]. 0 <= value <= 1e+09; default 0.
    contact : {"kernel", "touch"}
        Snow on which a node of an obstacle acts: all snow whose splines reach the node (kernel),
        or only snow beside a particle that touches the obstacle itself (touch). Default "kernel".
    contact_radius : float
        Contact radius of a particle, relative to half the spacing of particles. 0 < value <= 1;
        default 0.6.
    fields : {"one", "events"}
        Velocity fields of the grid: one for all snow, which then sticks together on contact, or
        one for the snow of each event, which then touches, slides and separates. Default "one".
    event_friction : float
        With fields of events: friction between the snow of different events, relative to that of
        the snow itself at the critical state, M/sqrt(3). 0 <= value <= 100; default 1.
    basis : {"quadratic", "cubic"}
        B-spline of the grid. Default "quadratic".
    courant_factor : float
        Time step relative to the largest stable time step. 0 < value <= 1; default 0.9; also
        step_factor.
    strain_limit : float
        Largest ``|dt grad v|`` that a step may impose on a particle. 0 < value <= 0.5; default
        0.2.
    sleep_speed : float
        Snow slower than this drops out of the steps until something moves it; 0: never [m/s]. 0 <=
        value <= 10000; default 0.02.
    sleep_time : float
        Time for which snow must stay below sleep_speed without speeding up [s]. 0 <= value <=
        1e+09; default 0.04.
    threads : int
        Threads; 0: all. 0 <= value <= 4096; default 0.
    device : {"cpu", "gpu", "auto"}
        Device that computes the steps: the processor (cpu), a graphics card of NVIDIA (gpu), or a
        card if one is there and can compute the scene (auto). Default "cpu".
    """

    dx: Optional[float] = default(0.01)
    scheme: Optional[Scheme] = default("thesis")
    precision: Optional[Precision] = default("float")
    transfer: Optional[Transfer] = default("flip")
    flip_ratio: Optional[float] = default(0.99)
    damping_rate: Optional[float] = None
    damping_length: Optional[float] = default(0.0)
    crack_band_length: Optional[float] = default(0.0)
    relaxation_time: Optional[float] = default(0.0)
    contact: Optional[Contact] = default("kernel")
    contact_radius: Optional[float] = default(0.6)
    fields: Optional[Fields] = default("one")
    event_friction: Optional[float] = default(1.0)
    basis: Optional[Basis] = default("quadratic")
    courant_factor: Optional[float] = default(0.9)
    strain_limit: Optional[float] = default(0.2)
    sleep_speed: Optional[float] = default(0.02)
    sleep_time: Optional[float] = default(0.04)
    threads: Optional[int] = default(0)
    device: Optional[Literal["cpu", "gpu", "auto"]] = default("cpu")

    RESOLUTION: ClassVar[str] = "dx"
    INSTEAD_OF: ClassVar[Mapping[str, str]] = {"damping_rate": "flip_ratio"}
    ADOPTS: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "scheme": (
            "transfer",
            "flip_ratio",
            "damping_rate",
            "damping_length",
            "crack_band_length",
            "relaxation_time",
            "contact",
            "contact_radius",
            "fields",
            "event_friction",
        )
    }

    def damping_text(self, rate: Optional[float] = None) -> str:
        """Return how PIC damps, for captions; the settings must be complete.

        Examples
        --------
        >>> MpmSettings(transfer="flip", flip_ratio=0.99).damping_text(188.2)
        'damping 188 1/s (FLIP 0.99 per step)'
        >>> MpmSettings(transfer="flip", damping_rate=50).damping_text()
        'damping 50 1/s'
        >>> settings = MpmSettings(transfer="affine_flip", damping_rate=380, damping_length=0.01)
        >>> settings.damping_text()
        'damping 380 1/s over 0.01 m'
        """
        if self.transfer == "apic":
            return "APIC"
        if self.damping_rate is not None:
            over = f" over {self.damping_length:g} m" if self.damping_length else ""
            return f"damping {self.damping_rate:g} 1/s{over}"
        share = f"FLIP {self.flip_ratio:g} per step"
        return share if rate is None else f"damping {rate:.3g} 1/s ({share})"

    step_factor = Alias("courant_factor")  # its name up to version 0.1
