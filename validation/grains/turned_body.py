"""A body of synthetic snow that is turned in its grid of voxels before it becomes voxels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.special import ndtri

from snowshed.analysis.tomography.gaussian_field import SHELL_WIDTH
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.parts import largest_part
from snowshed.base.arrays import Booleans, Floats, Labels

WAVES = 600  # waves in the random field
WAVELENGTH = 5e-4  # m, their mean length
ICE_FRACTION = 0.35  # of the field above the cut; with parts that hang in the air
HEIGHT = DIAMETER = 3e-3  # m, of the cylinder
CELLS = 330  # points of the cells in a cube 1.2 times as large: a grain's size is 0.45 mm
MARGIN = 2  # voxels between the cylinder and the sides of the grid


@dataclass(frozen=True)
class TurnedBody:
    """A cylinder of a random field, cut at a level, that stands in a grid of voxels.

    The field is a function of space and the cylinder is turned about its own axis, along which it
    is loaded. For every grid it is therefore the same body under the same load.

    Parameters
    ----------
    seed
        Seed of the field.
    voxel
        Edge of a voxel, m.
    turn
        Angle about the axis, degrees.
    shift
        Displacement along x and y, voxels.
    """

    seed: int
    voxel: float
    turn: float = 0.0
    shift: float = 0.0

    def image(self) -> IceImage:
        """Return the ice: voxels whose centres are in the cylinder and above the cut.

        Examples
        --------
        >>> straight, turned = (TurnedBody(1, 1e-4, turn).image() for turn in (0, 45))
        >>> bool(abs(turned.density / straight.density - 1) < 0.02)
        True
        >>> straight.ice.shape, bool((straight.ice == turned.ice).all())
        ((30, 34, 34), False)
        """
        tall, wide = round(HEIGHT / self.voxel), round(DIAMETER / self.voxel) + 2 * MARGIN
        z: Floats = (np.arange(tall, dtype=float) + 0.5) * self.voxel
        x: Floats = (np.arange(wide, dtype=float) + 0.5 - 0.5 * wide - self.shift) * self.voxel
        inside = np.hypot(*np.meshgrid(x, x)) <= 0.5 * DIAMETER
        ice = (self._field(z, x) > ndtri(1.0 - ICE_FRACTION)) & inside
        return IceImage(
            largest_part(ice),
            self.voxel,
            f"synthetic: a cylinder of a random field, seed {self.seed}, turned by {self.turn:g}",
            synthetic=True,
        )

    def _field(self, z: Floats, x: Floats) -> Floats:
        """Return the field, of unit variance, at heights z and at x along both sides."""
        random = np.random.default_rng(self.seed)
        waves = random.standard_normal((WAVES, 3))
        length = WAVELENGTH / (1 + SHELL_WIDTH * random.standard_normal(WAVES))
        waves *= (2 * np.pi / length / np.linalg.norm(waves, axis=1))[:, None]
        phase = random.uniform(0, 2 * np.pi, WAVES)
        east, north = self._turned(waves[:, 0], waves[:, 1])
        upward = np.exp(1j * (np.outer(z, waves[:, 2]) + phase))
        layer = (
            np.exp(1j * np.outer(north, x))[:, :, None] * np.exp(1j * np.outer(east, x))[:, None]
        )
        field = (upward @ layer.reshape(WAVES, -1)).real * np.sqrt(2 / WAVES)
        return np.asarray(field.reshape(len(z), len(x), len(x)))

    def cells(self, ice: Booleans) -> Labels:
        """Return grains that turn with the body: the ice of each cell of space.

        Parameters
        ----------
        ice : (nz, ny, nx)
            The body's own image.
        """
        random = np.random.default_rng((self.seed, CELLS))
        points = random.uniform(-0.6, 0.6, (CELLS, 3)) * DIAMETER
        points[:, :2] = np.transpose(self._turned(points[:, 0], points[:, 1]))
        centres = (np.argwhere(ice) + 0.5) * self.voxel - 0.5 * HEIGHT
        wide = ice.shape[2]
        centres[:, 1:] += 0.5 * HEIGHT - (0.5 * wide + self.shift) * self.voxel
        nearest = cKDTree(points).query(centres[:, ::-1])[1]
        labels = np.zeros(ice.shape, dtype=np.int32)
        labels[ice] = nearest + 1
        return labels

    def _turned(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        angle = np.radians(self.turn)
        return np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y
