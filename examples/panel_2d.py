"""Simulate five slide-offs from a panel in 2D; write the table and the pictures.

    python examples/panel_2d.py [FOLDER [DX]]

This takes about ten seconds with the grid size of the thesis, dx = 0.01 m.
"""

import sys

from snowshed import Panel, Scene, Slab, Snow, run_events


def main(folder: str = "panel-2d", dx: float = 0.01) -> None:
    """Run the scene into `folder`, new or empty, and print the table of events."""
    scene = Scene(
        dimension=2,
        title="A low panel, steep enough to shed",
        snow=Snow.preset("calibrated"),
        panel=Panel(height=0.33, length=0.245, tilt=50, friction=0.3),
        slab=Slab(thickness=0.02),
    )
    scene.set("ground.condition", "sticky")
    scene.update({"events": {"count": 5, "between": "carry"}, "numerics.dx": dx})
    scene.set("panel.tilt", 45)  # overrides the tilt above; the last value counts

    table = run_events(scene, folder)
    print(table[["event", "height_m", "length_m", "head_m", "tail_m", "ended"]].to_string())
    print(f"pictures and particles in {folder}")


if __name__ == "__main__":
    main(*sys.argv[1:2], *map(float, sys.argv[2:3]))
