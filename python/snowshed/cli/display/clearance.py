"""The output of ``snowshed clearance``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from snowshed.analysis.clearance import words
from snowshed.analysis.clearance.answer import Answer
from snowshed.cli.display.winters import print_quality
from snowshed.cli.terminal import plain_table, wide_console


def print_answers(answers: Sequence[Answer], folder: Path) -> None:
    """Print the answer in a sentence, and the heights for each panel and probability."""
    console = wide_console(120)
    console.print(words.sentence(answers))
    head = ("slope\nlength, m", "tilt\ndegrees", "stays\nclear", "height\nm", "90 % confidence\nm")
    shown = plain_table("Height of the lower edge", head, padding=0)
    for answer in answers:
        for level in answer.levels:
            shown.add_row(
                f"{answer.design.slope_length:g}",
                f"{answer.design.tilt:g}",
                f"{100 * level.probability:g} %",
                f"{level.height:.2f}",
                f"{level.low:.2f} to {level.high:.2f}",
            )
    console.print(shown)
    if answers[0].known is not None:
        print_quality(console, answers[0].known)
    for warning in words.warnings(answers):
        console.print(f"note: {warning}")
    console.print(f"clearance.html and clearance.csv in {folder}")
