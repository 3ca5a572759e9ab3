"""The components of a scene of grains: the sample, and how it is loaded.

As in `snowshed.scene.components`, a field that was not given reads as the core's default.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Optional

import numpy as np
from numpy.typing import ArrayLike

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.base.record import Record, default
from snowshed.io.array_files import array_file

LoadingKind = Literal["compress", "unload", "stretch", "shear", "isotropic", "penetrate", "hold"]


@checked
@dataclass
class Sample(Record):
    """Segmented snow to be loaded.

    Attributes
    ----------
    file : str or path
        Segmented image: an NPY file of integers (nz, ny, nx), 0 air and any other number a grain;
        relative to the scene file. Required.
    voxel_size : float
        Edge of a voxel [m]. 1e-09 <= value <= 1; required.
    split_labels : bool
        Whether each connected piece of a label is a grain; else all pieces of a label are one
        rigid grain. Default False.
    """

    file: Optional[PathLike] = None
    voxel_size: Optional[float] = None
    split_labels: Optional[bool] = default(False)

    @classmethod
    def from_labels(
        cls, labels: ArrayLike, *, voxel_size: float, split_labels: Optional[bool] = None
    ) -> Sample:
        """Return a sample from an array of grains.

        Parameters
        ----------
        labels : (nz, ny, nx)
            Whole numbers: 0 air, and any other number a grain.
        voxel_size
            Edge of a voxel, m.
        split_labels
            Whether each connected piece of a label is a grain.

        Raises
        ------
        InputError
            If the array is none of three dimensions, or its numbers are not whole.

        Examples
        --------
        >>> Sample.from_labels(np.ones((2, 2, 2), int), voxel_size=1e-4).voxel_size
        0.0001
        """
        values = np.asarray(labels)
        if values.ndim != 3 or values.dtype.kind not in "iub":
            raise InputError("labels: needed is an array (nz, ny, nx) of whole numbers")
        file = array_file(values.astype(np.int32))
        return cls(file=file, voxel_size=voxel_size, split_labels=split_labels)


@dataclass
class LoadingStage(Record):
    """A stage of a loading.

    Attributes
    ----------
    kind : {"compress", "unload", "stretch", "shear", "isotropic", "penetrate", "hold"}
        Motion: the top plate down (compress), up until the stress has fallen (unload), up
        (stretch) or along x (shear); all sides inward (isotropic); a cone down (penetrate);
        nothing, until the snow rests (hold). Default "compress".
    speed : float
        Speed of the plates or of the cone [m/s]. 0 < value <= 1000; default 0.02.
    strain : float
        Displacement over the sample's initial height at which the stage ends. 0 < value <= 10;
        default 0.3.
    stress : float
        Stress that ends the stage (compress, isotropic; 0: none; unload), or is kept on the top
        plate (shear; 0: constant height) [Pa]. 0 <= value <= 1e+12; default 0.
    """

    kind: Optional[LoadingKind] = default("compress")
    speed: Optional[float] = default(0.02)
    strain: Optional[float] = default(0.3)
    stress: Optional[float] = default(0.0)


@dataclass
class Cone(Record):
    """The tip of a penetrometer, with its shaft.

    Attributes
    ----------
    radius : float
        Radius of the cone's base and of the shaft [m]. 1e-09 <= value <= 1; default 0.0025.
    half_angle : float
        Angle between the axis and the cone's side [degrees]. 0 < value <= 90; default 30.
    """

    radius: Optional[float] = default(0.0025)
    half_angle: Optional[float] = default(30.0)
