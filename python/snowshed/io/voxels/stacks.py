"""Images in TIFF stacks and in folders of numbered TIFF, PNG or BMP slices."""

from __future__ import annotations

import re
from math import isclose
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.limits import MAX_PAGES
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.voxels.pixel_picture import PixelPicture, stacked
from snowshed.io.voxels.png_bmp import open_picture
from snowshed.io.voxels.tiff.description import Description, parse_description
from snowshed.io.voxels.tiff.pages import contiguous_copies, is_big_endian, page_picture
from snowshed.io.voxels.tiff.tags import Tags, read_pages
from snowshed.io.voxels.voxel_file import VoxelFile

#: Format of a slice by its suffix.
FORMATS = {".tif": "TIFF", ".tiff": "TIFF", ".png": "PNG", ".bmp": "BMP"}
#: Units of the tag ResolutionUnit, m.
INCH, UNITS = 0.0254, {2: 0.0254, 3: 0.01}
#: Dots per inch that programs write by default, without knowing the picture.
USUAL_DPI = (1, 72, 96, 100, 150, 200, 300, 600, 1200)


def open_stack(path: Path) -> VoxelFile:
    """Return the image of a TIFF file, a slice from each page.

    Raises
    ------
    InputError
        If it is damaged, has colours, or its pages differ or do not form one stack.
    OSError
        If it cannot be read.
    """
    pictures, description, printed = _pages(path)
    if description.slices not in (None, len(pictures)):
        if len(pictures) == 1:
            pictures = contiguous_copies(pictures[0], description.slices or 0)
        else:
            issue_note(
                f"{path}: its description gives {description.slices} slices; it has "
                f"{len(pictures)} pages, which are read",
                InputNote,
            )
    for note in description.notes:
        issue_note(f"{path}: {note}", InputNote)
    return stacked(str(path), pictures, description.voxel_size, printed)


def open_slices(folder: Path) -> VoxelFile:
    """Return the image of a folder of slices, in the order of the numbers in their names.

    Raises
    ------
    InputError
        If slices are missing, of mixed types or sizes, or have colours, or other files have the
        same suffix.
    OSError
        If they cannot be read.
    """
    paths = _numbered_slices(folder)
    sizes: list[tuple[Optional[float], Optional[float]]] = []
    pictures = []
    for path in paths:
        kind = FORMATS[path.suffix.lower()]
        if kind == "TIFF":
            pages, description, printed = _pages(path)
            if len(pages) != 1 or (description.slices or 1) != 1:
                raise InputError(f"{path}: {len(pages)} pages; a slice has one")
            picture = pages[0]
            sizes.append((description.voxel_size, printed))
        else:
            picture = open_picture(path, kind)
        pictures.append(picture)
    voxel_size, printed = sizes[0] if len(set(sizes)) == 1 else (None, None)
    return stacked(str(folder), pictures, voxel_size, printed)


def _pages(path: Path) -> tuple[list[PixelPicture], Description, Optional[float]]:
    """Return the pages of a TIFF file, its description, and the size of its pixels in print."""
    big_endian = is_big_endian(path)
    descriptions: list[tuple[Description, Optional[float]]] = []

    def read_page(tags: Tags) -> PixelPicture:
        picture = page_picture(path, tags, big_endian)
        if not descriptions:
            text = parse_description(str(path), tags.text(270), tags.ratio(282))
            descriptions.append((text, _printed_size(tags)))
        return picture

    pictures = read_pages(path, read_page)
    if not pictures:
        raise InputError(f"{path}: damaged: not a readable TIFF: it has no pages")
    return (pictures, *descriptions[0])


def _printed_size(tags: Tags) -> Optional[float]:
    """Return the pixel size, m, from the resolution tags; None if they hold only a default."""
    unit, across, along = UNITS.get(tags.number(296, 2)), tags.ratio(282), tags.ratio(283)
    if unit is None or across is None or along is None:
        return None
    if not isclose(across, along, rel_tol=1e-3):
        issue_note(
            f"{tags.name}: its resolution tags declare pixels that are not square; ignored",
            InputNote,
        )
        return None
    if any(isclose(across * INCH / unit, usual, rel_tol=1e-2) for usual in USUAL_DPI):
        return None
    return unit / across


def _numbered_slices(folder: Path) -> list[Path]:
    """Return the slices of a folder by their number, without gaps."""
    paths = []
    for path in folder.iterdir():
        if path.suffix.lower() in FORMATS and not path.name.startswith("."):
            paths.append(path)
        if len(paths) > MAX_PAGES:
            raise InputError(f"{folder}: more than {MAX_PAGES:,} slices")
    if not paths:
        raise InputError(f"{folder}: no slices in it; {', '.join(FORMATS)} are read")
    kinds = {FORMATS[path.suffix.lower()] for path in paths}
    if len(kinds) > 1:
        raise InputError(f"{folder}: slices of mixed types: {', '.join(sorted(kinds))}")
    numbers: dict[int, Path] = {}
    named: dict[str, Path] = {}
    for path in sorted(paths):
        match = re.search(r"(\d{1,12})\D*$", path.stem)
        if match is None:
            raise InputError(f"{path}: no number in its name; slices are ordered by their numbers")
        number = int(match[1])
        if number in numbers:
            raise InputError(f"{path}: has the number of {numbers[number].name}, {number}")
        numbers[number] = path
        named.setdefault(path.stem[: match.start(1)] + "*" + path.stem[match.end(1) :], path)
    if len(named) > 1:
        first, other = [path.name for path in named.values()][:2]
        issue_note(
            f"{folder}: its slices have several names, {first} and {other}; all are one stack",
            InputNote,
        )
    order = sorted(numbers)
    for one_number, following in zip(order, order[1:]):
        if following != one_number + 1:
            raise InputError(
                f"{folder}: slice {one_number + 1} is missing, between "
                f"{numbers[one_number].name} and {numbers[following].name}"
            )
    return [numbers[number] for number in order]
