"""Sentences about an answer: the answer itself, its assumptions, and warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from snowshed.analysis.clearance.answer import ClearanceResult
from snowshed.analysis.clearance.panel_design import MARGIN, UNCERTAIN, SnowRanges
from snowshed.analysis.clearance.seasons import SeasonCase
from snowshed.analysis.clearance.statistics import (
    CHANCE,
    FIRST_PROBABILITY,
    GRID,
    STATISTIC_WINTERS,
    WINTERS,
    CauseShare,
    Level,
)
from snowshed.analysis.clearance.trend import trend_of
from snowshed.base.callers import argument
from snowshed.base.formatting import plural
from snowshed.season.notes import irradiance_share, sunshine_left_out
from snowshed.season.settings import SeasonSettings
from snowshed.season.weather.season_record import whole_percent

#: Most panels that the first sentence lists.
MAX_LISTED = 2
#: A cause is worth removing if the interval becomes narrower by this share.
WORTHWHILE = 0.1


def first_level(answer: ClearanceResult) -> Level:
    """Return the height of the answer's first sentence."""
    return answer.at(FIRST_PROBABILITY)


def sentence(answers: Sequence[ClearanceResult]) -> str:
    """Return the answer for all panels in one or two sentences."""
    heights, winters = _heights(answers), answers[0].winters_text
    fewest = min(answer.snowy_winters for answer in answers)
    if fewest >= STATISTIC_WINTERS:
        return (
            "To stay clear of shed snow in 9 of 10 winters, the lower edge must be at least "
            f"{heights}. The answer is from {winters}."
        )
    snow = "counts" if len(answers[0].winters) == 1 else "count"
    if fewest < len(answers[0].winters):
        winters, snow = plural(fewest, "winter"), "has snow" if fewest == 1 else "have snow"
    worst = "In the worst winter" if len(answers[0].winters) > 1 else "In it"
    return (
        f"This is a scenario, not a statistic, because only {winters} {snow}. {worst}, the lower "
        f"edge had to be at least {heights} to stay clear of shed snow."
    )


def _heights(answers: Sequence[ClearanceResult]) -> str:
    """Return the height of each panel with its interval, or their span if there are many."""
    if len(answers) == 1:
        return _height(answers[0])
    if len(answers) > MAX_LISTED:
        heights = [_numbers(answer)[0] for answer in answers]
        return (
            f"{rounded_up(min(heights)):.1f} to {rounded_up(max(heights)):.1f} m above the ground, "
            "depending on the panel"
        )
    texts = [f"{_height(answer)} for the panel of {panel_name(answer)}" for answer in answers]
    return ", ".join(texts[:-1]) + f" and {texts[-1]}"


def _height(answer: ClearanceResult) -> str:
    height, low, high = _numbers(answer)
    interval = f"90 % interval {low:.1f} to {rounded_up(high):.1f} m"
    return f"{rounded_up(height):.1f} m above the ground ({interval})"


def headline_height(answer: ClearanceResult) -> float:
    """Return the height of the first sentence, rounded up to 10 cm, m."""
    return rounded_up(_numbers(answer)[0])


def rounded_up(height: float) -> float:
    """Return a height, m, rounded up to 10 cm, because a lower edge would not be clear."""
    return math.ceil(10.0 * height - 1e-9) / 10.0


def _numbers(answer: ClearanceResult) -> tuple[float, float, float]:
    if not answer.heights_by_probability.is_statistic:
        return answer.highest
    level = first_level(answer)
    return level.height, level.low, level.high


def panel_name(answer: ClearanceResult) -> str:
    """Return the size and the tilt of a panel, such as "4 m at 60°"."""
    return f"{answer.design.slope_length:g} m at {answer.design.tilt:g}°"


def _rows(answer: ClearanceResult) -> str:
    """Return a sentence on the rows of a plant."""
    rows = answer.design.rows
    if rows.count == 1:
        return "The panel stands alone: no other row sheds snow to it."
    return (
        f"{rows.count} rows stand {rows.pitch:g} m apart, and shed their snow at the same time. "
        "The height is that of the row that needs most."
    )


