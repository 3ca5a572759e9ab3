"""Settings that decide how accurate a run is."""

import subprocess
import sys

from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.scene.schema import scene_parameters


def test_they_are_all_numerics_but_threads_and_how_snow_is_seeded():
    numerics = {p.path for p in scene_parameters() if p.path.startswith("numerics.")}
    seeding = {"seeding.particles_per_voxel", "seeding.pattern"}
    assert set(ACCURACY.values()) == numerics - {"numerics.threads"} | seeding


def test_knowing_them_needs_no_heavy_library():
    code = (
        "import sys, snowshed.scene.accuracy_settings; "
        "print({'matplotlib', 'pandas', 'scipy', 'sqlite3'} & set(sys.modules))"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "set()"
