// The mesh file formats, each from the bytes of a file. Vertices in file units, not merged.
#pragma once

#include <filesystem>
#include <string_view>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed {

/// No more vertices or triangles are read, so that a small file cannot take much memory.
inline constexpr std::size_t max_mesh_items = 20'000'000;

TriangleMesh parse_stl(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh parse_obj(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh parse_ply(const std::filesystem::path& path, std::string_view bytes);

}  // namespace snowshed
