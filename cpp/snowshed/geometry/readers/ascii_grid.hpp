// ESRI ASCII grids: rasters of elevations as text.
#pragma once

#include <filesystem>

#include "snowshed/geometry/height_field.hpp"

namespace snowshed {

/// Reads a grid from an untrusted file: ncols, nrows, xllcenter or xllcorner, yllcenter or
/// yllcorner, cellsize and, if present, nodata_value (-9999 without it), in any order, then the
/// values, from the north-west, row by row. Nodes are the centres of the raster's cells. Throws
/// InputError with the file and the line.
HeightField read_ascii_grid(const std::filesystem::path& file);

}  // namespace snowshed
