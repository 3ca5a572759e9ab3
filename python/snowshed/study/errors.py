"""Errors that end a study before its last run is computed."""

from __future__ import annotations

from pathlib import Path

from snowshed._core import SimulationError


class StudyError(SimulationError):
    """The study cannot go on, for a reason that lies in the machine; what is stored is safe."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"{reason}; what is stored is safe. When that is mended, repeat the command to go on"
        )


class StudyInterrupted(KeyboardInterrupt):
    """A study was interrupted; its runs have left checkpoints in its folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__(f"interrupted; go on with: {resume_command(folder)}")


def resume_command(folder: Path) -> str:
    """Return the command that goes on with the studies in a folder."""
    return f"snowshed study resume {folder}"
