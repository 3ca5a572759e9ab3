"""Settings that decide the accuracy of a run."""

from helpers.processes import modules_after

from snowshed.scene.accuracy_settings import ACCURACY, FORMER_NAMES
from snowshed.scene.schema import scene_parameters


def test_they_are_all_numerics_but_threads_and_how_snow_is_seeded():
    numerics = [p.path for p in scene_parameters() if p.path.startswith("numerics.")]
    numerics.remove("numerics.threads")
    seeding = ["seeding.particles_per_voxel", "seeding.pattern"]
    assert list(ACCURACY.values()) == numerics + seeding  # the order of a study's columns


def test_former_names_lead_to_those_of_today():
    assert FORMER_NAMES == {"step_factor": "courant_factor"}


def test_knowing_them_needs_no_heavy_library():
    modules = modules_after("import snowshed.scene.accuracy_settings")
    assert {"matplotlib", "pandas", "scipy", "sqlite3"} & modules == set()
