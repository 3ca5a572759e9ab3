// Surroundings of the grains and their motion: plates, side walls or periods, the cone.
#pragma once

#include <array>
#include <cstdint>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::methods::grains {

/// Bodies, other than grains, that a grain can touch. They are numbered after the last grain.
enum class Partner : std::uint32_t { bottom_plate, top_plate, west, east, south, north, cone };
inline constexpr std::uint32_t partner_count = 7;

/// Positions and velocities, and the forces of the grains on each part. A plate is an endless
/// square grid of spheres. One of them lies half a spacing from the plate's origin along x and y.
struct Boundary {
  Vec3 plate[2] = {Vec3::Zero(), Vec3::Zero()};  // m, origins: bottom, top
  Vec3 plate_velocity[2] = {Vec3::Zero(), Vec3::Zero()};
  double side[4] = {0, 0, 0, 0};  // m: west, east, south, north; periodic sides are a period apart
  double side_velocity[4] = {0, 0, 0, 0};
  Vec3 tip = Vec3::Zero();  // tip of the cone
  Vec3 tip_velocity = Vec3::Zero();
  bool has_top = true, has_cone = false;

  Vec3 plate_force[2] = {Vec3::Zero(), Vec3::Zero()};  // N, of the grains on them
  double side_force[4] = {0, 0, 0, 0};  // N, outward; on periodic sides the pull of the images
  Vec3 cone_force = Vec3::Zero();
  std::int64_t top_contacts = 0;  // pairs of spheres that touch

  double period(int axis) const { return side[2 * axis + 1] - side[2 * axis]; }
  double period_growth(int axis) const {
    return side_velocity[2 * axis + 1] - side_velocity[2 * axis];
  }
  void move(double dt);
  /// The largest displacement of a part since an earlier time, m.
  double travel_since(const Boundary& earlier) const;
  double top_speed() const;  // m/s, of the fastest part

  /// Calls visit(number) for each number in an archive.
  template <class Self, class Visit>
  static void for_each_number(Self& b, const Visit& visit) {
    const auto all = [&](auto& v) {
      for (int i = 0; i < 3; ++i) visit(v[i]);
    };
    for (int p = 0; p < 2; ++p) {
      all(b.plate[p]);
      all(b.plate_velocity[p]);
      all(b.plate_force[p]);
    }
    all(b.tip);
    all(b.tip_velocity);
    all(b.cone_force);
    for (int s = 0; s < 4; ++s) {
      visit(b.side[s]);
      visit(b.side_velocity[s]);
      visit(b.side_force[s]);
    }
  }
};

/// A sphere's contact with a surface. It is treated as a contact with a sphere of the same radius
/// behind the surface.
struct SurfaceContact {
  double gap;   // m, between the surface and the sphere
  Vec3 normal;  // into the surface
};

/// Contact of a cone with a shaft and a sphere whose centre lies at `center` from the tip.
SurfaceContact meet_cone(const Cone&, const Vec3& center, double radius);

/// The wall that a sphere with this centre meets.
inline SurfaceContact meet_side(const Boundary& b, int side, const Vec3& center, double radius) {
  const int axis = side / 2;
  const double sign = side % 2 == 0 ? -1 : 1;  // outward
  return {sign * (b.side[side] - center[axis]) - radius, sign * Vec3::Unit(axis)};
}

}  // namespace snowshed::methods::grains
