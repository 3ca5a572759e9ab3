// Notes on values and obstacles of a scene that cannot change its results.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Adds notes on frictions of sticky parts, intervals of records that are not kept, obstacles below
/// the ground or far from all snow, and motions that begin after the run. `obstacles` are those of
/// build_obstacles.
void add_notes_on_effects(const Scene& scene, const std::vector<methods::Obstacle>& obstacles,
                          std::vector<std::string>& notes);

}  // namespace snowshed::scene
