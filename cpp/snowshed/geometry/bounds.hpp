// Axis-aligned bounds, with infinite sides allowed.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the bounds of all space.
inline Bounds unbounded() { return {Vec3::Constant(-infinity), Vec3::Constant(infinity)}; }

/// Returns the bounds of the empty set, the neutral element of `united_bounds`.
inline Bounds empty_bounds() { return {Vec3::Constant(infinity), Vec3::Constant(-infinity)}; }

/// Returns the smallest bounds that contain both.
inline Bounds united_bounds(const Bounds& a, const Bounds& b) {
  return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
}

/// Returns `bounds` with each side moved outward by `margin`, metres.
inline Bounds expanded(const Bounds& bounds, double margin) {
  return {bounds.min.array() - margin, bounds.max.array() + margin};
}

inline bool is_empty(const Bounds& bounds) {
  return (bounds.min.array() > bounds.max.array()).any();
}

/// Returns bounds of the points rotation * x + translation for x within `bounds`.
inline Bounds transformed(const Bounds& bounds, const Mat3& rotation, const Vec3& translation) {
  if (is_empty(bounds)) return bounds;
  Bounds result{translation, translation};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const double r = rotation(row, column);
      // Rounding in a rotation (cos 90 deg = 6e-17) must not make a finite side infinite.
      if (std::abs(r) < 1e-15) continue;
      const double a = r * bounds.min[column], b = r * bounds.max[column];
      result.min[row] += std::min(a, b);
      result.max[row] += std::max(a, b);
    }
  return result;
}

/// Returns whether the bounds are finite along every axis of the scene (x and z in 2D).
inline bool is_finite(const Bounds& bounds, int dimension) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 1 && dimension == 2) continue;
    if (!std::isfinite(bounds.min[axis]) || !std::isfinite(bounds.max[axis])) return false;
  }
  return true;
}

}  // namespace snowshed::geometry
