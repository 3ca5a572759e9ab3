"""The answer in words: one sentence, what is assumed, and where it leaves its validity."""

from __future__ import annotations

from collections.abc import Sequence

from snowshed.analysis.clearance.answer import Answer
from snowshed.analysis.clearance.design import MEANING, Ranges
from snowshed.season.record import percent

OWNERS = 0.9  # the probability that the first sentence tells
CHANCE = "chance: places of particles, and causes that act together"


def sentence(answers: Sequence[Answer]) -> str:
    """Return the answer in a sentence, of the first panel."""
    answer = answers[0]
    level = next(level for level in answer.levels if level.probability == OWNERS)
    return (
        f"The lower edge of a panel of {answer.design.slope_length:g} m at "
        f"{answer.design.tilt:g}° must be {level.height:.1f} m above the ground, so that its snow "
        f"stays clear of it in 9 of 10 winters. This follows from {answer.winters_in_words} of the "
        f"file; chance and what nobody knows of the snow leave {level.low:.1f} to "
        f"{level.high:.1f} m."
    )


def cause_in_words(cause: str) -> str:
    """Return a cause of variance in words."""
    if cause == "winter":
        return "the winter's weather"
    return CHANCE if cause == "chance" else MEANING[cause]


def advice(answer: Answer) -> str:
    """Return what would reduce the uncertainty of the required height most."""
    shares = [share for share in answer.shares if share.cause in MEANING]
    if not shares:
        return "There are too few seasons to tell the causes apart; take more winters, or --draws."
    first = shares[0]
    winter = next((share.part for share in answer.shares if share.cause == "winter"), 0.0)
    return (
        f"To know the {MEANING[first.cause]} would reduce the uncertainty most: "
        f"{100 * first.part:.0f} % of the variance goes with it. {100 * winter:.0f} % goes with "
        "the winter, which no measurement reduces."
    )


def warnings(answers: Sequence[Answer]) -> list[str]:
    """Return where the answer leaves its validity."""
    found = _left_out(answers[0])
    for answer in answers:
        name = f"{answer.design.slope_length:g} m at {answer.design.tilt:g}°"
        for level in answer.levels:
            if level.height > answer.heights[-1]:
                found.append(
                    f"{name}: {level.height:.1f} m for {100 * level.probability:g} % lies above "
                    f"all candidate heights (up to {answer.heights[-1]:g} m); give higher --heights"
                )
            elif not level.counted:
                found.append(
                    f"{name}: {100 * level.probability:g} % is extrapolated (Gumbel) from "
                    f"{_number(len(answer.winters))}; {level.return_period:.0f} and more would be "
                    "needed to count it"
                )
        if answer.failed:
            found.append(
                f"{name}: {answer.failed} seasons could not be simulated, and are left out"
            )
    return found


def _left_out(answer: Answer) -> list[str]:
    """Return what to know of the winters of the file that do not count."""
    if answer.known is None or len(answer.known.counted) == len(answer.known.winters):
        return []
    number = len(answer.known.winters) - len(answer.known.counted)
    return [
        f"the answer is from {answer.known.words}; the snow of {_number(number)} was not observed "
        f"on {percent(answer.known.coverage)} of the days {answer.known.season.words}: "
        f"{answer.known.left_out_words}"
    ]


def _number(winters: int) -> str:
    return "1 winter" if winters == 1 else f"{winters} winters"


def assumptions(answer: Answer) -> list[str]:
    """Return what the seasons assume, a sentence each."""
    season = answer.cases[0].season
    cover = "from the weather" if season.cover == "weather" else f"{season.cover}"
    return [
        "The panel is long across the slope: the simulation is of a strip (2D).",
        f"Cells of {100 * answer.design.dx:.3g} cm. Releases thinner than "
        f"{1000 * season.pool_below:.0f} mm slide with those that follow.",
        f"The stack lies on the natural snow cover (its depth: {cover}), and nobody clears it.",
        f"Snow settles ({season.settling or 'not at all'}) on the panel, in the stack and on the "
        "ground.",
        f"Strength and stiffness of a slab follow from its density ({season.strength or 'no'}).",
        "Melt of the stack, rain, wind drift and snow that falls on the stack beside the cover are "
        "left out.",
        "Winters follow each other by chance: the climate does not change.",
    ]


def range_rows(ranges: Ranges) -> list[tuple[str, str, str]]:
    """Return what varies, from where to where."""
    return [(MEANING[name], f"{low:g}", f"{high:g}") for name, (low, high) in ranges.spans.items()]
