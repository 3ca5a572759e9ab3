#include "snowshed/geometry/readers/mesh_io.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/readers/mesh_formats.hpp"
#include "snowshed/io/file_bytes.hpp"

namespace snowshed::geometry {
namespace {

TriangleMesh parse(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto parser = extension == ".stl"   ? parse_stl
                      : extension == ".obj" ? parse_obj
                      : extension == ".ply" ? parse_ply
                                            : nullptr;
  if (!parser) throw InputError(path.string(), "not a mesh file; allowed: .stl, .obj, .ply");
  return parser(path, io::read_bytes(path));
}

}  // namespace

ShellSolid read_solid(const std::filesystem::path& path, double scale) {
  TriangleMesh mesh = parse(path);
  for (Vec3& vertex : mesh.vertices) vertex *= scale;
  require_valid_numbers(mesh, path.string());
  merge_identical_vertices(mesh);
  cancel_opposite_triangles(mesh);
  if (mesh.triangles.empty()) throw InputError(path.string(), "the mesh encloses no volume");
  require_closed(mesh, path.string());
  return solid_of_shells(mesh, path.string());
}

TriangleMesh read_mesh(const std::filesystem::path& path, double scale) {
  return merged_layers(read_solid(path, scale));
}

}  // namespace snowshed::geometry
