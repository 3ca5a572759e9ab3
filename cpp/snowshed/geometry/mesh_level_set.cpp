#include "snowshed/geometry/mesh_level_set.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "snowshed/geometry/pseudo_normals.hpp"
#include "snowshed/geometry/triangle_hierarchy.hpp"

namespace snowshed::geometry {
namespace {

class Mesh final : public LevelSet {
 public:
  explicit Mesh(TriangleMesh mesh)
      : mesh_(std::move(mesh)),
        hierarchy_(mesh_),
        normals_(mesh_),
        inradius_(estimate_inradius()) {}

  double distance(const Vec3& x) const override {
    const Nearest n = hierarchy_.nearest(x);
    return std::copysign(std::sqrt(n.squared_distance), side(x, n));
  }

  Vec3 normal(const Vec3& x) const override {
    const Nearest n = hierarchy_.nearest(x);
    const Vec3 outward = x - n.point;
    const double length = outward.norm();
    // Close to the surface the direction to the nearest point is lost in rounding.
    const double rounding = 1e-9 * (1 + x.cwiseAbs().maxCoeff());
    if (length > rounding) return outward * std::copysign(1 / length, side(x, n));
    const Vec3 pseudo = normals_.at(n.triangle, n.feature);
    return pseudo.norm() > 0 ? Vec3(pseudo.normalized()) : Vec3::UnitZ();
  }

  Bounds bounds() const override { return hierarchy_.bounds(); }
  double inradius() const override { return inradius_; }

 private:
  double side(const Vec3& x, const Nearest& n) const {
    return (x - n.point).dot(normals_.at(n.triangle, n.feature));
  }

  double estimate_inradius() const {
    constexpr std::size_t samples = 200;
    const double limit = (bounds().max - bounds().min).minCoeff() / 2;
    const std::size_t stride = std::max<std::size_t>(1, mesh_.triangles.size() / samples);
    Ball largest;
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += stride) {
      if (largest.radius > 0.999 * limit) break;
      const Ball ball = touching_ball(static_cast<std::uint32_t>(t), largest.radius, limit);
      if (ball.radius > largest.radius) largest = ball;
    }
    return deepest_near(largest).radius;
  }

  struct Ball {
    Vec3 center = Vec3::Zero();
    double radius = 0;
  };

  Ball ball_at(const Vec3& center) const { return {center, std::max(0.0, -distance(center))}; }

  /// Returns the ball at a local maximum of the depth, found from `ball` by steps along the axes
  /// and away from the surface.
  Ball deepest_near(Ball ball) const {
    constexpr int max_steps = 200;
    double step = ball.radius;
    for (int n = 0; n < max_steps && step > 1e-3 * ball.radius; ++n) {
      const Ball before = ball;
      const Vec3 inward = -normal(ball.center);
      for (const Vec3& direction :
           {inward, Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
        for (const double s : {step, -step}) {
          const Ball moved = ball_at(before.center + s * direction);
          if (moved.radius > ball.radius) ball = moved;
        }
      if (!(ball.radius > before.radius)) step /= 2;
    }
    return ball;
  }

  /// Returns the largest ball inside the mesh, of radius at most `max_radius`, that touches the
  /// triangle at its centroid (Ma, Bae & Choi 2012, "3D medial axis point approximation using
  /// nearest neighbors"). A ball that contains another point of the surface is shrunk until that
  /// point lies on it. The search ends once the radius falls below `min_radius`.
  Ball touching_ball(std::uint32_t triangle, double min_radius, double max_radius) const {
    constexpr int max_steps = 30;
    const Triangle& t = mesh_.triangles[triangle];
    const Vec3 touch = (mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]]) / 3;
    const Vec3 inward = -normals_.face(triangle);
    double radius = max_radius;
    for (int step = 0; step < max_steps && radius > min_radius; ++step) {
      const Nearest n = hierarchy_.nearest(touch + radius * inward);
      if (std::sqrt(n.squared_distance) > radius * (1 - 1e-6))
        return ball_at(touch + radius * inward);
      const Vec3 chord = n.point - touch;
      const double depth = chord.dot(inward);
      if (!(depth > 0)) return {};
      radius = chord.squaredNorm() / (2 * depth);
    }
    return {};
  }

  const TriangleMesh mesh_;
  const TriangleHierarchy hierarchy_;
  const PseudoNormals normals_;
  const double inradius_;
};

}  // namespace

Shape make_mesh(TriangleMesh mesh) { return std::make_shared<Mesh>(std::move(mesh)); }

}  // namespace snowshed::geometry
