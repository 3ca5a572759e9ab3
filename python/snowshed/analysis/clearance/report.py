"""The files of the clearance answer: a page, a table and a summary."""

from __future__ import annotations

import calendar
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed.analysis.clearance import answer_text
from snowshed.analysis.clearance.answer import ClearanceResult
from snowshed.analysis.clearance.load_chapter import (
    WorstLoads,
    landing_text,
    reach_table,
    scene_with_forces,
)
from snowshed.analysis.clearance.panel_design import SnowRanges
from snowshed.analysis.clearance.statistics import FIRST_PROBABILITY
from snowshed.analysis.clearance.tables import burials, panel_columns, write_tables
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv
from snowshed.io.json_file import sealed
from snowshed.plot.clearance_figure import (
    burial_figure,
    causes_figure,
    design_figure,
    parts_figure,
)
from snowshed.plot.html_page import HtmlTable, Picture, template
from snowshed.season.weather.quality_table import ALIGN, HEAD, quality_rows, title

#: Titles of the columns that name a panel.
PANEL_HEADS = {
    "slope_length_m": "slope length, m",
    "tilt_deg": "tilt, degrees",
    "rows": "rows",
    "pitch_m": "pitch, m",
}
#: Heights at which the curve of burials is drawn.
CURVE_POINTS = 80


def write_report(
    answers: Sequence[ClearanceResult],
    ranges: SnowRanges,
    folder: Path,
    notes: Sequence[str] = (),
    price: Optional[float] = None,
    record: Optional[Mapping[str, Any]] = None,
) -> None:
    """Write clearance.html, its tables (`write_tables`), clearance.csv and clearance.json.

    A page for each panel beside them shows the slide-offs of its worst winter in motion.

    Parameters
    ----------
    answers
        One answer for each panel.
    ranges
        The ranges of the uncertain parameters.
    folder
        The results folder.
    notes
        Notes from reading the weather.
    price
        Price of a metre of height. With it, the table of panels has costs.
    record
        From `ClearanceInputs.record_data`, for clearance.json.
    """
    import pandas as pd

    table = pd.concat([answer.table() for answer in answers], ignore_index=True)
    write_csv(table, folder / "clearance.csv", float_format="%.6g")
    files = write_tables(answers, folder, price)
    data = summary(answers, ranges, notes)
    write_text(folder / "clearance.json", sealed({**data, **(record or {})}))
    page = template("snowshed.plot", "clearance.html.j2").render(
        title="How high must the lower edge be?",
        sentence=answer_text.sentence(answers),
        warnings=answer_text.warnings(answers),
        panels=[_panel(answer, folder) for answer in answers],
        designs=_design_grid(answers, price) if len(answers) > 1 or price is not None else None,
        chart=_chart(answers) if len(answers) > 1 and all(a.levels for a in answers) else None,
        panel_snow=_panel_snow_grid(answers),
        winter_table=_winter_table(answers[0]),
        files=" and ".join(files),
        notes=data["notes"],
        ranges=HtmlTable(
            ("uncertain parameter", "from", "to"), answer_text.range_rows(ranges), "lrr"
        ),
        assumptions=answer_text.assumptions(answers[0]),
    )
    write_text(folder / "clearance.html", page)


