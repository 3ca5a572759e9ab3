"""Every reader of files, with a good file to begin with: one line in `READERS` for each.

A reader gets the path of a file that was changed. It may raise what the command line turns into a
sentence (`REFUSED`). What `exact` readers return must be what the good file holds, since their
formats are ours and carry checksums.
"""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
import pickle
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from bad_scenes import CLOSED_MESH
from conftest import tiny_scene
from grain_files import write_labels
from slide_files import plane, write_polygons

from snowshed import InputError, Scene, SimulationError, _core, run_events
from snowshed.io.csv_table import read_csv
from snowshed.io.map_areas import read_areas
from snowshed.io.pvd import read_series
from snowshed.io.raster import read_raster, write_ascii_grid
from snowshed.io.vtp import read_particles

REFUSED = (InputError, SimulationError, OSError)


@dataclasses.dataclass(frozen=True)
class Reader:
    """A kind of file: how a good one is made in a folder, and how one is read."""

    make: Callable[[Path], Path]
    read: Callable[[Path], Any]
    exact: bool = False
    share: float = 1.0  # of the tries that other readers get: those that start a process get fewer


# --- good files ----------------------------------------------------------------------------


def _text(name: str, content: str | bytes) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)
        return folder / name

    return make


def _scene(folder: Path) -> Path:
    scene = tiny_scene(**{"output.energy": True, "events.between": "reseed"})
    scene.append("obstacles", {"name": "post", "shape": {"type": "sphere", "radius": 0.02}})
    scene.resolve().save(folder / "scene.json")
    return folder / "scene.json"


def _results(folder: Path) -> Path:
    scene = tiny_scene(**{"output.energy": True, "events.max_time": 0.6})
    run_events(scene, folder / "out", pictures=False)
    return folder / "out"


def _result(name: str) -> Callable[[Path], Path]:
    return lambda folder: _results(folder) / name


def _grid(folder: Path) -> Path:
    x, z = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), indexing="ij")
    np.save(folder / "grid.npy", (np.hypot(x, z) - 0.5).astype("<f4") * 0.1)
    return folder / "grid.npy"


def _stl(folder: Path) -> Path:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0], [0, 0, 1]], dtype="<f4")
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    body = b"".join(bytes(12) + corners[list(face)].tobytes() + b"\0\0" for face in faces)
    (folder / "a.stl").write_bytes(bytes(80) + np.uint32(len(faces)).tobytes() + body)
    return folder / "a.stl"


def _geotiff(folder: Path) -> Path:
    import rasterio

    transform = rasterio.transform.from_origin(0, 60, 2, 2)
    heights = plane(columns=8, rows=6).heights[::-1].astype("float32")
    with rasterio.open(
        *(folder / "a.tif", "w"), driver="GTiff", height=6, width=8, count=1, dtype="float32",
        crs="EPSG:31287", transform=transform,
    ) as file:  # fmt: skip
        file.write(heights, 1)
    return folder / "a.tif"


def _ascii_raster(folder: Path) -> Path:
    write_ascii_grid(folder / "a.asc", plane(columns=8, rows=6))
    return folder / "a.asc"


def _polygons(suffix: str) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        import pyogrio

        file = write_polygons(folder / "a.geojson", thickness=0.5, name="one")
        if suffix == ".geojson":
            return file
        meta, _, shapes, columns = pyogrio.raw.read(file)
        made = folder / f"b{suffix}"
        pyogrio.raw.write(
            *(made, shapes, columns, meta["fields"]), crs=meta["crs"], geometry_type="Polygon"
        )
        return made

    return make


def _checkpoint(folder: Path) -> Path:
    simulation = _core.Simulation(tiny_scene(**{"events.max_time": 0.6}).resolve().json)
    simulation.begin_event()
    simulation.save(str(folder / "checkpoint.bin"))
    return folder / "checkpoint.bin"


def _grains_checkpoint(folder: Path) -> Path:
    simulation = _core.Simulation(_grains(write_labels(folder)).resolve().json)
    simulation.begin_event()
    simulation.save(str(folder / "checkpoint.bin"))
    return folder / "checkpoint.bin"


