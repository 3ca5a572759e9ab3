"""Figures of loading tests show the measured curves and forces."""

import numpy as np
import pytest

from snowshed.methods.grains.contacts import GrainContacts
from snowshed.methods.grains.curve import COLUMNS, LoadingCurve
from snowshed.plot.force_chains import MAX_LINE_WIDTH, force_figure
from snowshed.plot.loading_figure import loading_figure


def curve(**columns):
    rows = 50
    ramp = np.linspace(0.0, 0.1, rows)
    blank = {name: np.zeros(rows) for name in COLUMNS}
    return LoadingCurve({**blank, "stage": np.ones(rows), "time_s": ramp, **columns})


RAMP = np.linspace(0.0, 0.1, 50)


@pytest.mark.parametrize(
    ("kinds", "columns", "label"),
    [
        (["compress"], {"axial_strain": RAMP, "top_stress_pa": 1e5 * RAMP}, "axial strain, %"),
        (["stretch"], {"axial_strain": -RAMP, "top_stress_pa": -1e5 * RAMP}, "extension, %"),
        (["shear"], {"shear_strain": RAMP, "shear_stress_pa": 1e5 * RAMP}, "shear strain, %"),
        (["compress", "shear"], {"axial_strain": RAMP, "kinetic_j": RAMP}, "time, ms"),
        (["penetrate"], {"cone_force_n": RAMP}, "time, ms"),
    ],
)
def test_every_kind_of_test_is_drawn(kinds, columns, label):
    figure = loading_figure(curve(**columns), kinds)
    assert figure.axes[0].get_xlabel() == label
    assert all(axes.lines or axes.collections for axes in figure.axes[1:])
    if kinds == ["penetrate"]:
        assert figure.axes[1].get_title("left") == "Force on the cone"


def contacts(
    forces, centres=((0, 0, 0), (1, 0, 0), (3.9, 0, 0)), points=((0.5, 0, 0), (-0.05, 0, 0))
):
    return GrainContacts(
        spheres=np.array(centres, dtype=float),
        sphere_grains=np.arange(3),
        grains=np.array([[0, 1], [2, 0]]),
        points=np.array(points, dtype=float),
        forces=np.array(forces, dtype=float),
        bonded=np.array([True, False]),
    )


def test_pressure_is_positive_and_tension_negative():
    pressed = contacts([(-3, 0, 0), (0, 0, 0)])
    assert pressed.normal_forces[0] == pytest.approx(3.0)
    assert contacts([(3, 0, 0), (0, 0, 0)]).normal_forces[0] == pytest.approx(-3.0)
    # Across the periodic sides, the last grain lies left of the first and is pressed to the left.
    assert contacts([(0, 0, 0), (-2, 0, 0)]).normal_forces[1] == pytest.approx(2.0)


def test_line_widths_follow_forces_and_no_line_crosses_the_picture():
    from matplotlib.collections import LineCollection

    figure = force_figure(contacts([(-4, 0, 0), (-1, 0, 0)]), voxel_size=0.1)
    drawn = [
        collection
        for collection in figure.axes[0].collections
        if isinstance(collection, LineCollection)
    ]
    widths = np.concatenate([lines.get_linewidths() for lines in drawn if len(lines.get_paths())])
    assert sorted(widths) == pytest.approx([MAX_LINE_WIDTH / 4, MAX_LINE_WIDTH, MAX_LINE_WIDTH])
    segments = [s for lines in drawn for s in lines.get_segments()]
    assert max(np.ptp(s[:, 0]) for s in segments) < 1e3 * 3.9 / 2


def test_a_sample_without_forces_is_drawn_without_lines():
    figure = force_figure(contacts([(0, 0, 0), (0, 0, 0)]), voxel_size=0.1)
    assert figure.axes[0].get_title("left") == "No forces between the grains"


def lines_of(figure):
    from matplotlib.collections import LineCollection

    drawn = [
        collection
        for collection in figure.axes[0].collections
        if isinstance(collection, LineCollection)
    ]
    return {
        tuple(collection.get_colors()[0]): len(collection.get_paths())
        for collection in drawn
        if collection.get_paths()
    }


def test_only_bonds_pull():
    """Both contacts are pushed along the line of their centres; the second has no bond."""
    pulled = contacts([(3, 0, 0), (2, 0, 0)])
    assert (pulled.normal_forces < 0).all()
    assert len(lines_of(force_figure(pulled, voxel_size=0.1))) == 2  # each with its colour


def test_for_many_grains_only_forces_in_a_slice_are_drawn():
    count = 400
    y = np.linspace(0, 1, count)
    centres = np.stack([np.zeros(count), y, np.zeros(count)], axis=1)
    chain = GrainContacts(
        spheres=centres,
        sphere_grains=np.arange(count),
        grains=np.stack([np.arange(count - 1), np.arange(1, count)], axis=1),
        points=0.5 * (centres[1:] + centres[:-1]),
        forces=np.tile([0.0, -1.0, 0.0], (count - 1, 1)),
        bonded=np.ones(count - 1, dtype=bool),
    )
    figure = force_figure(chain, voxel_size=0.1)
    assert sum(lines_of(figure).values()) <= 2 * 0.26 * count
    assert "in the slice" in figure.axes[0].get_title("left")


def test_a_modulus_is_given_only_for_a_linear_stress():
    waves = 1e5 * RAMP + 4e3 * np.sin(300 * RAMP)
    for stress, words in ((1e5 * RAMP, "tangent modulus"), (waves, "not linear")):
        stresses = {"top_stress_pa": stress, "bottom_stress_pa": stress}
        figure = loading_figure(curve(axial_strain=RAMP, **stresses), ["compress"])
        assert words in figure.axes[1].get_title("left")