def cause_label(cause: str, answer: ClearanceResult) -> str:
    """Return the label of a cause of uncertainty."""
    if cause == WINTERS:
        return f"the record of {plural(len(answer.winters), 'winter')}"
    if cause == CHANCE:
        return "chance, by which seasons of one winter differ"
    return "the grid" if cause == GRID else f"the {UNCERTAIN[cause].name}"


def interval_reasons(answer: ClearanceResult) -> str:
    """Return why the interval is as wide as it is, and what would narrow it."""
    shares = answer.shares
    if not shares:
        return "All parameters are known; only the assumptions are uncertain."
    largest = [share for share in shares if share.part >= 0.05] or shares[:1]
    texts = [f"{cause_label(s.cause, answer)} ({100 * s.part:.0f} %)" for s in largest]
    listed = ", ".join(texts[:-1]) + f" and {texts[-1]}" if len(texts) > 1 else texts[0]
    return f"The width of the interval comes from {listed}. {_narrowing(answer)}"


def _narrowing(answer: ClearanceResult) -> str:
    """Return sentences on what would narrow the interval."""
    _, low, high = _numbers(answer)
    helpful = [
        share
        for share in answer.shares
        if share.high - share.low < (1.0 - WORTHWHILE) * (high - low)
    ]
    measurable = [share for share in helpful if share.cause in UNCERTAIN]
    sentences = [
        f"Measuring the {UNCERTAIN[share.cause].name} would narrow it to {_span(share)}."
        for share in measurable[:1]
    ]
    if not sentences and answer.heights_by_probability.separable:
        sentences = ["No measurement of the panel or the snow would narrow it by a tenth."]
    others = {share.cause: share for share in helpful}
    if WINTERS in others:
        sentences.append(f"Many more winters would narrow it to {_span(others[WINTERS])}.")
    if GRID in others:
        sentences.append(f"Without the error of the grid it would be {_span(others[GRID])}.")
    return " ".join(sentences)


def _span(share: CauseShare) -> str:
    return f"{share.low:.1f} to {rounded_up(share.high):.1f} m"


def warnings(answers: Sequence[ClearanceResult]) -> list[str]:
    """Return warnings that the answer is extrapolated or incomplete, each once."""
    panels: dict[str, list[str]] = {}
    for answer in answers:
        for note in _warnings_of(answer):
            panels.setdefault(note, []).append(panel_name(answer))
    return [
        *_excluded_winters(answers[0]),
        *(
            note if len(names) == len(answers) > 1 else f"{', '.join(names)}: {note}"
            for note, names in panels.items()
        ),
    ]


def _warnings_of(answer: ClearanceResult) -> Iterator[str]:
    if answer.is_simulated:
        yield (
            f"the intervals contain the error of the grid, {answer.grid_error.text}; the seasons "
            f"that need most have {plural(answer.slide_offs, 'slide-off')} (median)"
        )
    highest = f"{answer.heights[-1]:g} m"
    reached = sum(outcomes[-1].contact is not None for outcomes in answer.outcomes)
    if reached:
        yield (
            f"{plural(reached, 'season')} {'reaches' if reached == 1 else 'reach'} the highest "
            f"candidate, {highest}, so the heights are estimates; give higher {argument('heights')}"
        )
    for level in answer.levels:
        percentage = f"{100 * level.probability:g} %"
        if level.height > answer.heights[-1]:
            yield (
                f"{level.height:.1f} m for {percentage} lies above all candidate heights (up to "
                f"{highest}); give higher {argument('heights')}"
            )
        if level.extrapolated:
            yield (
                f"{percentage} is extrapolated: a return period of {level.return_period:.0f} years "
                f"from {plural(len(answer.winters), 'winter')}"
            )
    years = sorted({int(case.winter.name[:4]) for case in answer.cases})
    trend = trend_of(answer.heights_by_probability.per_winter, years)
    if trend is not None:
        yield (
            f"the heights {'rise' if trend.per_decade > 0.0 else 'fall'} by "
            f"{abs(trend.per_decade):.2f} m in ten years (Mann-Kendall test, "
            f"p = {trend.chance:.2g}): the climate changes, but the answer counts all winters "
            "alike"
        )
    if not answer.heights_by_probability.separable and answer.is_simulated:
        yield (
            "there are too few seasons to separate the snow parameters from the weather, so they "
            f"count as changing from winter to winter; give more {argument('draws')}"
        )
    ended = sum(any(outcome.is_censored for outcome in case) for case in answer.outcomes)
    if ended and answer.design.rows.count > 1:
        yield (
            f"in {plural(ended, 'season')} snow stays on a lower row at a candidate height, which "
            "ends the simulation and counts as a burial; the height lies half way to the next "
            f"candidate, so give more {argument('heights')}"
        )
    if answer.failed:
        yield f"{answer.failed} seasons could not be simulated, and are left out"


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


