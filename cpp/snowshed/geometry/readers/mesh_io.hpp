// Reading surface meshes.
#pragma once

#include <filesystem>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed {

/// Reads a .stl (binary or ASCII), .obj or .ply (ASCII or binary) file. Polygons become fans of
/// triangles, identical vertices are merged, and coordinates are multiplied by `scale`. The mesh is
/// checked by require_solid.
///
/// Files are untrusted. Every fault gives an InputError that names the file, the line or byte, and
/// what is allowed. Memory stays in proportion to the size of the file.
TriangleMesh read_mesh(const std::filesystem::path& path, double scale = 1.0);

}  // namespace snowshed
