"""A slide with a secondary release, a forest and a dam.

usage: python slide_dam.py [FOLDER] [SECONDS]

Draws ``slide_dam.png`` into the folder: the peak speed, and what lies on the slope, on terrain that
is made for it.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib import rc_context

from snowshed import Area, Scene, run
from snowshed.io import Raster
from snowshed.plot import (
    INK,
    STYLE,
    blank_figure,
    draw_outlines,
    draw_terrain,
    focus,
    save_figure,
)
from snowshed.scene import Dam, DamCorner, ResistanceArea, example_slide, slide_terrain

BOWL = [(60.0, 18.0), (80.0, 16.0), (84.0, 34.0), (64.0, 40.0)]
FOREST = [(94.0, 14.0), (118.0, 14.0), (118.0, 44.0), (94.0, 42.0)]
DAM = [(120.0, 50.0), (124.0, 68.0), (120.0, 90.0)]


def main(folder: Path, seconds: float) -> None:
    """Simulate the slide, print its notes, and draw it."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = scene_with_dam(folder, seconds)
    results = run(scene, folder / "slide", pictures=False)
    print("event 1:", *results.summary.notes, sep="\n  ")
    maps = results.result("maps")
    draw(scene, slide_terrain(scene), maps["peak_speed"].values, folder / "slide_dam.png")


def scene_with_dam(folder: Path, seconds: float) -> Scene:
    """Return the example's slide with a bowl that is released on contact, forest and a dam."""
    scene = example_slide(folder)
    scene.terrain.secondary_release = [Area(name="bowl", outline=BOWL, thickness=0.4)]
    scene.terrain.resistance = [ResistanceArea(name="forest", outline=FOREST)]
    corners = [DamCorner(x=x, y=y, height=2.0) for x, y in DAM]
    scene.terrain.dams = [Dam(name="lower", corners=corners)]
    return scene.update(
        {"numerics.detrainment": 20.0, "numerics.resistance": 0.05, "events.max_time": seconds}
    )


def draw(scene: Scene, ground: Raster, speed: np.ndarray, file: Path) -> None:
    """Draw the map of the peak speed with the areas and the dam."""
    outlines = [area.outline for area in scene.terrain.release]
    part = focus(ground, speed > 0.0, [*outlines, BOWL, FOREST, DAM])
    with rc_context(STYLE):
        figure = blank_figure(10.5, 6.0)
        axes = figure.subplots()
        draw_terrain(axes, ground, part)
        half = 0.5 * ground.cell
        rows, columns = speed.shape
        west, south = ground.east - half, ground.north - half
        drawn = axes.imshow(
            np.where(speed > 0.0, speed, np.nan),
            origin="lower",
            extent=(west, west + columns * ground.cell, south, south + rows * ground.cell),
            cmap="YlOrRd",
            alpha=0.86,
            zorder=3,
        )
        draw_outlines(axes, outlines)
        for label, outline, colour in (
            ("secondary release", BOWL, "tab:purple"),
            ("forest", FOREST, "tab:green"),
        ):
            axes.plot(*zip(*outline, outline[0]), color=colour, lw=2.0, zorder=6, label=label)
        axes.plot(*zip(*DAM), color=INK, lw=4.0, zorder=7, label="dam, 2 m high")
        axes.legend(loc="upper left", framealpha=0.9, edgecolor="none")
        axes.set(xlim=part[:2], ylim=part[2:], xlabel="east, m", ylabel="north, m")
        figure.colorbar(drawn, ax=axes, label="peak speed, m/s", shrink=0.9, pad=0.01)
    save_figure(figure, file)


if __name__ == "__main__":
    main(
        Path(sys.argv[1] if len(sys.argv) > 1 else "slide_dam"),
        float(sys.argv[2]) if len(sys.argv) > 2 else 60.0,
    )
