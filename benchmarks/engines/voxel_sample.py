"""Spheres and bonds from voxels, for engines without images.

The module is independent of the solver and serves as its check: both make the same spheres, bonds,
masses and moments of inertia from an image. It needs only NumPy, because engines have their own
Python.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

ICE_DENSITY = 917.0  # kg/m3
FACES = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


@dataclass
class VoxelSample:
    """Clumps in a box with a corner at the origin; x is the last axis of the labels.

    Attributes
    ----------
    centres, grain
        Centres of all voxels of ice, (n, 3) in m, and the grain of each, (n,).
    surface
        Whether a voxel touches air or another grain and therefore is a sphere, (n,).
    bonds
        Pairs of voxels of different grains that share a face, (m, 2).
    mass, centre, inertia
        Mass, centre of mass and moments of inertia of each grain, kg, m and kg m2: (g,), (g, 3),
        (g, 3, 3). Each voxel is a cube.
    box
        Edges of the box, m.
    radius
        Radius of the spheres, m.
    """

    centres: np.ndarray
    grain: np.ndarray
    surface: np.ndarray
    bonds: np.ndarray
    mass: np.ndarray
    centre: np.ndarray
    inertia: np.ndarray
    box: np.ndarray
    radius: float

    @classmethod
    def of_labels(cls, labels: np.ndarray, voxel: float) -> VoxelSample:
        """Return the sample of an image (nz, ny, nx); 0 is air, other numbers are grains."""
        image = np.ascontiguousarray(labels.transpose(2, 1, 0))
        voxels = np.argwhere(image)
        _, grain = np.unique(image[tuple(voxels.T)], return_inverse=True)
        grain = grain.reshape(-1)
        number = np.full(image.shape, -1)
        number[tuple(voxels.T)] = np.arange(len(voxels))
        padded = np.pad(image, 1)
        inner = np.ones(image.shape, dtype=bool)
        bonds = []
        for face in FACES:
            for sign in (1, -1):
                moved = np.roll(padded, [-sign * step for step in face], axis=(0, 1, 2))
                inner &= moved[1:-1, 1:-1, 1:-1] == image
            first = image[tuple(slice(0, n - step) for n, step in zip(image.shape, face))]
            second = image[tuple(slice(step, None) for step in face)]
            joined = np.argwhere((first != second) & (first != 0) & (second != 0))
            bonds.append(
                np.stack([number[tuple(joined.T)], number[tuple((joined + face).T)]], axis=1)
            )
        centres = voxel * (voxels + 0.5)
        mass, centre, inertia = _weigh(centres, grain, voxel)
        return cls(
            centres=centres,
            grain=grain,
            surface=~inner[tuple(voxels.T)],
            bonds=np.concatenate(bonds),
            mass=mass,
            centre=centre,
            inertia=inertia,
            box=voxel * np.array(image.shape),
            radius=voxel / 2,
        )

    @property
    def height(self) -> float:
        """Distance between the plates, m."""
        return float(self.box[2])

    def save(self, file: Path) -> None:
        """Write the sample to an NPZ file."""
        np.savez(file, **{field.name: getattr(self, field.name) for field in fields(self)})

    @classmethod
    def load(cls, file: Path) -> VoxelSample:
        """Return the sample from a file of `save`."""
        with np.load(file) as data:
            arrays = {field.name: data[field.name] for field in fields(cls)}
        return cls(**{**arrays, "radius": float(arrays["radius"])})


def _weigh(
    centres: np.ndarray, grain: np.ndarray, voxel: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return masses, centres of mass and moments of inertia of the grains."""
    count = grain.max() + 1
    each = ICE_DENSITY * voxel**3
    mass = each * np.bincount(grain, minlength=count)
    centre = np.stack([np.bincount(grain, x, count) for x in centres.T], axis=1)
    centre /= np.bincount(grain, minlength=count)[:, None]
    arm = centres - centre[grain]
    own = (arm**2).sum(axis=1) + voxel**2 / 6
    parts = each * (own[:, None, None] * np.eye(3) - arm[:, :, None] * arm[:, None, :])
    inertia = np.zeros((count, 3, 3))
    np.add.at(inertia, grain, parts)
    return mass, centre, inertia
