// Reading surface meshes.
#pragma once

#include <filesystem>

#include "snowshed/geometry/mesh_shells.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// Reads a .stl (binary or ASCII), .obj or .ply (ASCII or binary) file. Polygons are cut into
/// triangles, identical vertices are merged, and coordinates are multiplied by `scale`. The surface
/// must be closed (require_closed); solid_of_shells defines the solid that it bounds.
///
/// Files are untrusted. Every fault gives an InputError that names the file, the line or byte, and
/// what is allowed. Memory stays in proportion to the size of the file.
ShellSolid read_solid(const std::filesystem::path& path, double scale = 1.0);

/// Returns the surface of the same solid, as one mesh.
TriangleMesh read_mesh(const std::filesystem::path& path, double scale = 1.0);

}  // namespace snowshed::geometry
