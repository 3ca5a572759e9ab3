// Reading surface meshes.
#pragma once

#include <filesystem>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed {

/// Reads .stl (binary or ASCII), .obj or .ply (ASCII or binary); polygons become fans of
/// triangles, identical vertices become one, coordinates are multiplied by `scale`.
/// The mesh is checked by require_solid.
///
/// Files are not trusted: whatever is wrong gives an InputError that names the file, the line
/// or byte and what is allowed, and memory stays in proportion to the size of the file.
TriangleMesh read_mesh(const std::filesystem::path& path, double scale = 1.0);

}  // namespace snowshed
