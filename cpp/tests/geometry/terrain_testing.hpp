// Terrain for the tests.
#pragma once

#include "snowshed/geometry/height_field.hpp"

namespace snowshed::geometry {

/// Returns the terrain whose nodes have the heights `height(x, y)`, all in metres.
template <class F>
HeightField terrain_of(int columns, int rows, double cell, F height) {
  HeightField f;
  f.columns = columns;
  f.rows = rows;
  f.cell = cell;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) f.heights.push_back(height(i * cell, j * cell));
  return f;
}

}  // namespace snowshed::geometry
