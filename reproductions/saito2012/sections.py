"""The sections of the report: the wooden slope, and slopes 1 and 2."""

from __future__ import annotations

from collections.abc import Sequence

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.saito2012 import figures
from reproductions.saito2012.cases import BINGHAM, COMBINED, OBSTACLE_NAMES
from reproductions.saito2012.claims import SLOPE_CLAIMS, WOODEN_CLAIMS, Courses
from reproductions.saito2012.measures import Course
from reproductions.saito2012.stages import AvalancheComputation
from snowshed.plot.html_page import HtmlTable, Picture

WOODEN_TIMES = (1.0, 2.0, 3.0, 4.0)
SLOPE_TIMES = (2.0, 5.0, 10.0, 20.0)
WOODEN = [f"wooden slope, {name}" for name in OBSTACLE_NAMES]
SLOPES = [f"slope {n}, {model}" for n in (1, 2) for model in (BINGHAM, COMBINED)]


def wooden(work: AvalancheComputation) -> Content:
    """Return the content of the section on the wooden slope."""
    courses = _complete_courses(work.courses, WOODEN)
    return Content(
        (),
        _tables(courses, WOODEN_TIMES),
        _pictures(courses, WOODEN_TIMES, "wooden"),
        judge(WOODEN_CLAIMS, work.courses),
    )


def slopes(work: AvalancheComputation) -> Content:
    """Return the content of the section on slopes 1 and 2."""
    courses = _complete_courses(work.courses, SLOPES)
    return Content(
        (),
        _tables(courses, SLOPE_TIMES),
        _pictures(courses, SLOPE_TIMES, "slopes"),
        judge(SLOPE_CLAIMS, work.courses),
    )


def _complete_courses(courses: Courses, cases: Sequence[str]) -> list[Course]:
    return [courses.by_name[name] for name in cases if name in courses.by_name]


def _pictures(courses: Sequence[Course], times: Sequence[float], name: str) -> list[Picture]:
    if not courses:
        return []
    pictures = [
        Picture.drawn(
            figures.side_views(courses, times), f"{name}-side", "From the side",
            "All particles, seen along the slope's width.",
        ),
        Picture.drawn(
            figures.fronts(courses), f"{name}-fronts", "Fronts",
            "Distance along the ground that 99 % of the snow have not passed; 0 at the foot.",
        ),
    ]  # fmt: skip
    if all(course.width(course.snow[-1]) > 0 for course in courses):
        plan = Picture.drawn(
            figures.top_views(courses, times), f"{name}-plan", "From above",
            "Over the distance along the ground; the line is where the obstacle stands.",
        )  # fmt: skip
        pictures.insert(1, plan)
    return pictures


def _tables(courses: Sequence[Course], times: Sequence[float]) -> list[tuple[str, HtmlTable]]:
    rows = []
    for course in courses:
        for time in times:
            snow = course.at(time)
            row = [course.case.name, f"{time:g}", f"{course.front(snow):.2f}"]
            row += [f"{course.speed(snow):.3f}", f"{course.width(snow):.2f}"]
            if course.case.obstacle is not None:
                row += [f"{100 * course.passed(snow):.1f}", f"{100 * course.held(snow):.1f}"]
            rows.append(row)
    titles = ["case", "s", "front, m", "mean speed, m/s", "width, m"]
    if courses and courses[0].case.obstacle is not None:
        titles += ["passed, %", "held, %"]
    return [("Measures", HtmlTable(titles, rows, "l" + "r" * (len(titles) - 1)))] if rows else []
