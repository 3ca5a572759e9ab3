#include "snowshed/methods/slide/terrain.hpp"

#include <algorithm>

namespace snowshed::methods::slide {
namespace {

struct Slope {
  double x, y;
};

/// The slope of the bilinear surface in the middle of a cell: half the sum of its diagonals' rises
/// (AvaFrame's normal by the cross product of the diagonals).
Slope cell_slope(const geometry::HeightField& f, int column, int row) {
  const double z00 = f.height(column, row), z10 = f.height(column + 1, row),
               z01 = f.height(column, row + 1), z11 = f.height(column + 1, row + 1);
  return {-(z10 - z01 + (z11 - z00)) / (2 * f.cell), -(z11 - z00 - (z10 - z01)) / (2 * f.cell)};
}

/// The mean slope of the four cells around a node. At the border the last cells count twice.
Slope node_slope(const geometry::HeightField& f, int column, int row) {
  const auto clamped = [](int i, int cells) { return std::clamp(i, 0, cells - 1); };
  Slope sum{0, 0};
  for (const int j : {row - 1, row})
    for (const int i : {column - 1, column}) {
      const Slope s = cell_slope(f, clamped(i, f.columns - 1), clamped(j, f.rows - 1));
      sum.x += s.x;
      sum.y += s.y;
    }
  return {0.25 * sum.x, 0.25 * sum.y};
}

}  // namespace

Terrain::Terrain(const geometry::HeightField& f, BorderSlope border)
    : columns_(f.columns),
      rows_(f.rows),
      cell_(f.cell),
      per_cell_(1 / f.cell),
      west_(f.west),
      south_(f.south),
      nodes_(f.heights.size()) {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      Slope s = node_slope(f, column, row);
      const bool level =
          border == BorderSlope::level_in_the_south_west && (row == 0 || column == 0);
      if (level || std::isnan(s.x) || std::isnan(s.y)) s = {0, 0};
      const double area = cell_ * cell_ * std::sqrt(1 + s.x * s.x + s.y * s.y);
      nodes_[index(column, row)] = {f.height(column, row), s.x, s.y, area};
    }
}

}  // namespace snowshed::methods::slide