def _store(folder: Path) -> Path:
    from snowshed.study.outcome import Outcome
    from snowshed.study.scene_hash import Run
    from snowshed.study.store import Store

    runs = [Run.of(tiny_scene(**{"panel.friction": mu}).resolve()) for mu in (0.1, 0.2)]
    with Store.create(folder / "store") as store:
        store.register("tiny", ["panel.friction"], runs)
        rows = [{"event": 1, "wall_s": 0.5, "height_m": 0.25, "ended": "rest"}]
        kept = {1: b"particles"}
        store.record(Outcome(runs[0].hash, "done", rows, {"run_wall_s": 1.0}, None, kept))
        store._connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return folder / "store" / "store.sqlite"


def _packed(folder: Path) -> Path:
    from snowshed.run.event_particles import EventParticles

    ones = np.ones(5, dtype=np.float32)
    place = np.arange(15, dtype=np.float32).reshape(5, 3)
    whole = EventParticles(place, ones, ones, ones > 2, 3, 0.1, 0.0)
    (folder / "a.npz").write_bytes(whole.packed())
    return folder / "a.npz"


def _model(folder: Path) -> Path:
    from snowshed.analysis.regression import save_model
    from snowshed.analysis.regression.ensemble import Ensemble
    from snowshed.analysis.regression.model_file import Member, StackModel
    from snowshed.analysis.regression.scaling import Scaling
    from snowshed.analysis.regression.spread import INTERVAL, SPREAD, Spread

    chance = np.random.default_rng(1)
    inputs = chance.uniform(1, 4, (12, 4))
    scaled = Scaling.of(inputs).scaled(inputs)
    ensemble = Ensemble(scaled, chance.normal(size=(2, 12)), np.zeros(2), np.full((2, 4), 0.1))
    member = Member(ensemble, 1.0, 0.5, Spread(0.1, 0.2, {SPREAD: 1.0, INTERVAL: 2.0}))
    save_model(StackModel(inputs, {("ratio", "rbf"): member}, "t", "stack"), folder / "a.npz")
    return folder / "a.npz"


def _study_table(folder: Path) -> Path:
    table = pd.DataFrame({"hash": ["a", "b"], "panel.tilt": [40.0, 50.0], "seed": [1, 1]})
    table = table.assign(event=1, height_m=[0.2, 0.3], length_m=[0.5, 0.6], dimension=2)
    table.to_csv(folder / "table.csv", index=False)
    return folder / "table.csv"


# --- reading -------------------------------------------------------------------------------


def _stand(shape: dict[str, Any], dimension: int) -> _core.Simulation:
    scene = tiny_scene(dimension=dimension).append("obstacles", {"shape": shape})
    return _core.Simulation(scene.resolve().json, ".")


def _as_mesh(file: Path) -> None:
    _stand({"type": "mesh", "file": str(file), "scale": 0.1}, 3)


def _as_grid(file: Path) -> None:
    shape = {"type": "grid", "file": str(file), "origin": [0, 0.2], "spacing": 0.025}
    _stand(shape, 2)


def _grains(file: Path) -> Scene:
    sample = {"file": str(file), "voxel_size": 1e-4}
    loading = [{"kind": "compress", "speed": 0.1, "strain": 0.01}]
    return Scene.from_data(
        {"snowshed": 2, "method": "grains", "sample": sample, "loading": loading, "gravity": 0}
    )


def _as_labels(file: Path) -> None:
    _core.Simulation(_grains(file).resolve().json, ".").begin_event()


def _as_scene(file: Path) -> None:
    Scene.load(file)
    simulation = _core.Simulation(_core.load_scene(str(file)), str(file.parent))
    if simulation.scene and simulation.event_count:
        _core.update_version(file.read_text(errors="replace"))


def _as_checkpoint(file: Path) -> str:
    simulation = _core.Simulation.load(str(file))
    whole = [simulation.positions(), simulation.velocities(), simulation.masses()]
    facts = [simulation.scene, simulation.event, simulation.event_running, simulation.time_s]
    return _digest([*(array.tobytes() for array in whole), facts])


def _as_store(file: Path) -> Any:
    from snowshed.study.store import Store
    from snowshed.study.table import read_table

    folder = file.parent / "copy"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(file, folder / "store.sqlite")
    with Store.open(folder) as store:
        kept = [store.particles(run.hash) for name in store.studies() for run in store.runs(name)]
    return read_table(folder, timing=True).to_csv(), kept


def _as_resumed_table(file: Path) -> Any:
    """Go on with a finished run one of whose tables has changed; return the tables."""
    folder = file.parent
    with contextlib.redirect_stderr(None):
        run_events(folder / "scene.json", folder, resume=True, pictures=False)
    return [read_csv(folder / name).to_csv() for name in ("outline.csv", "energy.csv")]


