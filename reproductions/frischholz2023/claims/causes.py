"""What likely makes claims of the thesis fail here, by the claim's text.

Only ``docs/trust/thesis-claims.md`` shows them. A cause says what was tried; where nothing was, it
says so.
"""

from __future__ import annotations

from collections.abc import Mapping

_STRENGTH = (
    "Here p₀ and M change the stack at every event and as much as β does, since the tensile "
    "strength is β p₀: weak snow runs out flat, strong snow stays in lumps."
)

CAUSES: Mapping[str, str] = {
    "The tail hardly moves after the first event.": (
        "The claim describes the measured stacks. The simulated slab lands as a board and pushes "
        "the snow beneath it outward: the far end consists of the second and third slab, and "
        "advances at every event. Sieved snow of very low cohesion lands in lumps, and by hand a "
        "stack was measured only as far as it was one body. Both readings of A.4.2 give the same; "
        "other snow was not tried for this claim."
    ),
    "The length grows mainly by the head.": (
        "The same cause: the far end advances more than the near one."
    ),
    "p₀ lowers the height (the thesis says the opposite in 3.4.1).": (
        "The thesis contradicts itself. Here its section 3.4.1 is confirmed: the higher p₀, the "
        "higher the stack."
    ),
    "M matters for the height only when there is much snow.": (
        f"{_STRENGTH} "
        "The thesis contradicts itself here too: by its Figure 3.4.1, M raises the stack at every "
        "event. Its index comes from single runs, whose noise is not given."
    ),
    "p₀ lengthens the stack.": (
        f"{_STRENGTH} "
        "The thesis calls what p₀ does to the length mixed, since after the third event its curve "
        "is flat."
    ),
    "Events matter more for the height than snow parameters.": _STRENGTH,
    "Below β 0.2, β drives the height: M and p₀ hardly matter.": _STRENGTH,
    "The stack's height grows with the panel's height too.": (
        "Snow that falls farther lands faster and spreads more. The rows say so by both readings "
        "of A.4.2 and with reseeded stacks (-8 to -10 % per metre). At the thesis's reference tilt "
        "of 40° stacks from 2.5 m on are equally high within 3 %. Its words, that the height is "
        "affected in proportion but to a lesser extent, may also mean that it falls."
    ),
    "It falls with the same slope at every event.": (
        "H/L falls less steeply after later events by both readings of A.4.2 and with reseeded "
        "stacks. The thesis judges by eye, one panel after the other; the claim's bar, a quarter, "
        "may be stricter than its figure."
    ),
    "H/L hardly depends on the tilt.": (
        "A few panels decide: the largest difference is between two of four tilts. The thesis "
        "calls this dependence the noisiest; its panels are single runs."
    ),
    "The quartiles of the predicted H/L.": (
        "The lowest is a quarter too high, the others lie within 16 %. Cells of 1 cm instead of "
        "1.5 cm lower H/L by a fifth, and damping by a share in each step by a tenth (the gap's "
        "causes); the middle quartiles would then be too low."
    ),
}
