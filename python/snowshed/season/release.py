"""The criterion for the release of snow from a panel."""

from __future__ import annotations

import math
from dataclasses import dataclass

from snowshed.base.arguments import checked
from snowshed.season.weather.columns import COLUMNS, MeasuredColumn

_RANGES = {
    "load": MeasuredColumn(0.0, 1e5, "kg/m2"),
    "tilt": MeasuredColumn(0.0, 90.0, "degrees", usual=(3.0, 90.0)),
    "friction": COLUMNS["friction"],
    "adhesion": COLUMNS["adhesion_pa"],
    "gravity": MeasuredColumn(0.0, 1000.0, "m/s2", usual=(1.0, 30.0)),
}


@dataclass(frozen=True)
class SnowBalance:
    """The driving and the resisting stress of the snow on a panel, Pa."""

    driving: float
    resisting: float

    @property
    def releases(self) -> bool:
        """True if the snow is released."""
        return self.driving > self.resisting


@checked
def snow_balance(
    load: float, tilt: float, friction: float, adhesion: float, gravity: float = 9.81
) -> SnowBalance:
    """Return the downslope part of the snow's weight, and the friction and adhesion against it.

    The snow is released if m g sin(Phi) > mu m g cos(Phi) + a (Mohr-Coulomb). Without adhesion the
    load does not matter: snow is released if tan(Phi) > mu. With adhesion, snow accumulates until m
    = a / (g (sin(Phi) - mu cos(Phi))).

    Parameters
    ----------
    load
        Mass of the snow, kg per m2 of the panel.
    tilt
        Phi, degrees from the horizontal.
    friction
        mu, static Coulomb coefficient between snow and panel.
    adhesion
        a, adhesion, Pa.
    gravity
        Gravity, m/s2.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> snow_balance(10.0, 40.0, 0.7, 0.0).releases, snow_balance(10.0, 30.0, 0.7, 0.0).releases
    (True, False)
    """
    for name, value in (("load", load), ("tilt", tilt), ("friction", friction),
                        ("adhesion", adhesion), ("gravity", gravity)):  # fmt: skip
        _RANGES[name].check(value, name)
    weight = load * gravity
    slope = math.radians(tilt)
    return SnowBalance(weight * math.sin(slope), friction * weight * math.cos(slope) + adhesion)
