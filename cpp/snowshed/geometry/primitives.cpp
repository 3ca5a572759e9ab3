#include "snowshed/geometry/primitives.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/geometry/bounds.hpp"

namespace snowshed::geometry {
namespace {

Vec3 any_perpendicular(const Vec3& axis) { return axis.unitOrthogonal(); }

/// Returns `v` normalised, or `fallback` if `v` is zero.
Vec3 direction(const Vec3& v, const Vec3& fallback) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : fallback;
}

class Convex : public LevelSet {
 public:
  bool is_convex() const final { return true; }
};

class Plane final : public Convex {
 public:
  Plane(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal.normalized()) {}
  double distance(const Vec3& x) const override { return (x - point_).dot(normal_); }
  Vec3 normal(const Vec3&) const override { return normal_; }
  Bounds bounds() const override { return unbounded(); }
  Bounds non_planar_bounds() const override { return empty_bounds(); }
  double inradius() const override { return infinity; }

 private:
  Vec3 point_, normal_;
};

class Box : public Convex {
 public:
  explicit Box(const OrientedBox& box) : box_(box) {}

  double distance(const Vec3& x) const override {
    const Vec3 q = excess(local(x));
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
  }

  Vec3 normal(const Vec3& x) const override {
    const Vec3 p = local(x), q = excess(p);
    Vec3 outward = q.cwiseMax(0.0);
    if (outward.isZero(0.0)) {  // inside: the nearest face
      int axis;
      q.maxCoeff(&axis);
      outward = Vec3::Unit(axis);
    }
    for (int i = 0; i < 3; ++i) outward[i] = std::copysign(outward[i], p[i]);
    return box_.axes * outward.normalized();
  }

  Bounds bounds() const override {
    return transformed({-box_.half, box_.half}, box_.axes, box_.center);
  }
  double inradius() const override { return box_.half.minCoeff(); }
  std::optional<OrientedBox> oriented_box() const override { return box_; }

 protected:
  Vec3 local(const Vec3& x) const { return box_.axes.transpose() * (x - box_.center); }
  Vec3 excess(const Vec3& p) const { return p.cwiseAbs() - box_.half; }
  const OrientedBox box_;
};

class Plate final : public Box {
 public:
  using Box::Box;

  Vec3 normal(const Vec3& x) const override {
    const Vec3 p = local(x);
    if (excess(p).maxCoeff() > 0) return Box::normal(x);
    const Vec3 n = box_.axes.col(2);
    return p.z() >= 0 ? n : Vec3(-n);
  }
};

class Sphere final : public Convex {
 public:
  Sphere(const Vec3& center, double radius) : center_(center), radius_(radius) {}
  double distance(const Vec3& x) const override { return (x - center_).norm() - radius_; }
  Vec3 normal(const Vec3& x) const override { return direction(x - center_, Vec3::UnitZ()); }
  Bounds bounds() const override { return expanded({center_, center_}, radius_); }
  double inradius() const override { return radius_; }

 private:
  Vec3 center_;
  double radius_;
};

class Cylinder final : public Convex {
 public:
  Cylinder(const Vec3& from, const Vec3& to, double radius)
      : center_((from + to) / 2),
        axis_((to - from).normalized()),
        half_length_((to - from).norm() / 2),
        radius_(radius) {}

  double distance(const Vec3& x) const override {
    const Offsets o = offsets(x);
    return std::hypot(std::max(o.radial, 0.0), std::max(o.axial, 0.0)) +
           std::min(std::max(o.radial, o.axial), 0.0);
  }

  Vec3 normal(const Vec3& x) const override {
    const Offsets o = offsets(x);
    const Vec3 outward = direction(o.across, any_perpendicular(axis_));
    const Vec3 along = o.along < 0 ? Vec3(-axis_) : axis_;
    if (o.radial > 0 && o.axial > 0) return (o.radial * outward + o.axial * along).normalized();
    return o.radial > o.axial ? outward : along;
  }

  Bounds bounds() const override {
    const Vec3 across = (1.0 - axis_.array().square()).max(0.0).sqrt();
    const Vec3 reach = half_length_ * axis_.cwiseAbs() + radius_ * across;
    return {center_ - reach, center_ + reach};
  }

  double inradius() const override { return std::min(radius_, half_length_); }

 private:
  /// Position relative to the axis, the lateral surface and the caps.
  struct Offsets {
    double along;          // coordinate along the axis, from the centre
    Vec3 across;           // vector from the axis
    double radial, axial;  // distances to the lateral surface and to the caps, positive outside
  };

  Offsets offsets(const Vec3& x) const {
    const double along = (x - center_).dot(axis_);
    const Vec3 across = x - center_ - along * axis_;
    return {along, across, across.norm() - radius_, std::abs(along) - half_length_};
  }

  Vec3 center_, axis_;
  double half_length_, radius_;
};

class Capsule final : public Convex {
 public:
  Capsule(const Vec3& from, const Vec3& to, double radius)
      : from_(from), edge_(to - from), radius_(radius) {}

  double distance(const Vec3& x) const override { return from_axis(x).norm() - radius_; }
  Vec3 normal(const Vec3& x) const override {
    return direction(from_axis(x), any_perpendicular(edge_));
  }
  Bounds bounds() const override {
    const Vec3 to = from_ + edge_;
    return expanded({from_.cwiseMin(to), from_.cwiseMax(to)}, radius_);
  }
  double inradius() const override { return radius_; }

 private:
  Vec3 from_axis(const Vec3& x) const {
    const double s = std::clamp((x - from_).dot(edge_) / edge_.squaredNorm(), 0.0, 1.0);
    return x - from_ - s * edge_;
  }

  Vec3 from_, edge_;
  double radius_;
};

}  // namespace

Shape make_plane(const Vec3& point, const Vec3& normal) {
  return std::make_shared<Plane>(point, normal);
}

Shape make_box(const Vec3& center, const Vec3& size) {
  return make_box(OrientedBox{center, Mat3::Identity(), size / 2});
}

Shape make_box(const OrientedBox& box) { return std::make_shared<Box>(box); }

Shape make_sphere(const Vec3& center, double radius) {
  return std::make_shared<Sphere>(center, radius);
}

Shape make_cylinder(const Vec3& from, const Vec3& to, double radius) {
  return std::make_shared<Cylinder>(from, to, radius);
}

Shape make_capsule(const Vec3& from, const Vec3& to, double radius) {
  return std::make_shared<Capsule>(from, to, radius);
}

Shape make_plate(const Vec3& center, const Vec3& normal, double length, double width,
                 double thickness) {
  OrientedBox box;
  const Vec3 n = normal.normalized();
  const Vec3 t = Vec3::UnitY().cross(n).normalized();
  box.axes << t, n.cross(t), n;
  box.half = Vec3(length, width, thickness) / 2;
  box.center = center - thickness / 2 * n;
  return std::make_shared<Plate>(box);
}

}  // namespace snowshed::geometry