def assumptions(answer: ClearanceResult) -> list[str]:
    """Return the assumptions of the seasons, a sentence each."""
    case = answer.cases[0]
    return [
        "The panel is long across the slope: the simulation is of a strip (2D).",
        _rows(answer),
        *_fence(answer),
        *([_cells(case)] if answer.is_simulated else []),
        f"The edge keeps a distance of {100 * MARGIN:.0f} cm from the snow.",
        "The snow parameters are unknown, but the same in every winter. Only the weather and "
        "chance change from winter to winter.",
        "The highest snow of a winter has a generalised extreme value distribution.",
        f"The ground {_slope(case)}. The stack lies on {_ground(case.settings)}, and nobody clears "
        "it.",
        _settling(case.settings),
        "Snow that has broken is looser than its slab, by a tenth or more, because its pieces do "
        "not become round or grind each other.",
        _strength(case.settings),
        *_thaw(answer),
        "Rain, wind drift and snowfall on the stack (except on the cover) are left out.",
        "Winters are independent of each other: the climate does not change.",
    ]


def _cells(case: SeasonCase) -> str:
    return (
        f"Grid cells are {100 * case.dx:.3g} cm wide. Releases thinner than "
        f"{case.cells_across:.3g} cells, {1000 * case.settings.pool_below:.0f} mm, slide with "
        "those that follow."
    )


def _slope(case: SeasonCase) -> str:
    tilt = float(case.base.get("ground.tilt", 0.0))
    if tilt == 0.0:
        return "is level"
    return f"{'falls' if tilt > 0.0 else 'rises'} by {abs(tilt):g}° in the slide direction"


def _ground(season: SeasonSettings) -> str:
    if season.cover == "weather":
        return "the natural snow cover of the weather file"
    if season.cover in ("none", 0):
        return "bare ground"
    return f"natural snow, {season.cover:g} m deep"


def _fence(answer: ClearanceResult) -> list[str]:
    if answer.design.tilt < 90.0:
        return []
    return [
        "No snow lies on a vertical panel, so none is shed: the height is that of the natural "
        "cover and the margin. Rime, packed snow and drifts are left out."
    ]


def _thaw(answer: ClearanceResult) -> list[str]:
    season = answer.cases[0].settings
    melt = "Snow on panel and ground and in the stack melts in air warmer than 0 °C."
    share = irradiance_share([day for case in answer.cases for day in case.winter.days])
    sun = ", or colder in sunshine" if share else ""
    wet = f"In air warmer than 0 °C{sun}, snow does not adhere to the panel ({season.thaw})."
    sentences = [*([melt] if season.melt_factor else []), *([wet] if season.thaw else [])]
    if share < 1.0:
        left_out = sunshine_left_out(share)
        sentences.append(f"{left_out[0].upper()}{left_out[1:]}.")
    return sentences


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
