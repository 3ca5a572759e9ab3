"""What a file may cost. Every reader goes by these limits before it takes memory or time.

A file of somebody else may be small and unpack to more than the memory holds, or never end. The
limits are far above what people have, and low enough that a reader that meets one has taken no more
than a gigabyte and some seconds.
"""

from __future__ import annotations

KB, MB = 1 << 10, 1 << 20

#: Bytes of what people write: scenes, studies, lists, and of a table.
TEXT, TABLE = 64 * MB, 1024 * MB
#: Bytes of the description of a coordinate system.
COORDINATE_SYSTEM = 64 * KB
#: Columns of a table; pandas takes minutes for a line of a hundred thousand names.
COLUMNS = 1000
#: Pages of a TIFF file, and slices in a folder: each takes some 0.1 ms to look at. Tomographs make
#: some thousand.
PAGES = 16_384
#: Bytes of a tag of a TIFF file. The longest are lists of strips, and descriptions as XML.
TAG = 16 * MB
#: Numbers of an image that are read at once; they are held up to five times, in 8 bytes each.
VOXELS_AT_ONCE = 4 * MB
#: Numbers as text, bytes: some 20 million voxels, whose numbers take eight times as much.
VOXELS_AS_TEXT = 64 * MB
#: How many times as large an image may become when it is unpacked, if it is larger than this then.
#: Segmented snow shrinks to a tenth or a fiftieth; what shrinks more shows nothing.
UNPACKED_RATIO, UNPACKED_FREELY = 200, 256 * MB
