// Parsers of the mesh file formats. Vertices are in the file's unit and not merged.
#pragma once

#include <filesystem>
#include <string_view>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// The largest number of vertices or triangles that is read, so that a small file cannot take much
/// memory.
inline constexpr std::size_t max_mesh_items = 20'000'000;

TriangleMesh parse_stl(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh parse_obj(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh parse_ply(const std::filesystem::path& path, std::string_view bytes);

}  // namespace snowshed::geometry
