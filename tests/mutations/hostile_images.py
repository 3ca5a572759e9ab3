"""Images with well-formed headers of false content: sizes, offsets, types and compressions.

Each function changes a good file of its format at random, by a seed. Checksums are computed again,
so that readers meet the false content and not a wrong sum.
"""

from __future__ import annotations

import random
import struct
import zlib

EXTREMES = (
    *(0, 1, 2, 3, 7, 8, 16, 255, 256, 65_535, 65_536, 100_000, 1 << 24, 1 << 30),
    *((1 << 31) - 1, 1 << 31, (1 << 32) - 1),
)
ZEROS = zlib.compress(bytes(64 << 20), 9)  # 64 kB that unpack to 64 MB
WORDS = (
    *("", "x", "-1", "0", "1", "2", "3", "nan", "inf", "1e308", "True", "False", "LOCAL", "LIST"),
    *("../a", "/dev/zero", "/etc/passwd", "a%03d.raw 1 99999999 1", "a.mha", "9" * 300, "1 1 1"),
    *("65535 65535 1", "65536 65536 65536", "7 6 5 4", "-7 6 5", "0 0 0", "1 0 0 0 1 0 0 0 1"),
    *(
        "0 1 0 1 0 0 0 0 -1",
        "1e-300 1e-300 1e-300",
        "MET_DOUBLE",
        "MET_LONG_LONG",
        "MET_UCHAR_ARRAY",
    ),
    *("MET_STRING", "1000 1000 1000", "1200 1200 1200", "2000 2000 1", "7.5 6 5", "\x00", "é"),
)
FIELDS = (
    *("ObjectType", "NDims", "DimSize", "ElementType", "ElementByteOrderMSB", "CompressedData"),
    *(
        "BinaryData",
        "BinaryDataByteOrderMSB",
        "CompressedDataSize",
        "TransformMatrix",
        "HeaderSize",
    ),
    *("ElementSpacing", "ElementSize", "ElementNumberOfChannels", "DistanceUnits", "Rotation"),
    *("ElementDataFile", "ElementToIntensityFunctionSlope", "Offset", "Comment"),
)
TAGS = (
    *(254, 256, 257, 258, 259, 262, 266, 270, 273, 274, 277, 278, 279, 282, 284, 292, 296, 317),
    *(320, 322, 323, 324, 325, 330, 338, 339, 347, 32997, 34665, 50838, 50839, 65000),
)
ORIENTED = b"II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0"  # Exif up to the value
COMPRESSIONS = (1, 2, 3, 4, 5, 6, 7, 8, 32773, 32946, 34712, 34925, 50000, 50001, 99)


def mha(content: bytes, seed: int) -> bytes:
    """Return a MetaImage whose fields hold other values, some with data that unpack to 64 MB."""
    chance = random.Random(seed)
    head, _, data = content.partition(b"ElementDataFile = LOCAL\n")
    fields = dict(line.split(" = ", 1) for line in head.decode().splitlines())
    fields["ElementDataFile"] = "LOCAL"
    for _ in range(chance.choice((1, 1, 2, 3))):
        fields[chance.choice(FIELDS)] = chance.choice(WORDS)
    if chance.random() < 0.3:
        fields["CompressedData"], data = "True", ZEROS
        fields.setdefault("DimSize", "400 400 400")
    last = fields.pop("ElementDataFile")
    lines = [f"{name} = {value}\n" for name, value in fields.items()]
    return ("".join(lines) + f"ElementDataFile = {last}\n").encode() + data


def npy(content: bytes, seed: int) -> bytes:
    """Return an NPY file with another shape, type or order."""
    chance = random.Random(seed)
    sizes = [chance.choice((-1, 0, 1, 5, 6, 7, 100, 1000, 65_536, 10**6, 10**18, 10**30))
             for _ in range(chance.choice((0, 1, 2, 3, 3, 3, 3, 4, 40)))]  # fmt: skip
    shape = chance.choice((repr(tuple(sizes)), repr(sizes), "None", "(5, 6, 7)", "(" * 300, "(7,)"))
    kinds = (
        "|u1",
        "<f8",
        ">f4",
        "|O",
        "<M8[s]",
        "|S9",
        "[('a', 'u1')]",
        "<f16",
        "<c8",
        "|V5",
        "<U9",
    )
    kind = chance.choice(kinds)
    kind = kind if kind.startswith("[") else repr(kind)
    order = chance.choice(("True", "False", "False", "0", "None"))
    head = f"{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}"
    if chance.random() < 0.1:
        head += "x" * 9000
    version = chance.choice((1, 1, 1, 2, 3, 9))
    size = "<H" if version == 1 else "<I"
    length = chance.choice((len(head), len(head), len(head), 65_535, 3))
    mark = b"\x93NUMPY" + bytes([version, 0]) + struct.pack(size, length)
    return mark + head.encode() + content[-chance.choice((0, 1, 209, 210)) :]


