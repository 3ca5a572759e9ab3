"""Every reader of files, with a good file: one line in `READERS` for each.

A reader gets the path of a file that was changed. It may raise the exceptions that the command line
turns into a sentence (`REFUSED`). `exact` readers must return the content of the good file, because
their formats are ours and carry checksums.
"""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import good_files as good
import hostile_images as hostile
import numpy as np
from conftest import tiny_scene
from helpers import weather_files
from helpers.bad_scenes import CLOSED_MESH
from helpers.grain_files import write_labels
from helpers.voxel_files import save_metaimage, save_pages

from snowshed import InputError, Results, Scene, SimulationError, Snow, _core, run_events
from snowshed.cli.options.scene import json_object
from snowshed.io.csv_table import read_csv
from snowshed.io.film import Film
from snowshed.io.raster.areas import read_areas
from snowshed.io.raster.raster import read_raster
from snowshed.io.voxels.open_voxels import open_voxels
from snowshed.io.vtk.pvd import read_series
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.run import GrainsRun
from snowshed.methods.grains.sample_folder import find_sample
from snowshed.methods.slide.maps import PeakMaps

REFUSED = (InputError, SimulationError, OSError)


@dataclasses.dataclass(frozen=True)
class Reader:
    """A kind of file: a function that writes a good file into a folder, and the reader."""

    make: Callable[[Path], Path]
    read: Callable[[Path], Any]
    exact: bool = False
    share: float = 1.0  # of the usual number of tries; slow readers get fewer
    change: Callable[[bytes, int], bytes] | None = None  # by a seed; None: `mutated`


# --- reading -------------------------------------------------------------------------------


def _simulation_with(shape: dict[str, Any], dimension: int) -> _core.Simulation:
    scene = tiny_scene(dimension=dimension).append("obstacles", {"shape": shape})
    return _core.Simulation(scene.resolve().json, ".")


def _as_mesh(file: Path) -> None:
    _simulation_with({"type": "mesh", "file": str(file), "scale": 0.1}, 3)


def _as_grid(file: Path) -> None:
    shape = {"type": "grid", "file": str(file), "origin": [0, 0.2], "spacing": 0.025}
    _simulation_with(shape, 2)


def _as_labels(file: Path) -> None:
    _core.Simulation(good.grains_of(file).resolve().json, ".").begin_event()


def _as_scene(file: Path) -> None:
    Scene.load(file)
    simulation = _core.Simulation(_core.ParsedScene.load(str(file)), str(file.parent))
    if simulation.scene and simulation.event_count:
        _core.update_version(file.read_text(errors="replace"))


def _as_checkpoint(file: Path) -> str:
    simulation = _core.Simulation.load(str(file))
    arrays = [simulation.positions(), simulation.velocities(), simulation.masses()]
    facts = [simulation.scene, simulation.event, simulation.event_running, simulation.time_s]
    return _digest([*(array.tobytes() for array in arrays), facts])


def _as_store(file: Path) -> Any:
    from snowshed.study.store import Store
    from snowshed.study.table import read_table

    folder = file.parent / "copy"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(file, folder / "store.sqlite")
    with Store.open(folder) as store:
        particles = [
            store.particles(run.hash) for name in store.studies() for run in store.runs(name)
        ]
    return read_table(folder, timing=True).to_csv(), particles


def _as_resumed_table(file: Path) -> Any:
    """Resume a finished run with a changed table; return the tables."""
    folder = file.parent
    with contextlib.redirect_stderr(None):
        run_events(folder / "scene.json", folder, resume=True, pictures=False)
    return [read_csv(folder / name).to_csv() for name in ("outline.csv", "energy.csv")]


def _as_record(file: Path) -> str:
    """Resume a finished run with a changed run.json, unless reading already refuses it."""
    record = Results(file.parent).run
    run_events(file.parent / "scene.json", file.parent, resume=True, pictures=False)
    return json.dumps(record)


def _as_lua(file: Path) -> None:
    from snowshed.scene import load_lua

    load_lua(file)


def _as_season(file: Path) -> None:
    from snowshed.season.weather.reading import read_season

    read_season(file)


def _as_measurements(file: Path) -> None:
    from snowshed.analysis.calibration.measurements import read_measurements

    read_measurements(file)


def _as_stack_table(file: Path) -> None:
    from snowshed.study.stack_table import StackTable

    StackTable.read_file(file)


def _as_study(file: Path) -> None:
    from snowshed.study import Study

    with contextlib.suppress(OverflowError):
        Study.load(file)


