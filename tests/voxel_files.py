"""Three-dimensional images in every format that is read."""

import zlib

import numpy as np
from PIL import Image

VOXELS = np.random.default_rng(3).integers(0, 250, (5, 6, 7)).astype(np.uint8)
TYPES = {"uint8": "MET_UCHAR", "int16": "MET_SHORT", "uint16": "MET_USHORT", "float32": "MET_FLOAT"}


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
    nz, ny, nx = voxels.shape
    numbers = voxels.astype(voxels.dtype.newbyteorder(order)).tobytes()
    numbers = zlib.compress(numbers) if compress else numbers
    text = (
        f"ObjectType = Image\nNDims = 3\nDimSize = {nx} {ny} {nz}\n{header}"
        f"ElementType = {kind or TYPES[voxels.dtype.name]}\n"
        f"ElementByteOrderMSB = {order == '>'}\nCompressedData = {compress}\n"
        f"ElementDataFile = {data}\n"
    )
    path.write_bytes(text.encode() + (numbers if data == "LOCAL" else b""))
    if data != "LOCAL":
        path.with_name(data).write_bytes(numbers)
    return path
