"""The reproduction of the thesis, declared: its sizes, stages, claims and sections."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import click

from reproductions.common.reproduction import Reproduction
from reproductions.common.section import Section
from reproductions.common.size import Size
from reproductions.frischholz2023.claims.calibration import CALIBRATION
from reproductions.frischholz2023.claims.fixation import FIXATION
from reproductions.frischholz2023.claims.geometry import GEOMETRY
from reproductions.frischholz2023.claims.lab import DIMENSIONS, GROWTH, RELEASE
from reproductions.frischholz2023.claims.regression import REGRESSION
from reproductions.frischholz2023.claims.s_index import S_INDEX
from reproductions.frischholz2023.sections import (
    calibration,
    deviations,
    fixation,
    geometry,
    lab,
    regression,
    s_index,
)
from reproductions.frischholz2023.settings import FULL, MIDDLE, PLANAR, QUICK
from reproductions.frischholz2023.stages import ThesisComputation, stages
from snowshed.methods.mpm.settings import Scheme

ABOUT = (
    "Frischholz, <em>Snow slide-off from solar panels with the Material Point Method</em> (master "
    "thesis, EPFL and SLF): its laboratory experiment and chapters 3 to 5, computed again with "
    "snowshed. Every table stands beside the numbers that the thesis prints; every claim has a "
    "verdict."
)
QUICK_CAUTION = (
    "<strong>A quick reproduction.</strong> Coarse cells, 2D instead of 3D in chapters 3 and 4, "
    "few seedings and few values: it shows the procedure. Its verdicts hold for these settings, "
    "not for the thesis's; for those use <code>--full</code>."
)
PLANAR_CAUTION = (
    "<strong>In 2D.</strong> The thesis computed chapters 2 to 4 in 3D, too. The cells are the "
    "thesis's, and there are few seedings."
)
NOISE = (
    "Its noise is that of the seeding: another placement of the particles gives another stack. "
    "Deviations between seedings are pooled over the points that a claim compares, divided by the "
    "root of the number of averaged runs, and widened by Student's t if there are few seedings. "
    "The noise of a fitted slope is its standard error. For scores of the regressions it is the "
    "standard error over the outer folds, for errors and quartiles over the panels. Rules that say "
    "<em>no noise</em> compare the numbers without noise."
)

HELP = """Reproduce chapters 3 to 5 of the thesis and its lab experiment, and judge its claims.

Writes thesis.html. After an interruption, the same command resumes.

\b
Example:
  snowshed reproduce frischholz2023 --quick -o report
"""
STAGE_HELP = (
    "Compute only this: lab, s-index, fixation, calibration, deviations, variations, geometry "
    "(with --full) or regression; may be repeated."
)
OPTIONS = (
    click.Option(
        ["--table"],
        type=click.Path(path_type=Path),
        help="Rows of panels to use for chapter 5 instead of simulating them.",
    ),
    click.Option(
        ["--condition"],
        type=click.Choice(["separate", "slip"]),
        default="separate",
        help="Contact with the panel: snow may leave it, or, as in the thesis (SLIP), only over "
        "its edge.  [default: separate]",
    ),
    click.Option(
        ["--scheme"],
        type=click.Choice(get_args(Scheme)),
        default="thesis",
        help="Scheme of the MPM in all simulations.  [default: thesis]",
    ),
)

REPRODUCTION: Reproduction[ThesisComputation] = Reproduction(
    name="frischholz2023",
    alias="thesis",
    author="the thesis",
    title="The thesis reproduced",
    about=ABOUT,
    noise=NOISE,
    help=HELP,
    stage_help=STAGE_HELP,
    jobs_help="Processes at once.  [default: the number of cores]",
    options=OPTIONS,
    identity=("condition", "scheme"),
    former={"publication": "thesis", "condition": "separate", "scheme": "thesis"},
    sizes=(
        Size("quick", "Minutes: in 2D, a coarse grid (default).", QUICK, QUICK_CAUTION),
        Size("planar", "Half an hour: as --middle, in 2D.", PLANAR, PLANAR_CAUTION),
        Size("middle", "Hours: the thesis's settings, few seedings.", MIDDLE),
        Size("full", "Days: all of it, several seedings.", FULL),
    ),
    stages=stages,
    claims=(
        *GROWTH,
        *DIMENSIONS,
        *RELEASE,
        *S_INDEX,
        *FIXATION,
        *CALIBRATION,
        *GEOMETRY,
        *REGRESSION,
    ),
    sections=(
        Section("lab", "The laboratory experiment (chapter 2)", lab.build, ["lab"], "done"),
        Section("s-index", "Single-parameter index (3.3)", s_index.build, ["s-index"], "done"),
        Section(
            "fixation", "Single-parameter fixation (3.4)", fixation.build, ["fixation"], "done"
        ),
        Section(
            "calibration",
            "Calibration (chapter 4), on synthetic stacks",
            calibration.build,
            ["calibration"],
            "ended",
        ),
        Section(
            "deviations",
            "Deviations from the thesis, one by one",
            deviations.build,
            ["deviations"],
            "ended",
        ),
        Section("geometry", "Panels (5.1)", geometry.build, ["geometry"], "ended"),
        Section("regression", "Regression (5.2, 5.3)", regression.build, ["regression"], "ended"),
    ),
)
