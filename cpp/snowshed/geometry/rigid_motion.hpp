// The pose and velocity of a moving obstacle.
#pragma once

#include <algorithm>

#include "snowshed/core/vec.hpp"

namespace snowshed::geometry {

/// Prescribed rigid motion of an obstacle between `start` and `end`.
struct MotionSpec {
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, about `pivot`
  Vec3 pivot = Vec3::Zero();             // m, moves with the velocity
  double start = 0.0;                    // s
  double end = 1.0e9;                    // s
};

/// Pose and velocity of a rigid body at one instant, in metres and m/s. Before the motion starts,
/// the body frame is the world frame.
struct RigidPose {
  Mat3 rotation = Mat3::Identity();
  Vec3 pivot = Vec3::Zero();        // in the body frame
  Vec3 moved_pivot = Vec3::Zero();  // in the world
  Vec3 linear_velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();

  Vec3 to_body(const Vec3& x) const { return pivot + rotation.transpose() * (x - moved_pivot); }
  Vec3 to_world(const Vec3& x) const { return moved_pivot + rotation * (x - pivot); }
  Vec3 normal_to_world(const Vec3& n) const { return rotation * n; }

  /// Returns the velocity of the body's material point at the world position x.
  Vec3 velocity(const Vec3& x) const {
    return linear_velocity + angular_velocity.cross(x - moved_pivot);
  }
};

/// The motion of a MotionSpec: a constant velocity, and a constant spin about a pivot that moves
/// with that velocity. The body moves for start <= t < end and is at rest before and after.
class RigidMotion {
 public:
  explicit RigidMotion(const MotionSpec& spec) : spec_(spec) {}

  bool is_moving(double t) const { return t >= spec_.start && t < spec_.end; }

  /// Returns pose and velocity at time t, seconds. Callers call it once per time step.
  RigidPose at(double t) const {
    const double elapsed = std::max(0.0, std::min(t, spec_.end) - spec_.start);
    RigidPose pose;
    pose.pivot = spec_.pivot;
    pose.moved_pivot = spec_.pivot + elapsed * spec_.velocity;
    const double spin = spec_.angular_velocity.norm();
    if (spin > 0)
      pose.rotation =
          Eigen::AngleAxisd(spin * elapsed, spec_.angular_velocity / spin).toRotationMatrix();
    if (is_moving(t)) {
      pose.linear_velocity = spec_.velocity;
      pose.angular_velocity = spec_.angular_velocity;
    }
    return pose;
  }

  Vec3 to_body(const Vec3& x, double t) const { return at(t).to_body(x); }
  Vec3 velocity(const Vec3& x, double t) const { return at(t).velocity(x); }
  Vec3 normal_to_world(const Vec3& n, double t) const { return at(t).normal_to_world(n); }

 private:
  MotionSpec spec_;
};

}  // namespace snowshed::geometry
