"""Pages of TIFF files as pictures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.callers import argument
from snowshed.io.input_file import open_regular
from snowshed.io.voxels.pixel_picture import ORIENTATIONS, PixelPicture
from snowshed.io.voxels.tiff import segments
from snowshed.io.voxels.tiff.segments import Coding, decoded, read_at
from snowshed.io.voxels.tiff.tags import Tags
from snowshed.io.voxels.voxel_file import check_size

WHITE_IS_ZERO, BLACK_IS_ZERO, PALETTE = 0, 1, 3
#: The sample formats of TIFF, by NumPy's letter for the kind.
KINDS = {1: "u", 2: "i", 3: "f", 4: "u"}
UNDEFINED_FORMAT = 4
MAX_TILE = 1 << 20  # pixels of a tile that may exceed its image


@dataclass(frozen=True)
class Layout:
    """Positions of the numbers of a page.

    Attributes
    ----------
    size
        Pixels along y and x.
    piece
        Pixels of a strip or tile along y and x.
    tiled
        Whether the segments are tiles, which are all complete; the last strip may have fewer rows.
    offsets, counts
        First byte, and number of bytes, of each strip or tile, row by row.
    coding
        Coding of the pixels.
    """

    size: tuple[int, int]
    piece: tuple[int, int]
    tiled: bool
    offsets: tuple[int, ...]
    counts: tuple[int, ...]
    coding: Coding

    def rows_of(self, number: int) -> int:
        """Return the number of rows of a strip or tile."""
        if self.tiled:
            return self.piece[0]
        return min(self.piece[0], self.size[0] - number * self.piece[0])


def page_picture(path: Path, tags: Tags, big_endian: bool) -> PixelPicture:
    """Return a page as a picture.

    Raises
    ------
    InputError
        If the page is damaged, has colours, or uses an unsupported compression.
    """
    name = tags.name
    height, width = tags.number(257, 0), tags.number(256, 0)
    check_size(name, (1, height, width))
    _check_one_number(tags)
    dtype, notes = _dtype(tags, big_endian)
    photometric = tags.number(262, BLACK_IS_ZERO)
    palette: Optional[NDArray[Any]] = None
    if photometric == PALETTE:
        palette, seen = _palette(tags, dtype)
        notes += seen
        dtype = palette.dtype
    elif photometric == WHITE_IS_ZERO:
        notes += (
            "numbers are taken as they are stored; by its tag PhotometricInterpretation "
            "(WhiteIsZero), larger numbers are darker. If ice has the smaller numbers, give "
            f"{argument('dark_ice', True)}",
        )
    elif photometric != BLACK_IS_ZERO:
        raise InputError(
            f"{name}: has colours (PhotometricInterpretation {photometric}); convert it to shades "
            "of grey"
        )
    orientation = tags.number(274, 0) or None
    if orientation not in (None, *ORIENTATIONS):
        raise InputError(f"{name}: Orientation {orientation}; 1 to 8 are allowed")
    layout = _layout(path, tags, (height, width), big_endian)
    shades = {WHITE_IS_ZERO: ", WhiteIsZero", PALETTE: ", palette"}.get(photometric, "")
    return PixelPicture(
        name,
        (height, width),
        dtype,
        f"{layout.coding.bits} bits, {dtype.name}{shades}",
        _PageReader(path, name, layout, palette),
        orientation,
        sum(layout.counts),
        notes,
    )


def _check_one_number(tags: Tags) -> None:
    samples = tags.number(277, 1)
    if samples != 1:
        raise InputError(
            f"{tags.name}: has {samples} numbers per pixel (colours, transparency?); convert it "
            "to shades of grey"
        )
    if tags.number(32997, 1) != 1:
        raise InputError(f"{tags.name}: several layers in one page (ImageDepth) are not read")


def _dtype(tags: Tags, big_endian: bool) -> tuple[np.dtype[Any], tuple[str, ...]]:
    """Return the type of the numbers, in the byte order of the file, and assumptions."""
    bits, sample_format = tags.number(258, 1), tags.number(339, 1)
    kind = KINDS.get(sample_format, "")
    supported = {"u": (1, 2, 4, 8, 16, 32, 64), "i": (8, 16, 32, 64), "f": (16, 32, 64)}
    if bits not in supported.get(kind, ()):
        raise InputError(
            f"{tags.name}: numbers of {bits} bits, SampleFormat {sample_format}: whole numbers of "
            "1, 2, 4, 8, 16, 32 or 64 bits and floating-point numbers of 16, 32 or 64 are read"
        )
    order = ">" if big_endian else "<"
    notes = ("SampleFormat is undefined: numbers are taken as whole and not negative",)
    dtype = np.dtype(f"{order}{kind}{max(bits // 8, 1)}")
    return dtype, notes if sample_format == UNDEFINED_FORMAT else ()


def _palette(tags: Tags, dtype: np.dtype[Any]) -> tuple[NDArray[Any], tuple[str, ...]]:
    """Return the shade of grey that each number of a palette stands for."""
    count = 1 << tags.number(258, 1)
    colours = np.array(tags.numbers(320), dtype=np.int64)
    if dtype.kind != "u" or count > 1 << 16 or len(colours) != 3 * count:
        raise InputError(f"{tags.name}: damaged: no palette for its numbers")
    red, green, blue = colours.reshape(3, count)
    if (red != green).any() or (red != blue).any():
        raise InputError(
            f"{tags.name}: has colours (a palette); convert it to shades of grey, or remove the "
            "look-up table"
        )
    if (red < 0).any() or (red > 0xFFFF).any():
        raise InputError(f"{tags.name}: damaged: its palette is not of 16 bits")
    shades = (red >> 8).astype(np.uint8) if count <= 256 else red.astype(np.uint16)
    if (shades == np.arange(count)).all():
        return shades, ()
    return shades, ("the shades of its palette are used as its numbers",)


def _layout(path: Path, tags: Tags, size: tuple[int, int], big_endian: bool) -> Layout:
    tiled = bool(tags.numbers(322))
    height, width = size
    if tiled:
        piece = (tags.number(323, 0), tags.number(322, 0))
        offsets, counts = tags.numbers(324), tags.numbers(325)
    else:
        piece = (min(tags.number(278, height), height), width)
        offsets, counts = tags.numbers(273), tags.numbers(279)
    max_pixels = max(4 * height * width, MAX_TILE)
    if min(piece) < 1 or piece[0] * piece[1] > max_pixels:
        raise InputError(f"{tags.name}: damaged: strips or tiles of {piece[1]} x {piece[0]} pixels")
    coding = _coding(tags, big_endian)
    across, down = -(-width // piece[1]), -(-height // piece[0])
    layout = Layout(size, piece, tiled, offsets, counts, coding)
    if len(offsets) != across * down:
        raise InputError(
            f"{tags.name}: damaged: {len(offsets)} strips or tiles for {across * down}"
        )
    lengths = tuple(
        layout.rows_of(number) * coding.row_bytes(piece[1]) for number in range(len(offsets))
    )
    if coding.compression == segments.NONE:
        counts = lengths
    if len(counts) != len(offsets):
        raise InputError(f"{tags.name}: damaged: no lengths of its strips or tiles")
    end = path.stat().st_size
    most = coding.longest(*piece)
    for offset, count in zip(offsets, counts):
        if offset < 8 or count < 1 or offset + count > end or count > most:
            raise InputError(
                f"{tags.name}: damaged: a strip or tile of {count:,} bytes at {offset:,} in a file "
                f"of {end:,}"
            )
    return Layout(size, piece, tiled, offsets, counts, coding)


def _coding(tags: Tags, big_endian: bool) -> Coding:
    compression = tags.number(259, segments.NONE)
    bits, predictor = tags.number(258, 1), tags.number(317, segments.NO_PREDICTOR)
    dtype, _ = _dtype(tags, big_endian)
    if compression not in segments.READ or (compression == segments.JPEG and bits != 8):
        raise InputError(
            f"{tags.name}: compression {compression} of {bits} bits is not read; save the image "
            "uncompressed, or with LZW or deflate"
        )
    needed = {
        segments.NO_PREDICTOR: True,
        segments.DIFFERENCES: bits >= 8,
        segments.FLOAT_DIFFERENCES: dtype.kind == "f",
    }
    if compression in (segments.NONE, segments.JPEG, *segments.FAX):
        predictor = segments.NO_PREDICTOR
    if not needed.get(predictor, False):
        raise InputError(f"{tags.name}: Predictor {predictor} of {bits} bits is not read")
    fill = tags.number(266, 1)
    if fill not in (1, 2):
        raise InputError(f"{tags.name}: damaged: FillOrder {fill}")
    tables = tags.value(347)
    options = tags.number(292 if compression == 3 else 293, 0)
    return Coding(
        compression,
        predictor,
        bits,
        dtype,
        fill == 2,
        bytes(tables) if isinstance(tables, bytes) else None,
        options,
    )


@dataclass(frozen=True)
class _PageReader:
    """Reader of the numbers of a page."""

    path: Path
    name: str
    layout: Layout
    palette: Optional[NDArray[Any]]

    def __call__(self) -> NDArray[Any]:
        layout = self.layout
        (height, width), (rows, columns) = layout.size, layout.piece
        across = -(-width // columns)
        numbers: Optional[NDArray[Any]] = None
        with open_regular(self.path) as file:
            for number, (offset, count) in enumerate(zip(layout.offsets, layout.counts)):
                packed = read_at(file, offset, count, self.name)
                y, x = number // across * rows, number % across * columns
                rows = layout.rows_of(number)
                part = decoded(layout.coding, packed, rows, columns, self.name)
                if part.shape != (rows, columns):
                    raise InputError(f"{self.name}: damaged: a strip of {part.shape} pixels")
                if numbers is None:
                    numbers = np.empty((height, width), part.dtype.newbyteorder("="))
                part = part[: height - y, : width - x]
                numbers[y : y + part.shape[0], x : x + part.shape[1]] = part
        if numbers is None:
            raise InputError(f"{self.name}: damaged: it has no numbers")
        return numbers if self.palette is None else self.palette[numbers]


def is_big_endian(path: Path) -> bool:
    """Return whether a TIFF file stores the highest byte of a number first."""
    with open_regular(path) as file:
        return file.read(2) == b"MM"


def contiguous_copies(picture: PixelPicture, count: int) -> list[PixelPicture]:
    """Return pictures that follow one another in a file; only the first one is a page.

    Raises
    ------
    InputError
        If its numbers are compressed or not contiguous, or the file ends early.
    """
    reader = picture.read
    if not isinstance(reader, _PageReader):
        raise TypeError("a page of a TIFF file is needed")
    layout = reader.layout
    begins = layout.offsets[0]
    ends = [offset + length for offset, length in zip(layout.offsets, layout.counts)]
    contiguous = [*layout.offsets[1:], ends[-1]] == ends and layout.piece[1] == layout.size[1]
    length = ends[-1] - begins
    if layout.coding.compression != segments.NONE or not contiguous:
        raise InputError(
            f"{picture.name}: {count} slices in one page, which are read only uncompressed and in "
            "one piece; save the image as a sequence of images, or as raw"
        )
    file_bytes = reader.path.stat().st_size
    if begins + count * length > file_bytes:
        raise InputError(
            f"{picture.name}: damaged: {count} slices end at byte {begins + count * length:,} of "
            f"{file_bytes:,}"
        )
    pictures = []
    for number in range(count):
        offsets = tuple(offset + number * length for offset in layout.offsets)
        moved = replace(reader, layout=replace(layout, offsets=offsets))
        pictures.append(replace(picture, read=moved))
    return pictures
