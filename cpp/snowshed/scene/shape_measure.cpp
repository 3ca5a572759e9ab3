#include "snowshed/scene/shape_measure.hpp"

#include <cmath>
#include <limits>

#include "snowshed/core/angles.hpp"

namespace snowshed::scene {
namespace {

using Box = Eigen::AlignedBox3d;

Box around(const Vec3& center, const Vec3& half) { return {center - half, center + half}; }

Box unbounded() {
  const Vec3 everywhere = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {-everywhere, everywhere};
}

/// The box around `box` after a rotation and a translation.
Box transformed(const Box& box, const Mat3& rotation, const Vec3& translation) {
  if (!box.sizes().allFinite()) return unbounded();
  return around(rotation * box.center() + translation, rotation.cwiseAbs() * box.sizes() / 2.0);
}

Box cylinder_bounds(const ShapeSpec& shape) {
  const Vec3 axis = (shape.to - shape.from).normalized();
  const Vec3 rim = shape.radius * (1.0 - axis.array().square()).max(0.0).sqrt().matrix();
  return around(shape.from, rim).merged(around(shape.to, rim));
}

Box plate_bounds(const ShapeSpec& shape) {
  Mat3 axes;
  axes.col(2) = shape.normal.normalized();
  axes.col(0) = Vec3::UnitY().cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Vec3 size(shape.length, shape.width, shape.thickness);
  return transformed(around(Vec3::Zero(), size / 2.0), axes,
                     shape.center - shape.thickness / 2.0 * axes.col(2));
}

std::optional<Box> transform_bounds(const ShapeSpec& shape) {
  const auto inner = shape_bounds(shape.shapes.front());
  if (!inner) return std::nullopt;
  const Eigen::AngleAxisd rotation(radians(shape.angle), shape.axis.normalized());
  return transformed(*inner, rotation.toRotationMatrix(), shape.translate);
}

std::optional<Box> union_bounds(const ShapeSpec& shape) {
  Box all;  // empty
  for (const auto& part : shape.shapes) {
    const auto bounds = shape_bounds(part);
    if (!bounds) return bounds;
    all.extend(*bounds);
  }
  return all;
}

std::optional<double> union_volume(const ShapeSpec& shape, int dimension) {
  double sum = 0.0;
  for (const auto& part : shape.shapes) {
    const auto volume = shape_volume(part, dimension);
    if (!volume) return volume;
    sum += *volume;
  }
  return sum;
}

double ball_volume(double radius, int dimension) {
  return dimension == 2 ? pi * radius * radius : 4.0 / 3.0 * pi * std::pow(radius, 3);
}

double cylinder_volume(const ShapeSpec& shape, int dimension) {
  const double length = (shape.to - shape.from).norm();
  const double r = shape.radius;
  return length * (dimension == 2 ? 2.0 * r : pi * r * r);
}

}  // namespace

std::optional<Box> shape_bounds(const ShapeSpec& shape) {
  const Vec3 radius = Vec3::Constant(shape.radius);
  if (shape.type == "plane") return unbounded();
  if (shape.type == "box") return around(shape.center, shape.size / 2.0);
  if (shape.type == "sphere") return around(shape.center, radius);
  if (shape.type == "cylinder") return cylinder_bounds(shape);
  if (shape.type == "capsule") return around(shape.from, radius).merged(around(shape.to, radius));
  if (shape.type == "plate") return plate_bounds(shape);
  if (shape.type == "union") return union_bounds(shape);
  if (shape.type == "difference") return shape_bounds(shape.shapes.front());
  if (shape.type == "transform") return transform_bounds(shape);
  return std::nullopt;
}

std::optional<double> shape_volume(const ShapeSpec& shape, int dimension) {
  const bool flat = dimension == 2;
  if (shape.type == "plane") return std::numeric_limits<double>::infinity();
  if (shape.type == "box") return flat ? shape.size.x() * shape.size.z() : shape.size.prod();
  if (shape.type == "sphere") return ball_volume(shape.radius, dimension);
  if (shape.type == "cylinder") return cylinder_volume(shape, dimension);
  if (shape.type == "capsule")
    return cylinder_volume(shape, dimension) + ball_volume(shape.radius, dimension);
  if (shape.type == "plate") return shape.length * shape.thickness * (flat ? 1.0 : shape.width);
  if (shape.type == "union") return union_volume(shape, dimension);
  if (shape.type == "difference" || shape.type == "transform")
    return shape_volume(shape.shapes.front(), dimension);
  return std::nullopt;
}

}  // namespace snowshed::scene