def summary(
    answers: Sequence[ClearanceResult], ranges: SnowRanges, notes: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the answer as JSON data; the parameters are those of `write_report`."""
    record = answers[0].winter_list
    return {
        "sentence": answer_text.sentence(answers),
        "warnings": answer_text.warnings(answers),
        "notes": [*ranges.notes, *notes],
        "coverage": None if record is None else record.coverage,
        "winters_of_the_file": [] if record is None else record.data(),
        "ranges": {name: list(span) for name, span in ranges.spans.items()},
        "draws": ranges.draws_of(len(answers[0].winters)),
        "panels": [
            {
                **asdict(answer.design),
                "dx": answer.cases[0].dx,
                "winters": list(answer.winters),
                "confidence": answer.heights_by_probability.confidence,
                "levels": [vars(level) for level in answer.levels],
                "worst_winter": dict(zip(("height", "low", "high"), answer.highest)),
                "heights": burials(answer),
                "shares": [vars(share) for share in answer.shares],
                "grid_error": vars(answer.grid_error),
            }
            for answer in answers
        ],
    }


def _winter_table(answer: ClearanceResult) -> Optional[tuple[str, HtmlTable]]:
    """Return the title and the table of the winters of the file."""
    record = answer.winter_list
    if record is None:
        return None
    return title(record), HtmlTable(HEAD, quality_rows(record), ALIGN)


def _panel(answer: ClearanceResult, folder: Path) -> dict[str, Any]:
    """Return the section of a panel, and write the moving view of its worst winter."""
    shares = {answer_text.cause_label(share.cause, answer): share.part for share in answer.shares}
    name = f"{answer.design.slope_length:g}-{answer.design.tilt:g}"
    causes: Optional[Picture] = None
    if len(shares) > 1:
        caption = "Shares of the variance of the height's logarithm."
        causes = Picture.drawn(causes_figure(shares), f"causes-{name}", "Causes", caption)
    view = folder / f"worst-winter-{name}.html"
    picture, loads = _worst_winter(answer, view)
    return {
        "title": f"Slope length {answer.design.slope_length:g} m, tilt {answer.design.tilt:g}°",
        "parts": _parts_picture(answer, name),
        "levels": _level_grid(answer) if answer.levels else None,
        "heights": _height_grid(answer) if answer.levels else None,
        "burial": _burial_picture(answer, name) if answer.levels else None,
        "causes": causes,
        "reasons": answer_text.interval_reasons(answer),
        "worst": _worst(answer),
        "picture": picture,
        "view": view.name if picture else None,
        "reach": reach_table(answer),
        "landing": landing_text(answer),
        "loads": loads,
    }


def _parts_picture(answer: ClearanceResult, name: str) -> Picture:
    cases = {"the worst winter": answer.worst_case_index}
    if len(answer.winters) > 1:
        cases = {"a typical winter": answer.typical_case_index, **cases}
    bars = {
        f"{label}, {answer.cases[index].winter.name}": vars(answer.height_parts(index))
        for label, index in cases.items()
    }
    caption = "Simulated seasons, without the error of the grid."
    return Picture.drawn(
        parts_figure(bars), f"parts-{name}", "Parts of the required height", caption
    )


def _burial_picture(answer: ClearanceResult, name: str) -> Picture:
    levels = [(level.probability, level.height, level.low, level.high) for level in answer.levels]
    most = max(levels[-1][1], levels[1][3])
    heights = np.linspace(0.0, 1.2 * most, CURVE_POINTS)
    curves = [answer.heights_by_probability.burial(height) for height in heights]
    return Picture.drawn(
        burial_figure(heights, np.array(curves), answer.heights_by_probability.per_winter, levels),
        f"burial-{name}",
        "Probability of burial",
        "Points: the winters. Line: the fitted distribution, with its 90 % interval.",
    )


def _design_grid(answers: Sequence[ClearanceResult], price: Optional[float]) -> HtmlTable:
    """Return the heights of all panels, with their intervals, and their costs."""
    names, rows = list(panel_columns(answers[0])), []
    for answer in answers:
        heights = [answer.highest, *((at.height, at.low, at.high) for at in answer.levels)]
        cells = [f"{middle:.2f} ({low:.2f} to {high:.2f})" for middle, low, high in heights]
        cost = [] if price is None else [f"{price * answer_text.headline_height(answer):,.0f}"]
        rows.append([*(f"{value:g}" for value in panel_columns(answer).values()), *cells, *cost])
    clear = [f"clear in {100 * level.probability:g} %, m" for level in answers[0].levels]
    cost_head = [] if price is None else ["cost at the first sentence's height"]
    head = (*(PANEL_HEADS[name] for name in names), "the worst winter, m", *clear, *cost_head)
    return HtmlTable(head, rows, "r" * len(head))


def _panel_snow_grid(answers: Sequence[ClearanceResult]) -> Optional[HtmlTable]:
    """Return the days with snow on each panel by month, and the energy that it blocks."""
    months = [answer.panel_snow for answer in answers]
    names = list(dict.fromkeys(month for panel in months for month in panel))
    if not names:
        return None
    head = ("panel", *(calendar.month_abbr[name] for name in names), "all")
    rows = []
    for answer, panel in zip(answers, months):
        days = [panel[name].covered_days if name in panel else 0.0 for name in names]
        label = f"{answer_text.panel_name(answer)}: covered days"
        rows.append([label, *(f"{value:.1f}" for value in (*days, sum(days)))])
        blocked = [panel[name].blocked if name in panel else None for name in names]
        if any(share is not None for share in blocked):
            shares = ["" if share is None else f"{100 * share:.0f}" for share in blocked]
            rows.append(["blocked irradiation, %", *shares, ""])
    return HtmlTable(head, rows, "l" + "r" * (len(head) - 1))


def _level_grid(answer: ClearanceResult) -> HtmlTable:
    rows = [
        (
            f"{100 * level.probability:g} %",
            f"{level.height:.2f}",
            f"{level.low:.2f} to {level.high:.2f}",
            f"{level.return_period:.0f}",
            "shorter: extrapolated" if level.extrapolated else "long enough",
        )
        for level in answer.levels
    ]
    head = ("stays clear in", "height, m", "90 % interval, m", "return period, years", "record")
    return HtmlTable(head, rows, "lrrrl")


def _height_grid(answer: ClearanceResult) -> HtmlTable:
    rows = [
        (
            f"{burial['height']:g}",
            f"{100 * burial['buried']:.0f}",
            f"{100 * burial['low']:.0f} to {100 * burial['high']:.0f}",
            _years(burial["buried"]),
        )
        for burial in burials(answer)
    ]
    head = ("height, m", "buried in, %", "90 % interval, %", "return period, years")
    return HtmlTable(head, rows, "rrrr")


def _years(buried: float) -> str:
    years = 1.0 / max(buried, 1e-9)
    return f"{years:.1f}" if years < 100.0 else "more than 100"


def _worst(answer: ClearanceResult) -> str:
    case, outcomes = answer.cases[answer.worst_case_index], answer.outcomes[answer.worst_case_index]
    last = next((outcome for outcome in reversed(outcomes) if outcome.contact), None)
    snowfall = f"{case.winter.name}: {case.winter.snowfall:.1f} m of new snow in all. "
    if last is None or last.contact is None:
        return f"{snowfall}Its snow reaches none of the heights."
    contact = last.contact
    return (
        f"{snowfall}At {last.height:g} m, {contact.text} on {contact.date[:10]}; an edge at "
        f"{answer.required[answer.worst_case_index]:.2f} m would have stayed clear."
    )


def _worst_winter(
    answer: ClearanceResult, view: Path
) -> tuple[Optional[Picture], Optional[WorstLoads]]:
    """Simulate the worst winter once more with its forces, and write its moving view.

    Returns
    -------
    picture, loads
        The picture of the season, and its loads; None if nothing slides.
    """
    from tempfile import TemporaryDirectory

    from snowshed.results.view import write_view
    from snowshed.season.driver import plan_season, simulate_season

    case, outcomes = answer.cases[answer.worst_case_index], answer.outcomes[answer.worst_case_index]
    if not case.has_releases:
        return None, None
    reached = [outcome.height for outcome in outcomes if outcome.contact] or [outcomes[0].height]
    with TemporaryDirectory() as folder:
        out = Path(folder) / "season"
        scene = scene_with_forces(answer, answer.worst_case_index, reached[-1])
        plan = plan_season(case.winter.days, scene, settings=case.settings)
        simulate_season(plan, out, settings=case.settings)
        write_view(out, view)
        picture = Picture.read(
            out / "season.png",
            f"The worst winter, {case.winter.name}",
            f"Lower edge at {reached[-1]:g} m.",
            dpi=160,
        )
        return picture, WorstLoads.read(out)


def _chart(answers: Sequence[ClearanceResult]) -> Picture:
    heights = []
    for answer in answers:
        level, design = answer_text.first_level(answer), answer.design
        heights.append((design.slope_length, design.tilt, level.height, (level.low, level.high)))
    return Picture.drawn(
        design_figure(heights, FIRST_PROBABILITY),
        "designs",
        "Required height",
        "Bars: 90 % intervals.",
    )
