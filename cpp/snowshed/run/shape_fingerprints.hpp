// Fingerprints of the files that shapes are read from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// The fingerprints of the mesh and grid files that a scene names, in the order of `shape_files`.
std::vector<std::int64_t> shape_fingerprints(const scene::Scene& scene,
                                             const std::filesystem::path& base_dir);

}  // namespace snowshed::run
