// Distances from the nodes of a regular grid to points and to surfaces, by sweeping.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

/// A grid that stores the nearest seed point at each node. Sweeps in all directions pass the seeds
/// on from node to node (Danielsson 1980, "Euclidean distance mapping").
class NearestSeed {
 public:
  struct Index {
    std::int64_t i, j, k;
  };

  NearestSeed(const Vec3& origin, double spacing, const std::array<std::size_t, 3>& counts);

  /// Returns the position of a node in arrays of values, with k running fastest.
  std::size_t at(const Index& n) const {
    return static_cast<std::size_t>((n.i * counts_[1] + n.j) * counts_[2] + n.k);
  }
  /// Returns the lowest corner of the cell that contains x.
  Index cell_of(const Vec3& x) const {
    const Vec3 u = (x - origin_) / spacing_;
    return {std::int64_t(std::floor(u.x())), std::int64_t(std::floor(u.y())),
            std::int64_t(std::floor(u.z()))};
  }
  Vec3 position(const Index& n) const { return origin_ + spacing_ * Vec3(n.i, n.j, n.k); }
  bool contains(const Index& n) const {
    return n.i >= 0 && n.j >= 0 && n.k >= 0 && n.i < counts_[0] && n.j < counts_[1] &&
           n.k < counts_[2];
  }

  template <class Visit>
  void for_each_node(Visit visit) const {
    for (std::int64_t i = 0; i < counts_[0]; ++i)
      for (std::int64_t j = 0; j < counts_[1]; ++j)
        for (std::int64_t k = 0; k < counts_[2]; ++k) visit(Index{i, j, k});
  }

  template <class Visit>
  void for_each_node_backwards(Visit visit) const {
    for (std::int64_t i = counts_[0] - 1; i >= 0; --i)
      for (std::int64_t j = counts_[1] - 1; j >= 0; --j)
        for (std::int64_t k = counts_[2] - 1; k >= 0; --k) visit(Index{i, j, k});
  }

  /// Calls visit(node, next) for all pairs of neighbours along the axes.
  template <class Visit>
  void for_each_edge(Visit visit) const {
    for_each_node([&](const Index& n) {
      for (const Index& next : {Index{n.i + 1, n.j, n.k}, {n.i, n.j + 1, n.k}, {n.i, n.j, n.k + 1}})
        if (contains(next)) visit(n, next);
    });
  }

  /// Finds the nearest of `seeds` at every node; earlier seeds are forgotten. There must be at
  /// least one seed. `seeds` must outlive the calls of `distance`.
  void propagate(const std::vector<Vec3>& seeds);

  /// Returns the distance from a node to its nearest seed, metres.
  double distance(const Index& n) const {
    return ((*seeds_)[nearest_[at(n)]] - position(n)).norm();
  }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;

  void offer(const Index& n, std::uint32_t seed);
  void offer_to_cell(std::uint32_t seed);
  void sweep(int di, int dj, int dk);

  Vec3 origin_;
  double spacing_;
  std::array<std::int64_t, 3> counts_;
  std::vector<std::uint32_t> nearest_;
  const std::vector<Vec3>* seeds_ = nullptr;
};

/// Returns the points on the grid's edges where `values` changes sign, by linear interpolation.
std::vector<Vec3> zero_crossings(const NearestSeed& grid, const std::vector<float>& values);

}  // namespace snowshed::geometry
