"""Likely causes of contradictions to claims of the thesis, by the claim's text.

Only ``docs/trust/thesis-claims.md`` shows them. Each cause states its test, or that it was not
tested.
"""

from __future__ import annotations

from collections.abc import Mapping

_STRENGTH = (
    "In our runs p₀ and M change the stack at every event, and as much as β does, because the "
    "tensile strength is β p₀: weak snow runs out flat, strong snow stays in lumps."
)

CAUSES: Mapping[str, str] = {
    "The tail hardly moves after the first event.": (
        "The claim describes the measured stacks. The simulated slab lands as a board and pushes "
        "the snow beneath it outward: the far end consists of the second and third slab, and "
        "advances at every event. In the laboratory, sieved snow of very low cohesion landed in "
        "lumps, and only the continuous body of the stack was measured. Both trimming rules "
        "give the same result. Other snow was not tested for this claim."
    ),
    "The length grows mainly by the head.": (
        "The cause is the same: the far end advances more than the near end."
    ),
    "p₀ lowers the height (the thesis says the opposite in 3.4.1).": (
        "The thesis contradicts itself. Our runs confirm its section 3.4.1: a higher p₀ gives a "
        "higher stack."
    ),
    "M matters for the height only when there is much snow.": (
        f"{_STRENGTH} "
        "The thesis contradicts itself here, too: in its Figure 3.4.1, M raises the stack at every "
        "event. Its index comes from single runs, whose noise it does not state."
    ),
    "p₀ lengthens the stack.": (
        f"{_STRENGTH} "
        "The thesis calls the effect of p₀ on the length mixed, because its curve is flat after "
        "the third event."
    ),
    "Events matter more for the height than snow parameters.": _STRENGTH,
    "Below β 0.2, β drives the height: M and p₀ hardly matter.": _STRENGTH,
    "The stack's height grows with the panel's height too.": (
        "Snow that falls farther lands faster and spreads more. The rows show this by both "
        "trimming rules and with reseeded stacks (-8 to -10 % per metre). At the thesis's "
        "reference tilt of 40°, stacks below panels of 2.5 m and more have the same height within "
        "3 %. The thesis says that the height is affected in proportion but to a lesser extent, "
        "which may also mean that it falls."
    ),
    "H/L falls with the same slope at every event.": (
        "H/L falls less steeply after later events, by both trimming rules and with reseeded "
        "stacks. The thesis judges by eye, panel by panel. Our criterion, a difference of at most "
        "a quarter, may be stricter than its figure."
    ),
    "H/L hardly depends on the tilt.": (
        "A few panels decide, because the largest difference is between two of four tilts. The "
        "thesis calls this dependence the noisiest; its panels are single runs."
    ),
    "The quartiles of the predicted H/L.": (
        "The lowest quartile is a quarter too high, and the others differ by up to 16 %. Cells of "
        "1 cm instead of 1.5 cm lower H/L by a fifth, and damping by a share in each step lowers "
        "it by a tenth (see the gap); the middle quartiles would then be too low."
    ),
}
