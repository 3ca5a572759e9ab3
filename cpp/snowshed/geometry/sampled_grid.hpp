// A level set given by samples on a regular grid.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

/// Signed distances in metres at origin + spacing * (i, j, k), stored with k running fastest.
/// A count of 1 along y stands for a solid that is constant in y.
struct GridSamples {
  Vec3 origin = Vec3::Zero();
  double spacing = 0.0;
  std::array<std::size_t, 3> counts{};
  std::vector<float> values;
};

/// The solid where the trilinear interpolant of the samples is negative. Beyond the grid the
/// value is that at the clamped point plus the distance to it.
///
/// Throws InputError at `where` if the counts do not fit the values, a value is not finite,
/// none is negative, or neighbours differ by clearly more than the spacing, which no signed
/// distance does.
Shape make_sampled_grid(GridSamples samples, const std::string& where);

}  // namespace snowshed
