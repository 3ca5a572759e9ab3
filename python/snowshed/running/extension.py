"""Extension of a finished run in a new folder: more events, also with other snow."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.callers import resuming_call
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.io.atomic import replacing_folder, write_text
from snowshed.io.folders import check_empty
from snowshed.io.json_file import read_object, sealed
from snowshed.io.run_files import RECORD
from snowshed.methods.registry import method_of
from snowshed.results.folder import RunFolder, parse_events
from snowshed.running.ageing.ageing import Ageing
from snowshed.running.run import run_events
from snowshed.running.scene_notes import notes_of_end
from snowshed.scene.components import Snow
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    import pandas as pd

#: Files of a run from which the new run continues.
CONTINUED_FILES = (
    *(RECORD, "events.csv", "outline.csv", "conversions.csv", "ageing.csv", "ageing.json"),
    *(
        "energy.csv",
        "forces.csv",
        "loads.csv",
        "pressures",
        "film.bin",
        "particles.pvd",
        "particles",
        "snapshots",
    ),
)


@checked
def extend_run(
    results: PathLike,
    folder: PathLike,
    events: int,
    *,
    snow: Optional[Snow] = None,
    thickness: Optional[float] = None,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
) -> pd.DataFrame:
    """Add slide-offs to a finished run, in a new results folder.

    The results of the finished run stay as they are. If the slabs are the same, the new folder
    holds, bit for bit, the results of a run that had all these events from the start.

    Parameters
    ----------
    results
        The folder of the finished run.
    folder
        The new folder; new or empty.
    events
        Number of further events.
    snow
        Snow of the slabs of these events. [default: as before]
    thickness
        Thickness of the slabs of these events, m. [default: as before]
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw the pictures at the end.

    Returns
    -------
    pandas.DataFrame
        One row per event, also of those before.

    Raises
    ------
    InputError
        If the run is not finished, its method has no further events, or an argument is not
        allowed; nothing has been written then.
    SimulationError
        If the simulation cannot continue; a checkpoint holds its last good state.
    Interrupted
        After Ctrl-C; the new folder is resumed as any other.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene, run_events
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     _ = run_events(tiny, folder + "/one", pictures=False)
    ...     table = extend_run(folder + "/one", folder + "/two", 1, pictures=False)
    >>> table.event.tolist()
    [1, 2]
    """
    earlier = RunFolder(results)
    if not earlier.scene.is_file() or not earlier.checkpoint.is_file():
        raise InputError(
            f"{results}: not a run that can be extended; the scene or the checkpoint is missing"
        )
    scene = ResolvedScene.load(earlier.scene)
    status = earlier.read_run().get("status")
    if status != "finished":
        raise InputError(
            f"{results}: not finished ({status}); first resume it with "
            f"{resuming_call(earlier.scene, results)}"
        )
    longer = extended_scene(scene, events, snow=snow, thickness=thickness)
    check_empty(folder)
    ageing = read_object(earlier.ageing) if earlier.ageing.is_file() else None
    _prepare(earlier, scene, longer, Path(folder))
    return run_events(
        longer,
        folder,
        resume=True,
        ageing=None if ageing is None else Ageing.from_data(ageing, str(earlier.ageing)),
        progress=progress,
        pictures=pictures,
    )


def extended_scene(
    scene: ResolvedScene,
    events: int,
    *,
    snow: Optional[Snow] = None,
    thickness: Optional[float] = None,
) -> ResolvedScene:
    """Return a scene with more events; the new events may lay other slabs.

    Raises
    ------
    InputError
        If its method has no further events, it has no slab to change, or a value is not allowed.

    Examples
    --------
    >>> from snowshed import Scene
    >>> lab = Scene.preset("lab-50").set("events.count", 2).resolve()
    >>> layers = extended_scene(lab, 1, thickness=0.03).data["slab"]["layers"]
    >>> [(layer["event"], layer["thickness"]) for layer in layers]
    [(1, 0.02), (2, 0.02), (3, 0.03)]
    """
    data: dict[str, Any] = scene.copied_data()
    method = method_of(data)
    if "stack" not in method.results:
        raise InputError(f'/method: "{method.name}" has a single event; none can follow')
    if isinstance(events, bool) or not isinstance(events, int) or events < 1:
        raise InputError(f"events: {events!r}; a whole number from 1 is needed")
    done = data["events"]["count"]
    changes: dict[str, Any] = {}
    if snow is not None:
        changes["snow"] = snow.to_data()
    if thickness is not None:
        changes["thickness"] = thickness
    if changes and not data.get("slab"):
        raise InputError("/slab: missing; the scene has no slab to change")
    if snow is not None and "snow" not in data:
        raise InputError("/snow: the snow of this method is the same in all events")
    if data.get("slab"):
        _change_slab(data["slab"], done, done + events, changes)
    data["events"]["count"] = done + events
    return ResolvedScene.from_data(data, scene.base_dir)


def _change_slab(slab: dict[str, Any], done: int, last: int, changes: Mapping[str, Any]) -> None:
    """Keep the slab of the past events, and set that of the events to come.

    A slab that is the same in all events stays as it is. Where every layer belongs to a single
    event, as after an earlier change, the layers of the last event are laid again.
    """
    layers = slab["layers"] or [{"thickness": slab["thickness"], "event": 0}]
    always = [layer for layer in layers if not layer.get("event")]
    if always and not changes:
        return
    repeated = always or [layer for layer in layers if layer.get("event") == done]
    if "thickness" in changes and len(repeated) > 1:
        raise InputError(
            "/slab/layers: several layers; a new thickness needs a slab with a single layer"
        )
    before = [
        {**layer, "event": event}
        for event in range(1, done + 1)
        for layer in layers
        if layer.get("event", 0) in (0, event)
    ]
    after = [
        {**layer, **changes, "event": event}
        for event in range(done + 1, last + 1)
        for layer in repeated
    ]
    slab["layers"] = before + after
    slab["thickness"] = 0.0  # the layers have the thickness


def _prepare(
    earlier: RunFolder, earlier_scene: ResolvedScene, scene: ResolvedScene, folder: Path
) -> None:
    """Make the new folder, whole or not at all, as if its own run had computed the past events."""
    simulation = _core.Simulation.load_into(
        scene.core, scene.base_dir, os.fspath(earlier.checkpoint)
    )
    with replacing_folder(folder) as beside:
        for name in CONTINUED_FILES:
            there = earlier.folder / name
            if there.is_dir():
                shutil.copytree(there, beside / name)
            elif there.exists():
                shutil.copyfile(there, beside / name)
        if earlier.events.path.is_file():
            ended = notes_of_end(parse_events(earlier.events.path), earlier_scene)
            _drop_notes(beside / RECORD, ended)
        simulation.save(os.fspath(beside / "checkpoint.bin"))
        scene.save(beside / "scene.json")


def _drop_notes(file: Path, ended: Sequence[str]) -> None:
    """Remove the notes on the end of a run from its record, because it goes on."""
    record = read_object(file)
    notes = [note for note in record.get("notes", ()) if note not in ended]
    write_text(file, sealed({**record, "notes": notes}))
