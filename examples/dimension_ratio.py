"""Compare the stack in 3D and in 2D: the ratio of the heights, which is 2/3 in the thesis.

    python examples/dimension_ratio.py [FOLDER [DX [EVENTS]]]

This takes about two minutes with dx = 0.01 m and five events. To compare existing results folders:

    snowshed compare FOLDER/3d FOLDER/2d
"""

import sys
from pathlib import Path

from snowshed import Scene, run_events
from snowshed.analysis import dimension_ratio


def main(folder: str = "dimensions", dx: float = 0.01, events: float = 5) -> None:
    """Run the lab experiment in 3D and in 2D into `folder`, and print both heights and ratios."""
    tables = {}
    for dimension in (3, 2):
        scene = Scene.preset("lab-50").update({"dimension": dimension, "panel.friction": 0.3})
        scene.update({"numerics.dx": dx, "events.count": int(events)})
        tables[dimension] = run_events(scene, Path(folder) / f"{dimension}d")
    print(dimension_ratio(tables[3], tables[2]).round(3).to_string(index=False))


if __name__ == "__main__":
    main(*sys.argv[1:2], *map(float, sys.argv[2:4]))
