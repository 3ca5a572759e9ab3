"""Typical mistakes of scientists with arrays, tables and maps: none is silent.

Mistakes with scenes, runs and studies are in `tests/running/test_mistakes_of_scientists.py`. Tests
elsewhere have further ones: files of weather stations in `tests/io/weather`, rasters and polygons
in `tests/io/raster`, `tests/io/polygons` and `tests/scene/builders/test_terrain_checks.py`, images
in `tests/analysis/tomography`, measured stacks in `tests/running/test_mistakes.py` and
``test_calibration_measurements.py``, stacks of particles in ``test_unlikely_values.py``.
"""

import numpy as np
import pandas as pd
import pytest
from helpers.mistakes import texts_of

import snowshed
from snowshed import (
    GrainsSettings,
    LoadingStage,
    Obstacle,
    Results,
    Sample,
    Scene,
    Shape,
    Simulation,
    SlideSettings,
    read_events,
    run_events,
)
from snowshed.analysis.clearance import SnowRanges
from snowshed.scene import grains_scene, slide_scene
from snowshed.season import EXAMPLE_CLIMATE, SeasonSettings

HILL = np.repeat([np.linspace(60.0, 0.0, 41)], 21, axis=0)


def terrain(heights=HILL, **attributes):
    xarray = pytest.importorskip("xarray")
    y, x = (5.0 * np.arange(count) for count in heights.shape)
    return xarray.DataArray(heights, {"y": y, "x": x}, ("y", "x"), attrs=attributes)


def box(*limits):
    return pytest.importorskip("shapely.geometry").box(*limits)


def slide(heights=HILL, area=(20, 30, 60, 70), thickness=0.5, **options):
    scene = slide_scene(terrain(heights, **options), box(*area), thickness=thickness)
    Simulation(scene)


def holed(value):
    return np.where(np.arange(41) < 8, value, HILL)


#: Slides, and what is told of them.
SLIDES = {
    "missing elevations as -9999": (lambda: slide(holed(-9999.0)), "is it a missing value"),
    "release over missing elevations": (lambda: slide(holed(np.nan)), "the terrain has a hole"),
    "no elevation at all": (lambda: slide(HILL * np.nan), "holds no elevation"),
    "elevations in cm": (lambda: slide(HILL * 100), "are some missing?"),
    "elevations in feet": (lambda: slide(units="ft"), "its units are 'ft'"),
    "map in degrees": (lambda: slide(crs="EPSG:4326"), "is in degrees"),
    "array without coordinates": (
        lambda: slide_scene(HILL, box(20, 30, 60, 70), thickness=0.5), "ndarray; needed"
    ),
    "polygon beside the terrain": (
        lambda: slide(area=(2000, 30, 2060, 70)), "do both have the same coordinate system"
    ),
    "polygon partly beside the terrain": (lambda: slide(area=(-20, 30, 60, 70)), "reaches beyond"),
    "polygon in degrees": (
        lambda: slide(area=(11.2, 47.1, 11.21, 47.11)), "smaller than a cell of the terrain"
    ),
    "polygon without an area": (lambda: slide(area=(9, 9, 9, 9)), "crosses or touches itself"),
    "corners for a polygon": (
        lambda: slide_scene(terrain(), [(20, 30), (60, 30), (60, 70)], thickness=0.5),
        "not a polygon, but tuple",
    ),
    "thickness in cm": (lambda: slide(thickness=50), "is it in centimetres?"),
    "thick snow": (lambda: slide(thickness=5), "5 m is unusual"),
    "negative thickness": (lambda: slide(thickness=-1), "at least 0.01 m are needed"),
    "no thickness": (lambda: slide(thickness=None), "gives no thickness"),
    "friction in degrees": (
        lambda: Simulation(
            slide_scene(
                terrain(), box(20, 30, 60, 70), thickness=0.5, settings=SlideSettings(friction=25)
            )
        ),
        "25 is unusual",
    ),
    "stack of a slide": (
        lambda: run_events(slide_scene(terrain(), box(20, 30, 60, 70), thickness=0.5)),
        'the snow of "slide" makes no stack',
    ),
}  # fmt: skip

