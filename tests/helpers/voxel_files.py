"""Three-dimensional images in every supported format."""

import zlib

import numpy as np
from PIL import Image

VOXELS = np.random.default_rng(3).integers(0, 250, (5, 6, 7)).astype(np.uint8)
TYPES = {
    "uint8": "MET_UCHAR", "int8": "MET_CHAR", "uint16": "MET_USHORT", "int16": "MET_SHORT",
    "uint32": "MET_UINT", "int32": "MET_INT", "uint64": "MET_ULONG_LONG", "int64": "MET_LONG_LONG",
    "float32": "MET_FLOAT", "float64": "MET_DOUBLE",
}  # fmt: skip


def voxels_of_type(kind):
    """Return voxels that span the full range of a type."""
    dtype = np.dtype(kind)
    if dtype.kind == "u":
        return VOXELS.astype(dtype) * dtype.type(np.iinfo(dtype).max // 250)
    if dtype.kind == "i":
        return (VOXELS.astype(dtype) - dtype.type(125)) * dtype.type(np.iinfo(dtype).max // 125)
    return VOXELS.astype(dtype) * dtype.type(1.5) - dtype.type(30)


def save_pages(path, voxels, **options):
    pages = [Image.fromarray(page) for page in voxels]
    pages[0].save(path, save_all=True, append_images=pages[1:], **options)
    return path


def save_slices(folder, voxels, ending="png", first=1):
    folder.mkdir()
    for number, page in enumerate(voxels, first):
        Image.fromarray(page).save(folder / f"slice{number}.{ending}")
    return folder


def save_metaimage(path, voxels, header="", kind=None, data="LOCAL", order="<", compress=False):
    """Write a MetaImage; `header` holds lines that are added, or replace those of their fields."""
    nz, ny, nx = voxels.shape
    numbers = voxels.astype(voxels.dtype.newbyteorder(order)).tobytes()
    numbers = zlib.compress(numbers) if compress else numbers
    fields = {
        "ObjectType": "Image", "NDims": "3", "DimSize": f"{nx} {ny} {nz}",
        "ElementType": kind or TYPES[voxels.dtype.name], "ElementByteOrderMSB": f"{order == '>'}",
        "CompressedData": f"{compress}",
    }  # fmt: skip
    for line in header.splitlines():
        name, _, value = line.partition(" = ")
        fields[name] = value
    lines = [f"{name} = {value}\n" for name, value in fields.items()]
    text = "".join(lines) + f"ElementDataFile = {data}\n"
    path.write_bytes(text.encode() + (numbers if data == "LOCAL" else b""))
    if data != "LOCAL":
        path.with_name(data).write_bytes(numbers)
    return path
