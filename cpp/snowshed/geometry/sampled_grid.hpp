// A level set given by samples on a regular grid.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

/// Signed distances in metres at origin + spacing * (i, j, k), stored with k running fastest.
/// A count of 1 along y means that the solid is constant in y.
struct GridSamples {
  Vec3 origin = Vec3::Zero();
  double spacing = 0.0;
  std::array<std::size_t, 3> counts{};
  std::vector<float> values;

  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return (i * counts[1] + j) * counts[2] + k;
  }
  bool is_flat() const { return counts[1] == 1; }

  /// Calls visit(i, j, k) for all samples.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t i = 0; i < counts[0]; ++i)
      for (std::size_t j = 0; j < counts[1]; ++j)
        for (std::size_t k = 0; k < counts[2]; ++k) visit(i, j, k);
  }
};

/// Returns the solid in which the trilinear interpolant of the samples is negative. A solid that
/// reaches the border of the grid ends there. Outside the grid the distance is that of the nearest
/// point of the grid plus the distance to it.
///
/// Throws InputError at `where` as require_counts and require_distances do.
Shape make_sampled_grid(GridSamples samples, const std::string& where);

}  // namespace snowshed::geometry
