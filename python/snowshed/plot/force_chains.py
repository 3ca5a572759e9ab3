"""The forces between the grains of a sample."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from snowshed.base.arrays import Booleans, Floats
from snowshed.methods.grains.contacts import GrainContacts
from snowshed.plot.figure_style import BODY, FAINT, INK, STACK, STYLE, blank_figure, describe

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SLICE_SHARE = 0.25  # thickness of the drawn slice in the middle, relative to the sample's depth
TITLE_WIDTH = 80  # characters
MAX_LINE_WIDTH = 7.0  # points, of a line
SLICED_FROM_GRAINS = 300  # number of grains from which only the forces in the slice are drawn
ICE = ("#e3ebf1", "#cfdce6", "#bccdda", "#d9e0ea", "#c5d6d9")


def force_figure(contacts: GrainContacts, voxel_size: float, title: str = "") -> Figure:
    """Return the picture of a sample from the side, with the forces between its grains.

    Lines connect the centres of touching grains through their contacts. In a small sample all
    contacts are drawn, in a large one only those within the drawn slice of ice. The width of a
    line is proportional to the force. Only bonds can pull: unbonded grains in oblique contact
    always push.

    Parameters
    ----------
    contacts
        The contacts between grains at one time.
    voxel_size
        Diameter of the spheres, m.
    title
        Text above the figure, such as the recipe of a synthetic sample.
    """
    from matplotlib import rc_context

    with rc_context(STYLE):
        width, _, height = np.ptp(contacts.spheres, axis=0) + voxel_size
        figure = blank_figure(6.4, 1.2 + 5.6 * min(height / width, 2.0))
        if title:
            describe(figure, fill(title, TITLE_WIDTH))
        axes = figure.subplots()
        axes.grid(visible=False)
        _draw_ice(axes, contacts, voxel_size)
        _draw_forces(axes, contacts)
        axes.set_aspect("equal")
        axes.set(xlabel="x, mm", ylabel="z, mm")
    return figure


def _draw_ice(axes: Axes, contacts: GrainContacts, voxel_size: float) -> None:
    from matplotlib.collections import EllipseCollection

    depth = contacts.spheres[:, 1]
    shown = np.flatnonzero(_in_slice(contacts, depth, 0.5 * voxel_size))
    shown = shown[np.argsort(-depth[shown], kind="stable")]  # from the back to the front
    centres = 1e3 * contacts.spheres[shown][:, [0, 2]]
    size = np.full(len(shown), 1e3 * voxel_size)
    colours = [ICE[grain % len(ICE)] for grain in contacts.sphere_grains[shown]]
    discs = EllipseCollection(
        size, size, np.zeros(len(shown)), units="xy", offsets=centres,
        offset_transform=axes.transData, facecolors=colours, edgecolors="none",
    )  # fmt: skip
    axes.add_collection(discs)
    edge = voxel_size
    for set_limits, axis in ((axes.set_xlim, 0), (axes.set_ylim, 2)):
        values = contacts.spheres[:, axis]
        set_limits(1e3 * (values.min() - edge), 1e3 * (values.max() + edge))


def _in_slice(contacts: GrainContacts, depth: Floats, margin: float = 0.0) -> Booleans:
    """Return whether each depth (y, m) is in the slice in the middle, whose ice is drawn."""
    low, high = contacts.spheres[:, 1].min(), contacts.spheres[:, 1].max()
    near = np.abs(depth - 0.5 * (low + high)) <= 0.5 * SLICE_SHARE * (high - low) + margin
    return np.asarray(near)


def _draw_forces(axes: Axes, contacts: GrainContacts) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    pulling = contacts.bonded & (contacts.normal_forces < 0.0)
    many = int(contacts.sphere_grains.max(initial=0)) >= SLICED_FROM_GRAINS
    drawn_ones = _in_slice(contacts, contacts.points[:, 1]) if many else np.isfinite(pulling)
    size = np.linalg.norm(contacts.forces, axis=1) * drawn_ones
    largest = float(size.max(initial=0.0))
    if largest == 0.0:
        axes.set_title("No forces between the grains")
        return
    for pulls, colour in ((False, BODY), (True, STACK)):
        chosen = (pulling == pulls) & drawn_ones
        for side in (0, 1):
            arms, complete = contacts.arms(side)
            shown = np.flatnonzero(chosen & complete)
            ends = np.stack([contacts.points[shown] - arms[shown], contacts.points[shown]], axis=1)
            lines, widths = 1e3 * ends[:, :, [0, 2]], MAX_LINE_WIDTH * size[shown] / largest
            drawn = LineCollection(list(lines), linewidths=widths, colors=colour)
            drawn.set(alpha=0.75, capstyle="round")
            axes.add_collection(drawn)
    where = " in the slice" if many else ""
    axes.set_title(f"Forces between grains{where}", color=INK)
    key = [
        Line2D([], [], color=BODY, lw=MAX_LINE_WIDTH, label=f"pressing, {_force_label(largest)}"),
        Line2D(
            [],
            [],
            color=BODY,
            lw=MAX_LINE_WIDTH / 4,
            label=f"pressing, {_force_label(largest / 4)}",
        ),
        Line2D(
            [],
            [],
            color=STACK,
            lw=MAX_LINE_WIDTH / 4,
            label=f"pulling, {_force_label(largest / 4)}",
        ),
    ]
    axes.figure.legend(handles=key, loc="outside lower center", ncols=3, edgecolor=FAINT)


def _force_label(newtons: float) -> str:
    for unit, factor in (("N", 1.0), ("mN", 1e3)):
        if newtons * factor >= 1.0:
            return f"{newtons * factor:.3g} {unit}"
    return f"{newtons * 1e6:.3g} µN"
