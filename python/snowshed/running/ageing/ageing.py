"""Settling and sintering of a simulated stack between two slide-offs.

Settling lowers the particles by the shortening of the snow below them, and compacts them: the
strain goes into the volumetric plastic strain, which hardens them as any compaction does. Sintering
gives strength back to broken snow: it lowers the volumetric plastic strain until the yield surface
has the size of bonds of that age, and at most its initial size. Elastic stresses stay.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any, NamedTuple, Optional, Union

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked, is_number
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.field_type import shown
from snowshed.base.json_values import JsonObject
from snowshed.base.messages import shortened
from snowshed.base.notes import issue_note
from snowshed.running.ageing.columns import SnowColumns
from snowshed.scene.resolved import snows_of
from snowshed.snow.relations.relation import check_choice
from snowshed.snow.relations.settling import SETTLING_LAWS, settled_densities
from snowshed.snow.relations.sintering import SINTERING_LAWS

# The volume of loosened snow has no meaning; the laws hold for connected snow only.
MIN_DENSITY = 50.0  # kg/m3
ABSOLUTE_ZERO = -273.15  # degrees C
MAX_TEMPERATURE = 60.0  # degrees C, of the air; more is in kelvin or degrees F
MIN_PAUSE = 60.0  # s; less is probably in hours or days
FIRST_EVENT = 2  # that follows a pause


class Interval(NamedTuple):
    """A time at one temperature: s, degrees C."""

    seconds: float
    temperature: float


@checked
@dataclass(frozen=True)
class Ageing:
    """The ageing of a stack before each event.

    Attributes
    ----------
    pauses
        Time that passes before an event, by its number (2 is the second).
    settling
        A name in `SETTLING_LAWS`; None: the stack does not settle.
    sintering
        A name in `SINTERING_LAWS`; None: broken bonds stay broken.
    strength_age
        Age at which bonds reach the strength of the slab's snow, hours.

    Raises
    ------
    InputError
        If a value is not allowed.

    Examples
    --------
    >>> day = Interval(86400.0, -5.0)
    >>> Ageing({2: [day], 3: [day, day]}, settling="vionnet-2012").hours(3)
    48.0
    """

    pauses: Mapping[int, Sequence[Interval]] = field(default_factory=dict)
    settling: Optional[str] = None
    sintering: Optional[str] = None
    strength_age: float = 24.0

    def __post_init__(self) -> None:
        check_choice("settling", self.settling, SETTLING_LAWS)
        check_choice("sintering", self.sintering, SINTERING_LAWS)
        if not 0.0 < self.strength_age < np.inf:
            raise InputError(f"strength_age: {self.strength_age} hours; must be positive")
        pauses = {
            event: [_plain(pause, f"pauses[{event}][{at}]") for at, pause in enumerate(intervals)]
            for event, intervals in self.pauses.items()
        }
        first = min(pauses, default=FIRST_EVENT)
        if first < FIRST_EVENT:
            raise InputError(
                f"pauses: no pause is before event {first}; {FIRST_EVENT} is the first"
            )
        object.__setattr__(self, "pauses", pauses)

    @classmethod
    def from_data(cls, data: object, where: str) -> Ageing:
        """Return the ageing for the output of the property `data`.

        Parameters
        ----------
        data
            JSON data from any source; the data are checked.
        where
            Place of the data, for messages.

        Raises
        ------
        InputError
            If the data are invalid.

        Examples
        --------
        >>> one = Ageing({2: [Interval(86400.0, -5.0)]}, settling="vionnet-2012")
        >>> Ageing.from_data(one.data, "ageing") == one
        True
        """
        names = {field.name for field in fields(cls)}
        if not isinstance(data, dict) or set(data) != names:
            raise InputError(f"{where}: needed: an object with {', '.join(sorted(names))}")
        pauses = data["pauses"]
        if not isinstance(pauses, dict):
            raise InputError(f"{where}/pauses: not an object")
        read = {_event(key, where): _intervals(pauses[key], where) for key in pauses}
        for name in ("settling", "sintering"):
            if not isinstance(data[name], (str, type(None))):
                raise InputError(f"{where}/{name}: neither a name nor null")
        age = data["strength_age"]
        if not _is_number(age):
            raise InputError(f"{where}/strength_age: not a number")
        return cls(read, data["settling"], data["sintering"], float(age))

    @property
    def data(self) -> JsonObject:
        """The ageing as JSON data."""
        data: JsonObject = json.loads(json.dumps(asdict(self)))
        return data

    def notes(self, events: int) -> list[str]:
        """Return notes on pauses that change nothing in a run of a number of events.

        Examples
        --------
        >>> Ageing({9: [Interval(86400.0, -5.0)]}, settling="vionnet-2012").notes(5)
        ['ageing: no pause is before event 9, because the scene has 5']
        """
        beyond = [event for event in self.pauses if event > events]
        notes = [
            f"ageing: no pause is before event {event}, because the scene has {events}"
            for event in beyond
        ]
        if self.pauses and not (self.settling or self.sintering):
            notes.append("ageing: neither settling nor sintering; the pauses change nothing")
        return notes

    def hours(self, event: int) -> float:
        """Return the time before an event, h."""
        return sum(interval.seconds for interval in self.pauses.get(event, ())) / 3600.0

    def apply(
        self, simulation: _core.Simulation, event: int, gravity: float
    ) -> Optional[dict[str, float]]:
        """Age the stack by the time before an event; return its row of ageing.csv, if any.

        Snow that lies on the panel does not age: the next slab is laid on it at once. The gravity
        of the scene, m/s2, makes the stack settle.
        """
        seconds = 3600.0 * self.hours(event)
        if not seconds or not (self.settling or self.sintering):
            return None
        snow = _AgeingSnow(simulation, gravity)
        strains = self._strains(snow, event)
        drops = np.zeros(len(snow.masses))
        drops[snow.stack] = snow.columns.drops(strains)
        compaction = np.zeros(len(snow.masses))
        compaction[snow.stack] = snow.columns.at_particles(strains)
        aged = self._sinter(snow, snow.plastic_strains - compaction, seconds)
        changes = aged - snow.plastic_strains
        simulation.settle(drops, changes)
        return {
            "event": event,
            "hours": seconds / 3600.0,
            "temperature_c": self._mean_temperature(event),
            "crest_sank_m": snow.crest(0.0) - snow.crest(drops),
            "density_before_kg_m3": snow.mean_density(0.0),
            "density_kg_m3": snow.mean_density(changes),
            "intact_before": snow.intact(snow.plastic_strains),
            "intact": snow.intact(aged),
        }

    def _strains(self, snow: _AgeingSnow, event: int) -> Floats:
        """Return the logarithmic shortening at the nodes of the columns."""
        nodes = snow.columns
        if self.settling is None or not snow.yields.any():  # elastic snow does not compact
            return np.zeros(nodes.densities.shape)
        before = np.maximum(nodes.densities, MIN_DENSITY)
        stress, after = nodes.stresses(snow.gravity), before
        for interval in self.pauses[event]:
            after = settled_densities(SETTLING_LAWS[self.settling], after, stress, *interval)
        strains: Floats = np.log(after / before)
        return strains

    def _sinter(self, snow: _AgeingSnow, plastic_strains: Floats, seconds: float) -> Floats:
        """Return the plastic strains of snow with the strength after sintering."""
        if self.sintering is None:
            return plastic_strains
        strength = snow.strengths(plastic_strains)
        age = seconds / (3600.0 * self.strength_age)
        grown = SINTERING_LAWS[self.sintering].strengthen(strength, age)
        healed = (grown > strength) & snow.stack
        return np.where(healed, snow.plastic_strains_of(grown), plastic_strains)

    def _mean_temperature(self, event: int) -> float:
        seconds, temperatures = np.array(self.pauses[event]).T
        return float(np.average(temperatures, weights=seconds))


def _plain(interval: Interval, where: str) -> Interval:
    """Return a checked interval of Python's own numbers, which JSON can hold."""
    for name, value in interval._asdict().items():
        if not _is_number(value):
            raise InputError(f"{where}, {name}: {shown(value)}; needed: a finite number")
    if interval.seconds < 0:
        raise InputError(f"{where}, seconds: {interval.seconds:g}; needed: not negative")
    if interval.temperature < ABSOLUTE_ZERO:
        raise InputError(
            f"{where}, temperature: {interval.temperature:g} °C is below absolute zero "
            f"({ABSOLUTE_ZERO} °C)"
        )
    if interval.temperature > MAX_TEMPERATURE:
        raise InputError(
            f"{where}, temperature: {interval.temperature:g} °C; at most {MAX_TEMPERATURE:g} °C "
            "are allowed; is it in kelvin or degrees F?"
        )
    if 0 < interval.seconds < MIN_PAUSE:
        issue_note(f"{where}, seconds: {interval.seconds:g} s is unusual; is it in hours or days?")
    return Interval(*map(float, interval))


