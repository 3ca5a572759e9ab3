"""The same slab with strong and with weak bonds: one moves as a unit, the other tears.

usage: python slab_and_bonds.py [FOLDER] [SECONDS]

Draws ``slab_and_bonds.png`` into the folder: particles and bonds at some times, on terrain that is
made for it.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.collections import LineCollection

from snowshed.io import Raster
from snowshed.methods import SlideState, slide_states
from snowshed.plot import (
    INK,
    STACK,
    STYLE,
    blank_figure,
    draw_outlines,
    draw_terrain,
    focus,
    save_figure,
)
from snowshed.scene import example_slide, slide_terrain

STRAINS = {"strong bonds": 0.2, "weak bonds": 0.03}  # at which a bond breaks
SHARES = (0.15, 0.4, 1.0)  # of the time that is shown


def main(folder: Path, seconds: float) -> None:
    """Simulate both slabs, draw them and print how many bonds are left."""
    folder.mkdir(parents=True, exist_ok=True)
    times = [share * seconds for share in SHARES]
    scene = example_slide(folder)
    ground = slide_terrain(scene)
    outlines = [area.outline for area in scene.terrain.release]
    slabs = {
        name: slide_states(scene.with_({"numerics.max_strain": strain}), times)
        for name, strain in STRAINS.items()
    }
    for name, states in slabs.items():
        counts = ", ".join(f"{len(state.bonds)} at {state.time:.1f} s" for state in states)
        print(f"bonds in the event with {name}: {counts}")
    draw(ground, outlines, slabs, folder / "slab_and_bonds.png")


def draw(ground: Raster, outlines: list, slabs: dict, file: Path) -> None:
    """Draw a row for each slab and a column for each time."""
    origin = (ground.east, ground.north)
    snow = [xy(state) + origin for states in slabs.values() for state in states]
    part = focus(ground, np.zeros(ground.heights.shape, dtype=bool), [*outlines, *snow])
    with rc_context(STYLE):
        ratio = (part[3] - part[2]) / (part[1] - part[0])
        figure = blank_figure(11.0, 11.0 / len(SHARES) * ratio * len(slabs) + 0.9)
        panels = figure.subplots(len(slabs), len(SHARES), squeeze=False)
        for row, (name, states) in zip(panels, slabs.items()):
            for axes, state in zip(row, states):
                positions = xy(state) + origin
                draw_terrain(axes, ground, part, labels=False)
                bonds = LineCollection(positions[state.bonds], colors=STACK, lw=0.8, zorder=4)
                axes.add_collection(bonds)
                axes.plot(*positions.T, ".", ms=2.4, mew=0, color=INK, zorder=5)
                draw_outlines(axes, outlines)
                axes.set(xticks=[], yticks=[])
                axes.set_title(f"{name}, {state.time:.0f} s: {len(state.bonds):,} bonds")
    save_figure(figure, file)


def xy(state: SlideState) -> np.ndarray:
    """Return the horizontal positions of the particles (n, 2), m."""
    return state.particles["position"].values[:, :2]


if __name__ == "__main__":
    main(
        Path(sys.argv[1] if len(sys.argv) > 1 else "slab_and_bonds"),
        float(sys.argv[2]) if len(sys.argv) > 2 else 30.0,
    )
