"""Tables of the loads of slides on objects: of one slide, and of many with uncertain parameters."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.hazard.maps import moving_notes, stored_maps, wilson_interval
from snowshed.io.film import FILM, Film
from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.frames import slide_frames
from snowshed.methods.slide.objects import ObjectNodes, SlideObject, check_drag
from snowshed.results.reader import Results
from snowshed.scene.builders.terrain_checks import common_system
from snowshed.scene.scene import ResolvedScene
from snowshed.scene.terrain_grid import slide_terrain
from snowshed.study.store import Store
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

RUNS = "runs"  # folder of the store beside maps of probability
PERCENTILES = (50, 95)


def object_loads(folder: Path, objects: Sequence[SlideObject], drag: float) -> pd.DataFrame:
    """Return the loads of a slide, or of the slides of maps of probability, on objects.

    Parameters
    ----------
    folder
        The results folder of a slide, or the folder of ``snowshed slide --range``.
    objects
        The objects, as from `read_objects`.
    drag
        Drag coefficient c_d of the objects.

    Returns
    -------
    pandas.DataFrame
        A row for each object. Of one slide: ``pressure_kpa``, ``depth_m``, ``force_kn`` and, with a
        film, ``duration_s``. Of many slides: the 50th and the 95th percentile of these over the
        slides, and the probability that the object is reached, with its 95 % interval. The notes of
        the slides are in ``attrs["notes"]``.

    Raises
    ------
    InputError
        If the folder has no such results, or an object lies outside the terrain.
    """
    check_drag(drag)
    if (folder / RUNS).is_dir():
        return _loads_of_many(folder, objects, drag)
    return _loads_of_one(folder, objects, drag)


def _loads_of_one(folder: Path, objects: Sequence[SlideObject], drag: float) -> pd.DataFrame:
    import pandas as pd

    results = Results(folder)
    maps, density = results.maps, float(results.scene.data["numerics"]["density"])
    _check_systems(str(maps.attrs["crs"]), objects)
    east, north = maps.x.to_numpy(), maps.y.to_numpy()
    film = folder / FILM
    frames = (
        slide_frames(Film(film), Raster(maps.thickness.to_numpy(), east[0], north[0],
                                        float(east[1] - east[0])))
        if film.is_file()
        else []
    )  # fmt: skip
    rows = []
    for target in objects:
        nodes = ObjectNodes(target, east, north)
        load = nodes.load(maps.peak_speed.to_numpy(), maps.peak_thickness.to_numpy(), density, drag)
        row = {
            "object": target.name,
            "width_m": target.width,
            "drag": drag,
            "pressure_kpa": load.pressure,
            "depth_m": load.depth,
            "force_kn": load.force,
        }
        rows.append(row | ({"duration_s": nodes.duration(frames)} if frames else {}))
    table = pd.DataFrame(rows)
    table.attrs["notes"] = list(getattr(results.summary, "notes", ()))
    return table


def _check_systems(crs: str, objects: Sequence[SlideObject]) -> None:
    """Refuse objects on a map of another coordinate system than the terrain's."""
    common_system([("the terrain", crs), *((target.file, target.crs) for target in objects)])


def _loads_of_many(folder: Path, objects: Sequence[SlideObject], drag: float) -> pd.DataFrame:
    import pandas as pd

    with Store.open(folder / RUNS) as store:
        runs = store.runs(store.named(None))
        done = [run for run in runs if run.status == "done"]
        if not done:
            raise InputError(f"{folder}: no run of the study is done yet")
        ground = slide_terrain(ResolvedScene.parse(runs[0].scene))
        _check_systems(ground.crs, objects)
        height, width = ground.heights.shape
        east = ground.east + ground.cell * np.arange(width, dtype=float)
        north = ground.north + ground.cell * np.arange(height, dtype=float)
        nodes = [ObjectNodes(target, east, north) for target in objects]
        loads = np.zeros((3, len(objects), len(done)))
        for number, run in enumerate(done):
            maps = stored_maps(store, run.hash)
            density = float(ResolvedScene.parse(run.scene).data["numerics"]["density"])
            speed, depth = (
                maps.window(name, 0, height).astype(float) for name in ("speed", "thickness")
            )
            for place, of_object in enumerate(nodes):
                load = of_object.load(speed, depth, density, drag)
                loads[:, place, number] = load.pressure, load.depth, load.force
    rows = []
    for place, target in enumerate(objects):
        reached = int((loads[1, place] > 0.0).sum())
        low, high = wilson_interval(reached, len(done))
        row = {
            "object": target.name, "width_m": target.width, "drag": drag, "slides": len(done),
            "reached": reached / len(done), "reached_low": float(low), "reached_high": float(high),
        }  # fmt: skip
        for name, values in zip(("pressure_kpa", "depth_m", "force_kn"), loads[:, place]):
            for percentile in PERCENTILES:
                row[f"{name}_p{percentile}"] = float(np.percentile(values, percentile))
        rows.append(row)
    table = pd.DataFrame(rows)
    table.attrs["notes"] = moving_notes(read_table(folder / RUNS), len(done))
    return table
