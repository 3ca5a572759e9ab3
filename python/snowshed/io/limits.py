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
#: Days from one row of weather to the next; no station is silent for longer and goes on.
WEATHER_GAP = 50 * 366
