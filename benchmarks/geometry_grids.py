"""Record stacks below some panels of the geometry data set on several grids.

Usage: python -m benchmarks.geometry_grids FOLDER

The stacks have the settings of the data set's rows with each scheme. `snowshed predict` takes the
error of the grid from them. Two cores take two hours. Runs of this build that are in FOLDER
already are not made again.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from snowshed.analysis.regression.geometry import FRICTION, geometry_study
from snowshed.analysis.regression.grid_error import COLUMNS, TABLE
from snowshed.io.csv_table import write_csv
from snowshed.study import Study

TILTS = [40.0, 60.0]  # degrees
HEIGHT = 2.0  # of the lower edge, m


@dataclass(frozen=True)
class Grid:
    """A scheme, the size of its cells (m), and the seeds of panels by their length (m)."""

    scheme: str
    cells: float
    seeds: dict[float, int]


MANY = {0.5: 6, 1.0: 4, 2.0: 2, 4.0: 2}
GRIDS = (
    Grid("thesis", 0.02, MANY),
    Grid("thesis", 0.015, MANY),
    Grid("thesis", 0.01, MANY),
    Grid("thesis", 0.005, {**MANY, 4.0: 1}),
    Grid("objective", 0.015, {0.5: 3, 1.0: 2, 2.0: 1, 4.0: 1}),
    Grid("objective", 0.01, {0.5: 2, 1.0: 2, 2.0: 1}),
    Grid("objective", 0.005, {0.5: 1, 1.0: 1}),
)


def studies(grid: Grid) -> Iterator[Study]:
    """Return the studies of a grid, one for each length of the panel."""
    base = geometry_study(dx=grid.cells, scheme=grid.scheme).scene.with_(
        {"panel.friction": FRICTION, "panel.height": HEIGHT, "events.between": "carry"}
    )
    for length, seeds in grid.seeds.items():
        scene = base.with_({"panel.length": length})
        yield Study.product(scene, {"panel.tilt": TILTS}, seeds=range(1, seeds + 1))


def main() -> None:
    """Compute the stacks, and write the record."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    parts = []
    for grid in GRIDS:
        for study in studies(grid):
            length = study.scene.panel.length
            rows = study.run(folder / f"{grid.scheme}-{grid.cells}-{length}", threads=1)
            parts.append(rows.assign(**{"panel.length": length}))
    write_csv(pd.concat(parts)[list(COLUMNS)], TABLE)


if __name__ == "__main__":
    main()
