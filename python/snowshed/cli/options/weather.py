"""The options of commands that read the weather of winters."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH
from snowshed.season.weather.source import AUTO, CHOICES

Command = TypeVar("Command", bound=Callable[..., Any])


class ShareType(click.ParamType):  # type: ignore[type-arg]  # click 8.1 has no parameter
    """A share from 0 to 1, or in percent from 0 to 100 with or without its sign."""

    name = "share"

    def convert(self, value: Any, param: Any, ctx: Any) -> float:
        """Return the share.

        Examples
        --------
        >>> [ShareType().convert(text, None, None) for text in ("0.9", "90", "90 %")]
        [0.9, 0.9, 0.9]
        """
        text = str(value).strip()
        try:
            number = float(text.removesuffix("%"))
        except ValueError:
            number = -1.0
        share = number / 100.0 if text.endswith("%") or number > 1.0 else number
        if not 0.0 <= share <= 1.0:
            raise InputError(f"--coverage: {text!r}; allowed: 0 to 1, such as 0.9, or 0 to 100 %")
        return share


def weather_options(command: Command) -> Command:
    """Add --coverage, --snow-from and --temperature."""
    options = (
        click.option(
            "--coverage",
            type=ShareType(),
            default=0.9,
            show_default=True,
            help="Share of the days of the snow season on which a winter's snow must have been "
            "observed.",
        ),
        click.option(
            "--snow-from",
            type=click.Choice((AUTO, *CHOICES)),
            default=AUTO,
            show_default=True,
            help="Column of a station file that observes new snow; auto takes the best of each "
            "winter.",
        ),
        click.option(
            "--temperature",
            metavar="FILE",
            type=PATH,
            help="Another weather file of the station, whose temperatures come first; or a table "
            "with the columns date and temperature_c.",
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command
