#include "snowshed/geometry/thin_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_set>

#include "snowshed/geometry/bounds.hpp"

namespace snowshed::geometry {
namespace {

constexpr std::size_t max_cells = 400'000;
/// Thin cells are divided once more unless that makes more pieces than this.
constexpr std::size_t max_fine_pieces = 100'000;
/// Minimum cosine between a normal and the reversed normal at the other end of its chord.
constexpr double min_parallel_cosine = 0.77;

/// The lengths below are relative to the requested half thickness.
constexpr double surface_tolerance = 1e-6, min_step = 2e-3, min_thickness = 0.999;
/// The middle of a bent part may leave it along its tangent by this distance.
constexpr double bend_tolerance = 0.1;

class ThinPartSearch {
 public:
  ThinPartSearch(const LevelSet& shape, double half, int dimension)
      : shape_(shape), half_(half), dimension_(dimension) {}

  std::vector<ThinPart> run() {
    const Bounds within = expanded(shape_.non_planar_bounds(), 2 * half_);
    if (!is_finite(within, dimension_)) return {};
    std::vector<Vec3> cells = cover(within);
    while (edge_ > 1.001 * half_ && children() / 2 * cells.size() <= max_cells)
      cells = divided(cells);
    std::vector<ThinPart> parts = parts_of(cells);
    if (parts.empty() || parts.size() * children() > max_fine_pieces) return parts;
    return parts_of(divided(around_thin(cells)));
  }

  /// The same for a solid that only planes bound; the search is near the origin.
  std::optional<ThinPart> run_at_origin() {
    edge_ = half_;
    const std::optional<Vec3> touch = nearest_on_surface(Vec3::Zero(), infinity);
    return touch ? part_near(*touch) : std::nullopt;
  }

 private:
  std::size_t children() const { return dimension_ == 2 ? 4 : 8; }

  /// Half of the diagonal of a cell.
  double reach() const { return 0.5 * edge_ * std::sqrt(double(dimension_)); }

  /// Covers bounds with a single cell, a cube whose edge is `half_` times a power of two.
  std::vector<Vec3> cover(const Bounds& within) {
    const Vec3 size = (within.max - within.min).cwiseProduct(in_space());
    edge_ = half_;
    while (edge_ < size.maxCoeff()) edge_ *= 2;
    Vec3 middle = 0.5 * (within.min + within.max);
    if (dimension_ == 2) middle.y() = 0;
    corner_ = middle - 0.5 * edge_ * in_space();
    return {middle};
  }

  /// Returns a number that differs between the cell that holds x and the cells around it.
  std::uint64_t key(const Vec3& x) const {
    std::uint64_t sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      sum = sum << 21 |
            (std::uint64_t(std::int64_t(std::floor((x - corner_)[axis] / edge_)) + 1) & 0x1fffff);
    return sum;
  }

  /// Returns the thin cells and their neighbours. A cell that is equally near to a thin and a thick
  /// part may not count as thin, but must be searched.
  std::vector<Vec3> around_thin(const std::vector<Vec3>& cells) const {
    std::unordered_set<std::uint64_t> thin;
    for (const Vec3& cell : thin_cells_)
      for (int k = 0; k < 27; ++k)
        thin.insert(
            key(cell + edge_ * in_space().cwiseProduct(Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1))));
    std::vector<Vec3> near_thin;
    for (const Vec3& cell : cells)
      if (thin.count(key(cell))) near_thin.push_back(cell);
    return near_thin;
  }

  Vec3 in_space() const { return {1.0, dimension_ == 2 ? 0.0 : 1.0, 1.0}; }

  /// The parts of cells, half as large, that the surface may pass through.
  std::vector<Vec3> divided(const std::vector<Vec3>& cells) {
    edge_ *= 0.5;
    std::vector<Vec3> middles;
    for (const Vec3& cell : cells)
      for (std::size_t k = 0; k < children(); ++k) {
        const double sign[3] = {k & 1 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5};
        const Vec3 middle = cell + edge_ * in_space().cwiseProduct(Vec3(sign[0], sign[1], sign[2]));
        if (std::abs(shape_.distance(middle)) <= reach() + surface_tolerance * half_)
          middles.push_back(middle);
      }
    return middles;
  }

  std::vector<ThinPart> parts_of(const std::vector<Vec3>& cells) {
    std::vector<ThinPart> parts;
    std::vector<Vec3> thin;
    for (const Vec3& cell : cells) {
      const std::optional<ThinPart> part = part_near(cell);
      if (!part) continue;
      parts.push_back(*part);
      thin.push_back(cell);
    }
    thin_cells_ = std::move(thin);
    return parts;
  }

  double depth(const Vec3& x) const { return -shape_.distance(x); }
  bool is_inside(const Vec3& x) const { return depth(x) >= -surface_tolerance * half_; }

  Vec3 normal(const Vec3& x) const {
    Vec3 n = shape_.normal(x);
    if (dimension_ == 3) return n;
    n.y() = 0;
    const double length = n.norm();
    return length > 1e-9 ? Vec3(n / length) : Vec3::UnitZ();
  }

