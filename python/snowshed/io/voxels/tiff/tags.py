"""The pages of a TIFF file, and their tags from tifffile."""

from __future__ import annotations

import io
import logging
import os
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Optional, TypeVar

from snowshed._core import InputError
from snowshed.base.damage import DAMAGED
from snowshed.base.extras import require
from snowshed.base.limits import MAX_PAGES, MAX_TAG_BYTES
from snowshed.base.messages import shortened
from snowshed.io.input_file import open_regular

if TYPE_CHECKING:
    from tifffile import TiffFile, TiffPage

Page = TypeVar("Page")

#: Dialects whose own structures tifffile would follow; here every file is read as plain TIFF.
DIALECTS = (
    "is_lsm", "is_ndpi", "is_philips", "is_scanimage", "is_nih", "is_stk", "is_svs", "is_ome",
    "is_imagej", "is_micromanager", "is_mmstack", "is_sis", "is_fluoview", "is_tvips", "is_eer",
)  # fmt: skip
#: Largest number of passes over a file to find its pages; three are normal.
MAX_PASSES = 4


class Tags:
    """The tags of a page, as numbers and texts; damaged values are refused.

    Parameters
    ----------
    page
        The page from tifffile.
    name
        Name for messages.
    """

    def __init__(self, page: TiffPage, name: str) -> None:
        self.name = name
        self.offset = int(page.offset)
        self._tags = page.tags

    def value(self, code: int) -> Any:
        """Return the value of a tag, if the page has it."""
        tag = self._tags.get(code)
        return None if tag is None else tag.value

    def numbers(self, code: int) -> tuple[int, ...]:
        """Return the whole numbers of a tag; none if the page does not have it."""
        value = self.value(code)
        if value is None:
            return ()
        many = value if isinstance(value, (tuple, list)) else (value,)
        if not all(isinstance(value, int) for value in many):
            raise InputError(f"{self.name}: damaged: tag {code} holds {shortened(repr(value))}")
        return tuple(map(int, many))

    def number(self, code: int, default: int) -> int:
        """Return the whole number of a tag whose values are all the same."""
        numbers = set(self.numbers(code)) or {default}
        if len(numbers) > 1:
            raise InputError(f"{self.name}: tag {code} holds {shortened(str(sorted(numbers)))}")
        return numbers.pop()

    def ratio(self, code: int) -> Optional[float]:
        """Return the positive ratio of a tag; None: the page does not have it."""
        value = self.value(code)
        try:
            above, below = value
            return float(above) / float(below) if above > 0 and below > 0 else None
        except (TypeError, ValueError):
            return None

    def text(self, code: int) -> str:
        """Return the text of a tag; empty if the page does not have it."""
        value = self.value(code)
        if isinstance(value, bytes):
            return value.decode("utf-8", "replace")
        return value if isinstance(value, str) else ""


@contextmanager
def tiff_errors(path: Path) -> Iterator[None]:
    """Turn the errors of tifffile into InputError, and keep its log from stderr."""
    tifffile = require("tifffile", "images", "reading TIFF files")
    log = logging.getLogger("tifffile")
    level = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    except InputError:
        raise
    except (OSError, struct.error, tifffile.TiffFileError, *DAMAGED) as error:
        text = shortened(str(error) or type(error).__name__, 200)
        raise InputError(f"{path}: damaged: not a readable TIFF: {text}") from None
    finally:
        log.setLevel(level)


def read_pages(path: Path, read_page: Callable[[Tags], Page]) -> list[Page]:
    """Apply a function to the tags of each page of an open TIFF file, and return the results.

    Raises
    ------
    InputError
        If it is damaged, or has more than `MAX_PAGES` pages.
    OSError
        If it cannot be read.
    """
    tifffile = require("tifffile", "images", "reading TIFF files")
    with open_regular(path) as file, tiff_errors(path):
        off = _without_dialects(tifffile.TiffFile)
        with tifffile.TiffFile(_Bounded(file), name=path.name, **off) as tiff:
            return [read_page(tags) for tags in _tags(tiff, path)]


def _without_dialects(tiff_file: type[TiffFile]) -> dict[str, bool]:
    """Return the arguments by which tifffile follows no dialect; old ones fix some of them."""
    fixed = [name for name in DIALECTS if isinstance(getattr(tiff_file, name, None), property)]
    return {name: False for name in DIALECTS if name not in fixed}


def _tags(tiff: TiffFile, path: Path) -> Iterator[Tags]:
    offsets: set[int] = set()
    while True:
        name = f"{path}, page {len(offsets) + 1}"
        try:
            page = tiff.pages[len(offsets)]
        except IndexError:
            return
        if len(offsets) == MAX_PAGES:
            raise InputError(f"{path}: more than {MAX_PAGES:,} pages")
        tags = Tags(page, name)  # type: ignore[arg-type]
        if tags.offset in offsets:
            raise InputError(f"{name}: damaged: it is an earlier page again")
        offsets.add(tags.offset)
        yield tags


class _Bounded(io.RawIOBase):
    """A file that limits the size of tags (`MAX_TAG_BYTES`) and the passes over its bytes."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._left = MAX_PASSES * os.fstat(file.fileno()).st_size + MAX_TAG_BYTES

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def tell(self) -> int:
        return self._file.tell()

    def seek(self, offset: int, whence: int = os.SEEK_SET, /) -> int:
        return self._file.seek(offset, whence)

    def read(self, size: Optional[int] = -1, /) -> bytes:
        if size is None or not 0 <= size <= MAX_TAG_BYTES:
            raise InputError(f"a tag of {size} bytes; up to {MAX_TAG_BYTES:,} are read")
        self._left -= size
        if self._left < 0:
            raise InputError("its tags take more bytes than it has")
        return self._file.read(size)