def tiff(content: bytes, seed: int) -> bytes:
    """Return a TIFF file with other types, counts and values in some of its tags."""
    chance = random.Random(seed)
    data = bytearray(content)
    pages = list(_pages(data))
    for _ in range(chance.choice((1, 1, 2, 3, 5))):
        start, count = chance.choice(pages)
        entry = start + 2 + 12 * chance.randrange(count)
        end = start + 2 + 12 * count
        change = chance.randrange(7)
        if change == 0:
            _put(data, entry, "<H", chance.choice(TAGS))
        elif change == 1:
            _put(data, entry + 2, "<H", chance.choice((0, 1, 2, 3, 4, 5, 6, 7, 11, 12, 13, 16, 99)))
        elif change == 2:
            _put(data, entry + 4, "<I", chance.choice(EXTREMES))
        elif change == 3:
            _put(data, entry + 8, "<I", chance.choice(EXTREMES))
        elif change == 4:
            _put(data, end, "<I", chance.choice((0, 8, *(page for page, _ in pages), *EXTREMES)))
        elif change == 5:
            _put(data, start, "<H", chance.choice((0, 1, count - 1, count + 1, 4096, 65_535)))
        else:
            _set(data, start, count, 259, chance.choice(COMPRESSIONS))
    if chance.random() < 0.2:  # a large page of packed zeros
        for start, count in pages:
            for code, value in ((256, 20_000), (257, 20_000), (259, 8), (278, 20_000)):
                _set(data, start, count, code, value)
            _set(data, start, count, 273, len(data))
            _set(data, start, count, 279, len(ZEROS))
        data += ZEROS
    return bytes(data)


def _pages(data: bytearray) -> list[tuple[int, int]]:
    """Return the start of each page of a file, and its number of tags."""
    pages = []
    (start,) = struct.unpack_from("<I", data, 4)
    while start:
        (count,) = struct.unpack_from("<H", data, start)
        pages.append((start, count))
        (start,) = struct.unpack_from("<I", data, start + 2 + 12 * count)
    return pages


def _set(data: bytearray, start: int, count: int, code: int, value: int) -> None:
    """Set a tag to a single 32-bit number if the page has it."""
    for entry in range(start + 2, start + 2 + 12 * count, 12):
        if struct.unpack_from("<H", data, entry)[0] == code:
            data[entry : entry + 12] = struct.pack("<HHII", code, 4, 1, value & 0xFFFFFFFF)


def _put(data: bytearray, offset: int, kind: str, value: int) -> None:
    mask = 0xFFFF if kind == "<H" else 0xFFFFFFFF
    if offset + struct.calcsize(kind) <= len(data):
        struct.pack_into(kind, data, offset, value & mask)


def png(content: bytes, seed: int) -> bytes:
    """Return a PNG file with another header, other chunks, or pixels that unpack to 64 MB."""
    chance = random.Random(seed)
    chunks, offset = [], 8
    while offset < len(content):
        (length,) = struct.unpack_from(">I", content, offset)
        chunks.append((content[offset + 4 : offset + 8], content[offset + 8 : offset + 8 + length]))
        offset += 12 + length
    head = list(struct.unpack(">IIBBBBB", chunks[0][1]))
    for _ in range(chance.choice((0, 1, 2))):
        field = chance.randrange(7)
        head[field] = (
            chance.choice(EXTREMES) if field < 2 else chance.choice((0, 1, 2, 3, 4, 6, 8, 16, 255))
        )
    body = [(kind, ZEROS if kind == b"IDAT" and chance.random() < 0.3 else data)
            for kind, data in chunks[1:]]  # fmt: skip
    extra = chance.choice((
        (b"zTXt", b"a\0\0" + ZEROS), (b"iTXt", b"a\0\1\0\0\0" + ZEROS), (b"iCCP", b"a\0\0" + ZEROS),
        (b"eXIf", ORIENTED + bytes([chance.randrange(12), 0, 0, 0])),
        (b"acTL", struct.pack(">II", chance.choice(EXTREMES), 0)), (b"PLTE", bytes(range(9))),
        (b"tRNS", b"\0\1"), (b"IDAT", b""), (b"IEND", b""), (b"tEXt", b"x" * 1000),
    ))  # fmt: skip
    if chance.random() < 0.6:
        body.insert(chance.randrange(len(body)), extra)
    packed = struct.pack(">IIBBBBB", *head[:2], *(value & 255 for value in head[2:]))
    return content[:8] + b"".join(_chunk(*part) for part in [(b"IHDR", packed), *body])


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def bmp(content: bytes, seed: int) -> bytes:
    """Return a BMP file with other numbers in its header."""
    chance = random.Random(seed)
    data = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 3))):
        offset, kind = chance.choice((
            (2, "<I"), (10, "<I"), (14, "<I"), (18, "<I"), (22, "<I"), (26, "<H"), (28, "<H"),
            (30, "<I"), (34, "<I"), (46, "<I"), (50, "<I"),
        ))  # fmt: skip
        _put(data, offset, kind, chance.choice((*EXTREMES, 4, 24, 32)))
    return bytes(data)
