"""Limits on the cost of files. Every reader checks them before it uses memory or time.

A file from elsewhere may be small and unpack to more than the memory, or never end. The limits are
far above real files, and so low that a reader needs at most a gigabyte and some seconds before it
refuses a file.
"""

from __future__ import annotations

KB, MB, GB = 1 << 10, 1 << 20, 1 << 30

#: Bytes of a file that people write (a scene, a study, a list).
MAX_TEXT_BYTES = 64 * MB
#: Bytes of a table; memory holds a table three times while it is read.
MAX_TABLE_BYTES = 256 * MB
#: Longest silence of the writer of a pipe, s.
MAX_PIPE_SILENCE_S = 3.0
#: Longest time to read a pipe, s.
PIPE_TIMEOUT_S = 8.0
#: Bytes of the description of a coordinate system.
MAX_COORDINATE_SYSTEM_BYTES = 64 * KB
#: Columns of a table; pandas takes minutes for a line of a hundred thousand names.
MAX_COLUMNS = 1000
#: Bytes of a line, or of the lines of one record. A line of 20 MB becomes ten million texts.
MAX_LINE_BYTES = 1 * MB
#: Rows of a table.
MAX_ROWS = 4_000_000
#: Rows of a hand-written table, which are kept as texts.
MAX_WRITTEN_ROWS = 300_000
#: Bytes of a line of a weather file.
MAX_WEATHER_LINE_BYTES = 64 * KB
#: Lines of a weather file: ten-minute values of 15 years, or daily elements of 150 years.
MAX_WEATHER_LINES = 1_000_000
#: Members or streams of a packed file; programs that pack in parallel write one per 64 KB and more.
MAX_MEMBERS = 10_000
#: Memory that unpacking may need besides its output, bytes; the strongest level of xz needs 65 MB.
MAX_UNPACKING_BYTES = 80 * MB
#: Largest gap between rows of weather, days; no station is silent for longer and then continues.
MAX_WEATHER_GAP_DAYS = 50 * 366
#: Cells of a raster; with all copies that reading makes, they take a gigabyte. The core has the
#: same limit.
MAX_RASTER_CELLS = 25_000_000
#: Bytes of a block of a raster, because GDAL reads complete blocks.
MAX_RASTER_BLOCK_BYTES = 256 * MB
#: Bytes of a metadata file beside a raster.
MAX_SIDECAR_BYTES = MB
#: Cells of terrain under a slide, unless more are allowed; with maps and page they take a gigabyte.
MAX_TERRAIN_CELLS = 2_500_000
#: Cells up to which the packing of a file of elevations is not checked.
UNCHECKED_RASTER_CELLS = 1_000_000
#: Cells per byte of a larger file. A file packed more tightly was made to be costly: a slide takes
#: hundreds of bytes for each cell.
MAX_CELLS_PER_BYTE = 20
#: Cells of snow in a raster of thickness.
MAX_SNOW_CELLS = 4_000_000
#: Corners of the areas that these cells make.
MAX_RELEASE_CORNERS = 5000
#: Cells times corners, because each cell and each particle is compared with each corner when snow
#: is laid.
MAX_CELLS_TIMES_CORNERS = 200_000_000
#: Pages of a TIFF file, and slices in a folder: each takes about 0.1 ms to look at. Tomographs
#: write about a thousand.
MAX_PAGES = 16_384
#: Bytes of a tag of a TIFF file. The longest are lists of strips, and descriptions as XML.
MAX_TAG_BYTES = 16 * MB
#: Numbers of an image to read in one block; they occupy up to five times 8 bytes each.
MAX_VOXELS_AT_ONCE = 4 * MB
#: Bytes of numbers as text: some 20 million voxels, which take 8 bytes each as numbers.
MAX_VOXEL_TEXT_BYTES = 64 * MB
#: Ratio of an unpacked to a packed image.
MAX_UNPACKED_RATIO = 200
#: Bytes of an unpacked image up to which any ratio is allowed.
UNCHECKED_UNPACKED_BYTES = 256 * MB
#: Polygons in a file.
MAX_POLYGONS = 10_000
#: Corners of all polygons in a file; each costs some 0.15 ms in a slide.
MAX_CORNERS = 50_000
#: Rings of one polygon: GDAL compares every ring with every other.
MAX_RINGS = 5_000
#: Bytes of a GeoJSON file; as objects of Python it takes up to 25 times as much.
MAX_GEOJSON_BYTES = 32 * MB
#: Bytes of a value in a GeoPackage.
MAX_GEOPACKAGE_VALUE_BYTES = 64 * MB
#: Bytes of a GeoPackage that another program writes, because it is copied.
MAX_GEOPACKAGE_COPY_BYTES = 1024 * MB
#: Instructions of SQLite while a GeoPackage is read; they take some seconds. Ten thousand columns
#: and a hundred thousand polygons need a tenth of them.
MAX_SQL_STEPS = 100_000_000
#: Layers of a GeoPackage.
MAX_LAYERS = 1000
#: Files of an AvaFrame project.
MAX_PROJECT_FILES = 10_000
#: Bytes of all files of a project, because they are copied.
MAX_PROJECT_BYTES = 2 * GB
#: Depth of a project's folders.
MAX_PROJECT_DEPTH = 8
#: Bytes of an ini file.
MAX_INI_BYTES = MB
#: Times besides the end at which maps are saved.
MAX_SAVED_TIMES = 10_000
#: Cells of all saved maps, 20 bytes each.
MAX_SAVED_CELLS = 1_000_000_000
#: Cells of terrain that is resampled, which takes some 50 bytes each.
MAX_RESAMPLED_CELLS = 10_000_000
