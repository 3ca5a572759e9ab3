// Elevations on a regular grid: terrain as rasters give it.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace snowshed {

/// Elevations at nodes; columns run east, rows north, both from the south-west node.
struct HeightField {
  int columns = 0, rows = 0;
  double cell = 1;              // m, between neighbouring nodes
  double west = 0, south = 0;   // m, coordinates of the south-west node
  std::vector<double> heights;  // m, row by row from the south; NaN if unknown

  std::size_t index(int column, int row) const {
    return std::size_t(row) * std::size_t(columns) + std::size_t(column);
  }
  double height(int column, int row) const { return heights[index(column, row)]; }
  double width() const { return (columns - 1) * cell; }  // m, from the first node to the last
  double length() const { return (rows - 1) * cell; }
};

/// Where a point lies in a grid: its cell and how far from the cell's south-west node, 0 to 1.
struct GridPlace {
  int column = -1, row = -1;  // -1: outside
  double east = 0, north = 0;

  bool inside() const { return column >= 0; }
};

/// The place of a point given from the south-west node, in cells. Points on the last row or column
/// are outside, as no cell begins there.
inline GridPlace place_in(double x, double y, int columns, int rows) {
  GridPlace place;
  if (!(x >= 0 && y >= 0 && x < columns - 1 && y < rows - 1)) return place;
  place.column = int(x);
  place.row = int(y);
  place.east = x - place.column;
  place.north = y - place.row;
  return place;
}

/// The field on a grid of another cell size with the same south-west node: bicubic where all
/// sixteen heights around are known, bilinear where only four are, NaN elsewhere. It covers the
/// field and no more. Throws InputError if the new grid would have more than 2^31 nodes.
HeightField resampled(const HeightField& field, double cell);

}  // namespace snowshed
