"""The report: ``saito.html``, which needs no other file, and ``claims.csv``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reproduction.hypothesis_tests import Judged, judge
from reproduction.report import Texts, common_facts, write_pages
from reproduction.section import Section

from saito import figures
from saito.cases import BINGHAM, COMBINED, OBSTACLES
from saito.claims import CLAIMS, Courses
from saito.measures import Course
from saito.reproduction import Reproduction
from snowshed.plot.html_page import Grid, Picture

ABOUT = (
    "Saito, Kato, Otsuki, Kimura, Shimizu and Isenko, <em>Refinement of MPS method for practical "
    "application to snow avalanches</em> (Annals of Glaciology 53, 2012): what it says of its "
    "simulations, tested with snowshed. Its equations, drawings and photographs are lost in the "
    "copy at hand. Density, adhesive force, friction angle, viscosity, spacing and the thickness "
    "of the erodible layer are printed; the shapes of slopes and obstacles, the amount of snow, "
    "and the limits of the dilatant branch, of erosion and of deposition are ours."
)
QUICK = (
    "<strong>A quick reproduction.</strong> Particles on the wooden slope are 0.02 m apart, as "
    "wide as the gap between narrow stakes; the paper has 0.01 m, as <code>--full</code> does. "
    "Slopes 1 and 2 are sections."
)
NOISE = (
    "Here each case is one simulation in which nothing is random: numbers have no noise, and a "
    "claim is left open where its number lies between two bounds."
)
WOODEN_TIMES = (1.0, 2.0, 3.0, 4.0)
SLOPE_TIMES = (2.0, 5.0, 10.0, 20.0)
WOODEN = [f"wooden slope, {name}" for name in OBSTACLES]
SLOPES = [f"slope {n}, {model}" for n in (1, 2) for model in (BINGHAM, COMBINED)]


def write_report(found: Reproduction) -> list[Judged]:
    """Write the report from what is there; return the claims with their findings."""
    courses = found.courses()
    judged = judge(CLAIMS, courses)
    of_slopes = [one for one in judged if one.source.startswith("slope")]
    of_wood = [one for one in judged if one not in of_slopes]
    sections = [
        _section(found, courses, "wooden", "The wooden slope", of_wood, WOODEN, WOODEN_TIMES),
        _section(found, courses, "slopes", "Slopes 1 and 2", of_slopes, SLOPES, SLOPE_TIMES),
    ]
    texts = Texts(
        "Avalanches as a fluid of particles, reproduced", "the paper", ABOUT,
        QUICK if found.size.name == "quick" else "", NOISE,
    )  # fmt: skip
    facts = common_facts(found.size.name, list(found.stages.values()))
    return write_pages(
        report_file(found.folder), found.folder / "claims.csv", texts, facts, sections
    )


def report_file(folder: Path) -> Path:
    """Return the report's file."""
    return folder / "saito.html"


def _section(
    found: Reproduction,
    courses: Courses,
    name: str,
    title: str,
    claims: Sequence[Judged],
    cases: Sequence[str],
    times: Sequence[float],
) -> Section:
    """Return the section on some cases, with the claims on them."""
    known = [courses.known[one] for one in cases if one in courses.known]
    missing = [
        f"{stage.case.name}: {stage.state().in_words()} {stage.failure()}".rstrip()
        for stage in found.stages.values()
        if stage.case.name in cases and stage.case.name not in courses.known
    ]
    return Section(
        name, title, (), _tables(known, times), _pictures(known, times, name), claims, missing
    )


def _pictures(courses: Sequence[Course], times: Sequence[float], name: str) -> list[Picture]:
    if not courses:
        return []
    found = [
        Picture.drawn(
            figures.side_views(courses, times), f"{name}-side", "From the side",
            "All particles, seen along the slope's width.",
        ),
        Picture.drawn(
            figures.fronts(courses), f"{name}-fronts", "Fronts",
            "The way along the ground that 99 % of the avalanche have not passed; 0 at the foot.",
        ),
    ]  # fmt: skip
    if all(one.width(one.snow[-1]) > 0 for one in courses):
        plan = Picture.drawn(
            figures.top_views(courses, times), f"{name}-plan", "From above",
            "Over the way along the ground; the line is where the obstacle stands.",
        )  # fmt: skip
        found.insert(1, plan)
    return found


def _tables(courses: Sequence[Course], times: Sequence[float]) -> list[tuple[str, Grid]]:
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
    return [("Measures", Grid(titles, rows, "l" + "r" * (len(titles) - 1)))] if rows else []
