#include "snowshed/geometry/triangle_mesh.hpp"

#include "geometry/mesh_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

TriangleMesh cube() { return box_mesh({0, 0, 0}, {1, 1, 1}); }

TEST(TriangleMesh, EnclosesTheVolumeOfItsSolid) {
  EXPECT_NEAR(enclosed_volume(box_mesh({9, 9, 9}, {10, 11, 12})), 6, 1e-12);
  EXPECT_NEAR(enclosed_volume(sphere_mesh(1, 40)), 4 * pi / 3, 0.02);
}

TEST(TriangleMesh, MergesIdenticalVertices) {
  const TriangleMesh original = cube();
  TriangleMesh soup;
  for (const Triangle& t : original.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(original.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.vertices[0].x() = -0.0;  // equal to 0
  soup.vertices.push_back(soup.vertices[0]);
  soup.triangles.push_back({0, static_cast<std::uint32_t>(soup.vertices.size() - 1), 1});
  merge_identical_vertices(soup);
  EXPECT_EQ(soup.vertices.size(), 8u);
  EXPECT_EQ(soup.triangles.size(), 12u);
  require_closed(soup, "m");
}

TEST(TriangleMesh, CancelsTrianglesOfOppositeSense) {
  TriangleMesh both = box_mesh({0, 0, 0}, {1, 1, 1});
  const TriangleMesh other = box_mesh({1, 0, 0}, {2, 1, 1});
  for (const Triangle& t : other.triangles)
    both.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  both.vertices.insert(both.vertices.end(), other.vertices.begin(), other.vertices.end());
  merge_identical_vertices(both);
  EXPECT_EQ(both.triangles.size(), 24u);
  cancel_opposite_triangles(both);
  EXPECT_LE(both.triangles.size(), 24u);
  require_closed(both, "m");
  EXPECT_NEAR(enclosed_volume(both), 2, 1e-12);
  TriangleMesh twice = cube();
  for (const Triangle& t : cube().triangles) twice.triangles.push_back({t[1], t[0], t[2]});
  twice.triangles.push_back(twice.triangles.front());
  cancel_opposite_triangles(twice);
  ASSERT_EQ(twice.triangles.size(), 1u);
}

TEST(TriangleMesh, RefusesOpenAndInvalidMeshes) {
  const auto check = [](TriangleMesh mesh, const std::string& expected) {
    expect_input_error([&] { require_closed(mesh, "m.stl"); }, expected);
    expect_input_error([&] { require_closed(mesh, "m.stl"); }, "m.stl");
  };
  check({}, "no triangles");
  TriangleMesh mesh = cube();
  mesh.triangles.pop_back();
  check(mesh, "closed");
  mesh = cube();
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  check(mesh, "same direction");
  mesh = cube();
  mesh.triangles.push_back(mesh.triangles[0]);
  check(mesh, "same direction");
  mesh = cube();
  mesh.vertices[2].y() = std::nan("");
  check(mesh, "vertex 2");
  mesh = cube();
  mesh.vertices[2].y() = 1e300;
  check(mesh, "vertex 2");
  mesh = cube();
  mesh.triangles[0][0] = 8;
  check(mesh, "vertex 8");
}

}  // namespace
}  // namespace snowshed::geometry
