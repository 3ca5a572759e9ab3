#include "snowshed/geometry/sampled_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/sample_checks.hpp"

namespace snowshed::geometry {
namespace {

class SampledGrid final : public LevelSet {
 public:
  explicit SampledGrid(GridSamples samples)
      : samples_(std::move(samples)), flat_(samples_.counts[1] == 1) {
    for (int axis = 0; axis < 3; ++axis)
      size_[axis] = samples_.spacing * static_cast<double>(samples_.counts[axis] - 1);
    touches_border_ = any_inside([this](const Vec3& at) { return border_distance(at) >= 0; });
    find_depth();
    find_bounds();
  }

  double distance(const Vec3& x) const override {
    Vec3 p = x - samples_.origin;
    if (flat_) p.y() = 0;
    const Vec3 clamped = p.cwiseMax(0.0).cwiseMin(size_);
    const double d = interpolate(clamped / samples_.spacing) + (p - clamped).norm();
    return touches_border_ ? std::max(d, border_distance(p)) : d;
  }

  Vec3 normal(const Vec3& x) const override {
    // The trilinear gradient jumps from cell to cell; a difference over a cell does not.
    const double h = samples_.spacing / 2;
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis)
      gradient[axis] = distance(x + h * Vec3::Unit(axis)) - distance(x - h * Vec3::Unit(axis));
    const double norm = gradient.norm();
    return norm > 0.1 * samples_.spacing ? Vec3(gradient / norm) : LevelSet::normal(x);
  }

  Bounds bounds() const override { return bounds_; }
  double inradius() const override { return deepest_; }

 private:
  /// Returns the trilinear interpolant at `u`, a position within the grid in units of the spacing.
  double interpolate(const Vec3& u) const {
    std::size_t low[3], high[3];
    double fraction[3];
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t last = samples_.counts[axis] - 1;
      low[axis] = std::min(static_cast<std::size_t>(u[axis]), last);
      high[axis] = std::min(low[axis] + 1, last);
      fraction[axis] = u[axis] - static_cast<double>(low[axis]);
    }
    const auto along_z = [&](std::size_t i, std::size_t j) {
      const double a = samples_.values[samples_.index(i, j, low[2])];
      return a + fraction[2] * (samples_.values[samples_.index(i, j, high[2])] - a);
    };
    const auto along_yz = [&](std::size_t i) {
      const double a = along_z(i, low[1]);
      return flat_ ? a : a + fraction[1] * (along_z(i, high[1]) - a);
    };
    const double a = along_yz(low[0]);
    return a + fraction[0] * (along_yz(high[0]) - a);
  }

  /// Returns the signed distance to the border of the grid at `p`, a position relative to its
  /// origin; a lower bound outside.
  double border_distance(const Vec3& p) const {
    double nearest = -infinity;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != 1 || !flat_) nearest = std::max({nearest, -p[axis], p[axis] - size_[axis]});
    return nearest;
  }

  /// Calls visit(position relative to the origin, value) for the samples inside the solid.
  template <class Visit>
  void for_each_inside(Visit visit) const {
    samples_.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
      const double value = samples_.values[samples_.index(i, j, k)];
      if (value < 0) visit(Vec3(samples_.spacing * Vec3(i, j, k)), value);
    });
  }

  template <class Predicate>
  bool any_inside(Predicate holds) const {
    bool any = false;
    for_each_inside([&](const Vec3& at, double) { any = any || holds(at); });
    return any;
  }

  void find_depth() {
    for_each_inside([&](const Vec3& at, double value) {
      deepest_ =
          std::max(deepest_, -(touches_border_ ? std::max(value, border_distance(at)) : value));
    });
  }

  /// Computes the bounds. A cell contains a part of the solid only if one of its corners is
  /// negative.
  void find_bounds() {
    bounds_ = empty_bounds();
    for_each_inside([&](const Vec3& at, double) {
      bounds_ = united_bounds(bounds_, {samples_.origin + at, samples_.origin + at});
    });
    bounds_ = expanded(bounds_, samples_.spacing);
    bounds_.min = bounds_.min.cwiseMax(samples_.origin);
    bounds_.max = bounds_.max.cwiseMin(samples_.origin + size_);
    if (!flat_) return;
    bounds_.min.y() = -infinity;
    bounds_.max.y() = infinity;
  }

  GridSamples samples_;
  bool flat_;
  Vec3 size_;
  bool touches_border_;
  double deepest_ = 0;
  Bounds bounds_;
};

}  // namespace

Shape make_sampled_grid(GridSamples samples, const std::string& where) {
  require_counts(samples, where);
  require_distances(samples, where);
  return std::make_shared<SampledGrid>(std::move(samples));
}

}  // namespace snowshed::geometry
