#include "snowshed/geometry/combine.hpp"

#include <algorithm>
#include <utility>

#include "snowshed/geometry/bounds.hpp"

namespace snowshed::geometry {
namespace {

/// Returns the shape with the smallest distance, and that distance. `shapes` must not be empty.
std::pair<const LevelSet*, double> nearest(const std::vector<Shape>& shapes, const Vec3& x) {
  const LevelSet* best = shapes.front().get();
  double smallest = best->distance(x);
  for (std::size_t i = 1; i < shapes.size(); ++i) {
    const double d = shapes[i]->distance(x);
    if (d >= smallest) continue;
    best = shapes[i].get();
    smallest = d;
  }
  return {best, smallest};
}

Bounds non_planar_bounds_of(const std::vector<Shape>& shapes) {
  Bounds result = empty_bounds();
  for (const Shape& shape : shapes) result = united_bounds(result, shape->non_planar_bounds());
  return result;
}

class Union final : public LevelSet {
 public:
  explicit Union(std::vector<Shape> shapes) : shapes_(std::move(shapes)) {}
  double distance(const Vec3& x) const override { return nearest(shapes_, x).second; }
  Vec3 normal(const Vec3& x) const override { return nearest(shapes_, x).first->normal(x); }

  Bounds bounds() const override {
    Bounds result = empty_bounds();
    for (const Shape& shape : shapes_) result = united_bounds(result, shape->bounds());
    return result;
  }

  double inradius() const override {
    double result = 0;
    for (const Shape& shape : shapes_) result = std::max(result, shape->inradius());
    return result;
  }

  double half_thickness(const Vec3& x) const override {
    return nearest(shapes_, x).first->half_thickness(x);
  }

  double min_half_thickness() const override {
    double result = infinity;
    for (const Shape& shape : shapes_) result = std::min(result, shape->min_half_thickness());
    return result;
  }

  Bounds non_planar_bounds() const override { return non_planar_bounds_of(shapes_); }

 private:
  std::vector<Shape> shapes_;
};

class Difference final : public LevelSet {
 public:
  Difference(Shape first, std::vector<Shape> others)
      : first_(std::move(first)), others_(std::move(others)) {}

  double distance(const Vec3& x) const override {
    return std::max(first_->distance(x), -nearest(others_, x).second);
  }

  Vec3 normal(const Vec3& x) const override {
    const auto [hole, depth] = nearest(others_, x);
    return first_->distance(x) >= -depth ? first_->normal(x) : Vec3(-hole->normal(x));
  }

  Bounds bounds() const override { return first_->bounds(); }
  double inradius() const override { return first_->inradius(); }

  Bounds non_planar_bounds() const override {
    const Bounds all = united_bounds(first_->non_planar_bounds(), non_planar_bounds_of(others_));
    const Bounds within = first_->bounds();
    return {all.min.cwiseMax(within.min), all.max.cwiseMin(within.max)};
  }

 private:
  Shape first_;
  std::vector<Shape> others_;
};

class Transformed final : public LevelSet {
 public:
  Transformed(Shape shape, const Mat3& rotation, const Vec3& translation)
      : shape_(std::move(shape)), rotation_(rotation), translation_(translation) {}

  double distance(const Vec3& x) const override { return shape_->distance(local(x)); }
  Vec3 normal(const Vec3& x) const override { return rotation_ * shape_->normal(local(x)); }
  Bounds bounds() const override { return transformed(shape_->bounds(), rotation_, translation_); }
  Bounds non_planar_bounds() const override {
    return transformed(shape_->non_planar_bounds(), rotation_, translation_);
  }
  double inradius() const override { return shape_->inradius(); }
  double half_thickness(const Vec3& x) const override { return shape_->half_thickness(local(x)); }
  double min_half_thickness() const override { return shape_->min_half_thickness(); }
  bool is_convex() const override { return shape_->is_convex(); }

  std::optional<OrientedBox> oriented_box() const override {
    auto box = shape_->oriented_box();
    if (!box) return box;
    return OrientedBox{rotation_ * box->center + translation_, rotation_ * box->axes, box->half};
  }

 private:
  Vec3 local(const Vec3& x) const { return rotation_.transpose() * (x - translation_); }

  Shape shape_;
  Mat3 rotation_;
  Vec3 translation_;
};

class Dilated final : public LevelSet {
 public:
  Dilated(Shape shape, double offset) : shape_(std::move(shape)), offset_(offset) {}
  double distance(const Vec3& x) const override { return shape_->distance(x) - offset_; }
  Vec3 normal(const Vec3& x) const override { return shape_->normal(x); }
  Bounds bounds() const override { return expanded(shape_->bounds(), offset_); }
  Bounds non_planar_bounds() const override {
    return expanded(shape_->non_planar_bounds(), offset_);
  }
  double inradius() const override { return shape_->inradius() + offset_; }
  double half_thickness(const Vec3& x) const override {
    return shape_->half_thickness(x) + offset_;
  }
  double min_half_thickness() const override { return shape_->min_half_thickness() + offset_; }
  bool is_convex() const override { return shape_->is_convex(); }

 private:
  Shape shape_;
  double offset_;
};

}  // namespace

Shape unite(std::vector<Shape> shapes) { return std::make_shared<Union>(std::move(shapes)); }

Shape subtract(Shape first, std::vector<Shape> others) {
  return std::make_shared<Difference>(std::move(first), std::move(others));
}

Shape transform(Shape shape, const Mat3& rotation, const Vec3& translation) {
  return std::make_shared<Transformed>(std::move(shape), rotation, translation);
}

Shape dilate(Shape shape, double offset) {
  return std::make_shared<Dilated>(std::move(shape), offset);
}

}  // namespace snowshed::geometry
