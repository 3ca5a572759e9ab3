"""Errors that end a study before its last run is computed."""

from __future__ import annotations

from pathlib import Path

from snowshed._core import SimulationError
from snowshed.base.paths import shell_words


class StudyError(SimulationError):
    """The study cannot continue because of a fault of the machine; stored results are safe."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"{reason}; stored results are safe. Remove the cause, then repeat the command "
            "to resume"
        )


class StudyInterrupted(KeyboardInterrupt):
    """A study was interrupted; its runs have left checkpoints in its folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__(f"interrupted; resume with: {resume_study_command(folder)}")


def resume_study_command(folder: Path) -> str:
    """Return the command that resumes the studies in a folder."""
    return shell_words("snowshed", "study", "resume", folder)
