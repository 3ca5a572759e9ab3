"""Sentences about an answer: the answer itself, its assumptions, and warnings."""

from __future__ import annotations

from collections.abc import Sequence

from snowshed.analysis.accuracy.mechanisms import Mechanisms
from snowshed.analysis.accuracy.stack_errors import recorded_bias
from snowshed.analysis.clearance.answer import ClearanceResult
from snowshed.analysis.clearance.panel_design import UNCERTAIN, SnowRanges
from snowshed.base.formatting import plural
from snowshed.season.settings import SeasonSettings
from snowshed.season.weather.season_record import whole_percent

FIRST_PROBABILITY = 0.9  # of the answer's first sentence
#: Number of slide-offs in a typical winter, for which recorded runs give the error of the grid.
TYPICAL_SLIDE_OFFS = 5
CHANCE = "chance: positions of particles, and interactions of causes"


def sentence(answers: Sequence[ClearanceResult]) -> str:
    """Return the answer for the first panel in a sentence."""
    answer = answers[0]
    design = answer.design
    level = next(level for level in answer.levels if level.probability == FIRST_PROBABILITY)
    panel = f" of the panel of {design.slope_length:g} m at {design.tilt:g}°"
    return (
        f"To stay clear of shed snow in 9 of 10 winters, the lower edge"
        f"{panel if len(answers) > 1 else ''} must be at least {level.height:.1f} m above ground "
        f"(90 % interval {level.low:.1f} to {level.high:.1f} m, from {answer.winters_text} and "
        "the uncertain snow parameters, without the error of the grid)."
    )


def cause_label(cause: str) -> str:
    """Return the label of a cause of variance."""
    if cause == "winter":
        return "the winter's weather"
    return CHANCE if cause == "chance" else UNCERTAIN[cause].name


def advice(answer: ClearanceResult) -> str:
    """Return which measurement would reduce the uncertainty of the required height most."""
    shares = [share for share in answer.shares if share.cause in UNCERTAIN]
    if not shares:
        return (
            "There are too few seasons to separate the causes. Use more winters, or more --draws."
        )
    largest = shares[0]
    winter = next((share.part for share in answer.shares if share.cause == "winter"), 0.0)
    return (
        f"Measuring the {UNCERTAIN[largest.cause].name} would reduce the uncertainty most: it "
        f"causes {100 * largest.part:.0f} % of the variance. The winter causes "
        f"{100 * winter:.0f} %, "
        "which no measurement reduces."
    )


def warnings(answers: Sequence[ClearanceResult]) -> list[str]:
    """Return warnings that the answer is extrapolated or incomplete."""
    notes = [*_excluded_winters(answers[0]), _grid_error(answers[0])]
    for answer in answers:
        name = f"{answer.design.slope_length:g} m at {answer.design.tilt:g}°"
        for level in answer.levels:
            if level.height > answer.heights[-1]:
                notes.append(
                    f"{name}: {level.height:.1f} m for {100 * level.probability:g} % lies above "
                    f"all candidate heights (up to {answer.heights[-1]:g} m); give higher --heights"
                )
            elif not level.counted:
                notes.append(
                    f"{name}: {100 * level.probability:g} % is extrapolated (Gumbel) from "
                    f"{plural(len(answer.winters), 'winter')}; counting it needs at least "
                    f"{level.return_period:.0f}"
                )
        if answer.failed:
            notes.append(
                f"{name}: {answer.failed} seasons could not be simulated, and are left out"
            )
    return notes


def _excluded_winters(answer: ClearanceResult) -> list[str]:
    """Return a note on the winters of the file that do not count."""
    record = answer.winter_list
    if record is None or len(record.counted) == len(record.winters):
        return []
    number = plural(len(record.winters) - len(record.counted), "winter")
    return [
        f"the answer uses {record.counted_text}; the snow of {number} was observed on less than "
        f"{whole_percent(record.coverage)} of the days {record.season.text}: {record.excluded_text}"
    ]


def _grid_error(answer: ClearanceResult) -> str:
    """Return a sentence on the grid's error in recorded runs, which no interval contains."""
    scene = answer.cases[0].panel_scene(answer.heights[0]).data
    bias = recorded_bias(2, TYPICAL_SLIDE_OFFS, Mechanisms.of_scene(scene))
    return f"the intervals leave out the error of the grid: {bias}"


def assumptions(answer: ClearanceResult) -> list[str]:
    """Return the assumptions of the seasons, a sentence each."""
    season = answer.cases[0].settings
    return [
        "The panel is long across the slope: the simulation is of a strip (2D).",
        f"Grid cells are {100 * answer.design.dx:.3g} cm wide. Releases thinner than "
        f"{1000 * season.pool_below:.0f} mm slide with those that follow.",
        f"The stack lies on {_ground(season)}, and nobody clears it.",
        _settling(season),
        _strength(season),
        "Melt of the stack, rain, wind drift and snowfall on the stack (except on the cover) are "
        "left out.",
        "Winters are independent of each other: the climate does not change.",
    ]


def _ground(season: SeasonSettings) -> str:
    if season.cover == "weather":
        return "the natural snow cover of the weather file"
    if season.cover in ("none", 0):
        return "bare ground"
    return f"natural snow, {season.cover:g} m deep"


def _settling(season: SeasonSettings) -> str:
    if season.settling is None:
        return "Snow does not settle."
    return f"Snow settles on the panel, in the stack and on the ground ({season.settling})."


def _strength(season: SeasonSettings) -> str:
    if season.strength is None:
        return "Strength and stiffness of a slab do not depend on its density."
    return f"Strength and stiffness of a slab follow from its density ({season.strength})."


def range_rows(ranges: SnowRanges) -> list[tuple[str, str, str]]:
    """Return the uncertain parameters, each with its lowest and highest value."""
    return [
        (UNCERTAIN[name].label, f"{low:g}", f"{high:g}")
        for name, (low, high) in ranges.spans.items()
    ]
