"""What a file may cost. Every reader goes by these limits before it takes memory or time.

A file of somebody else may be small and unpack to more than the memory holds, or never end. The
limits are far above what people have, and low enough that a reader that meets one has taken no more
than a gigabyte and some seconds.
"""

from __future__ import annotations

KB, MB = 1 << 10, 1 << 20

#: Bytes of what people write: scenes, studies, lists, and of a table. A table is in memory three
#: times while it is read.
TEXT, TABLE = 64 * MB, 256 * MB
#: Seconds to wait for the writer of a pipe, and until all of it is there.
PIPE_SILENCE, PIPE = 3.0, 8.0
#: Bytes of the description of a coordinate system.
COORDINATE_SYSTEM = 64 * KB
#: Columns of a table; pandas takes minutes for a line of a hundred thousand names.
COLUMNS = 1000
#: Bytes of a line, or of the lines of one record. A line of 20 MB becomes ten million texts.
LINE = 1 * MB
#: Rows of a table, and of one that people write, whose rows are kept as texts.
ROWS, WRITTEN_ROWS = 4_000_000, 300_000
#: Bytes of a line of a weather file, and its lines: ten-minute values of 15 years, or 150 years of
#: daily elements.
WEATHER_LINE, WEATHER_LINES = 64 * KB, 1_000_000
#: Members or streams of a packed file; programs that pack in parallel write one per 64 KB and more.
MEMBERS = 10_000
#: Bytes that unpacking may need besides what it yields; the strongest level of xz has 65 MB.
UNPACKING = 80 * MB
#: Days from one row of weather to the next; no station is silent for longer and goes on.
WEATHER_GAP = 50 * 366
