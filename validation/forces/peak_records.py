"""Records how loads depend on the grid and the seed, for `snowshed.analysis.loads.peak_errors`.

    python -m validation.forces.peak_records python/snowshed/analysis/loads/peak_records.csv

Slabs slide off onto the ground (the laboratory's panel at two tilts), onto a lower roof, and
against a fence: on three grids over a factor of four in cells, with five seeds and both schemes.
It takes a quarter of an hour.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from snowshed.io.csv_table import write_csv
from snowshed.results.reader import Results
from snowshed.running.run import run
from snowshed.scene.components import Ground, Obstacle, Panel, Slab
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

SEEDS = range(1, 6)
SCHEMES = ("thesis", "objective")
COLUMNS = (
    "rest_n", "peak_1ms_n", "peak_10ms_n", "peak_100ms_n", "impulse_x_ns", "impulse_z_ns",
)  # fmt: skip
LAB_GRIDS, ROOF_GRIDS = (0.01, 0.005, 0.0025), (0.08, 0.04, 0.02)  # m


def laboratory(preset: str) -> Scene:
    """Return the laboratory's panel with a slab of 2 cm, in 2D."""
    scene = Scene.preset(preset).set("dimension", 2)
    return scene.update({"events": {"count": 1, "max_time": 4.0}})


def roof(obstacle: Obstacle) -> Scene:
    """Return a panel 2 m above the ground with a slab of 20 cm, and an obstacle before it."""
    scene = Scene(
        dimension=2,
        panel=Panel(height=2.0, length=3.0, tilt=40.0, friction=0.2),
        slab=Slab(thickness=0.2),
        ground=Ground(),
    )
    scene.update({"events": {"count": 1, "max_time": 5.0}})
    return scene.append("obstacles", obstacle)


def box(name: str, center: tuple[float, float], size: tuple[float, float]) -> Obstacle:
    """Return a box on which snow slides with a friction of 0.4."""
    return Obstacle(name=name, shape=Shape.box(center, size), condition="separate", friction=0.4)


#: For each case: its scene, its grids, and the obstacle whose loads are recorded.
CASES: Mapping[str, tuple[Callable[[], Scene], tuple[float, ...], str]] = {
    "lab50": (partial(laboratory, "lab-50"), LAB_GRIDS, "ground"),
    "lab40": (partial(laboratory, "lab-40"), LAB_GRIDS, "ground"),
    "lower roof": (
        lambda: roof(box("lower roof", (2.4, 0.5), (2.4, 1.0))),
        ROOF_GRIDS,
        "lower roof",
    ),
    "fence": (lambda: roof(box("fence", (3.2, 0.75), (0.2, 1.5))), ROOF_GRIDS, "fence"),
}


def measured() -> Iterator[dict[str, Any]]:
    """Yield the loads of every run."""
    for scheme in SCHEMES:
        for case, (make, grids, obstacle) in CASES.items():
            for dx in grids:
                for seed in SEEDS:
                    scene = make()
                    if scheme != SCHEMES[0]:
                        scene.set("numerics.scheme", scheme)
                    scene.update(
                        {
                            "numerics.dx": dx,
                            "seeding.seed": seed,
                            "output.forces": True,
                            "output.film": False,
                        }
                    )
                    with TemporaryDirectory() as folder:
                        run(scene, Path(folder) / "run", pictures=False)
                        loads = Results(Path(folder) / "run").loads
                    (row,) = loads[loads["obstacle"] == obstacle].to_dict("records")
                    rest = sum(row[f"rest_f{axis}_n"] ** 2 for axis in "xyz") ** 0.5
                    yield {
                        **{str(name): value for name, value in row.items()},
                        "case": case,
                        "scheme": scheme,
                        "dx": dx,
                        "rest_n": rest,
                    }


def main(file: str) -> None:
    """Write the means over the seeds."""
    warnings.simplefilter("ignore")
    table = pd.DataFrame(measured())
    keys = ["scheme", "case", "obstacle", "dx"]
    means = table.groupby(keys)[list(COLUMNS)].mean().reset_index()
    write_csv(means, file, float_format="%.5g")


if __name__ == "__main__":
    main(sys.argv[1])
