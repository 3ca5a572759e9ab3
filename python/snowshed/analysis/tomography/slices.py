"""Slices through the grains of an image."""

from __future__ import annotations

import colorsys
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed.analysis.tomography.microstructure import Microstructure
from snowshed.base.arrays import Floats, Labels
from snowshed.plot.figure_style import STYLE, blank_figure, describe

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from snowshed.analysis.tomography.grain_tables import GrainStatistics

AIR = (1.0, 1.0, 1.0)
LINE = (0.13, 0.19, 0.24)  # between grains
HUES = 64
TURN = 0.381966  # turns from hue to hue, so that successive hues differ much
MAX_PIXELS = 1000  # along an edge of a slice


def slices_figure(
    labels: Labels, numbers: Microstructure, grains: Optional[GrainStatistics] = None
) -> Figure:
    """Return the picture of three slices through the middle of an image, with a colour per grain.

    Parameters
    ----------
    labels : (nz, ny, nx)
        0 air, else a grain; or 1 for all ice.
    numbers
        Numbers of the ice.
    grains
        The grains; None if they are not separated.
    """
    from matplotlib import rc_context

    nz, ny, nx = labels.shape
    cuts = [
        (labels[:, ny // 2, :], "x", "z", nx, nz),
        (labels[:, :, nx // 2], "y", "z", ny, nz),
        (labels[nz // 2], "x", "y", nx, ny),
    ]
    with rc_context(STYLE):
        tallest = max(height / width for *_, width, height in cuts)
        figure = blank_figure(10.0, 1.3 + 2.85 * min(tallest, 2.5))
        describe(figure, _caption(numbers, grains))
        for axes, (cut, across, up, width, height) in zip(figure.subplots(1, 3), cuts):
            _draw(axes, cut, numbers.voxel_size_m, (width, height))
            axes.set(xlabel=f"{across}, mm", ylabel=f"{up}, mm")
    return figure


def _draw(axes: Axes, cut: Labels, voxel_size: float, size: tuple[int, int]) -> None:
    every = -(-max(cut.shape) // MAX_PIXELS)
    extent = (0.0, 1e3 * size[0] * voxel_size, 0.0, 1e3 * size[1] * voxel_size)
    axes.grid(visible=False)
    axes.imshow(_slice_colours(cut[::every, ::every]), origin="lower", extent=extent)


def _slice_colours(cut: Labels) -> Floats:
    """Return the colours of a slice, with lines where grains touch."""
    scale = max(1, 400 // max(cut.shape))  # so that lines are thinner than a voxel
    fine = np.kron(cut, np.ones((scale, scale), dtype=cut.dtype))
    palette = np.array(
        [colorsys.hls_to_rgb(n * TURN % 1.0, 0.68 + 0.08 * (n % 3 - 1), 0.5) for n in range(HUES)]
    )
    colours = np.where((fine > 0)[..., None], palette[fine % HUES], AIR)
    touching = np.zeros(fine.shape, dtype=bool)
    for low, high, line in (
        (fine[:-1], fine[1:], touching[:-1]),
        (fine[:, :-1], fine[:, 1:], touching[:, :-1]),
    ):
        line |= low != high
    colours[touching] = LINE
    return np.asarray(colours)


def _caption(numbers: Microstructure, grains: Optional[GrainStatistics]) -> str:
    text = (
        f"{numbers.source}\n{numbers.density_kg_m3:.0f} kg/m³, "
        f"{numbers.specific_surface_m2_kg:.1f} m²/kg"
    )
    if grains is None:
        return text
    return (
        f"{text}; {grains.grains:,} grains of median diameter "
        f"{1e3 * grains.median_diameter_m:.2g} mm, coordination {grains.mean_coordination:.2f}"
    )
