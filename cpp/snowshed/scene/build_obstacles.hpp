// The solids of a scene with which snow collides.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Builds the ground, the panel, the obstacles of the scene's list and the sides of its domain, in
/// this order. Relative file names are looked for in `base_dir`. Throws InputError naming the
/// obstacle whose shape cannot be built. `notes`, if given, are those of build_shape.
std::vector<methods::Obstacle> build_obstacles(const Scene& scene,
                                               const std::filesystem::path& base_dir,
                                               std::vector<std::string>* notes = nullptr);

/// Returns the obstacles of the scene's list from the result of `build_obstacles`.
std::vector<methods::Obstacle> listed_obstacles(const Scene& scene,
                                                const std::vector<methods::Obstacle>& built);

}  // namespace snowshed::scene