def _as_model(file: Path) -> Any:
    from snowshed.analysis.regression import load_model

    model = load_model(file)
    return _digest([model.title, model.measure, model.inputs.tobytes(), repr(model.members)])


def _as_packed(file: Path) -> Any:
    from snowshed.results.event_particles import EventParticles

    return _digest([repr(vars(EventParticles.unpacked(file.read_bytes())))])


def _as_ini(file: Path) -> None:
    from snowshed.scene.builders.avaframe.ini import read_ini

    read_ini(file)


def _as_particles(file: Path) -> str:
    return _digest([(name, array.tobytes()) for name, array in read_particles(file).items()])


def _as_film(file: Path) -> str:
    from snowshed.plot.film_summary import summarise_film

    film = Film(file)
    frames = [
        (frame.time, frame.event, frame.ids.tobytes(), frame.events.tobytes(),
         frame.materials.tobytes(), frame.radii.tobytes(), frame.positions.tobytes(),
         frame.codes.tobytes())
        for frame in film
    ]  # fmt: skip
    summary = summarise_film(film)
    if film.notes and len(frames) < good.FRAMES:
        raise InputError("cut off, as its notes say; a killed run leaves such a film")
    facts = (film.dimension, film.quantum, film.interval, film.share, film.quantities)
    return _digest([frames, facts, [colouring.title for colouring in summary.colourings]])


def _as_image(file: Path) -> None:
    opened = open_voxels(file)
    opened.layers(0, opened.shape[0])


def _as_slice(file: Path) -> None:
    _as_image(file.parent)


def _as_sample(file: Path) -> None:
    find_sample(file.parent, "labels.npy")


def _as_peaks(file: Path) -> str:
    return _digest([repr(vars(PeakMaps.unpacked(file.read_bytes())))])


def _as_snow(file: Path) -> None:
    with contextlib.suppress(click.ClickException):
        Snow.from_data(json_object(str(file)))


def _as_events(file: Path) -> str:
    return Results(file.parent).events.to_csv()


def _as_film_of_run(file: Path) -> str:
    film = Results(file.parent).film
    return _digest(
        [(frame.time, frame.positions.tobytes(), frame.codes.tobytes()) for frame in film]
    )


def _as_scene_of_run(file: Path) -> str:
    data = Results(file.parent).scene.copied_data()
    data["numerics"].pop("threads")  # no part of the results
    return json.dumps(data)


def _as_outline(file: Path) -> str:
    return Results(file.parent).outline.to_csv()


def _as_energies(file: Path) -> str:
    return Results(file.parent).energy.to_dataframe().to_csv()


def _as_history(file: Path) -> str:
    return Results(file.parent).energy_history.to_csv()


def _as_curve(file: Path) -> str:
    """Read a curve, and check that `snowshed-run` does not resume with a changed curve."""
    text = LoadingCurve.read(file).text()
    folder, scene = str(file.parent), str(file.parent / "scene.json")
    command = [str(Path(sys.executable).with_name("snowshed-run")), scene, "-o", folder]
    done = subprocess.run([*command, "--resume", "-q"], capture_output=True, text=True)
    if done.returncode == 2:
        raise InputError(done.stderr)
    assert done.returncode == 0, done.stderr
    return text


def _as_summary(file: Path) -> str:
    (row,) = GrainsRun.rows(file.parent)
    return json.dumps(row)


def _as_series(file: Path) -> Any:
    return [(time, str(path)) for time, path in read_series(file)]


def _digest(value: object) -> str:
    return hashlib.sha256(pickle.dumps(value)).hexdigest()


