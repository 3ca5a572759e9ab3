// Notes on sizes of a scene's solids that do not fit together, and on oddities of their files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/methods/obstacle.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Adds notes on solids that are probably in another unit: any that are at least 300 times larger
/// than everything else in the scene; those from meshes, grids and OpenVDB files also if they are
/// smaller than a cell, or as much smaller than something else; snow whose size does not fit that
/// of the panel. Adds notes on changes and assumptions about the files of bodies, too. `obstacles`
/// are those of build_obstacles, which has noted their files.
void add_notes_on_files(const Scene& scene, const std::filesystem::path& base_dir,
                        const std::vector<methods::Obstacle>& obstacles,
                        std::vector<std::string>& notes);

}  // namespace snowshed::scene