def _as_record(file: Path) -> None:
    run_events(file.parent / "scene.json", file.parent, resume=True, pictures=False)


def _as_lua(file: Path) -> None:
    from snowshed.scene.lua import load_lua

    load_lua(file)


def _as_season(file: Path) -> None:
    from snowshed.run.season.weather import read_season

    read_season(file)


def _as_measurements(file: Path) -> None:
    from snowshed.analysis.calibration.measurements import read_measurements

    read_measurements(file)


def _as_stack_table(file: Path) -> None:
    from snowshed.analysis.stack_table import StackTable

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
    from snowshed.run.event_particles import EventParticles

    return _digest([repr(vars(EventParticles.unpacked(file.read_bytes())))])


def _as_ini(file: Path) -> None:
    from snowshed.scene.builders.avaframe_ini import read_ini

    read_ini(file)


def _as_particles(file: Path) -> str:
    return _digest([(name, array.tobytes()) for name, array in read_particles(file).items()])


def _digest(value: object) -> str:
    return hashlib.sha256(pickle.dumps(value)).hexdigest()


SEASON = "date,snowfall_m,temperature_c\n2024-12-01,0.2,-4\n2024-12-02T06:00+01:00,0.1,1.5\n"
MEASURED = "tilt_deg,event,height_m,height_std_m\n40,1,0.05,0.005\n50,2,0.08,0.01\n"
STUDY = """name = "a"
dimension = 2
events = 1
seeds = [1]
[scene]
preset = "lab-50"
[accuracy]
dx = 0.02
[axes]
panel.friction = [0.1, 0.2]
snow.density = { from = 100, to = 300, count = 2 }
"""
LUA = 'preset "lab-50"\nmaterial{density = 200, M = 3}\nfor i = 1, 3 do panel{tilt = 40 + i} end\n'
INI = "[GENERAL]\n[com1DFA_com1DFA_override]\nmuvoellmy = 0.3\ndt = 0.1\nrho = 200\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "-1 -1 0\n1 -1 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
)

#: A new reader is one more line.
READERS = {
    "scene": Reader(_scene, _as_scene, share=2),
    "mesh obj": Reader(_text("a.obj", CLOSED_MESH), _as_mesh),
    "mesh stl": Reader(_stl, _as_mesh),
    "mesh ply": Reader(_text("a.ply", PLY), _as_mesh),
    "npy grid": Reader(_grid, _as_grid),
    "npy labels": Reader(write_labels, _as_labels),
    "ascii raster": Reader(_ascii_raster, read_raster),
    "geotiff": Reader(_geotiff, read_raster),
    "polygons geojson": Reader(_polygons(".geojson"), read_areas),
    "polygons shp": Reader(_polygons(".shp"), read_areas),
    "polygons gpkg": Reader(_polygons(".gpkg"), read_areas, share=0.5),
    "avaframe ini": Reader(_text("a.ini", INI), _as_ini),
    "season": Reader(_text("season.csv", SEASON), _as_season),
    "measurements": Reader(_text("measured.csv", MEASURED), _as_measurements),
    "stack table": Reader(_study_table, _as_stack_table),
    "study": Reader(_text("study.toml", STUDY), _as_study),
    "lua": Reader(_text("a.lua", LUA), _as_lua, share=0.3),
    "vtp": Reader(_result("particles/event_001.vtp"), _as_particles, exact=True),
    "pvd": Reader(_result("particles.pvd"), read_series),
    "checkpoint": Reader(_checkpoint, _as_checkpoint, exact=True),
    "checkpoint of grains": Reader(_grains_checkpoint, _as_checkpoint, exact=True, share=0.5),
    "run.json": Reader(_result("run.json"), _as_record, share=0.5),
    "outline.csv": Reader(_result("outline.csv"), _as_resumed_table, exact=True, share=0.5),
    "energy.csv": Reader(_result("energy.csv"), _as_resumed_table, exact=True, share=0.5),
    "store": Reader(_store, _as_store, exact=True),
    "kept particles": Reader(_packed, _as_packed, exact=True),
    "model": Reader(_model, _as_model, exact=True),
}


def tries_of(name: str, tries: int) -> int:
    """Return how many mutated files a reader gets, where most get `tries`."""
    return max(1, round(tries * READERS[name].share))


def main() -> None:
    """Print the names of the readers as JSON."""
    print(json.dumps(sorted(READERS)))