GRAINS = np.zeros((8, 8, 8), int)
GRAINS[:4, 2:6, 2:6], GRAINS[4:, 2:6, 2:6] = 1, 2


def load(labels=GRAINS, voxel_size=1e-4, strain=0.01):
    scene = Scene(
        method="grains", dimension=3, sample=Sample.from_labels(labels, voxel_size=voxel_size),
        loading=[LoadingStage(kind="compress", strain=strain)],
        numerics=GrainsSettings(density_scaling=1e4),
    )  # fmt: skip
    Simulation(scene)


#: Loading tests of grains, and what is told of them.
SAMPLES = {
    "voxels in micrometres": (lambda: load(voxel_size=100), "outside the allowed range"),
    "voxels in millimetres": (lambda: load(voxel_size=0.1), "is the voxel size in m?"),
    "voxels in metres for kilometres": (lambda: load(voxel_size=1e-7), "is the voxel size in m?"),
    "no size of voxels": (lambda: grains_scene("missing.npy"), "missing.npy"),
    "labels with fractions": (lambda: load(GRAINS + 0.5), "whole numbers"),
    "a single slice": (lambda: load(GRAINS[0]), "(nz, ny, nx)"),
    "negative labels": (lambda: load(GRAINS - 1), "is negative"),
    "only air": (lambda: load(0 * GRAINS), "no grain in the image"),
    "a mask of ice for labels": (lambda: load(GRAINS > 0), "all ice has the same label"),
    "grey values for labels": (
        lambda: load(np.random.default_rng(1).integers(0, 255, (20, 20, 20))), "not a label image"
    ),
    "strain in percent": (lambda: load(strain=5), "allowed: up to 0.95"),
}  # fmt: skip


def disc(sign=1.0, spacing=0.01, shape=(41, 41)):
    axes = np.meshgrid(*[np.linspace(-0.2, 0.2, n) for n in shape], indexing="ij")
    distances = sign * (np.hypot(*axes[:2]) - 0.1)
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    solid = Shape.from_distances(distances, origin=(2.0, -0.2, 0.0)[: len(shape)], spacing=spacing)
    Simulation(scene.append("obstacles", Obstacle(shape=solid)))


#: Solids from signed distances, and what is told of them.
SOLIDS = {
    "positive inside": (lambda: disc(-1.0), "the sign is the other"),
    "distances in cm": (lambda: disc(100.0), "not a signed distance in metres"),
    "spacing in cm": (lambda: disc(spacing=1.0), "is the unit wrong?"),
    "solid of three dimensions in 2D": (lambda: disc(shape=(9, 9, 9)), "the scene is 2D"),
}

DATES = pd.to_datetime(["2024-12-01", "2024-12-02", "2024-12-05"])


def winter(order=(0, 1, 2), **columns):
    table = {"date": DATES, "snowfall_m": [0.2, 0.1, 0.0], "temperature_c": [-4.0, -2.0, 1.0]}
    frame = pd.DataFrame({**table, **columns}).iloc[list(order)]
    snowshed.season.read_season(frame)


def needed(heights=(1.0,), slope_length=2.0, tilt=60.0, **options):
    """A clearance that is refused before anything is computed."""
    rows = EXAMPLE_CLIMATE.winters(2, seed=1)
    snowshed.clearance(
        rows, "unused", slope_length=slope_length, tilt=tilt, heights=heights, **options
    )


