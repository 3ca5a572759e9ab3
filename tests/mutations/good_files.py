"""Good files of every kind, to be mutated by the tests."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from conftest import tiny_mps, tiny_scene
from helpers import film_files
from helpers.grain_files import write_labels
from helpers.slide_files import plane, write_polygons
from helpers.voxel_files import VOXELS, save_metaimage, save_slices

from snowshed import Scene, _core, run_events
from snowshed.io.raster.raster import write_ascii_grid
from snowshed.methods.slide.maps import PeakMaps
from snowshed.running.run import run
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage

FRAMES = 5  # of the film
SEASON = """date,snowfall_m,temperature_c
2024-12-01T06:00+01:00,0.2,-4
2024-12-02T06:00+01:00,0.1,1.5
"""
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


def text(name: str, content: str | bytes) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)
        return folder / name

    return make


def grains_of(file: Path) -> Scene:
    sample = {"file": str(file), "voxel_size": 1e-4}
    loading = [{"kind": "compress", "speed": 0.1, "strain": 0.01}]
    return Scene.from_data(
        {"snowshed": 2, "method": "grains", "sample": sample, "loading": loading, "gravity": 0}
    )


def scene(folder: Path) -> Path:
    scene = tiny_scene(**{"output.energy": True, "events.between": "reseed"})
    scene.append("obstacles", {"name": "post", "shape": {"type": "sphere", "radius": 0.02}})
    scene.resolve().save(folder / "scene.json")
    return folder / "scene.json"


def results(folder: Path) -> Path:
    scene = tiny_scene(**{"output.energy": True, "events.max_time": 0.6})
    run_events(scene, folder / "out", pictures=False)
    return folder / "out"


def result(name: str) -> Callable[[Path], Path]:
    return lambda folder: results(folder) / name


def grid(folder: Path) -> Path:
    x, z = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), indexing="ij")
    np.save(folder / "grid.npy", (np.hypot(x, z) - 0.5).astype("<f4") * 0.1)
    return folder / "grid.npy"


def stl(folder: Path) -> Path:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0], [0, 0, 1]], dtype="<f4")
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    body = b"".join(bytes(12) + corners[list(face)].tobytes() + b"\0\0" for face in faces)
    (folder / "a.stl").write_bytes(bytes(80) + np.uint32(len(faces)).tobytes() + body)
    return folder / "a.stl"


def geotiff(folder: Path) -> Path:
    import rasterio

    transform = rasterio.transform.from_origin(0, 60, 2, 2)
    heights = plane(columns=8, rows=6).heights[::-1].astype("float32")
    with rasterio.open(
        *(folder / "a.tif", "w"), driver="GTiff", height=6, width=8, count=1, dtype="float32",
        crs="EPSG:31287", transform=transform,
    ) as file:  # fmt: skip
        file.write(heights, 1)
    return folder / "a.tif"


def ascii_raster(folder: Path) -> Path:
    write_ascii_grid(folder / "a.asc", plane(columns=8, rows=6))
    return folder / "a.asc"


def polygons(suffix: str) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        import pyogrio

        file = write_polygons(folder / "a.geojson", thickness=0.5, name="one")
        if suffix == ".geojson":
            return file
        meta, _, shapes, columns = pyogrio.raw.read(file)
        converted = folder / f"b{suffix}"
        pyogrio.raw.write(
            *(converted, shapes, columns, meta["fields"]), crs=meta["crs"], geometry_type="Polygon"
        )
        return converted

    return make


def _checkpoint_of(scene: Scene, folder: Path, steps: int = 0) -> Path:
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    if steps:
        simulation.step(steps)
    simulation.save(str(folder / "checkpoint.bin"))
    return folder / "checkpoint.bin"


def checkpoint(folder: Path) -> Path:
    return _checkpoint_of(tiny_scene(**{"events.max_time": 0.6}), folder)


def grains_checkpoint(folder: Path) -> Path:
    return _checkpoint_of(grains_of(write_labels(folder)), folder)


def slide_checkpoint(folder: Path) -> Path:
    write_ascii_grid(folder / "terrain.asc", plane())
    release = [{"outline": [[20, 20], [40, 20], [40, 40], [20, 40]], "thickness": 0.5}]
    terrain = {"file": str(folder / "terrain.asc"), "release": release}
    scene = Scene.from_data({"snowshed": 2, "method": "slide", "dimension": 3, "terrain": terrain})
    return _checkpoint_of(scene, folder, steps=5)


def mps_checkpoint(folder: Path) -> Path:
    return _checkpoint_of(tiny_mps(**{"output.energy": True}), folder, steps=5)


def store(folder: Path) -> Path:
    from snowshed.study.outcome import RunOutcome
    from snowshed.study.scene_hash import RunKey
    from snowshed.study.store import Store

    runs = [RunKey.of(tiny_scene(**{"panel.friction": mu}).resolve()) for mu in (0.1, 0.2)]
    with Store.create(folder / "store") as store:
        store.register("tiny", ["panel.friction"], runs)
        rows = [{"event": 1, "wall_s": 0.5, "height_m": 0.25, "ended": "rest"}]
        particles = {1: b"particles"}
        store.record(RunOutcome(runs[0].hash, "done", rows, {"run_wall_s": 1.0}, None, particles))
        store._connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return folder / "store" / "store.sqlite"


def packed(folder: Path) -> Path:
    from snowshed.results.event_particles import EventParticles

    ones = np.ones(5, dtype=np.float32)
    positions = np.arange(15, dtype=np.float32).reshape(5, 3)
    particles = EventParticles(positions, ones, ones, ones > 2, 3, 0.1, 0.0)
    (folder / "a.npz").write_bytes(particles.packed())
    return folder / "a.npz"


def model(folder: Path) -> Path:
    from snowshed.analysis.regression import save_model
    from snowshed.analysis.regression.ensemble import Ensemble
    from snowshed.analysis.regression.model_file import Member, StackModel
    from snowshed.analysis.regression.scaling import Scaling
    from snowshed.analysis.regression.spread import INTERVAL_SHARE, SPREAD_SHARE, Spread

    chance = np.random.default_rng(1)
    inputs = chance.uniform(1, 4, (12, 4))
    scaled = Scaling.of(inputs).scaled(inputs)
    ensemble = Ensemble(scaled, chance.normal(size=(2, 12)), np.zeros(2), np.full((2, 4), 0.1))
    member = Member(ensemble, 1.0, 0.5, Spread(0.1, 0.2, {SPREAD_SHARE: 1.0, INTERVAL_SHARE: 2.0}))
    save_model(StackModel(inputs, {("ratio", "rbf"): member}, "t", "stack"), folder / "a.npz")
    return folder / "a.npz"


def study_table(folder: Path) -> Path:
    table = pd.DataFrame({"hash": ["a", "b"], "panel.tilt": [40.0, 50.0], "seed": [1, 1]})
    table = table.assign(event=1, height_m=[0.2, 0.3], length_m=[0.5, 0.6], dimension=2)
    table.to_csv(folder / "table.csv", index=False)
    return folder / "table.csv"


def film(folder: Path) -> Path:
    frames = film_files.falling_film(40, FRAMES, axes="xz")
    (folder / "film.bin").write_bytes(film_files.film_bytes(frames, axes="xz", closed=True))
    return folder / "film.bin"


def film_of_version_1(folder: Path) -> Path:
    frames = film_files.falling_film(40, FRAMES, axes="xz")
    content = film_files.film_bytes(frames, axes="xz", version=1)
    (folder / "film.bin").write_bytes(content)
    return folder / "film.bin"


def image(name: str, save: Callable[[Path, Any], Any]) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        save(folder / name, VOXELS)
        return folder / name

    return make


def save_columns_first(file: Path, voxels: Any) -> None:
    np.save(file, np.asfortranarray(voxels))


def save_packed(file: Path, voxels: Any) -> None:
    save_metaimage(file, voxels, compress=True)


def save_as_text(file: Path, voxels: Any) -> None:
    save_metaimage(file, voxels, "BinaryData = False")
    head = file.read_bytes()[: -voxels.size]
    file.write_bytes(head + " ".join(map(str, voxels.ravel())).encode())


def save_plain(file: Path, voxels: Any) -> None:
    _save_tiff(file, voxels, metadata=None)


def save_tiles(file: Path, voxels: Any) -> None:
    options = {"tile": (16, 16), "compression": "deflate", "predictor": 2}
    _save_tiff(file, voxels.astype(np.uint16), metadata=None, **options)


def save_imagej(file: Path, voxels: Any) -> None:
    size = {"axes": "ZYX", "spacing": 50.0, "unit": "um"}
    _save_tiff(file, voxels, imagej=True, resolution=(0.02, 0.02), metadata=size)


def save_ome(file: Path, voxels: Any) -> None:
    _save_tiff(file, voxels, ome=True, bigtiff=True, metadata={"axes": "ZYX"})


def _save_tiff(file: Path, voxels: Any, **options: Any) -> None:
    import tifffile

    tifffile.imwrite(file, voxels, photometric="minisblack", **options)


def slice_of(ending: str) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        return save_slices(folder / "slices", VOXELS, ending) / f"slice2.{ending}"

    return make


def sample(folder: Path) -> Path:
    write_labels(folder)
    facts = {"voxel_size_m": 1e-4, "synthetic": True, "source": "spheres"}
    (folder / "microstructure.json").write_text(json.dumps(facts))
    return folder / "microstructure.json"


def curve(folder: Path) -> Path:
    loading = [LoadingStage(kind="compress", speed=0.1, strain=0.001)]
    run(grains_scene(write_labels(folder), 1e-4, loading), folder / "out", pictures=False)
    return folder / "out" / "curve.csv"


def grains_summary(folder: Path) -> Path:
    return curve(folder).with_name("grains.json")


def peaks(folder: Path) -> Path:
    values = np.arange(1, 13, dtype=np.float32).reshape(3, 4)
    (folder / "peaks.npz").write_bytes(
        PeakMaps(values, 2 * values, 3 * values, 1, 2, (8, 9)).packed()
    )
    return folder / "peaks.npz"


def snow(folder: Path) -> Path:
    (folder / "snow.json").write_text(json.dumps(tiny_scene().resolve().data["snow"]))
    return folder / "snow.json"
