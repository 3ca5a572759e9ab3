// Free rotation of a rigid body.
#pragma once

#include <cmath>

#include "snowshed/core/vec.hpp"

namespace snowshed::methods::grains {

/// The rotation from a body's principal frame to space.
using Orientation = Eigen::Quaternion<double, Eigen::DontAlign>;

namespace detail {

/// Turns a body about one of its principal axes by an angle, rad. The angular momentum in the
/// body's frame turns the other way.
inline void turn_about(int axis, double angle, Orientation& q, Vec3& momentum) {
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const double l = momentum[b], m = momentum[c];
  momentum[b] = cosine * l + sine * m;
  momentum[c] = cosine * m - sine * l;
  Vec3 half = Vec3::Zero();
  half[axis] = std::sin(0.5 * angle);
  q = q * Orientation(std::cos(0.5 * angle), half.x(), half.y(), half.z());
}

}  // namespace detail

/// Turns a body without a torque for a time dt (s). `momentum` is its angular momentum in space,
/// which is constant; `inertia` holds its principal moments.
///
/// The kinetic energy is split by principal axes, and each part is solved exactly (Dullweber,
/// Leimkuhler and McLachlan 1997, doi:10.1063/1.474310). The scheme is symplectic, reversible in
/// time, and of second order. The energy oscillates by O(dt^2) and does not drift.
inline void rotate_freely(Orientation& q, const Vec3& momentum, const Vec3& inertia, double dt) {
  Vec3 l = q.conjugate() * momentum;
  const auto turn = [&](int axis, double share) {
    detail::turn_about(axis, share * dt * l[axis] / inertia[axis], q, l);
  };
  turn(0, 0.5);
  turn(1, 0.5);
  turn(2, 1.0);
  turn(1, 0.5);
  turn(0, 0.5);
  q.normalize();
}

/// The angular velocity in space, rad/s.
inline Vec3 angular_velocity(const Mat3& rotation, const Vec3& momentum, const Vec3& inertia) {
  return rotation * (rotation.transpose() * momentum).cwiseQuotient(inertia);
}

}  // namespace snowshed::methods::grains