  /// The thin part whose surface is nearest to the middle of a cell.
  std::optional<ThinPart> part_near(const Vec3& cell) const {
    const std::optional<Vec3> touch = nearest_on_surface(cell, 4 * reach());
    if (!touch) return std::nullopt;
    const Vec3 n = normal(*touch);
    if (depth(*touch - half_ * n) >= 0.98 * half_) return std::nullopt;  // a ball fits in
    // The surface of one operand of a union may lie within another: the chord then continues
    // outward.
    const double out = is_inside(*touch + min_step * half_ * n) ? distance_out(*touch, n) : 0.0;
    const double in = distance_out(*touch, -n);
    if (in + out >= min_thickness * 2 * half_) return std::nullopt;
    const Vec3 middle = *touch + 0.5 * (out - in) * n;
    const Vec3 begin = normal(*touch + out * n), end = normal(*touch - in * n);
    if (begin.dot(end) <= -min_parallel_cosine) return piece(middle, n, 0.5 * (in + out));
    return deepest_near(middle, n, begin + end);
  }

  std::optional<Vec3> nearest_on_surface(Vec3 x, double farthest) const {
    constexpr int max_steps = 12;
    const Vec3 start = x;
    double distance = shape_.distance(x);
    for (int step = 0; step < max_steps && std::abs(distance) > surface_tolerance * half_; ++step) {
      x -= distance * normal(x);
      distance = shape_.distance(x);
    }
    if (std::abs(distance) > 0.05 * half_ || (x - start).norm() > farthest) return std::nullopt;
    return x;
  }

  /// The distance from x to the outside of the solid, at most twice the half thickness.
  double distance_out(const Vec3& x, const Vec3& direction) const {
    const double longest = 2 * half_, shortest = min_step * half_;
    double distance = 0;
    for (double d = 0; distance < longest; d = depth(x + distance * direction)) {
      if (d < -surface_tolerance * half_)
        return std::max(0.0, distance + d);  // back to the surface
      distance += std::max(d, shortest);
    }
    return longest;
  }

  /// The distance along the middle of a part to its edge, less half of the thickness.
  double distance_to_edge(const Vec3& middle, const Vec3& direction, double half,
                          double longest) const {
    const double allowed = bend_tolerance * half_, end = longest + half + allowed;
    double distance = 0;
    while (distance < end) {
      const double d = depth(middle + distance * direction) + allowed;
      if (d < 0) return std::clamp(distance - allowed - half, 0.0, longest);
      distance += std::max(d, min_step * half_);
    }
    return longest;
  }

  ThinPart piece(const Vec3& middle, const Vec3& n, double half) const {
    ThinPart part{middle, n, half, {}};
    const auto [along, across] = tangents(n);
    const double cover = reach(), least = 1e-4 * half_;
    const auto ends = [&](const Vec3& direction) {
      return std::max(least, distance_to_edge(middle, direction, half, cover));
    };
    const double a0 = ends(-along), a1 = ends(along);
    const double b0 = dimension_ == 2 ? cover : ends(-across),
                 b1 = dimension_ == 2 ? cover : ends(across);
    part.corners[0] = middle - a0 * along - b0 * across;
    part.corners[1] = middle + a1 * along - b0 * across;
    part.corners[2] = middle + a1 * along + b1 * across;
    part.corners[3] = middle - a0 * along + b1 * across;
    if (dimension_ == 3)
      for (Vec3& corner : part.corners) {  // an oblique edge cuts the corner off
        const double distance = (corner - middle).norm();
        const Vec3 direction = (corner - middle) / distance;
        corner = middle +
                 std::max(least, distance_to_edge(middle, direction, half, distance)) * direction;
      }
    return part;
  }

  std::pair<Vec3, Vec3> tangents(const Vec3& n) const {
    if (dimension_ == 2) return {Vec3::UnitY().cross(n), Vec3::UnitY()};
    int min_axis;
    n.cwiseAbs().minCoeff(&min_axis);
    const Vec3 along = (Vec3::Unit(min_axis) - n[min_axis] * n).normalized();
    return {along, n.cross(along)};
  }

  /// The thin part around the deepest point near x; none if this point is deep enough. `outward`
  /// points to the edge at which the faces meet.
  std::optional<ThinPart> deepest_near(const Vec3& x, const Vec3& n, const Vec3& outward) const {
    constexpr int max_steps = 60;
    const auto [along, across] = tangents(n);
    Vec3 best = x;
    double deepest = depth(x), step = 0.5 * half_;
    for (int k = 0; k < max_steps && step > 0.02 * half_; ++k) {
      const Vec3 from = best;
      for (const Vec3& direction : {Vec3(outward.stableNormalized()), n, along, across})
        for (const double sign : {1.0, -1.0}) {
          if (direction.isZero() || (dimension_ == 2 && direction.y() != 0)) continue;
          const Vec3 next = from + sign * step * direction;
          const double d = depth(next);
          if (d <= deepest || (next - x).norm() > 3.5 * half_) continue;
          best = next;
          deepest = d;
        }
      if (deepest >= 0.95 * half_) return std::nullopt;
      if (best == from) step *= 0.5;
    }
    return piece(best, n, std::max(deepest, 0.0));
  }

  const LevelSet& shape_;
  const double half_;
  const int dimension_;
  double edge_ = 0;  // edge of the present cells, m
  Vec3 corner_ = Vec3::Zero();
  std::vector<Vec3> thin_cells_;
};

}  // namespace

std::vector<ThinPart> find_thin_parts(const LevelSet& shape, double half, int dimension) {
  return ThinPartSearch(shape, half, dimension).run();
}

std::optional<ThinPart> find_thin_plate(const LevelSet& shape, double half, int dimension) {
  if (!is_empty(shape.non_planar_bounds())) return std::nullopt;
  return ThinPartSearch(shape, half, dimension).run_at_origin();
}

}  // namespace snowshed::geometry
