"""Snow slides from a panel on a flat roof over the roof's edge and onto a post below.

    python examples/custom_obstacles.py [FOLDER [DX]]

Obstacles are composed of shapes. The roof is the union of a box and a second box, its lip, minus a
round gutter (a difference). The post is a capsule. The scene is 2D, so vectors are (x, z).
"""

import sys

from snowshed import Obstacle, Panel, Scene, Shape, Slab, run_events


def roof() -> Shape:
    """Return a roof 3 m above the ground. Its edge is 0.6 m from the panel's centre."""
    slab = Shape.box(center=(-0.4, 2.85), size=(2.0, 0.3))
    lip = Shape.box(center=(0.55, 3.0), size=(0.1, 0.1))
    gutter = Shape.sphere(center=(0.35, 3.0), radius=0.08)
    return Shape.difference(Shape.union(slab, lip), gutter)


def main(folder: str = "custom-obstacles", dx: float = 0.02) -> None:
    """Run the scene into `folder`, new or empty, and print the stack after each event."""
    scene = Scene(dimension=2, title="Over the edge of a roof")
    scene.panel = Panel(height=3.2, length=1.0, tilt=35, friction=0.1)
    scene.slab = Slab(thickness=0.1)
    scene.set("ground.condition", "sticky")
    scene.append("obstacles", Obstacle("roof", roof(), condition="separate", friction=0.4))
    post = Shape.capsule(start=(0.9, 0.0), end=(0.9, 1.0), radius=0.06)
    scene.append("obstacles", Obstacle("post", post, condition="separate", friction=0.3))
    scene.update({"numerics.dx": dx, "events": {"count": 2, "max_time": 4}})

    table = run_events(scene, folder)
    print(table[["event", "height_m", "length_m", "on_panel_kg", "detached_kg"]].to_string())
    print(f"pictures and particles in {folder}")


if __name__ == "__main__":
    main(*sys.argv[1:2], *map(float, sys.argv[2:3]))
