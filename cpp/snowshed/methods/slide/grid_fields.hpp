// The snow at the nodes of the terrain: thickness, velocity, and their peaks so far.
#pragma once

#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/methods/slide/cells.hpp"
#include "snowshed/methods/slide/particles.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed {

/// Peaks over time at all nodes of the terrain, row by row from the south.
struct PeakFields {
  std::vector<double> thickness;  // m, normal to the ground
  std::vector<double> speed;      // m/s

  explicit PeakFields(std::size_t nodes = 0) : thickness(nodes, 0.0), speed(nodes, 0.0) {}
};

/// Thickness and velocity at the nodes within the cells' rectangle, from masses and momenta that
/// the particles hand on bilinearly.
class GridFields {
 public:
  struct Node {
    double thickness;   // m; mass (kg) while they are handed on
    double vx, vy, vz;  // m/s; momentum (kg m/s) while they are handed on
  };

  /// Makes room for snow anywhere on the terrain.
  void reserve(const Terrain& terrain);

  void update(const Terrain& terrain, const SlideParticles& particles,
              const std::vector<GridPlace>& places, const CellLists& cells, double density,
              int threads);

  /// Raises the peaks to the fields where these are larger.
  void raise(PeakFields& peaks, const Terrain& terrain) const;

  /// Bilinear between the nodes.
  Vec3 velocity(const GridPlace& place) const;
  double thickness(const GridPlace& place) const;

  /// One value of each node of the terrain.
  std::vector<double> thickness_everywhere(const Terrain& terrain) const;
  std::vector<double> speed_everywhere(const Terrain& terrain) const;

  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

 private:
  std::size_t local(int column, int row) const {
    return std::size_t(row - first_row_) * std::size_t(columns_) +
           std::size_t(column - first_column_);
  }
  template <class Visit>
  void for_each_covered(const Terrain& terrain, Visit visit) const;

  int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;
  AlignedVector<Node> nodes_;
};

inline Vec3 GridFields::velocity(const GridPlace& p) const {
  const Node* a = &nodes_[local(p.column, p.row)];
  const Node* b = a + columns_;
  const double w0 = (1 - p.east) * (1 - p.north), w1 = p.east * (1 - p.north),
               w2 = (1 - p.east) * p.north, w3 = p.east * p.north;
  return {w0 * a[0].vx + w1 * a[1].vx + w2 * b[0].vx + w3 * b[1].vx,
          w0 * a[0].vy + w1 * a[1].vy + w2 * b[0].vy + w3 * b[1].vy,
          w0 * a[0].vz + w1 * a[1].vz + w2 * b[0].vz + w3 * b[1].vz};
}

inline double GridFields::thickness(const GridPlace& p) const {
  const Node* a = &nodes_[local(p.column, p.row)];
  const Node* b = a + columns_;
  const double w0 = (1 - p.east) * (1 - p.north), w1 = p.east * (1 - p.north),
               w2 = (1 - p.east) * p.north, w3 = p.east * p.north;
  return w0 * a[0].thickness + w1 * a[1].thickness + w2 * b[0].thickness + w3 * b[1].thickness;
}

}  // namespace snowshed
