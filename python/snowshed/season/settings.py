"""The settings of accumulation, release and ageing in a season."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.running.ageing.ageing import Ageing, Interval
from snowshed.season.rows import SINGLE_ROW, PanelRows
from snowshed.season.weather.checks import USUAL
from snowshed.season.weather.columns import MeasuredColumn
from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY
from snowshed.snow.relations.relation import check_choice, choose
from snowshed.snow.relations.settling import SETTLING_LAWS, SettlingLaw
from snowshed.snow.relations.sintering import SINTERING_LAWS
from snowshed.snow.relations.strength import TENSILE_STRENGTH

COVERS = ("weather", "none")  # or a depth
#: Criteria for wet snow. Snow slid off panels in air warmer than -I / `SUNSHINE_PER_DEGREE` degrees
#: C, where I is the irradiance of the panel, W/m2 (Marion et al. 2013, Solar Energy 97, 112-121).
THAWS = ("marion-2013",)
SUNSHINE_PER_DEGREE = 80.0  # W/m2 per degree C
#: Melt, kg/m2 (mm of water) per day and degree above 0 degrees C, in the middle of the values for
#: snow in Hock 2003, J. Hydrol. 282, 104-115, which differ by a factor of four.
DEGREE_DAY_FACTOR = 4.0
DAY = 86400.0  # s


_RANGES = {
    "friction": MeasuredColumn(0.0, 10.0, "", usual=USUAL["friction"]),
    "adhesion": MeasuredColumn(0.0, 1e6, "Pa", usual=USUAL["adhesion"]),
    "catch": MeasuredColumn(0.0, 1.0, ""),
    "cover": MeasuredColumn(0.0, 10.0, "m"),
    "pool_below": MeasuredColumn(0.0, 10.0, "m", usual=(1e-3, 1.0)),
    "melt_factor": MeasuredColumn(0.0, 100.0, "kg/m2 per day and degree", usual=(0.5, 20.0)),
}


@checked
@dataclass(frozen=True)
class SeasonSettings:
    """The settings of accumulation, release and ageing.

    Attributes
    ----------
    friction
        Static Coulomb coefficient between snow and panel. The laboratory measured 0.6 to 0.8 on
        Plexiglas (thesis 2.1). Sliding snow has the friction of the scene's panel.
    adhesion
        Adhesion of the snow to the panel, Pa.
    catch
        Part of the snowfall that the panel catches; wind blows the rest past it.
    density
        Name of the relation (`NEW_SNOW_DENSITY`) for rows without a density.
    settling
        Name of a law in `SETTLING_LAWS` for the snow on the panel, in the stack and on the ground;
        None: no settling.
    sintering
        Name of a law in `SINTERING_LAWS`, by which broken snow in the stack regains strength
        between events; None: no sintering.
    strength_age
        Age at which bonds reach the strength of the sliding snow, hours.
    strength
        Name of a relation in `TENSILE_STRENGTH`, which scales the strength and stiffness of a slab
        with its density; None: all slabs have the strength of the scene's snow.
    cover
        Natural snow cover on the ground, below the stack: "weather" (depth of the season file, or
        from its snowfalls), "none", or a constant depth in m.
    pool_below
        Releases are combined into one slide-off until their slab has at least this thickness, m
        normal to the panel; 0: each slides alone.
    melt_factor
        Melt of the snow on panel and ground and in the stack, kg/m2 (mm of water) per day and
        degree of the air above 0 degrees C. The stack melts in the table only, and not as long as
        there is a natural cover whose melt lowers it already.
    thaw
        Name of a criterion in `THAWS` for wet snow, which does not adhere to the panel; None: the
        adhesion does not depend on the weather.
    rows
        Rows of panels that stand behind each other; by default there is only the scene's panel.

    Raises
    ------
    InputError
        If a value is not allowed.
    """

    friction: float = 0.7
    adhesion: float = 0.0
    catch: float = 1.0
    density: str = "hedstrom-pomeroy-1998"
    settling: Optional[str] = "vionnet-2012"
    sintering: Optional[str] = None
    strength_age: float = 24.0
    strength: Optional[str] = "sigrist-2006"
    cover: Union[str, float] = "weather"
    pool_below: float = 0.0
    melt_factor: float = DEGREE_DAY_FACTOR
    thaw: Optional[str] = THAWS[0]
    rows: PanelRows = SINGLE_ROW

    def __post_init__(self) -> None:
        _RANGES["friction"].check(self.friction, "friction")
        _RANGES["adhesion"].check(self.adhesion, "adhesion")
        _RANGES["catch"].check(self.catch, "catch")
        choose(self.density, NEW_SNOW_DENSITY, "density")
        check_choice("strength", self.strength, TENSILE_STRENGTH)
        check_choice("settling", self.settling, SETTLING_LAWS)
        check_choice("sintering", self.sintering, SINTERING_LAWS)
        check_choice("thaw", self.thaw, THAWS)
        if not isinstance(self.cover, str):
            _RANGES["cover"].check(self.cover, "cover")
        elif self.cover not in COVERS:
            raise InputError(f"cover: {self.cover!r}; allowed: weather, none, a depth in m")
        _RANGES["pool_below"].check(self.pool_below, "pool_below")
        _RANGES["melt_factor"].check(self.melt_factor, "melt_factor")
        self.ageing({})

    @property
    def notes(self) -> list[str]:
        """Notes on unusual values, which results repeat.

        Examples
        --------
        >>> SeasonSettings(adhesion=30.0).notes
        []
        """
        return [
            note
            for name, column in _RANGES.items()
            if not isinstance(getattr(self, name), str)
            for note in column.unusual(getattr(self, name), name)
        ]

    def ageing(self, pauses: Mapping[int, Sequence[Interval]]) -> Ageing:
        """Return the ageing of the stack in the pauses before the events."""
        return Ageing(pauses, self.settling, self.sintering, self.strength_age)

    @property
    def ages(self) -> bool:
        """True if the stack settles or sinters."""
        return bool(self.settling or self.sintering)

    def melt(self, temperature: float, seconds: float) -> float:
        """Return the melt in some time at a temperature of the air, degrees C, kg/m2.

        Examples
        --------
        >>> SeasonSettings().melt(3.0, 43200.0), SeasonSettings().melt(-3.0, 43200.0)
        (6.0, 0.0)
        """
        return self.melt_factor * max(temperature, 0.0) * seconds / DAY

    def is_wet(self, temperature: float, irradiance: float = 0.0) -> bool:
        """Return whether snow on the panel is wet.

        Parameters
        ----------
        temperature
            Temperature of the air, degrees C.
        irradiance
            Irradiance of the panel's plane, W/m2.

        Examples
        --------
        >>> SeasonSettings().is_wet(-2.0), SeasonSettings().is_wet(-2.0, irradiance=200.0)
        (False, True)
        """
        return self.thaw is not None and temperature > -max(irradiance, 0.0) / SUNSHINE_PER_DEGREE

    @property
    def settling_law(self) -> Optional[SettlingLaw]:
        """The law of settling, if there is one."""
        return None if self.settling is None else SETTLING_LAWS[self.settling]


def settings_of(data: Mapping[str, Any]) -> SeasonSettings:
    """Return the settings from JSON data of `dataclasses.asdict`.

    Examples
    --------
    >>> from dataclasses import asdict
    >>> settings_of(asdict(SeasonSettings(friction=0.5))).friction
    0.5
    """
    return SeasonSettings(**{**data, "rows": PanelRows(**data["rows"])})
