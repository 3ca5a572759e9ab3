"""Packed files: gzip and xz, which may unpack to more than the memory."""

from __future__ import annotations

import lzma
import re
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.base.limits import KB, MAX_MEMBERS, MAX_TEXT_BYTES, MAX_UNPACKING_BYTES, MB

GZIP, XZ = b"\x1f\x8b", b"\xfd7zXZ\x00"
ZIP = b"PK\x03\x04"
#: Names near the beginning of the workbooks of spreadsheet programs (xlsx, ods).
WORKBOOKS, WORKBOOK_BYTES = (b"[Content_Types].xml", b"xl/", b"opendocument.spreadsheet"), 4096
#: Refused packings, by their first bytes.
REFUSED_PACKINGS = {
    ZIP: "a zip archive",
    b"BZh": "packed with bzip2",
    b"7z\xbc\xaf\x27\x1c": "a 7z archive",
    b"\x28\xb5\x2f\xfd": "packed with zstd",
}
ZEROS = re.compile(rb"\0*")
PART_BYTES = 64 * KB  # bytes of input at once, because the rest is copied for every member


def unpacked(content: bytes, path: Path, largest: int = MAX_TEXT_BYTES) -> bytes:
    """Return the content of a file, unpacked if it is packed with gzip or xz.

    Parameters
    ----------
    content
        Content of the file, packed or not.
    path
        Name for messages.
    largest
        Largest unpacked size, bytes.

    Raises
    ------
    InputError
        If the content is damaged, longer than allowed, or packed in another format.

    Examples
    --------
    >>> import gzip
    >>> unpacked(gzip.compress(b"snow"), Path("a.gz")), unpacked(b"snow", Path("a"))
    (b'snow', b'snow')
    """
    if content.startswith(ZIP) and any(mark in content[:WORKBOOK_BYTES] for mark in WORKBOOKS):
        raise InputError(
            f"{path}: a workbook of a spreadsheet program; save its sheet as CSV, with commas "
            "between cells, decimal points, and dates such as 2024-12-31"
        )
    for begin, what in REFUSED_PACKINGS.items():
        if content.startswith(begin):
            raise InputError(f"{path}: {what}; unpack it and give the file inside")
    if content.startswith(GZIP):
        return _members(content, path, largest, "gzip", _gzip_part, _gzip)
    if content.startswith(XZ):
        return _members(content, path, largest, "xz", _xz_part, _xz)
    return content


def _gzip() -> Any:
    return zlib.decompressobj(zlib.MAX_WBITS + 16)


def _xz() -> Any:
    return lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=MAX_UNPACKING_BYTES)


def _gzip_part(member: Any, part: bytes, most: int) -> Iterator[bytes]:
    while part:
        yield member.decompress(part, most)
        part = member.unconsumed_tail


def _xz_part(member: Any, part: bytes, most: int) -> Iterator[bytes]:
    yield member.decompress(part, most)
    while not (member.eof or member.needs_input):
        yield member.decompress(b"", most)


def _members(
    content: bytes,
    path: Path,
    largest: int,
    kind: str,
    made_of: Callable[[Any, bytes, int], Iterator[bytes]],
    begin: Callable[[], Any],
) -> bytes:
    """Return the joined contents of the members; zeros may follow each of them."""
    joined, start = bytearray(), 0
    for _ in range(MAX_MEMBERS):
        member = begin()
        while not member.eof:
            part = content[start : start + PART_BYTES]
            if not part:
                raise InputError(f"{path}: damaged: {kind}: it ends too early")
            start += len(part)
            try:
                for piece in made_of(member, part, MB):
                    joined += piece
                    if len(joined) > largest:
                        raise InputError(f"{path}: longer than {largest // MB} MB when unpacked")
            except (zlib.error, lzma.LZMAError) as error:
                raise InputError(f"{path}: damaged: {kind}: {error}") from None
        start -= len(member.unused_data)
        zeros = ZEROS.match(content, start)
        start = zeros.end() if zeros else start
        if start >= len(content):
            return bytes(joined)
    raise InputError(f"{path}: more than {MAX_MEMBERS} {kind} members; unpack it first")
