// The obstacles of a scene, thickened to the resolution of its method.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Returns the obstacles with their thin parts made as thick as the method resolves, and adds a
/// note on each that differs, with its thinnest place, its thickness and the displacement of its
/// surface.
std::vector<Obstacle> resolve_obstacles(const Scene& scene, const std::vector<Obstacle>& given,
                                        std::vector<std::string>& notes);

}  // namespace snowshed
