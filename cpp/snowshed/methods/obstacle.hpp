// A solid that snow collides with, at rest or in prescribed motion.
#pragma once

#include <optional>
#include <string>

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/geometry/rigid_motion.hpp"
#include "snowshed/methods/contact_law.hpp"

namespace snowshed {

struct Obstacle {
  std::string name;
  Shape shape;
  ContactLaw law;
  std::optional<RigidMotion> motion;
};

}  // namespace snowshed
