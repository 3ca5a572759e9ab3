"""A run that is repeated from its run.json alone."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.build import package_digest
from snowshed.base.callers import either
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.input_file import read_input
from snowshed.io.json_file import parse_object, read_object
from snowshed.io.run_files import RECORD, beyond_scene, file_mark, is_record
from snowshed.running.ageing.ageing import Ageing
from snowshed.running.laws import Laws, precision_of
from snowshed.scene.scene import SceneLike


@dataclass(frozen=True)
class RecordedRun:
    """The settings of an earlier run besides its scene.

    Attributes
    ----------
    record
        The content of its run.json.
    path
        The file.
    """

    record: Mapping[str, Any]
    path: Path

    @property
    def ageing(self) -> Optional[Ageing]:
        """The ageing of its stack between events; None: none."""
        data = self.record.get("ageing")
        return None if data is None else Ageing.from_data(data, f"{self.path}: ageing")

    def check_laws(self, laws: Optional[Laws]) -> None:
        """Raise InputError unless the laws of one's own are those of the run, by their name."""
        then, now = self.record.get("laws"), None if laws is None else laws.name
        if then is not None and then != now:
            give = either("give them (`laws=`)", "resume it in Python, with its laws (`laws=`)")
            raise InputError(f"{self.path}: made with the laws {then!r}; {give}")

    def differences(self, laws: Optional[Laws] = None) -> list[str]:
        """Return notes on what has changed since: the build, the files of the scene, the laws."""
        notes = []
        if laws is not None and self.record.get("laws"):
            then = self.record.get("laws_digest")
            now = laws.digest(precision_of(self.record["scene"]))
            if then is None or now is None:
                notes.append(
                    f"laws of the user: {laws.name}; known by this name only, so they may differ "
                    f"from those of {self.path}"
                )
            elif then != now:
                notes.append(
                    f"laws of the user: {laws.name}; their code has changed since the run of "
                    f"{self.path}"
                )
        present = {"build": _core.build_id, "package": package_digest()}
        if any(self.record.get(name, digest) != digest for name, digest in present.items()):
            notes.append(f"{self.path} is of another build of snowshed")
        inputs = self.record.get("inputs")
        for name, mark in inputs.items() if isinstance(inputs, dict) else ():
            path = Path(name)
            known = (mark.get("bytes"), mark.get("checksum")) if isinstance(mark, dict) else None
            if path.is_file() and file_mark(path) != known:
                notes.append(f"{path} has changed since the run of {self.path}")
        return notes


def recorded_run(scene: SceneLike) -> Optional[RecordedRun]:
    """Return the recorded run if a scene is given by the path of a run.json or a copy; else None.

    Raises
    ------
    InputError
        If the file is damaged.
    """
    if not isinstance(scene, (str, os.PathLike)):
        return None
    content = read_input(Path(scene))
    if b'"scene"' not in content:  # without parsing it
        return None
    record = parse_object(content, os.fspath(scene))
    return RecordedRun(record, Path(scene)) if is_record(record) else None


def check_scene_alone(scene: SceneLike, laws: Optional[Laws]) -> None:
    """Check the laws for a simulation of the scene of a recorded run; note its ageing."""
    recorded = recorded_run(scene)
    if recorded is None:
        return
    recorded.check_laws(laws)
    if recorded.ageing is not None:
        issue_note(f"{recorded.path}: the ageing of its run is left out; run repeats it", InputNote)


def note_run_beside(scene: SceneLike, *, as_it_was: bool) -> None:
    """Note that the run of a scene.json had more than its scene.

    Parameters
    ----------
    scene
        The scene, perhaps the path of the scene.json of a run.
    as_it_was
        Whether the new run has ageing or laws, too.
    """
    if as_it_was or not isinstance(scene, (str, os.PathLike)):
        return
    path = Path(scene)
    if path.name != "scene.json" or not (path.parent / RECORD).is_file():
        return
    if more := beyond_scene(read_object(path.parent / RECORD)):
        issue_note(
            f"{path}: its run had {more}, which a scene does not hold; {path.parent / RECORD} "
            "repeats the run",
            InputNote,
        )
