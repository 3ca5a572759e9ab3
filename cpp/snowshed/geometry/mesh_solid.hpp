// Solids from mesh files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

/// Returns the solid that a mesh file bounds, or in two dimensions its cross-section with the plane
/// y = 0; coordinates are multiplied by `scale`. Changes are added to `notes`, if given. Throws
/// InputError as read_solid and sections_at_y0 do.
Shape make_mesh_solid(const std::filesystem::path& file, double scale, int dimension,
                      std::vector<std::string>* notes = nullptr);

}  // namespace snowshed::geometry
