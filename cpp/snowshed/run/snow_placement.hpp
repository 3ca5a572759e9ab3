// Whether new snow lies where snow may be: outside of obstacles, and of other snow.
#pragma once

#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// The largest share of a body that may lie where snow may not be.
inline constexpr double max_misplaced = 0.01;

/// A body of new snow.
struct PlacedBody {
  std::string path;                    // in the scene
  const std::vector<Vec3>* positions;  // m, of its particles
  geometry::Shape shape = nullptr;     // solid that they fill; null if there is none
  bool is_only_noted = false;          // only notes, because the program placed it
};

/// Space that new snow must not enter.
struct OccupiedSpace {
  const std::vector<methods::Obstacle>& obstacles;  // as they are given
  const std::vector<methods::Obstacle>& resolved;  // the same, thickened to the method's resolution
  double time = 0;                                 // s, at which moving obstacles are met
  std::vector<Vec3> particles;                     // m, of the snow that is present already
  double particle_distance = 0;                    // m, mean, between these
  int event = 1;                                   // event of the new snow
};

/// Looks for particles of new snow that lie more than a thousandth of the scene's resolution inside
/// an obstacle, beyond the sides of the domain, or in another new body, and for particles that old
/// snow surrounds. (Old snow has no surface, so that overlaps of less than half a particle distance
/// remain unnoticed.) Returns a sentence for each body that has such particles, and one for
/// particles that lie only where a thin obstacle is made thicker and are pushed out.
///
/// Throws InputError with share and position if more than `max_misplaced` of a body's particles are
/// misplaced, not counting those in thickened parts. It only notes them if the scene allows
/// misplaced snow or the body's `is_only_noted` is set.
std::vector<std::string> check_placement(const scene::Scene&, const std::vector<PlacedBody>&,
                                         const OccupiedSpace&);

/// A share in percent: "0.4 %", "50 %".
std::string percent(double share);

}  // namespace snowshed::run
