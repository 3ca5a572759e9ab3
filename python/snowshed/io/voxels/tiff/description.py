"""The description of a TIFF file's pages: by ImageJ, OME, or tifffile.

Only facts about the numbers and their positions are read: the number of slices, whether they are
slices at all, and the voxel size. No other file that a description names is opened.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional
from xml.etree import ElementTree

from snowshed._core import InputError
from snowshed.base.messages import quoted

#: Units of length by their names in ImageJ and OME, m.
UNITS = {
    "nm": 1e-9, "micron": 1e-6, "microns": 1e-6, "um": 1e-6, "\N{MICRO SIGN}m": 1e-6,
    "\N{GREEK SMALL LETTER MU}m": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254,
}  # fmt: skip
CUBIC = 1.001  # ratio of edges up to which a voxel counts as a cube
#: Names in descriptions for the three dimensions along which pages may follow each other.
KINDS = ("channels", "slices", "frames")


@dataclass(frozen=True)
class Description:
    """Content of a description.

    Attributes
    ----------
    slices
        Number of slices, if the file states it.
    voxel_size
        Edge of a voxel, m; None: not stated.
    notes
        Assumptions made in reading.
    """

    slices: Optional[int] = None
    voxel_size: Optional[float] = None
    notes: tuple[str, ...] = ()


def parse_description(name: str, text: str, pixels_per_unit: Optional[float]) -> Description:
    r"""Return the content of a file's description.

    Parameters
    ----------
    name
        Name of the file.
    text
        The tag ImageDescription of its first page.
    pixels_per_unit
        The tag XResolution, which ImageJ gives in its own unit.

    Raises
    ------
    InputError
        If the pages are not a stack of slices, or the voxels not cubes.

    Examples
    --------
    >>> parse_description("a.tif", "ImageJ=1.53\nimages=40\nslices=40\nunit=mm\nspacing=0.05", 20.0)
    Description(slices=40, voxel_size=5e-05, notes=())
    """
    if text.startswith("ImageJ="):
        return _by_imagej(name, text, pixels_per_unit)
    if text.lstrip().startswith("<") and "<OME" in text[:4000]:
        return _by_ome(name, text)
    if text.startswith("{"):
        return _by_tifffile(name, text)
    return Description()


def _stack(name: str, counts: Mapping[str, int]) -> tuple[int, tuple[str, ...]]:
    """Return the number of slices, from pages along several dimensions."""
    more = {kind: count for kind, count in counts.items() if count > 1}
    if len(more) > 1:
        counted = " x ".join(f"{count} {kind}" for kind, count in more.items())
        raise InputError(
            f"{name}: {counted}; one stack of slices is needed: save one of them alone"
        )
    if more and "slices" not in more:
        ((kind, count),) = more.items()
        return count, (f"its {count} {kind} are taken for slices, because it has no others",)
    return math.prod(counts.values()), ()


def _cube(name: str, edges: list[Optional[float]]) -> Optional[float]:
    """Return the edge of a voxel; None unless all three are known."""
    valid = [edge for edge in edges if edge is not None and math.isfinite(edge) and edge > 0]
    if len(valid) < len(edges):
        return None
    if max(valid) > CUBIC * min(valid):
        text = " x ".join(f"{edge:.4g}" for edge in valid)
        raise InputError(f"{name}: voxels of {text} m; they must be cubes: resample the image")
    return float(f"{valid[0]:.7g}")


def _by_imagej(name: str, text: str, pixels_per_unit: Optional[float]) -> Description:
    facts = dict(line.split("=", 1) for line in text.splitlines() if "=" in line)
    counts = {kind: _count(facts.get(kind, "1")) for kind in KINDS}
    images = _count(facts.get("images", "1"))
    if math.prod(counts.values()) != images:
        counts = {"slices": images}
    slices, notes = _stack(name, counts)
    if facts.get("cf", "") in ("0", "20") and _number(facts.get("c1", "1")) is not None:
        scale = " and ".join(f"{key} = {facts.get(key, '0')}" for key in ("c0", "c1"))
        notes += (f"numbers, and thresholds, are those that are stored, without ImageJ's {scale}",)
    unit = facts.get("unit", "").replace("\\u00B5", "\N{MICRO SIGN}").strip()
    factor, depth = UNITS.get(unit), _number(facts.get("spacing", ""))
    edge = factor / pixels_per_unit if factor and pixels_per_unit else None
    size = _cube(name, [edge, None if depth is None or factor is None else depth * factor])
    return Description(slices, size, notes)


def _by_ome(name: str, text: str) -> Description:
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{name}: its description is XML that defines entities")
    try:
        root = ElementTree.fromstring(text.strip().encode())
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise InputError(f"{name}: damaged: its description is no XML: {error}") from None
    images = [element for element in root.iter() if _tag(element) == "Pixels"]
    if len(images) != 1:
        raise InputError(f"{name}: {len(images)} images by its description; one is needed")
    pixels = images[0]
    files = {element.get("FileName") for element in pixels.iter() if _tag(element) == "UUID"}
    if len(files) > 1:
        raise InputError(f"{name}: one of {len(files)} files of an image; save it as one file")
    data = [element for element in pixels.iter() if _tag(element) == "TiffData"]
    for entry in data:
        shift = _count(entry.get("FirstZ", "0")) - _count(entry.get("IFD", "0"))
        if shift and max(_count(pixels.get(f"Size{axis}", "1")) for axis in "CT") == 1:
            raise InputError(f"{name}: its pages are not in the order of z; save it again")
    sizes = zip(KINDS, "CZT")
    counts = {kind: _count(pixels.get(f"Size{axis}", "1")) for kind, axis in sizes}
    slices, notes = _stack(name, counts)
    edges = []
    for axis in "XYZ":
        unit = UNITS.get(pixels.get(f"PhysicalSize{axis}Unit", "um"))
        edge = _number(pixels.get(f"PhysicalSize{axis}", ""))
        edges.append(edge * unit if edge is not None and unit is not None else None)
    return Description(slices, _cube(name, edges), notes)


def _by_tifffile(name: str, text: str) -> Description:
    """Read the shape of an array, which tifffile writes by default."""
    try:
        facts: Any = json.loads(text)
        shape = [int(count) for count in facts["shape"]]
    except (ValueError, TypeError, KeyError, OverflowError, RecursionError):
        return Description()
    stacks = [count for count in shape[:-2] if count != 1]
    if len(stacks) > 1:
        raise InputError(
            f"{name}: an array of {' x '.join(map(str, shape))}; one stack of slices is needed"
        )
    return Description(stacks[0] if stacks else 1)


def _tag(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


def _count(text: Optional[str]) -> int:
    """Return a count in a description; raises InputError for other values."""
    if not re.fullmatch(r"[0-9]{1,9}", text or ""):
        raise InputError(f"{quoted(text or '')}: no count, in the description of a TIFF file")
    return int(text or "0")


def _number(text: str) -> Optional[float]:
    try:
        return float(text)
    except ValueError:
        return None
