#include "snowshed/geometry/height_field.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "snowshed/core/errors.hpp"

namespace snowshed::geometry {
namespace {

/// Weights of four equidistant values for a point between the second and the third: the cubic
/// convolution of Keys (1981, IEEE Trans. ASSP 29, eq. 15, a = -1/2), exact for quadratics.
std::array<double, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t,
          0.5 * t3 - 0.5 * t2};
}

/// The height at a node. Outside the grid it is extrapolated linearly from two nodes at the border.
double height_beyond(const HeightField& f, int column, int row) {
  if (column < 0) return 2 * height_beyond(f, 0, row) - height_beyond(f, 1, row);
  if (column >= f.columns)
    return 2 * height_beyond(f, f.columns - 1, row) - height_beyond(f, f.columns - 2, row);
  if (row < 0) return 2 * f.height(column, 0) - f.height(column, 1);
  if (row >= f.rows) return 2 * f.height(column, f.rows - 1) - f.height(column, f.rows - 2);
  return f.height(column, row);
}

double bicubic(const HeightField& f, const CellPosition& p) {
  const auto along = cubic_weights(p.east), up = cubic_weights(p.north);
  double sum = 0;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      sum += up[j] * along[i] * height_beyond(f, p.column - 1 + i, p.row - 1 + j);
  return sum;
}

double bilinear(const HeightField& f, const CellPosition& p) {
  const auto row = [&](int j) {
    return (1 - p.east) * f.height(p.column, j) + p.east * f.height(p.column + 1, j);
  };
  return (1 - p.north) * row(p.row) + p.north * row(p.row + 1);
}

/// Finds the cell of a point within the field; the last row and column belong to the cells before.
CellPosition find_cell_with_border(const HeightField& f, double x, double y) {
  CellPosition p;
  p.column = std::min(int(x), f.columns - 2);
  p.row = std::min(int(y), f.rows - 2);
  p.east = x - p.column;
  p.north = y - p.row;
  return p;
}

int nodes_along(double length, double cell) { return int(std::floor(length / cell + 1e-9)) + 1; }

}  // namespace

HeightField resampled(const HeightField& field, double cell) {
  if (cell == field.cell) return field;
  const double max_nodes = double(std::numeric_limits<int>::max());
  if ((field.width() / cell + 1) * (field.length() / cell + 1) > max_nodes)
    throw InputError("cell", "a grid of " + std::to_string(cell) + " m has too many nodes");
  HeightField fine = field;
  fine.cell = cell;
  fine.columns = nodes_along(field.width(), cell);
  fine.rows = nodes_along(field.length(), cell);
  fine.heights.resize(std::size_t(fine.columns) * std::size_t(fine.rows));
  for (int row = 0; row < fine.rows; ++row)
    for (int column = 0; column < fine.columns; ++column) {
      const CellPosition p =
          find_cell_with_border(field, column * cell / field.cell, row * cell / field.cell);
      const double z = bicubic(field, p);
      fine.heights[fine.index(column, row)] = std::isnan(z) ? bilinear(field, p) : z;
    }
  return fine;
}

}  // namespace snowshed::geometry
