"""The winter that all runs of a study have in common, if they are seasons."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.scene.scene import ResolvedScene
from snowshed.season.accumulation import snow_on_panel, stack_ageing
from snowshed.season.settings import SeasonSettings
from snowshed.season.slabs import season_scene
from snowshed.season.weather.reading import read_season
from snowshed.season.weather.row import Weather
from snowshed.study.named_laws import NamedLaws
from snowshed.study.scene_hash import RunKey

if TYPE_CHECKING:
    import pandas as pd

WEATHER = "weather"
#: Parameters of a scene that the winter sets.
SEASON_PATHS = ("slab.thickness", "slab.layers", "events.count", "bodies")


@checked
@dataclass(frozen=True)
class SeasonPart:
    """A winter, with the settings for gathering and release of its snow.

    Attributes
    ----------
    weather
        A season file, a DataFrame, or rows of `Weather`, as for `snowshed.season.run_season`.
    settings
        Settings of release, density, strength and settling; the same in all runs.

    Examples
    --------
    >>> from datetime import datetime
    >>> from snowshed import Scene
    >>> from snowshed.study import SeasonPart, Study
    >>> winter = [Weather(2, datetime(2024, 12, 1), 0.3, 100.0, -4.0)]
    >>> study = Study.product(
    ...     Scene.preset("lab-50").set("dimension", 2), {"panel.height": [0.3, 0.5]},
    ...     season=SeasonPart(winter, SeasonSettings(friction=0.5)),
    ... )
    >>> len(study.runs())
    2
    """

    weather: Union[PathLike, pd.DataFrame, Sequence[Weather]]
    settings: SeasonSettings = field(default_factory=SeasonSettings)

    @classmethod
    def of(cls, given: Mapping[str, object], folder: Path) -> SeasonPart:
        """Return the part that a table of a study file describes; its file is relative to `folder`.

        Raises
        ------
        InputError
            If a key is unknown, or a value is not allowed.
        """
        kinds = {field.name: field for field in fields(SeasonSettings)}
        for key in given:
            if key != WEATHER and key not in kinds:
                allowed = ", ".join((WEATHER, *kinds))
                raise InputError(f"season.{key}: unknown key; allowed: {allowed}")
        name = given.get(WEATHER)
        if not isinstance(name, str) or not name:
            raise InputError(f"season.{WEATHER}: missing; give the name of a season file")
        chosen: dict[str, Any] = {
            key: _setting(key, value) for key, value in given.items() if key != WEATHER
        }
        try:
            return cls(folder / name, SeasonSettings(**chosen))
        except InputError as error:
            raise InputError(f"season: {error}") from None

    @cached_property
    def rows(self) -> Sequence[Weather]:
        """The rows of the winter; raises InputError where the file is wrong."""
        return read_season(self.weather)

    def run(self, scene: ResolvedScene, laws: Optional[NamedLaws] = None) -> RunKey:
        """Return the slide-offs of the winter from the panel of a scene as a run.

        Raises
        ------
        InputError
            If the scene has no panel, or no snow is released.
        """
        data = scene.data
        if "panel" not in data:
            raise InputError("/panel: missing; a season needs a panel for the snow to gather on")
        days = snow_on_panel(self.rows, self.settings, data["panel"]["tilt"], data["gravity"])
        if not any(day.event for day in days):
            raise InputError("no snow slides off all winter; there is nothing to compute")
        resolved = season_scene(scene, days, self.settings)
        return RunKey.of(resolved, stack_ageing(days, self.settings), laws)

    def data(self) -> dict[str, object]:
        """Return the table of a study file that `of` reads.

        Raises
        ------
        InputError
            If the winter is not in a file.
        """
        if not isinstance(self.weather, (str, os.PathLike)):
            raise InputError(
                "season: its weather is not in a file, and a study file needs the file's name"
            )
        usual = asdict(SeasonSettings())
        own = {key: value for key, value in asdict(self.settings).items() if value != usual[key]}
        written = {key: "none" if value is None else value for key, value in own.items()}
        return {WEATHER: os.fspath(Path(self.weather).absolute()), **written}


def _setting(key: str, value: object) -> object:
    """Return a setting for `SeasonSettings`; "none" switches off settings that may be None."""
    usual = getattr(SeasonSettings(), key)
    may_be_none = key in ("settling", "sintering", "strength", "thaw")
    if may_be_none and value == "none":
        return None
    numbers: tuple[type, ...] = (int, float) if key == "cover" or _is_number(usual) else ()
    wanted = numbers if numbers and key != "cover" else (*numbers, str)
    if isinstance(value, bool) or not isinstance(value, wanted):
        what = "a number" if numbers else "a name"
        raise InputError(f"season.{key}: {value!r} is not {what}")
    return value


def _is_number(value: Optional[object]) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
