// Elevations on a regular grid: terrain as rasters give it.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace snowshed::geometry {

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

/// Position of a point in a grid: its cell, and its distances from the cell's south-west node in
/// cells, 0 to 1.
struct CellPosition {
  int column = -1, row = -1;  // -1: outside
  double east = 0, north = 0;

  bool inside() const { return column >= 0; }
};

/// Finds the cell of a point, whose distances from the south-west node are given in cells. Points
/// on the last row or column are outside, because no cell begins there.
inline CellPosition find_cell(double x, double y, int columns, int rows) {
  CellPosition position;
  if (!(x >= 0 && y >= 0 && x < columns - 1 && y < rows - 1)) return position;
  position.column = int(x);
  position.row = int(y);
  position.east = x - position.column;
  position.north = y - position.row;
  return position;
}

/// Interpolates a field on a grid of another cell size with the same south-west node: bicubic where
/// all sixteen heights around a node are known, bilinear where only four are, NaN elsewhere. The
/// grid does not reach beyond the field. Throws InputError if it would have more than 2^31 nodes.
HeightField resampled(const HeightField& field, double cell);

}  // namespace snowshed::geometry
