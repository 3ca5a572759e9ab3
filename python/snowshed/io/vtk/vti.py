"""Files of VTK (.vti): values at the nodes of a regular grid."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Union

from numpy.typing import NDArray

from snowshed.base.arrays import Floats
from snowshed.io.vtk.vtp import LENGTH_BYTES, write_appended


def write_image(
    path: Union[str, os.PathLike[str]],
    origin: Sequence[float],
    spacing: float,
    values: Mapping[str, Floats],
) -> None:
    """Write values at nodes as a .vti file in single precision, with appended raw data.

    Parameters
    ----------
    path
        The file.
    origin : (3,)
        The first node, m.
    spacing
        Distance of the nodes, m.
    values : (nx, ny, nz) or (nx, ny, nz, 3)
        Numbers or vectors, by name.
    """
    shape = next(iter(values.values())).shape[:3]
    extent = " ".join(f"0 {count - 1}" for count in shape)
    blocks: list[NDArray[Any]] = []
    arrays, offset = "", 0
    for name, array in values.items():
        components = 1 if array.ndim == 3 else array.shape[3]
        # In these files, x varies fastest.
        blocks.append(array.swapaxes(0, 2).astype("<f4").ravel())
        arrays += (
            f'<DataArray type="Float32" Name="{name}" NumberOfComponents="{components}" '
            f'format="appended" offset="{offset}"/>\n'
        )
        offset += LENGTH_BYTES + blocks[-1].nbytes
    where = " ".join(f"{x:.17g}" for x in origin)
    head = (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        f'<ImageData WholeExtent="{extent}" Origin="{where}" '
        f'Spacing="{spacing:.17g} {spacing:.17g} {spacing:.17g}">\n'
        f'<Piece Extent="{extent}">\n<PointData>\n{arrays}</PointData>\n</Piece>\n</ImageData>\n'
    )
    write_appended(path, head, blocks)
