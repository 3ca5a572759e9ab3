"""A season that is simulated again from its season.json alone."""

from __future__ import annotations

from pathlib import Path

from snowshed.results.computed_record import SEASON, recorded_inputs
from snowshed.scene.scene import ResolvedScene
from snowshed.season.driver import SeasonPlan, plan_record
from snowshed.season.settings import SeasonSettings, settings_of
from snowshed.season.weather.rows_data import weather_of


def recorded_season(file: Path) -> tuple[SeasonPlan, SeasonSettings]:
    """Return the plan of a recorded season and its settings, from its season.json.

    Raises
    ------
    InputError
        If the record is damaged.
    """
    with recorded_inputs(file, SEASON) as inputs:
        settings = settings_of(inputs["settings"])
        weather = weather_of(inputs["weather"], f"{file}: weather")
        scene = ResolvedScene.from_data(inputs["scene"])
        return plan_record(weather, scene, settings, inputs["coverage"]), settings
