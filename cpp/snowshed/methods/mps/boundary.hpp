// Search for the particles near each wall.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/geometry/thickened.hpp"
#include "snowshed/methods/mps/particles.hpp"
#include "snowshed/methods/mps/row_lists.hpp"
#include "snowshed/methods/obstacle.hpp"

namespace snowshed::methods::mps {

/// Returns the solid thickened for the particles: parts of solids that are not convex become two
/// spacings thick if they are thinner. Thin boxes and other convex solids do not change, because
/// they have walls on both sides (WallParticles).
geometry::ThickSolid thickened_for_particles(geometry::Shape shape, double spacing, int dimension);

/// A particle within the radius of an obstacle's surface.
template <int D>
struct WallContact {
  std::uint32_t obstacle;
  double distance;   // m
  double thickness;  // m, upper bound for the obstacle there
  VecD<D> normal;    // out of the obstacle
  VecD<D> velocity;  // m/s, of the obstacle's surface
};

/// An obstacle with its pose at a given time.
struct PlacedObstacle {
  const Obstacle* obstacle;
  std::uint32_t number;
  geometry::RigidPose pose;

  double thickness(const Vec3& x) const {
    return 2 * obstacle->shape->half_thickness(obstacle->motion ? pose.to_body(x) : x);
  }
  double distance(const Vec3& x) const {
    return obstacle->shape->distance(obstacle->motion ? pose.to_body(x) : x);
  }
  Vec3 normal(const Vec3& x) const {
    if (!obstacle->motion) return obstacle->shape->normal(x);
    return pose.normal_to_world(obstacle->shape->normal(pose.to_body(x)));
  }
};
std::vector<PlacedObstacle> place_obstacles(const std::vector<Obstacle>&, double time);

/// Finds the contacts of the snow within `reach` of obstacles, m, ordered by obstacle.
template <int D>
void find_contacts(const std::vector<Obstacle>& obstacles, double reach,
                   const Particles<D>& particles, double time, int threads,
                   RowLists<WallContact<D>>& contacts);

/// The largest speed of an obstacle's surface at a contact, m/s.
template <int D>
double largest_wall_speed(const RowLists<WallContact<D>>& contacts);

}  // namespace snowshed::methods::mps
