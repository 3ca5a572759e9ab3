"""The sections of the report: the wooden slope, and slopes 1 and 2."""

from __future__ import annotations

from collections.abc import Sequence

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.saito2012 import figures
from reproductions.saito2012.cases import BINGHAM, COMBINED, OBSTACLE_NAMES
from reproductions.saito2012.claims import SLOPE_CLAIMS, WOODEN_CLAIMS, CaseHistories
from reproductions.saito2012.measures import CaseHistory
from reproductions.saito2012.stages import AvalancheComputation
from snowshed.plot.html_page import HtmlTable, Picture

WOODEN_TIMES = (1.0, 2.0, 3.0, 4.0)
SLOPE_TIMES = (2.0, 5.0, 10.0, 20.0)
WOODEN = [f"wooden slope, {name}" for name in OBSTACLE_NAMES]
SLOPES = [f"slope {n}, {model}" for n in (1, 2) for model in (BINGHAM, COMBINED)]


def wooden(work: AvalancheComputation) -> Content:
    """Return the content of the section on the wooden slope."""
    histories = _complete_histories(work.histories, WOODEN)
    return Content(
        (),
        _tables(histories, WOODEN_TIMES),
        _pictures(histories, WOODEN_TIMES, "wooden"),
        judge(WOODEN_CLAIMS, work.histories),
    )


def slopes(work: AvalancheComputation) -> Content:
    """Return the content of the section on slopes 1 and 2."""
    histories = _complete_histories(work.histories, SLOPES)
    return Content(
        (),
        _tables(histories, SLOPE_TIMES),
        _pictures(histories, SLOPE_TIMES, "slopes"),
        judge(SLOPE_CLAIMS, work.histories),
    )


def _complete_histories(histories: CaseHistories, cases: Sequence[str]) -> list[CaseHistory]:
    return [histories.by_name[name] for name in cases if name in histories.by_name]


def _pictures(histories: Sequence[CaseHistory], times: Sequence[float], name: str) -> list[Picture]:
    if not histories:
        return []
    pictures = [
        Picture.drawn(
            figures.side_views(histories, times), f"{name}-side", "From the side",
            "All particles, seen along the slope's width.",
        ),
        Picture.drawn(
            figures.fronts(histories), f"{name}-fronts", "Fronts",
            "Distance along the ground that 99 % of the snow have not passed; 0 at the foot.",
        ),
    ]  # fmt: skip
    if all(history.width(history.snow[-1]) > 0 for history in histories):
        plan = Picture.drawn(
            figures.top_views(histories, times), f"{name}-plan", "From above",
            "Over the distance along the ground; the line is where the obstacle stands.",
        )  # fmt: skip
        pictures.insert(1, plan)
    return pictures


def _tables(
    histories: Sequence[CaseHistory], times: Sequence[float]
) -> list[tuple[str, HtmlTable]]:
    rows = []
    for history in histories:
        for time in times:
            snow = history.at(time)
            row = [history.case.name, f"{time:g}", f"{history.front(snow):.2f}"]
            row += [f"{history.speed(snow):.3f}", f"{history.width(snow):.2f}"]
            if history.case.obstacle is not None:
                row += [f"{100 * history.passed(snow):.1f}", f"{100 * history.held(snow):.1f}"]
            rows.append(row)
    titles = ["case", "s", "front, m", "mean speed, m/s", "width, m"]
    if histories and histories[0].case.obstacle is not None:
        titles += ["passed, %", "held, %"]
    return [("Measures", HtmlTable(titles, rows, "l" + "r" * (len(titles) - 1)))] if rows else []
