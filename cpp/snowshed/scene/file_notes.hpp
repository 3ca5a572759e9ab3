// Notes on oddities of the solids that a scene reads from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Adds notes on solids from meshes, grids and OpenVDB files that are probably in another unit:
/// they are smaller than a cell, or at least 300 times larger or smaller than everything else in
/// the scene. Adds notes on changes and assumptions about the files of bodies, too. `obstacles` are
/// those of build_obstacles, which has noted their files.
void add_notes_on_files(const Scene& scene, const std::filesystem::path& base_dir,
                        const std::vector<methods::Obstacle>& obstacles,
                        std::vector<std::string>& notes);

}  // namespace snowshed::scene
