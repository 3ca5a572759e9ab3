// A solid that snow collides with, at rest or in prescribed motion.
#pragma once

#include <optional>
#include <string>

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/geometry/rigid_motion.hpp"
#include "snowshed/methods/contact_law.hpp"

namespace snowshed::methods {

struct Obstacle {
  std::string name;
  geometry::Shape shape;
  ContactLaw law;
  std::optional<geometry::RigidMotion> motion;
};

}  // namespace snowshed::methods
