"""The origin of a day's new snow."""

from __future__ import annotations

from enum import Enum


class SnowSource(Enum):
    """Origin of the new snow of a day.

    Examples
    --------
    >>> SnowSource.DEPTH.label, SnowSource.DEPTH.observed, SnowSource.FILLED.observed
    ('snow depth', True, False)
    """

    GIVEN = "season file"  # the column snowfall_m of the user's own table
    HAND = "new snow"  # measured as new snow: on a board, or by the provider
    DEPTH = "snow depth"  # the rise of the depth sensor or the stake
    GAUGE = "precipitation"  # the water of a gauge, turned into snow by the temperature
    MODEL = "typical year"  # precipitation and temperature of a year assembled from several
    FILLED = "filled"  # by a rule, from a less trusted column or over a gap
    MISSING = "missing"  # unknown; no snow is laid on that day

    @property
    def label(self) -> str:
        """The name of the source in tables."""
        return self.value

    @property
    def observed(self) -> bool:
        """Whether the snow of such a day was observed."""
        return self not in (SnowSource.FILLED, SnowSource.MISSING)


#: Names of the sources in options (`--snow-from`).
CHOICES = {"new-snow": SnowSource.HAND, "depth": SnowSource.DEPTH, "gauge": SnowSource.GAUGE}
AUTO = "auto"
