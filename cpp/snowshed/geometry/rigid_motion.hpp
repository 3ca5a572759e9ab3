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

/// A function for the pose at a time: translation (m), rotation vector (rad), velocity (m/s) and
/// angular velocity (rad/s), three numbers each, about the origin.
using PoseFunction = void (*)(double time, double* pose);

/// The motion of a MotionSpec: a constant velocity, and a constant spin about a pivot that moves
/// with that velocity. The body moves for start <= t < end and is at rest before and after. A
/// PoseFunction may take its place; the body then always moves.
class RigidMotion {
 public:
  explicit RigidMotion(const MotionSpec& spec) : spec_(spec) {}
  explicit RigidMotion(PoseFunction function) : function_(function) {}

  bool is_moving(double t) const { return function_ || (t >= spec_.start && t < spec_.end); }

  /// Returns pose and velocity at time t, seconds. Callers call it once per time step.
  RigidPose at(double t) const {
    if (function_) return pose_of_function(t);
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
  RigidPose pose_of_function(double t) const {
    double values[12] = {};
    function_(t, values);
    RigidPose pose;
    pose.moved_pivot = Vec3(values[0], values[1], values[2]);
    const Vec3 rotation(values[3], values[4], values[5]);
    if (const double angle = rotation.norm(); angle > 0)
      pose.rotation = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
    pose.linear_velocity = Vec3(values[6], values[7], values[8]);
    pose.angular_velocity = Vec3(values[9], values[10], values[11]);
    return pose;
  }

  MotionSpec spec_;
  PoseFunction function_ = nullptr;
};

}  // namespace snowshed::geometry
