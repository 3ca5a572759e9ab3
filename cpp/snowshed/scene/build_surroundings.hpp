// The surroundings of a scene's snow.
#pragma once

#include <filesystem>

#include "snowshed/methods/surroundings.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Relative file names are looked for in `base_dir`. Throws InputError.
methods::Surroundings build_surroundings(const Scene& scene, const std::filesystem::path& base_dir);

}  // namespace snowshed::scene
