"""What a file may cost. Every reader goes by these limits before it takes memory or time.

A file of somebody else may be small and unpack to more than the memory holds, or never end. The
limits are far above what people have, and low enough that a reader that meets one has taken no more
than a gigabyte and some seconds.
"""

from __future__ import annotations

KB, MB, GB = 1 << 10, 1 << 20, 1 << 30

#: Bytes of what people write: scenes, studies, lists, and of a table.
TEXT, TABLE = 64 * MB, 1024 * MB
#: Bytes of the description of a coordinate system.
COORDINATE_SYSTEM = 64 * KB
#: Columns of a table; pandas takes minutes for a line of a hundred thousand names.
COLUMNS = 1000
#: Polygons of a file, and corners of all of them, each of which costs some 0.15 ms in a slide.
POLYGONS, CORNERS = 10_000, 50_000
#: Rings of one polygon: GDAL compares every ring with every other.
RINGS = 5_000
#: Bytes of a GeoJSON file; as objects of Python it takes up to 25 times as much.
GEOJSON = 32 * MB
#: Bytes of a value in a GeoPackage, and of one that is being written elsewhere, which is copied.
GEOPACKAGE_VALUE, GEOPACKAGE_COPY = 64 * MB, 1024 * MB
#: Instructions of SQLite while a GeoPackage is read, some seconds of them: ten thousand columns and
#: a hundred thousand polygons take a tenth.
SQL_STEPS = 100_000_000
#: Layers, and columns of a layer.
LAYERS = 1000
#: Files of an AvaFrame project, bytes of all of them, which are copied, and depth of its folders.
PROJECT_FILES, PROJECT_BYTES, PROJECT_DEPTH = 10_000, 2 * GB, 8
#: Bytes of an ini.
INI = MB
#: Times at which maps are saved beside the end, and cells of all these maps: 20 bytes each on disk.
SAVED_TIMES, SAVED_CELLS = 10_000, 1_000_000_000
#: Cells of terrain that is resampled, which takes some 50 bytes each.
RESAMPLED_CELLS = 10_000_000
