import json
import re

import numpy as np
import pytest
from helpers.piles import triangle
from matplotlib.image import imread

from snowshed import (
    Body,
    Ground,
    ResolvedScene,
    Scene,
    Shape,
    StackMeasure,
    measure_stack,
    read_events,
)
from snowshed.plot.caption import scene_caption
from snowshed.plot.figure_style import save_figure
from snowshed.plot.stack_figures import growth_figure, stack_figure

SCENE = Scene.preset("lab-50").set("dimension", 2).resolve().data


class Snow:
    """The part of a simulation that the pictures use."""

    event = 3
    damping_rate_per_s = 188.2

    def __init__(self, positions, tilt=0.0, panel=True):
        self._core = self
        self._positions = positions
        self.ground_tilt_deg = tilt
        self._panel = panel

    def positions(self):
        return self._positions

    def events(self):
        return 1 + np.arange(len(self._positions)) % 3

    def obstacle_distance(self, points):
        return np.hypot(points[:, 0] - 1.5, points[:, 2] - 0.5) - 0.1

    def panel_frame(self):
        frame = {"center": [0, 0, 1], "normal": [0.6, 0, 0.8], "slope": [0.8, 0, -0.6]}
        return {**frame, "length": 1.0, "width": 1.0} if self._panel else None


def coloured(path) -> float:
    """Return the share of a picture's pixels that are not white."""
    return float((imread(path)[..., :3].min(axis=-1) < 0.9).mean())


@pytest.mark.parametrize("name", ["stack.png", "growth.png"])
def test_a_run_draws_its_pictures(finished, name):
    assert coloured(finished / name) > 0.005


@pytest.mark.parametrize("panel", [True, False])
@pytest.mark.parametrize("tilt", [0.0, 15.0])
def test_stack_picture_shows_panel_and_stack_to_scale(tmp_path, panel, tilt):
    pile = triangle(1.0, 0.3, count=2000) + [1.5, 0, 0]
    ones = np.ones(len(pile))
    stack = measure_stack(pile, ones, ones, dimension=2, dx=0.05)
    figure = stack_figure(Snow(pile, tilt, panel), stack, SCENE)
    save_figure(figure, tmp_path / "stack.png")
    overview, enlarged = figure.axes
    assert overview.get_aspect() == enlarged.get_aspect() == 1
    low, high = overview.get_xlim()
    assert low < (-0.4 if panel else 0.0) and high > 1.9
    low, high = enlarged.get_xlim()
    assert low < stack.head and stack.tail < high
    assert "damping 188 1/s (FLIP 0.99 per step)" in figure.get_suptitle()
    labels = [text.get_text() for text in enlarged.texts]
    assert f"height {stack.height:.3f} m" in labels and f"length {stack.length:.3f} m" in labels
    if panel:
        support = 1 - 0.3 + 0.4 * np.tan(np.radians(tilt))  # of the lower edge above the ground
        assert f"{support:g} m" in [text.get_text() for text in overview.texts]
    assert coloured(tmp_path / "stack.png") > 0.02


def test_pictures_without_snow(tmp_path):
    save_figure(stack_figure(Snow(np.zeros((0, 3))), StackMeasure(), SCENE), tmp_path / "stack.png")
    assert (tmp_path / "stack.png").exists()


def test_growth_shows_stack_and_body(finished):
    figure = growth_figure(read_events(finished), ResolvedScene.load(finished / "scene.json").data)
    assert [axes.get_title(loc="left").split(",")[0] for axes in figure.axes] == [
        "height",
        "length",
        "head",
        "tail",
    ]
    assert "panel 0.245 m, tilt 50°" in figure.get_suptitle()
    assert re.search(r"separate, friction 0\.3 .*damping [\d.]+ 1/s", figure.get_suptitle(), re.S)
    assert all(len(axes.lines) == 2 for axes in figure.axes)


def test_the_scene_beside_the_pictures_is_complete(finished):
    assert json.loads((finished / "scene.json").read_text())["snowshed"] == 2


def test_snow_that_rolled_far_away_does_not_shrink_the_stack():
    pile = np.vstack([triangle(1.0, 0.3, count=2000), triangle(1.0, 0.1, count=200) + [50, 0, 0]])
    ones = np.ones(len(pile))
    stack = measure_stack(pile, ones, ones, dimension=2, dx=0.05)
    figure = stack_figure(Snow(pile), stack, SCENE)
    low, high = figure.axes[1].get_xlim()
    assert high - low < 3
    assert "97 % of the snow lies within" in figure.get_suptitle()


def test_captions_of_fluids_name_no_density():
    body = Body(shape=Shape.box(center=(0, 0.1), size=(0.2, 0.2)))
    scene = Scene(dimension=2, method="mps", ground=Ground(), bodies=[body])
    caption = scene_caption(scene.resolve().data)
    assert "spacing" in caption and "kg/m" not in caption
