// The obstacles of a scene as descriptions, before any solid is built.
#pragma once

#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// The obstacles "ground" and "panel", then the scene's own, without the domain's sides.
std::vector<ObstacleSpec> obstacle_specs(const Scene& scene);

}  // namespace snowshed::scene