#: Winters, and what is told of them.
WINTERS = {
    "snowfall in cm": (lambda: winter(snowfall_m=[20, 10, 0]), "is it in cm, mm or inches?"),
    "temperature in kelvin": (lambda: winter(temperature_c=[269.0, 270, 271]), "269 is outside"),
    "temperature in degrees F": (lambda: winter(temperature_c=[25.0, 28, 34]), "in degrees F"),
    "density in g/cm3": (lambda: winter(density_kg_m3=[0.1, 0.1, 0.1]), "0.1 is outside"),
    "depth of the snow in cm": (lambda: winter(snow_depth_m=[20, 30, 30]), "is it in cm"),
    "decimal commas": (lambda: winter(snowfall_m=["0,2", "0,1", "0"]), "'0,2' is not a number"),
    "missing snowfall": (lambda: winter(snowfall_m=[np.nan, 0.1, 0]), "column snowfall_m: empty"),
    "dates backwards": (lambda: winter((2, 1, 0)), "is not after"),
    "dates twice": (lambda: winter((0, 1, 1)), "is not after"),
    "another column": (lambda: winter(snow=[1, 1, 1]), "unknown column 'snow'"),
    "no rows": (lambda: winter(()), "no rows"),
    "no snow": (lambda: winter(snowfall_m=[0, 0, 0]), "it never snows"),
    "adhesion in kPa": (lambda: SeasonSettings(adhesion=0.03), "0.03 Pa is unusual"),
    "ranges upside down": (lambda: SnowRanges({"friction": (0.7, 0.3)}), "the smaller first"),
    "heights in cm": (lambda: needed(heights=[100, 150]), "from 0 to 100 m"),
    "no heights": (lambda: needed(heights=[]), "at least one"),
    "length in mm": (lambda: needed(slope_length=2000.0), "allowed: 0.1 to 50 m"),
    "tilt in radians": (lambda: needed(tilt=1.05), "tilt: 1.05 degrees; allowed: 5 to 90"),
    "coverage beyond a share": (lambda: needed(coverage=90), "a share from 0 to 1"),
}

X, Z = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, 51), np.linspace(0, 0.2, 11)))
HEAP = np.column_stack([X, 0 * X, Z])
MASS = np.full(len(HEAP), 0.07)


def measure(positions=HEAP, masses=MASS, densities=0 * MASS + 200, dimension=2):
    snowshed.measure_stack(positions, masses, densities, dimension=dimension, dx=0.02)


#: Measured particles and predicted stacks, and what is told of them.
MEASURES = {
    "transposed positions": (lambda: measure(HEAP.T), "(3, 561); needed: (n, 3) or (n, 2)"),
    "positions that are not finite": (lambda: measure(HEAP * np.nan), "all must be finite"),
    "positions in mm": (lambda: measure(1000 * HEAP), "are the positions in mm or cm?"),
    "y and z exchanged": (lambda: measure(HEAP[:, [0, 2, 1]]), "y is not zero in 2D"),
    "one mass for all": (lambda: measure(masses=0.07), "a number for each particle"),
    "a mass too few": (lambda: measure(masses=MASS[1:]), "a number for each particle"),
    "negative masses": (lambda: measure(masses=-MASS), "no number may be negative"),
    "densities in g/cm3": (lambda: measure(densities=0 * MASS + 0.2), "are they in g/cm3"),
    "masses and densities exchanged": (lambda: measure(densities=MASS, masses=MASS * 3e3),
                                       "or masses?"),
    "one dimension": (lambda: measure(dimension=1), "allowed: 2, 3"),
    "no particles": (lambda: measure(HEAP[:0], MASS[:0], MASS[:0]), "the stack is empty"),
    "predicted tilt in radians": (
        lambda: snowshed.predict(height=2, length=4, tilt=1.05, events=3), "outside the data"
    ),
    "predicted height in cm": (
        lambda: snowshed.predict(height=200, length=4, tilt=60, events=3), "outside the data"
    ),
    "prediction without events": (
        lambda: snowshed.predict(height=2, length=4, tilt=60), "events: missing"
    ),
}  # fmt: skip

ALL = {**SLIDES, **SAMPLES, **SOLIDS, **WINTERS, **MEASURES}


def test_the_data_themselves_are_no_mistake():
    for good in (slide, load, disc, winter, measure):
        texts = texts_of(good)
        assert not [text for text in texts if "unusual" in text or "needed" in text], texts


@pytest.mark.parametrize("mistake", ALL)
def test_data_that_are_a_mistake_are_told(mistake, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    make, expected = ALL[mistake]
    texts = texts_of(make)
    assert any(expected in text for text in texts), texts


def test_results_of_another_method_are_refused(tmp_path):
    scene = slide_scene(terrain(), box(20, 30, 60, 70), thickness=0.5).set("events.max_time", 0.5)
    texts_of(lambda: snowshed.run(scene, tmp_path / "slide", pictures=False))
    for read in (read_events, lambda folder: Results(folder).events):
        (text,) = texts_of(lambda read=read: read(tmp_path / "slide"))
        assert "no events" in text or "holds no events.csv" in text
