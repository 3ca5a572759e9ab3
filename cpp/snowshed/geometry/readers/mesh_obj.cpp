#include <cstdint>

#include "snowshed/geometry/polygon_faces.hpp"
#include "snowshed/geometry/readers/mesh_formats.hpp"
#include "snowshed/geometry/readers/text_scanner.hpp"

namespace snowshed::geometry {
namespace {

/// Returns the vertex that `word` refers to: "7", "7/1", "7/1/2", "7//2", or "-1" for the last of
/// the `count` vertices so far.
std::uint32_t vertex_index(const TextScanner& scanner, std::string_view word, std::size_t count) {
  const auto given = scanner.parse<std::int64_t>(word.substr(0, word.find('/')));
  const auto last = static_cast<std::int64_t>(count);
  const std::int64_t index = given > 0 ? given - 1 : last + given;
  if (given == 0 || given > last || index < 0)
    scanner.fail("vertex " + std::to_string(given) + " of a face; " + std::to_string(count) +
                 " vertices so far");
  return static_cast<std::uint32_t>(index);
}

}  // namespace

TriangleMesh parse_obj(const std::filesystem::path& path, std::string_view bytes) {
  TriangleMesh mesh;
  TextScanner scanner(path, bytes);
  FaceCutter cutter(path.string());
  Face face;
  while (scanner.next_line()) {
    const auto& words = scanner.words();
    if (words[0] == "v") {
      if (mesh.vertices.size() >= max_mesh_items) scanner.fail("more than 2e7 vertices");
      mesh.vertices.emplace_back(scanner.number<double>(1), scanner.number<double>(2),
                                 scanner.number<double>(3));
    } else if (words[0] == "f") {
      if (words.size() < 4) scanner.fail("a face with fewer than three vertices");
      const auto corner = [&](std::size_t i) {
        return vertex_index(scanner, words[i], mesh.vertices.size());
      };
      face.clear();
      for (std::size_t i = 1; i < words.size(); ++i) face.push_back(corner(i));
      if (mesh.triangles.size() + face.size() > max_mesh_items)
        scanner.fail("more than 2e7 triangles");
      cutter.append(face, mesh);
    }  // other lines concern the appearance only
  }
  return mesh;
}

}  // namespace snowshed::geometry
