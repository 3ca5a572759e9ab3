// A level set given by samples on a regular grid.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

/// Signed distances in metres at origin + spacing * (i, j, k), stored with k running fastest.
/// A count of 1 along y means that the solid is constant in y.
struct GridSamples {
  Vec3 origin = Vec3::Zero();
  double spacing = 0.0;
  std::array<std::size_t, 3> counts{};
  std::vector<float> values;
};

/// Returns the solid in which the trilinear interpolant of the samples is negative. A solid that
/// reaches the border of the grid ends there. Outside the grid the distance is that of the nearest
/// point of the grid plus the distance to it.
///
/// Throws InputError at `where` if the counts do not fit the values, if a value is not finite, if
/// no value is negative, or if neighbours differ by clearly more than the spacing, since a signed
/// distance cannot.
Shape make_sampled_grid(GridSamples samples, const std::string& where);

}  // namespace snowshed
