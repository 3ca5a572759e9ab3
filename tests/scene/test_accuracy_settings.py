"""Settings that affect the accuracy of a run."""

from helpers.processes import modules_after

from snowshed.scene.accuracy_settings import ACCURACY, FORMER_NAMES
from snowshed.scene.schema import scene_parameters


def test_they_are_all_numerics_except_threads_and_device_and_the_seeding():
    numerics = [p.path for p in scene_parameters() if p.path.startswith("numerics.")]
    numerics.remove("numerics.threads")
    numerics.remove("numerics.device")
    seeding = ["seeding.particles_per_voxel", "seeding.pattern"]
    assert list(ACCURACY.values()) == numerics + seeding  # the order of a study's columns


def test_former_names_refer_to_present_names():
    assert FORMER_NAMES == {"step_factor": "courant_factor"}


def test_importing_them_loads_no_heavy_library():
    modules = modules_after("import snowshed.scene.accuracy_settings")
    assert {"matplotlib", "pandas", "scipy", "sqlite3"} & modules == set()
