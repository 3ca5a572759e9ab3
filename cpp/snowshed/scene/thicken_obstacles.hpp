// The obstacles of a scene, thickened to the resolution of its method.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Returns the obstacles with thin parts made as thick as the method resolves. Adds a note on each
/// obstacle that changes: the position and thickness of its thinnest part, and how far its surface
/// moves.
std::vector<methods::Obstacle> thicken_obstacles(const Scene& scene,
                                                 const std::vector<methods::Obstacle>& given,
                                                 std::vector<std::string>& notes);

}  // namespace snowshed::scene
