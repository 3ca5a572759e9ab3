#include "snowshed/methods/slide/terrain.hpp"

#include <algorithm>

namespace snowshed::methods::slide {
namespace {

struct Slope {
  double x, y;
};

/// The slope of the bilinear surface in the middle of a cell: half the sum of its diagonals' rises
/// (AvaFrame's normal by the cross product of the diagonals).
Slope cell_slope(const Terrain& t, int column, int row) {
  const double z00 = t.node(column, row).height, z10 = t.node(column + 1, row).height,
               z01 = t.node(column, row + 1).height, z11 = t.node(column + 1, row + 1).height;
  return {-(z10 - z01 + (z11 - z00)) / (2 * t.cell()), -(z11 - z00 - (z10 - z01)) / (2 * t.cell())};
}

/// The mean slope of the four cells around a node. At the border the last cells count twice.
Slope node_slope(const Terrain& t, int column, int row) {
  const auto clamped = [](int i, int cells) { return std::clamp(i, 0, cells - 1); };
  Slope sum{0, 0};
  for (const int j : {row - 1, row})
    for (const int i : {column - 1, column}) {
      const Slope s = cell_slope(t, clamped(i, t.columns() - 1), clamped(j, t.rows() - 1));
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
      border_(border),
      nodes_(f.heights.size()) {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      nodes_[index(column, row)].height = f.height(column, row);
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) find_slope(column, row);
}

/// Finds slope and area at a node from the heights around it.
void Terrain::find_slope(int column, int row) {
  Slope s = node_slope(*this, column, row);
  const bool level = border_ == BorderSlope::level_in_the_south_west && (row == 0 || column == 0);
  if (level || std::isnan(s.x) || std::isnan(s.y)) s = {0, 0};
  Node& node = nodes_[index(column, row)];
  node.slope_x = s.x;
  node.slope_y = s.y;
  node.area = cell_ * cell_ * std::sqrt(1 + s.x * s.x + s.y * s.y);
}

void Terrain::set_rise(const Terrain& first, const std::vector<double>& rise,
                       const NodeRectangle& where) {
  if (where.empty()) return;
  where.for_each([&](int column, int row) {
    const std::size_t at = index(column, row);
    nodes_[at].height = first.nodes_[at].height + rise[at];
  });
  const NodeRectangle around{std::max(0, where.first_column - 1), std::max(0, where.first_row - 1),
                             std::min(columns_ - 1, where.last_column + 1),
                             std::min(rows_ - 1, where.last_row + 1)};
  around.for_each([this](int column, int row) { find_slope(column, row); });
}

}  // namespace snowshed::methods::slide
