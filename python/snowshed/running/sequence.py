"""The core's sequence of events in a results folder: opened, and run to its end.

Notes (`snowshed.base.notes`) that readers of the results need are issued here and written into
run.json, so that every caller sees the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Optional

import snowshed._core as _core
from snowshed.base.interrupt import Interrupted
from snowshed.base.notes import SnowshedNote, issue_note
from snowshed.base.paths import PathLike, utf8_path
from snowshed.io.run_files import file_mark
from snowshed.running.laws import Laws, addresses_of
from snowshed.running.scene_notes import notes_before
from snowshed.scene.scene import ResolvedScene

REPORT_INTERVAL = 0.5  # s of wall time between progress reports


def open_sequence(
    scene: ResolvedScene, folder: PathLike, *, resume: bool, laws: Optional[Laws] = None
) -> _core.EventSequence:
    """Return the sequence of a scene's events in a folder that is new, empty or to be resumed.

    Raises
    ------
    InputError
        If the scene is wrong, the folder is not empty, or there is nothing to resume.
    """
    open_folder = _core.EventSequence.resume if resume else _core.EventSequence.create
    addresses = addresses_of(laws, scene.data)
    return open_folder(scene.core, scene.base_dir, utf8_path(folder), addresses)


def seal_files(sequence: _core.EventSequence, folder: PathLike, *names: str) -> None:
    """Add checksums of files in the results folder to run.json, when it is written next."""
    marks = {name: file_mark(Path(folder) / name) for name in names}
    sequence.files = {**sequence.files, **marks}


def record_note(
    sequence: _core.EventSequence, note: str, subject: type[SnowshedNote] = SnowshedNote
) -> None:
    """Issue a note on a run, and add it once to run.json; `subject` as for `issue_note`."""
    sequence.add_note(note)
    issue_note(note, subject)


@contextmanager
def issuing_notes(core: _core.Simulation) -> Iterator[None]:
    """Issue the notes that a simulation makes within the block."""
    count = len(core.notes)
    yield
    for note in core.notes[count:]:
        issue_note(note)


def run_sequence(
    sequence: _core.EventSequence,
    observer: _core.EventObserver,
    scene: ResolvedScene,
    folder: PathLike,
) -> None:
    """Run the remaining events; a failure is recorded in the folder.

    The observer learns of the progress about twice a second. Warnings about the scene come first.

    Raises
    ------
    SimulationError, InputError
        If the simulation cannot continue.
    Interrupted
        If the observer asked for a stop; a checkpoint holds the state to resume from.
    """
    for note in notes_before(scene.data):
        record_note(sequence, note)
    try:
        finished = sequence.run(observer, REPORT_INTERVAL)
    except (_core.SimulationError, _core.InputError) as error:
        sequence.record_failure(str(error))
        raise
    if not finished:
        raise Interrupted(Path(folder))
