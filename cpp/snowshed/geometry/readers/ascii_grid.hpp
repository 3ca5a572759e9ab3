// ESRI ASCII grids: rasters of elevations as text.
#pragma once

#include <cstddef>
#include <filesystem>

#include "snowshed/geometry/height_field.hpp"

namespace snowshed::geometry {

/// Assumptions made when a grid was read.
struct GridAssumptions {
  std::size_t undeclared_missing = 0;  // values of -9999 where the header has no nodata_value
  std::size_t decimal_commas = 0;      // numbers whose decimals follow a comma
};

/// Reads a grid from an untrusted file: ncols, nrows, xllcenter or xllcorner, yllcenter or
/// yllcorner, cellsize (or dx and dy, which must be equal) and, if present, nodata_value (-9999
/// without it), in any order, then the values, from the north-west, row by row. Values that are
/// NaN, or equal to nodata_value in single precision, are missing. Nodes are the centres of the
/// raster's cells. `assumptions`, if given, receives the assumptions. Throws InputError with the
/// file and the line.
HeightField read_ascii_grid(const std::filesystem::path& file,
                            GridAssumptions* assumptions = nullptr);

}  // namespace snowshed::geometry
