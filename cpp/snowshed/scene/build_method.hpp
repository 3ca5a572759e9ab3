// From a scene to the method that simulates it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "snowshed/methods/grains/clumps.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/obstacle.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// What a scene's files and shapes hold, read and built once.
struct Surroundings {
  std::vector<Obstacle> obstacles;  // all of them, as they are given
  std::vector<Obstacle> resolved;   // the same as the method sees them
  std::vector<std::string> notes;   // on what was assumed or changed, a sentence each
  HeightField terrain;              // empty without terrain
  SlideAreas areas;
  GrainSample sample;  // empty without one
};

/// Relative file names are looked for in `base_dir`. Throws InputError.
Surroundings build_surroundings(const Scene& scene, const std::filesystem::path& base_dir);

/// The scene's method among its surroundings, before any snow. `snows` are those of
/// `assemble_snows`.
std::unique_ptr<Method> build_method(const Scene& scene, const std::vector<Snow>& snows,
                                     const Surroundings& surroundings);

}  // namespace snowshed
