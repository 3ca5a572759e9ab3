"""Choice of a winter's column of snow, if several of a station contradict each other.

New snow measured by hand is preferred to the gauge, and the gauge to the depth of the cover. Two
columns contradict each other in a winter if, on the days with a value in both, one has more than
twice the snow of the other and a decimetre more. Errors of gauge and depth make the snow too
small: wind carries snow past gauges, which catch half of it or less (Goodison, Louie and Yang 1998,
WMO/TD-872), unheated gauges stand still, and a cover settles while it grows. Therefore the larger
of the two is used. The depth replaces new snow by hand if it rises by more, because no cover rises
by more than the snowfall. If new snow by hand is 0 all winter, it was not entered, and gauge or
depth replace it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from snowshed.base.arrays import Booleans, Floats
from snowshed.season.weather.source import SnowSource

CONTRADICTION = 2.0  # ratio of two columns over a winter
MIN_DIFFERENCE = 0.1  # m over a winter
MAX_COLD_TEMPERATURE = -4.0  # degrees C; on colder days all precipitation is snow


@dataclass(frozen=True)
class StationColumn:
    """The new snow in one column of a station.

    Attributes
    ----------
    source
        Source of the column.
    snow : (n,)
        New snow of each day, m; NaN: unknown.
    filled : (n,)
        Whether the value of a day was not observed on that day.
    """

    source: SnowSource
    snow: Floats
    filled: Booleans

    @property
    def known(self) -> Booleans:
        """Whether the column observed the snow of each day (n,)."""
        return np.asarray(~np.isnan(self.snow) & ~self.filled)


@dataclass(frozen=True)
class StationChoice:
    """The columns for a winter's snow.

    Attributes
    ----------
    observing
        Columns in order of preference; a day uses the first with a value.
    filling
        The column that fills the remaining days, if any.
    sums
        Sum of each column over the days that all compared columns cover, m.
    contradicted
        Sources that are left out or used last, because another source contradicts them.
    """

    observing: Sequence[SnowSource]
    filling: SnowSource | None
    sums: Mapping[SnowSource, float]
    contradicted: frozenset[SnowSource] = frozenset()


class Chooser:
    """Chooses the columns for the winters of a station.

    Parameters
    ----------
    columns
        Columns by their sources.
    temperature : (n,)
        Temperature of every day, degrees C.
    only
        The only source that observes; None: chosen by the rules of this module.
    """

    def __init__(
        self,
        columns: Mapping[SnowSource, StationColumn],
        temperature: Floats,
        only: SnowSource | None = None,
    ) -> None:
        self.only = only
        self._cold = temperature <= MAX_COLD_TEMPERATURE
        everything = np.ones(len(temperature), dtype=bool)
        self._all = {
            source: column
            for source, column in columns.items()
            if _is_informative(column, everything)
        }
        idle = {source for source in self._all if source is not only and self._idle(source)}
        self._idle_columns = idle
        self.columns = {
            source: column for source, column in self._all.items() if source not in idle
        }
        self._gauge_fails = SnowSource.DEPTH in self._against(SnowSource.GAUGE, everything)

    def of(self, winter: Booleans) -> StationChoice:
        """Return the columns for the days of a winter (n,)."""
        there = {
            source for source, column in self.columns.items() if _is_informative(column, winter)
        }
        sums = self._sums(winter)
        if self.only is not None:
            others = [source for source in self.columns if source is not self.only]
            return StationChoice([self.only], others[0] if others else None, sums)
        with_hand = SnowSource.HAND in self.columns
        choice = (self._with_hand if with_hand else self._without_hand)(winter, there, sums)
        if max(sums.values(), default=0.0) <= MIN_DIFFERENCE:
            return choice
        unkept = {source for source in self._idle_columns if source in sums}
        return replace(choice, contradicted=choice.contradicted | unkept)

    def _with_hand(
        self, winter: Booleans, there: set[SnowSource], sums: Mapping[SnowSource, float]
    ) -> StationChoice:
        order = [source for source in (SnowSource.HAND, SnowSource.DEPTH) if source in there]
        stronger = self._against(SnowSource.HAND, winter)
        none_by_hand = sums.get(SnowSource.HAND, 0.0) == 0.0 and SnowSource.HAND in there
        wrong: set[SnowSource] = set()
        if SnowSource.DEPTH in stronger:
            order = [SnowSource.DEPTH, SnowSource.HAND]
            wrong.add(SnowSource.HAND)
        elif SnowSource.GAUGE in stronger and none_by_hand and self._cold_gauge(winter):
            return StationChoice(
                [SnowSource.GAUGE, *order], None, sums, frozenset({SnowSource.HAND})
            )
        filling: SnowSource | None = None
        if SnowSource.GAUGE in there:
            agrees = not any(self._contradict(SnowSource.GAUGE, source, winter) for source in order)
            filling = SnowSource.GAUGE if agrees and not self._gauge_fails else None
        return StationChoice(order, filling, sums, frozenset(wrong))

    def _without_hand(
        self, winter: Booleans, there: set[SnowSource], sums: Mapping[SnowSource, float]
    ) -> StationChoice:
        if SnowSource.DEPTH in self._against(SnowSource.GAUGE, winter):
            return StationChoice([SnowSource.DEPTH], None, sums, frozenset({SnowSource.GAUGE}))
        if SnowSource.GAUGE in self._against(SnowSource.DEPTH, winter):
            return StationChoice([SnowSource.GAUGE], None, sums, frozenset({SnowSource.DEPTH}))
        if self._gauge_fails and SnowSource.DEPTH in there:
            return StationChoice([SnowSource.DEPTH], None, sums)
        if self._gauge_fails:
            return StationChoice([], SnowSource.GAUGE, sums)
        return StationChoice(
            [source for source in (SnowSource.GAUGE, SnowSource.DEPTH) if source in there],
            None,
            sums,
        )

    def _against(self, source: SnowSource, days: Booleans) -> set[SnowSource]:
        """Return the sources that contradict a column because they have more snow."""
        return {
            other
            for other in self.columns
            if other is not source
            and source in self.columns
            and self._contradict(other, source, days)
            and np.subtract(*self._pair(other, source, days)) > 0.0
        }

    def _contradict(self, first: SnowSource, other: SnowSource, days: Booleans) -> bool:
        if first not in self.columns or other not in self.columns:
            return False
        less, more = sorted(self._pair(first, other, days))
        return bool(more > CONTRADICTION * less and more - less > MIN_DIFFERENCE)

    def _pair(
        self, reference: SnowSource, other: SnowSource, days: Booleans
    ) -> tuple[float, float]:
        """Return the sums of two columns on the days of both."""
        first, second = self.columns[reference], self.columns[other]
        both = days & first.known & second.known
        return float(first.snow[both].sum()), float(second.snow[both].sum())

    def _cold_gauge(self, winter: Booleans) -> bool:
        """Return whether the gauge has precipitation on days too cold for rain."""
        gauge = self.columns[SnowSource.GAUGE]
        return float(gauge.snow[winter & gauge.known & self._cold].sum()) > MIN_DIFFERENCE

    def _sums(self, winter: Booleans) -> dict[SnowSource, float]:
        """Return the sum of each column on the common days of columns with data in the winter."""
        there = [column for column in self._all.values() if column.known[winter].any()]
        both = winter.copy()
        for column in there:
            both &= column.known
        days = both if both.any() else winter
        return {
            column.source: float(np.nansum(column.snow[days & column.known])) for column in there
        }

    def _idle(self, source: SnowSource) -> bool:
        """Return whether a column is zero throughout the file although another one has snow."""
        own = self._all[source]
        if np.nansum(own.snow) > 0.0:
            return False
        for other, column in self._all.items():
            both = own.known & column.known
            if other is SnowSource.GAUGE:
                both &= self._cold
            least = MIN_DIFFERENCE if SnowSource.HAND in (source, other) else 0.0
            if other is not source and float(column.snow[both].sum()) > least:
                return True
        return False


def _is_informative(column: StationColumn, days: Booleans) -> bool:
    """Return whether a column has a value on any of some days."""
    return bool((days & ~np.isnan(column.snow)).any())
