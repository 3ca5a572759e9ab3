"""The reproduction of Saito and others (2012), declared: its sizes, stages, claims and sections."""

from __future__ import annotations

from reproductions.common.reproduction import Reproduction
from reproductions.common.section import Section
from reproductions.common.size import Size
from reproductions.saito2012.cases import FULL, QUICK, folder_name
from reproductions.saito2012.claims import CLAIMS
from reproductions.saito2012.sections import SLOPES, WOODEN, slopes, wooden
from reproductions.saito2012.stages import AvalancheComputation

ABOUT = (
    "Saito, Kato, Otsuki, Kimura, Shimizu and Isenko, <em>Refinement of MPS method for practical "
    "application to snow avalanches</em> (Annals of Glaciology 53, 2012): its claims on its "
    "simulations, tested with snowshed. The equations, drawings and photographs are missing in our "
    "copy. Density, adhesive force, friction angle, viscosity, spacing and the thickness "
    "of the erodible layer are printed; the shapes of slopes and obstacles, the amount of snow, "
    "and the limits of the dilatant branch, of erosion and of deposition are ours."
)
QUICK_CAUTION = (
    "<strong>A quick reproduction.</strong> Particles on the wooden slope are 0.02 m apart, as "
    "wide as the gap between narrow stakes; the paper has 0.01 m, as <code>--full</code> does. "
    "Slopes 1 and 2 are sections."
)
NOISE = (
    "Here each case is one simulation in which nothing is random: numbers have no noise, and a "
    "claim is left open where its number lies between two bounds."
)
HELP = """Judge the claims of Saito and others (2012) on avalanches as a fluid of particles.

Writes saito.html. After an interruption, the same command resumes.

\b
Example:
  snowshed reproduce saito2012 --quick -o avalanches
"""

REPRODUCTION: Reproduction[AvalancheComputation] = Reproduction(
    name="saito2012",
    alias="saito",
    author="the paper",
    title="Avalanches as a fluid of particles, reproduced",
    about=ABOUT,
    noise=NOISE,
    help=HELP,
    stage_help="Compute only this case, such as wooden-slope-no-obstacle; may be repeated.",
    sizes=(
        Size(
            "quick",
            "0.02 m between particles of the wooden slope, other slopes in 2D: minutes (default).",
            QUICK,
            QUICK_CAUTION,
        ),
        Size("full", "The paper's 0.01 m, and slopes 1 and 2 in space.", FULL),
    ),
    stages=AvalancheComputation,
    claims=CLAIMS,
    sections=(
        Section("wooden", "The wooden slope", wooden, [folder_name(name) for name in WOODEN]),
        Section("slopes", "Slopes 1 and 2", slopes, [folder_name(name) for name in SLOPES]),
    ),
)
