#include "snowshed/methods/slide/grid_fields.hpp"

#include <cmath>

namespace snowshed::methods::slide {
void GridFields::reserve(const Terrain& terrain, bool keeps_sums) {
  const std::size_t max_nodes =
      (std::size_t(terrain.columns()) + 2) * (std::size_t(terrain.rows()) + 2);
  nodes_.reserve(max_nodes);
  if (keeps_sums) sums_.reserve(max_nodes);
}

void GridFields::take_shape(const CellLists& cells) {
  first_column_ = cells.first_column();
  first_row_ = cells.first_row();
  columns_ = cells.columns();
  rows_ = cells.rows();
  nodes_.resize(std::size_t(columns_) * std::size_t(rows_));
}

/// Calls visit(node of the terrain, node) for the nodes that hold snow.
template <class Visit>
void GridFields::for_each_covered(const Terrain& terrain, Visit visit) const {
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const Node& n = nodes_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)];
      if (n.thickness > 0) visit(terrain.index(first_column_ + i, first_row_ + j), n);
    }
}

std::vector<double> GridFields::thickness_everywhere(const Terrain& terrain) const {
  std::vector<double> values(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for_each_covered(terrain, [&](std::size_t node, const Node& n) { values[node] = n.thickness; });
  return values;
}

std::vector<double> GridFields::speed_everywhere(const Terrain& terrain) const {
  std::vector<double> values(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for_each_covered(terrain, [&](std::size_t node, const Node& n) {
    values[node] = std::sqrt(n.vx * n.vx + n.vy * n.vy + n.vz * n.vz);
  });
  return values;
}

}  // namespace snowshed::methods::slide
