"""A season that is simulated again from its season.json alone."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.results.computed_record import SEASON
from snowshed.scene.scene import ResolvedScene
from snowshed.season.driver import SeasonPlan, plan_record
from snowshed.season.settings import SeasonSettings, settings_of
from snowshed.season.weather.rows_data import weather_of


def recorded_season(record: Mapping[str, Any], file: Path) -> tuple[SeasonPlan, SeasonSettings]:
    """Return the plan of a recorded season, and its settings.

    Parameters
    ----------
    record, file
        The content of its season.json, and the file for messages.

    Raises
    ------
    InputError
        If the record is damaged.
    """
    try:
        inputs = record[SEASON]
        settings = settings_of(inputs["settings"])
        weather = weather_of(inputs["weather"], f"{file}: weather")
        scene = ResolvedScene.from_data(inputs["scene"])
        return plan_record(weather, scene, settings, inputs["coverage"]), settings
    except (AttributeError, KeyError, TypeError) as error:
        raise InputError(f"{file}: damaged: {error}") from None
