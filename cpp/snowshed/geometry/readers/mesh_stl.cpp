#include "snowshed/geometry/readers/byte_reader.hpp"
#include "snowshed/geometry/readers/mesh_formats.hpp"
#include "snowshed/geometry/readers/text_scanner.hpp"

namespace snowshed::geometry {
namespace {

constexpr std::size_t header_size = 84, record_size = 50;

TriangleMesh parse_binary(ByteReader reader, std::size_t count) {
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    reader.skip(3 * sizeof(float));  // the normal; that of the vertices is more accurate
    const auto first = static_cast<std::uint32_t>(3 * n);
    for (int i = 0; i < 3; ++i) {
      Vec3 vertex;
      for (double& coordinate : vertex) coordinate = reader.read<float>();
      if (!vertex.allFinite()) reader.fail("a coordinate is not finite");
      mesh.vertices.push_back(vertex);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    reader.skip(2);
  }
  return mesh;
}

TriangleMesh parse_ascii(TextScanner scanner) {
  TriangleMesh mesh;
  bool ended = false;
  int corners = 0;
  while (scanner.next_line()) {
    const auto& words = scanner.words();
    if (words[0] == "vertex") {
      if (++corners > 3) scanner.fail("a facet with more than three vertices");
      if (mesh.vertices.size() >= 3 * max_mesh_items) scanner.fail("more than 2e7 triangles");
      mesh.vertices.emplace_back(scanner.number<double>(1), scanner.number<double>(2),
                                 scanner.number<double>(3));
    } else if (words[0] == "endloop") {
      if (corners != 3) scanner.fail("a facet with fewer than three vertices");
      const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.triangles.push_back({end - 3, end - 2, end - 1});
      corners = 0;
    } else if (words[0] == "endsolid") {
      ended = true;
    } else if (words[0] != "solid" && words[0] != "facet" && words[0] != "outer" &&
               words[0] != "endfacet") {
      scanner.fail("'" + std::string(words[0].substr(0, 40)) +
                   "' does not belong in an ASCII STL file");
    }
  }
  if (!ended || corners != 0) scanner.fail("the file ends without 'endsolid'");
  return mesh;
}

}  // namespace

TriangleMesh parse_stl(const std::filesystem::path& path, std::string_view bytes) {
  // Binary headers may begin with "solid", too. A file is binary if its size fits its count.
  const bool solid = bytes.substr(0, 5) == "solid";
  if (bytes.size() < header_size) {
    if (solid) return parse_ascii(TextScanner(path, bytes));
    throw InputError(path.string(), "too short for an STL file");
  }
  ByteReader reader(path, bytes, header_size - 4, ByteOrder::little);
  const std::uint64_t count = reader.read<std::uint32_t>();
  if (bytes.size() == header_size + record_size * count) {
    if (count > max_mesh_items) reader.fail("more than 2e7 triangles");
    return parse_binary(reader, count);
  }
  if (solid) return parse_ascii(TextScanner(path, bytes));
  throw InputError(io::at_byte(path, header_size - 4),
                   std::to_string(count) + " triangles declared, which take " +
                       std::to_string(header_size + record_size * count) + " bytes; the file has " +
                       std::to_string(bytes.size()));
}

}  // namespace snowshed::geometry
