#include "snowshed/geometry/thickened.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/triangle_hierarchy.hpp"

namespace snowshed::geometry {
namespace {

constexpr double rounding = 1e-9;  // share of the half thickness

/// The middles of thin parts as triangles, two for each part.
TriangleMesh middles_of(const std::vector<ThinPart>& parts) {
  TriangleMesh mesh;
  for (const ThinPart& part : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.corners, part.corners + 4);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

class Thickened final : public LevelSet {
 public:
  Thickened(Shape shape, const std::vector<ThinPart>& parts, double half)
      : shape_(std::move(shape)), half_(half), mesh_(middles_of(parts)), middles_(mesh_) {
    for (const ThinPart& part : parts) normals_.push_back(part.normal);
  }

  double distance(const Vec3& x) const override {
    const double original_distance = shape_->distance(x);
    if (original_distance > max_exact_distance * half_)
      return original_distance - half_;  // a lower bound
    const auto middle = nearest_part(x, original_distance);
    return middle ? std::sqrt(middle->squared_distance) - half_ : original_distance;
  }

  Vec3 normal(const Vec3& x) const override {
    const auto middle = nearest_part(x, shape_->distance(x));
    if (!middle) return shape_->normal(x);
    const Vec3 outward = x - middle->point;
    const double length = outward.norm();
    if (length > 1e-6 * half_) return outward / length;
    const Vec3& across = normals_[middle->triangle / 2];
    return across.z() >= 0 ? across : Vec3(-across);
  }

  Bounds bounds() const override {
    return united_bounds(shape_->bounds(), expanded(middles_.bounds(), half_));
  }
  Bounds non_planar_bounds() const override { return expanded(shape_->non_planar_bounds(), half_); }
  double inradius() const override { return std::max(shape_->inradius(), half_); }
  double min_half_thickness() const override { return half_; }

  double half_thickness(const Vec3& x) const override {
    return nearest_part(x, shape_->distance(x)) ? half_ : shape_->half_thickness(x);
  }

 private:
  /// At more than this many half thicknesses from the solid, a lower bound of the distance is
  /// enough.
  static constexpr double max_exact_distance = 5.0;

  /// The nearest middle of a thin part, if its grown surface is nearer than the original one.
  std::optional<Nearest> nearest_part(const Vec3& x, double original_distance) const {
    const double limit = original_distance + half_;
    if (!(limit > 0)) return std::nullopt;
    const Nearest nearest = middles_.nearest(x, limit * limit);
    if (!(nearest.squared_distance < limit * limit)) return std::nullopt;
    return nearest;
  }

  Shape shape_;
  double half_;
  TriangleMesh mesh_;
  TriangleHierarchy middles_;
  std::vector<Vec3> normals_;
};

/// Dilates a solid to the half thickness `half`. `half_thickness` is the present value: the
/// inradius of a convex solid, or half the thickness of a plate.
ThickSolid dilated(Shape shape, double half_thickness, double half) {
  const double missing = half - half_thickness;
  const Thickening thickening{Vec3::Zero(), 2 * half_thickness, missing, true};
  return {dilate(std::move(shape), missing), thickening};
}

}  // namespace

ThickSolid thickened(Shape shape, double half, int dimension) {
  if (shape->min_half_thickness() >= half * (1 - rounding)) return {std::move(shape), {}};
  if (shape->is_convex()) {
    const double inradius = shape->inradius();
    return dilated(std::move(shape), inradius, half);
  }
  if (const auto plate = find_thin_plate(*shape, half, dimension))
    return dilated(std::move(shape), plate->half, half);
  const std::vector<ThinPart> parts = find_thin_parts(*shape, half, dimension);
  if (parts.empty()) return {std::move(shape), {}};
  const ThinPart& thinnest = *std::min_element(
      parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.half < b.half; });
  const Thickening thickening{thinnest.middle, 2 * thinnest.half, half - thinnest.half, false};
  return {std::make_shared<Thickened>(std::move(shape), parts, half), thickening};
}

}  // namespace snowshed::geometry
