"""The reproduction of Hagenmuller and others (2015), declared: sizes, stages, claims, sections."""

from __future__ import annotations

from reproductions.common.reproduction import Reproduction
from reproductions.common.section import Section
from reproductions.common.size import Size
from reproductions.hagenmuller2015.claims import ENGINE, PAPER
from reproductions.hagenmuller2015.sections import engine, paper, sensitivity
from reproductions.hagenmuller2015.snows import FULL, QUICK
from reproductions.hagenmuller2015.stages import GrainsComputation
from reproductions.hagenmuller2015.studies import MAKERS

ABOUT = (
    "Hagenmuller, Chambon and Naaim, <em>Microstructure-based modeling of snow mechanics: a "
    "discrete element approach</em> (The Cryosphere 9, 1969-1982, 2015): its claims on snow in "
    "confined compression, tested with snowshed. Its images and tables are not available to us: "
    "the snow is synthetic, and the numbers beside ours were measured with Yade on a synthetic "
    "sample, by the same contact law."
)
QUICK_CAUTION = (
    "<strong>A quick reproduction.</strong> Samples of some 90 grains are below a representative "
    "volume, so their verdicts are not final. For 1000 grains and more use <code>--full</code>."
)
NOISE = (
    "Here it is the logarithm of a ratio of stresses, taken sample by sample. Its noise is the "
    "standard error from the scatter between samples, widened by Student's t because samples are "
    "few. “Hardly” means by less than a factor of 1.3."
)
HELP = """Judge the claims of Hagenmuller, Chambon and Naaim (2015) on snow in compression.

Writes hagenmuller.html. The snow is synthetic. After an interruption, the same command resumes.

\b
Example:
  snowshed reproduce hagenmuller2015 --quick -o grains
"""

REPRODUCTION: Reproduction[GrainsComputation] = Reproduction(
    name="hagenmuller2015",
    alias="hagenmuller",
    author="the paper",
    title="Snow from grains, reproduced",
    about=ABOUT,
    noise=NOISE,
    help=HELP,
    stage_help="Compute only this: elastic, brittle or dense; may be repeated.",
    jobs_help="Tests at once.  [default: the number of cores]",
    sizes=(
        Size(
            "quick",
            "Some 90 grains a sample: minutes on two cores (default).",
            QUICK,
            QUICK_CAUTION,
        ),
        Size("full", "1000 grains and more: some two hours on two cores.", FULL),
    ),
    stages=GrainsComputation,
    claims=(*PAPER, *ENGINE),
    sections=(
        Section("paper", "What the paper says", paper, list(MAKERS)),
        Section("engine", "Beside Yade", engine, []),
        Section("sensitivity", "What matters", sensitivity, []),
    ),
)
