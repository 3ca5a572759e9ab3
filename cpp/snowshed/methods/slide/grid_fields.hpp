// The snow at the nodes of the terrain: thickness, velocity, and their peaks so far.
#pragma once

#include <cmath>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/methods/slide/cells.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::methods::slide {

/// Peaks over time at all nodes of the terrain, row by row from the south.
struct PeakFields {
  std::vector<double> thickness;  // m, normal to the ground
  std::vector<double> speed;      // m/s

  explicit PeakFields(std::size_t nodes = 0) : thickness(nodes, 0.0), speed(nodes, 0.0) {}
};

/// Thickness and velocity at the nodes within the cells' rectangle. The masses and momenta of the
/// particles are distributed to the nodes bilinearly.
class GridFields {
 public:
  struct NodeSums {
    double mass;        // kg
    double px, py, pz;  // kg m/s, momentum
  };
  struct Node {
    double thickness;   // m
    double vx, vy, vz;  // m/s
  };

  /// Reserves memory for snow anywhere on the terrain, and for sums if they are kept.
  void reserve(const Terrain& terrain, bool keeps_sums);

  /// Takes over the cells' rectangle; `sum_on_nodes` (kernel_api.hpp) must then compute the values
  /// at its nodes.
  void take_shape(const CellLists& cells);

  /// The nodes of the rectangle, row by row, and its first column and row on the terrain.
  const Node* nodes() const { return nodes_.data(); }
  Node* nodes() { return nodes_.data(); }
  /// Memory for the sums over the particles at the nodes of the rectangle.
  NodeSums* sums() {
    sums_.resize(nodes_.size());
    return sums_.data();
  }
  int first_column() const { return first_column_; }
  int first_row() const { return first_row_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /// The thickness at a node of the terrain, m; 0 outside of the rectangle.
  double thickness_at(int column, int row) const {
    const int i = column - first_column_, j = row - first_row_;
    const bool inside = i >= 0 && i < columns_ && j >= 0 && j < rows_;
    return inside ? nodes_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)].thickness : 0.0;
  }

  /// The speed there, m/s.
  double speed_at(int column, int row) const {
    const int i = column - first_column_, j = row - first_row_;
    if (i < 0 || i >= columns_ || j < 0 || j >= rows_) return 0;
    const Node& n = nodes_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)];
    return std::sqrt(n.vx * n.vx + n.vy * n.vy + n.vz * n.vz);
  }

  /// One value for each node of the terrain.
  std::vector<double> thickness_everywhere(const Terrain& terrain) const;
  std::vector<double> speed_everywhere(const Terrain& terrain) const;

  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + sums_.capacity() * sizeof(NodeSums);
  }

 private:
  template <class Visit>
  void for_each_covered(const Terrain& terrain, Visit visit) const;

  int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;
  AlignedVector<Node> nodes_;
  AlignedVector<NodeSums> sums_;
};

}  // namespace snowshed::methods::slide