def _is_number(value: object) -> bool:
    return is_number(value) and bool(abs(value) < np.inf)  # type: ignore[arg-type]


def _event(key: object, where: str) -> int:
    if not (isinstance(key, str) and key.isdecimal() and key.isascii() and len(key) < 8):
        raise InputError(f"{where}/pauses: {shortened(str(key))} is not the number of an event")
    return int(key)


def _intervals(given: object, where: str) -> list[Interval]:
    pairs = given if isinstance(given, list) else []
    sound = [
        Interval(float(pair[0]), float(pair[1]))
        for pair in pairs
        if isinstance(pair, list) and len(pair) == 2 and all(map(_is_number, pair)) and pair[0] >= 0
    ]
    if not isinstance(given, list) or len(sound) < len(pairs):
        raise InputError(f"{where}/pauses: not pairs of seconds and a temperature")
    return sound


class _AgeingSnow:
    """The snow of a simulation between two events, with its hardening law (1.1.42)."""

    def __init__(self, simulation: _core.Simulation, gravity: float) -> None:
        self.gravity = gravity
        self.masses = simulation.masses()
        self.plastic_strains = simulation.plastic_strains()
        self.positions, densities = simulation.positions(), simulation.densities()
        self.stack: Booleans = ~simulation.on_panel()
        self.columns = SnowColumns(
            self.positions[self.stack],
            self.masses[self.stack],
            densities[self.stack],
            simulation.dimension,
            simulation.resolution,
        )
        snows = snows_of(simulation)
        self._kinds = simulation.material_ids()
        self._laws = [_law(snow) for snow in snows]
        self._p0 = np.array([snow["preconsolidation_pressure"] for snow in snows])[self._kinds]
        self.yields = np.array([law is not None for law in self._laws])[self._kinds]
        self._densities = densities

    def strengths(self, plastic_strains: Floats) -> Floats:
        """Return p0 relative to undisturbed snow; 1 for snow that does not yield."""
        strengths = np.ones(len(plastic_strains))
        for law, own in self._kinds_that_yield():
            strengths[own] = law.preconsolidation(plastic_strains[own]) / self._p0[own]
        return strengths

    def plastic_strains_of(self, strengths: Floats) -> Floats:
        """Return the volumetric plastic strains for strengths, the inverse of `strengths`."""
        strains = self.plastic_strains.copy()
        for law, own in self._kinds_that_yield():
            strains[own] = law.initial_plastic_strain(strengths[own] * self._p0[own])
        return strains

    def _kinds_that_yield(self) -> Iterator[tuple[_core.CamClay, Booleans]]:
        for kind, law in enumerate(self._laws):
            if law is not None:
                yield law, self._kinds == kind

    def intact(self, plastic_strains: Floats) -> float:
        """Return the mean strength of the stack; no particle counts as more than intact snow."""
        if not self.stack.any():
            return 1.0
        strength = np.minimum(self.strengths(plastic_strains), 1.0)
        return float(np.average(strength[self.stack], weights=self.masses[self.stack]))

    def mean_density(self, plastic_changes: Union[Floats, float]) -> float:
        """Return the mean density of the stack, its mass over its volume, after plastic changes."""
        masses = self.masses[self.stack]
        volumes = self.masses / self._densities * np.exp(plastic_changes)
        volume = float(volumes[self.stack].sum())
        return float(masses.sum()) / volume if volume else 0.0

    def crest(self, drops: Union[Floats, float]) -> float:
        """Return the height of the highest particle of the stack after the drops, m."""
        heights = (self.positions[:, 2] - drops)[self.stack]
        return float(heights.max()) if len(heights) else 0.0


def _law(snow: Mapping[str, Any]) -> Optional[_core.CamClay]:
    """Return the law of snow; None if the snow does not yield."""
    if snow["model"] != "cam_clay":
        return None
    return _core.CamClay(
        snow["youngs_modulus"],
        snow["poissons_ratio"],
        snow["critical_state_slope"],
        snow["cohesion"],
        snow["hardening_factor"],
    )
