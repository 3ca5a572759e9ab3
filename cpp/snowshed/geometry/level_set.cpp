#include "snowshed/geometry/level_set.hpp"

#include <algorithm>

namespace snowshed::geometry {
namespace {

template <class Difference>
Vec3 gradient(Difference difference, double step) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) result[axis] = difference(step * Vec3::Unit(axis)) / step;
  return result;
}

}  // namespace

Vec3 LevelSet::normal(const Vec3& x) const {
  // The gradient of a distance has norm 1 except on the medial axis. There the central difference
  // is smaller or vanishes by symmetry, and a one-sided difference picks one of the nearest points.
  constexpr double min_gradient_norm = 0.1;
  const double step = 1e-6 * std::max(1.0, x.cwiseAbs().maxCoeff());
  const auto central = [&](const Vec3& h) { return (distance(x + h) - distance(x - h)) / 2; };
  const auto forward = [&](const Vec3& h) { return distance(x + h) - distance(x); };
  Vec3 result = gradient(central, step);
  if (!(result.norm() > min_gradient_norm)) result = gradient(forward, step);
  if (!(result.norm() > min_gradient_norm)) return Vec3::UnitZ();
  return result.normalized();
}

}  // namespace snowshed::geometry