#: A new reader is an additional line.
READERS = {
    "scene": Reader(good.scene, _as_scene, share=2),
    "mesh obj": Reader(good.text("a.obj", CLOSED_MESH), _as_mesh),
    "mesh stl": Reader(good.stl, _as_mesh),
    "mesh ply": Reader(good.text("a.ply", good.PLY), _as_mesh),
    "npy grid": Reader(good.grid, _as_grid),
    "npy labels": Reader(write_labels, _as_labels),
    "ascii raster": Reader(good.ascii_raster, read_raster),
    "geotiff": Reader(good.geotiff, read_raster),
    "polygons geojson": Reader(good.polygons(".geojson"), read_areas),
    "polygons shp": Reader(good.polygons(".shp"), read_areas),
    "polygons gpkg": Reader(good.polygons(".gpkg"), read_areas, share=0.5),
    "avaframe ini": Reader(good.text("a.ini", good.INI), _as_ini),
    "season": Reader(good.text("season.csv", good.SEASON), _as_season),
    **{
        f"weather {name}": Reader(good.text("station.txt", text), _as_season, share=0.5)
        for name, (text, *_) in weather_files.FILES.items()
    },
    "film": Reader(good.film, _as_film, exact=True),
    "film of version 1": Reader(good.film_of_version_1, _as_film, exact=True, share=0.5),
    "film of a run": Reader(good.result("film.bin"), _as_film_of_run, exact=True),
    "scene of a run": Reader(good.result("scene.json"), _as_scene_of_run, exact=True, share=0.5),
    "image npy": Reader(good.image("a.npy", np.save), _as_image),
    "image mha": Reader(good.image("a.mha", save_metaimage), _as_image),
    "image npy columns first": Reader(good.image("a.npy", good.save_columns_first), _as_image),
    "image mha packed": Reader(good.image("a.mha", good.save_packed), _as_image),
    "image mha as text": Reader(good.image("a.mha", good.save_as_text), _as_image),
    "image tiff": Reader(good.image("a.tif", save_pages), _as_image),
    "image tiff packed": Reader(good.image("a.tif", good.save_tiles), _as_image),
    "image tiff of imagej": Reader(good.image("a.tif", good.save_imagej), _as_image),
    "image tiff of ome": Reader(good.image("a.tif", good.save_ome), _as_image),
    "hostile npy": Reader(good.image("a.npy", np.save), _as_image, change=hostile.npy),
    "hostile mha": Reader(good.image("a.mha", save_metaimage), _as_image, change=hostile.mha),
    "hostile tiff": Reader(good.image("a.tif", good.save_plain), _as_image, change=hostile.tiff),
    "hostile packed tiff": Reader(
        good.image("a.tif", good.save_tiles), _as_image, change=hostile.tiff
    ),
    "hostile png": Reader(good.slice_of("png"), _as_slice, change=hostile.png),
    "hostile bmp": Reader(good.slice_of("bmp"), _as_slice, change=hostile.bmp),
    "slice png": Reader(good.slice_of("png"), _as_slice),
    "slice bmp": Reader(good.slice_of("bmp"), _as_slice),
    "slice tiff": Reader(good.slice_of("tif"), _as_slice),
    "sample": Reader(good.sample, _as_sample, share=0.5),
    "loading curve": Reader(good.curve, _as_curve, exact=True),
    "grains.json": Reader(good.grains_summary, _as_summary, exact=True, share=0.5),
    "peak maps": Reader(good.peaks, _as_peaks, exact=True),
    "snow": Reader(good.snow, _as_snow),
    "events.csv": Reader(good.result("events.csv"), _as_events, exact=True),
    "outline.csv, shown": Reader(good.result("outline.csv"), _as_outline, exact=True, share=0.5),
    "energy.csv, shown": Reader(good.result("energy.csv"), _as_energies, exact=True, share=0.5),
    "energy_history.csv": Reader(
        good.result("energy_history.csv"), _as_history, exact=True, share=0.5
    ),
    "measurements": Reader(good.text("measured.csv", good.MEASURED), _as_measurements),
    "stack table": Reader(good.study_table, _as_stack_table),
    "study": Reader(good.text("study.toml", good.STUDY), _as_study),
    "lua": Reader(good.text("a.lua", good.LUA), _as_lua, share=0.3),
    "vtp": Reader(good.result("particles/event_001.vtp"), _as_particles, exact=True),
    "pvd": Reader(good.result("particles.pvd"), _as_series, exact=True),
    "checkpoint": Reader(good.checkpoint, _as_checkpoint, exact=True),
    "checkpoint of grains": Reader(good.grains_checkpoint, _as_checkpoint, exact=True, share=0.5),
    "checkpoint of a slide": Reader(good.slide_checkpoint, _as_checkpoint, exact=True, share=0.5),
    "checkpoint of mps": Reader(good.mps_checkpoint, _as_checkpoint, exact=True, share=0.5),
    "run.json": Reader(good.result("run.json"), _as_record, exact=True, share=0.5),
    "outline.csv": Reader(good.result("outline.csv"), _as_resumed_table, exact=True, share=0.5),
    "energy.csv": Reader(good.result("energy.csv"), _as_resumed_table, exact=True, share=0.5),
    "store": Reader(good.store, _as_store, exact=True),
    "kept particles": Reader(good.packed, _as_packed, exact=True),
    "model": Reader(good.model, _as_model, exact=True),
}


def tries_of(name: str, tries: int) -> int:
    """Return the number of mutated files for a reader; most get `tries`."""
    return max(1, round(tries * READERS[name].share))


def main() -> None:
    """Print the names of the readers as JSON."""
    print(json.dumps(sorted(READERS)))
