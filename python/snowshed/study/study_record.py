"""The record of a study beside its store: from this file alone the study is computed again.

It holds the scene, the factors, the seeds, the weather of a season row by row, and the names of
laws of one's own; files that these name stay files, with checksums.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.array_files import is_array_file
from snowshed.io.atomic import write_text
from snowshed.io.json_file import plain_value, read_object, sealed
from snowshed.results.computed_record import STUDY, record_data, recorded_inputs
from snowshed.results.replacement import inputs_beside
from snowshed.running.kept_inputs import copy_array_file
from snowshed.scene.named_files import named_files, with_named_files
from snowshed.scene.scene import Scene
from snowshed.season.settings import settings_of
from snowshed.season.weather.rows_data import rows_data, rows_of
from snowshed.study.factors import Factor
from snowshed.study.named_laws import NamedLaws
from snowshed.study.scene_hash import RunKey
from snowshed.study.season_part import SeasonPart
from snowshed.study.store import Store
from snowshed.study.study_file import Content, with_absolute_files

PLAIN_NAME = re.compile(r"\w[\w.-]*", re.ASCII)


def record_path(folder: PathLike, study: str) -> Path:
    """Return the path of the record of a study in the folder of its store.

    Examples
    --------
    >>> record_path("results", "tilts").name, record_path("results", "a/b").name
    ('tilts.json', 'study-c14cddc033f6.json')
    """
    if PLAIN_NAME.fullmatch(study):
        return Path(folder) / f"{study}.json"
    return Path(folder) / f"study-{hashlib.sha256(study.encode()).hexdigest()[:12]}.json"


def write_record(folder: PathLike, content: Content, runs: Sequence[RunKey]) -> None:
    """Write the record of a study, with the notes on its runs so far.

    Arrays in memory, from which its scene was made, are copied into ``FOLDER-inputs``.
    """
    try:
        inputs = json.loads(json.dumps(_inputs(content), default=plain_value))
    except TypeError as error:
        issue_note(f"{content.name}: no record of the study was written: {error}")
        return
    if any(map(is_array_file, named_files(inputs))):
        beside = inputs_beside(folder)
        beside.mkdir(parents=True, exist_ok=True)
        inputs = with_named_files(inputs, lambda path: copy_array_file(path, beside))
    inputs["runs"] = {"count": len(runs), "digest": _digest(runs)}
    record = record_data(STUDY, inputs, _files(inputs, content))
    _write(folder, content.name, record)


def renew_notes(folder: PathLike, study: str) -> None:
    """Write the notes on the runs of a study into its record again, if there is one."""
    path = record_path(folder, study)
    if path.is_file():
        _write(folder, study, read_object(path))


def read_study(file: Path) -> Content:
    """Return the study in a record; note what differs from the time of its writing.

    Raises
    ------
    InputError
        If the file is no record of a study, or damaged.
    """
    with recorded_inputs(file, STUDY) as inputs:
        return _content(inputs)


def note_other_runs(file: Path, runs: Sequence[RunKey]) -> None:
    """Issue a note if the runs of a study that was read are not those of its record."""
    if read_object(file)[STUDY]["runs"]["digest"] != _digest(runs):
        issue_note(
            f"{file}: its runs are others now: a file, a law, a default or the version of snowshed "
            "has changed",
            InputNote,
        )


def _inputs(content: Content) -> dict[str, Any]:
    folder = Path(content.scene._base_dir).absolute()
    inputs: dict[str, Any] = {
        "name": content.name,
        "description": content.description,
        "seeds": None if content.seeds is None else list(content.seeds),
        "scene": with_absolute_files(content.scene.to_data(), folder),
        "parts": [
            [with_absolute_files(dict(factor.columns), folder) for factor in part]
            for part in content.parts
        ],
    }
    if content.season is not None:
        rows = rows_data(content.season.rows)
        inputs["season"] = {"settings": asdict(content.season.settings), "weather": rows}
    if content.laws is not None:
        files = list(map(str, content.laws.files))
        inputs["laws"] = {"make": content.laws.make, "files": files}
    return inputs


def _content(inputs: Mapping[str, Any]) -> Content:
    season, laws = inputs.get("season"), inputs.get("laws")
    return Content(
        Scene.from_data(inputs["scene"]),
        [[Factor(columns) for columns in part] for part in inputs["parts"]],
        inputs["name"],
        inputs["seeds"],
        inputs["description"],
        None
        if season is None
        else SeasonPart(
            rows_of(season["weather"], "season: weather"), settings_of(season["settings"])
        ),
        None if laws is None else NamedLaws(laws["make"], laws["files"]),
    )


def _files(inputs: Mapping[str, Any], content: Content) -> list[str]:
    """Return the files that a study names: of its scenes, and the sources of its laws."""
    factors = [
        {path.rpartition(".")[2]: value}
        for part in inputs["parts"]
        for columns in part
        for path, values in columns.items()
        for value in values
    ]
    laws = content.laws.data()["sources"] if content.laws is not None else []
    return list(named_files({"scene": inputs["scene"], "factors": factors, "laws": laws}))


def _write(folder: PathLike, study: str, record: dict[str, Any]) -> None:
    with Store.open(folder) as store:
        notes = Counter(note for run in store.runs(study) for note in run.notes)
    record["notes"] = [{"note": note, "runs": runs} for note, runs in notes.most_common()]
    write_text(record_path(folder, study), sealed(record))


def _digest(runs: Sequence[RunKey]) -> str:
    return hashlib.sha256("".join(run.hash for run in runs).encode()).hexdigest()
