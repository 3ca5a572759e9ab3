"""Limits on the cost of files. Every reader checks them before it uses memory or time.

A file from elsewhere may be small and unpack to more than the memory, or never end. The limits are
far above real files, and low enough that a reader needs at most a gigabyte and some seconds to meet
one.
"""

from __future__ import annotations

KB, MB, GB = 1 << 10, 1 << 20, 1 << 30

#: Bytes of a file that people write (a scene, a study, a list), and of a table. Memory holds a
#: table three times while it is read.
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
#: Memory that unpacking may need besides its output, bytes; the strongest level of xz needs 65 MB.
UNPACKING = 80 * MB
#: Largest gap between rows of weather, days; no station is silent for longer and then continues.
WEATHER_GAP = 50 * 366
#: Cells of a raster, and bytes of one of its blocks, which GDAL reads as a whole. With all copies
#: that reading makes, that is a gigabyte. The core has the same limit for cells.
RASTER_CELLS, RASTER_BLOCK = 25_000_000, 256 * MB
#: Bytes of a file of facts beside a raster.
SIDECAR = MB
#: Cells of terrain under a slide, unless more are allowed; with maps and page they take a gigabyte.
TERRAIN_CELLS = 2_500_000
#: Above the first number of cells, a file of elevations must have a byte for every so many cells. A
#: file packed more tightly was made to be costly: a slide takes hundreds of bytes for each cell.
PACKED_CELLS, PACKED = 1_000_000, 20
#: Cells of snow in a raster of thickness, corners of the areas that they make, and cells times
#: corners, because each cell and each particle is compared with each corner when snow is laid.
SNOW_CELLS, RELEASE_CORNERS, CELLS_TIMES_CORNERS = 4_000_000, 5000, 200_000_000
#: Pages of a TIFF file, and slices in a folder: each takes about 0.1 ms to look at. Tomographs
#: write about a thousand.
PAGES = 16_384
#: Bytes of a tag of a TIFF file. The longest are lists of strips, and descriptions as XML.
TAG = 16 * MB
#: Numbers of an image to read in one block; they occupy up to five times 8 bytes each.
VOXELS_AT_ONCE = 4 * MB
#: Bytes of numbers as text: some 20 million voxels, which take 8 bytes each as numbers.
VOXELS_AS_TEXT = 64 * MB
#: Largest ratio of an unpacked to a packed image, if the unpacked one is larger than this.
UNPACKED_RATIO, UNPACKED_FREELY = 200, 256 * MB
#: Largest number of polygons in a file, and of their corners; each costs some 0.15 ms in a slide.
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
