#include "snowshed/methods/grains/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/angles.hpp"

namespace snowshed::methods::grains {

void Boundary::move(double dt) {
  for (int p = 0; p < 2; ++p) plate[p] += dt * plate_velocity[p];
  for (int s = 0; s < 4; ++s) side[s] += dt * side_velocity[s];
  tip += dt * tip_velocity;
}

double Boundary::travel_since(const Boundary& earlier) const {
  double farthest = (tip - earlier.tip).norm();
  for (int p = 0; p < 2; ++p) farthest = std::max(farthest, (plate[p] - earlier.plate[p]).norm());
  // Two sides move a periodic image together.
  for (int s = 0; s < 4; ++s)
    farthest = std::max(farthest, 2 * std::abs(side[s] - earlier.side[s]));
  return farthest;
}

double Boundary::top_speed() const {
  double fastest = tip_velocity.norm();
  for (int p = 0; p < 2; ++p) fastest = std::max(fastest, plate_velocity[p].norm());
  for (int s = 0; s < 4; ++s) fastest = std::max(fastest, 2 * std::abs(side_velocity[s]));
  return fastest;
}

SurfaceContact meet_cone(const Cone& cone, const Vec3& center, double radius) {
  // Coordinates in the plane of the axis and the centre: rho outward, h up from the tip. The cone's
  // profile goes from the tip to the shoulder and from there upward.
  const double rho = std::hypot(center.x(), center.y()), h = center.z();
  const double half = radians(cone.half_angle);
  const double slant = cone.radius / std::sin(half), shoulder = slant * std::cos(half);
  const double sine = std::sin(half), cosine = std::cos(half);
  const double along = std::clamp(rho * sine + h * cosine, 0.0, slant);  // from the tip
  const Eigen::Vector2d here(rho, h), face(along * sine, along * cosine);
  const Eigen::Vector2d shaft(cone.radius, std::max(h, shoulder));
  const bool inside = h > 0 && rho < cone.radius && rho * cosine < h * sine;
  const double to_face = (here - face).norm(), to_shaft = (here - shaft).norm();
  const bool on_shaft = to_shaft < to_face;
  const double depth = on_shaft ? to_shaft : to_face;
  Eigen::Vector2d in = on_shaft ? Eigen::Vector2d(shaft - here) : Eigen::Vector2d(face - here);
  if (inside) in = -in;
  // At a distance of zero the direction is the normal of the surface.
  in = depth > 0 ? Eigen::Vector2d(in / depth)
                 : (on_shaft ? Eigen::Vector2d(-1, 0) : Eigen::Vector2d(-cosine, sine));
  const Vec3 outward = rho > 0 ? Vec3(center.x() / rho, center.y() / rho, 0) : Vec3::UnitX();
  return {(inside ? -depth : depth) - radius, in[0] * outward + in[1] * Vec3::UnitZ()};
}

}  // namespace snowshed::methods::grains
