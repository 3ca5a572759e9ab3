"""Notes on unusual values of factors, such as tilts in radians, when a study is made."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterator, Mapping, Sequence

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.notes import issue_note
from snowshed.scene.named_files import named_files
from snowshed.scene.scene import Scene
from snowshed.scene.schema import current_path
from snowshed.study.factors import Factor, Part

Point = Mapping[str, object]


def note_on_unusual_values(scene: Scene, parts: Sequence[Part]) -> None:
    """Issue the scene's note on an unusual value of each factor, at most one for each.

    The points with the smallest and the largest value of each parameter are looked at. Of scenes
    that name files only the values are, not the files, because reading these takes long. Runs note
    the values of wrong scenes.
    """
    notes = (note for part in parts for note in _notes_on_part(scene, part))
    for note in dict.fromkeys(notes):  # parts may have the same factors
        issue_note(note)
    paths = {path for part in parts for factor in part for path in factor.columns}
    if "dimension" not in paths and scene.dimension == 2:
        for path in sorted(path for path in paths if path.endswith(".width")):
            issue_note(f"{path}: has no effect in 2D; all its values give the same results")


def _notes_on_part(scene: Scene, part: Part) -> Iterator[str]:
    """Yield at most one note on each factor, at the first values of all others."""
    firsts = {path: value for factor in part for path, value in factor.points()[0].items()}
    for factor in part:
        yield from itertools.islice(_notes(scene, firsts, factor), 1)


def _notes(scene: Scene, others: Point, factor: Factor) -> Iterator[str]:
    """Yield the notes of a scene on the values of a factor at its extreme points."""
    for path, values in factor.columns.items():
        name = "/" + current_path(path).replace(".", "/")
        for row in _extremes(values):
            for note in _notes_at(scene, {**others, **factor.points()[row]}):
                if note.startswith(f"{name}: "):
                    yield f"{path} = {values[row]}: {note}"


def _extremes(values: Sequence[object]) -> Sequence[int]:
    """Return the places of the smallest and the largest number; none without numbers.

    Examples
    --------
    >>> _extremes([0.3, 0.1, 0.9]), _extremes(["slip"])
    ([1, 2], [])
    """
    numbers = {
        place: float(value)
        for place, value in enumerate(values)
        if isinstance(value, (int, float)) and not isinstance(value, bool)
    }
    if not numbers:
        return []
    return [min(numbers, key=numbers.__getitem__), max(numbers, key=numbers.__getitem__)]


def _notes_at(scene: Scene, point: Point) -> Sequence[str]:
    """Return the notes of the core on the scene at a point; none if the scene is wrong."""
    try:
        with warnings.catch_warnings():  # the runs have the warnings on other parts
            warnings.simplefilter("ignore")
            resolved = scene.with_(point).resolve()
            if any(named_files(resolved.data)):
                return resolved.core.unusual_values
            return list(_core.Simulation(resolved.core, resolved.base_dir).notes)
    except (InputError, OSError):
        return []
