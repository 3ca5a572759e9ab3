#include "snowshed/geometry/mesh_shells.hpp"

#include "geometry/mesh_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/connected_shells.hpp"
#include "snowshed/geometry/mesh_level_set.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

void add(const TriangleMesh& part, TriangleMesh& mesh, bool inward = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (Triangle t : part.triangles) {
    if (inward) std::swap(t[1], t[2]);
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

struct Cube {
  Vec3 min, max;
  bool inward = false;
};

TriangleMesh cubes(const std::vector<Cube>& parts) {
  TriangleMesh mesh;
  for (const Cube& part : parts) add(box_mesh(part.min, part.max), mesh, part.inward);
  merge_identical_vertices(mesh);
  return mesh;
}

struct Solid {
  Shape shape;
  std::vector<std::string> notes;
  double volume() const { return sampling::measure(*shape, 3, 0.25); }
};

Solid solid_of(const TriangleMesh& mesh) {
  require_closed(mesh, "m");
  ShellSolid solid = solid_of_shells(mesh, "m");
  std::vector<Shape> shapes;
  for (const TriangleMesh& layer : solid.layers) shapes.push_back(make_mesh(layer));
  return {unite(std::move(shapes)), std::move(solid.notes)};
}

const Vec3 zero = Vec3::Zero(), ones = Vec3::Ones();

TEST(MeshShells, ASingleShellIsUnchanged) {
  const TriangleMesh ball = sphere_mesh(1, 6);
  const ShellSolid solid = solid_of_shells(ball, "m");
  ASSERT_EQ(solid.layers.size(), 1u);
  EXPECT_NEAR(enclosed_volume(solid.layers.front()), enclosed_volume(ball), 1e-12);
  EXPECT_EQ(solid.layers.front().triangles.size(), ball.triangles.size());
  EXPECT_TRUE(solid.notes.empty());
}

TEST(MeshShells, TurnsInwardTrianglesOutward) {
  const ShellSolid solid = solid_of_shells(cubes({{zero, ones, true}}), "m");
  EXPECT_NEAR(enclosed_volume(solid.layers.front()), 1, 1e-12);
  EXPECT_TRUE(solid.notes.empty());  // the convention of the file
}

TEST(MeshShells, TurnsEachShellSeparately) {
  for (const bool first : {false, true})
    for (const bool second : {false, true}) {
      const Solid both = solid_of(cubes({{zero, ones, first}, {{2, 0, 0}, {3, 2, 1}, second}}));
      EXPECT_NEAR(both.volume(), 3, 1e-9) << first << second;
      EXPECT_EQ(both.notes.size(), first != second ? 1u : 0u);
      EXPECT_NEAR(both.shape->distance({1.5, 0.5, 0.5}), 0.5, 1e-12);
    }
}

// The signed volumes of these shells cancel.
TEST(MeshShells, EqualShellsOfOppositeSenseAreTwoSolids) {
  EXPECT_NEAR(solid_of(cubes({{zero, ones}, {{2, 0, 0}, {3, 1, 1}, true}})).volume(), 2, 1e-9);
}

TEST(MeshShells, EnclosedShellsOfOppositeSenseAreCavities) {
  const Cube outer{{-2, -2, -2}, {2, 2, 2}}, cavity{-ones, ones, true}, core{-ones / 2, ones / 2};
  const Solid hollow = solid_of(cubes({outer, cavity})),
              cored = solid_of(cubes({outer, cavity, core}));
  EXPECT_NEAR(hollow.volume(), 64 - 8, 1e-9);
  EXPECT_NEAR(cored.volume(), 64 - 8 + 1, 1e-9);
  EXPECT_NEAR(cored.shape->distance({0.75, 0, 0}), 0.25, 1e-12);
  EXPECT_NEAR(cored.shape->distance({1.5, 0, 0}), -0.5, 1e-12);
  EXPECT_TRUE(cored.notes.empty());
}

TEST(MeshShells, ThreeNestedShellsFollowTheirWindingNumbers) {
  const auto level = [](double half, bool inward) {
    return Cube{-half * Vec3::Ones(), half * Vec3::Ones(), inward};
  };
  struct Case {
    bool inward[3];
    double volume;
  };
  // The winding number within the outermost cube is 1; each inner cube adds or subtracts one.
  for (const Case& c :
       {Case{{false, true, false}, 64 - 8 + 1},                                  // 1, 0, 1
        Case{{true, false, true}, 64 - 8 + 1}, Case{{false, false, false}, 64},  // 1, 2, 3
        Case{{false, false, true}, 64},                                          // 1, 2, 1
        Case{{false, true, true}, 64 - 8 + 1},                                   // 1, 0, -1
        Case{{true, true, true}, 64}}) {
    const Solid solid =
        solid_of(cubes({level(2, c.inward[0]), level(1, c.inward[1]), level(0.5, c.inward[2])}));
    EXPECT_NEAR(solid.volume(), c.volume, 1e-9) << c.inward[0] << c.inward[1] << c.inward[2];
  }
}

TEST(MeshShells, OverlappingShellsAreUnited) {
  for (const bool inward : {false, true}) {
    const Solid cross = solid_of(cubes(
        {{{-1, -0.25, -0.25}, {1, 0.25, 0.25}}, {{-0.25, -0.25, -1}, {0.25, 0.25, 1}, inward}}));
    EXPECT_NEAR(cross.volume(), 2 * 2 * 0.25 - 0.125, 1e-9);
    EXPECT_LT(cross.shape->distance(zero), -0.1);
    EXPECT_NEAR(cross.shape->distance({0.5, 0, 0.5}), 0.25, 1e-12);
  }
}

TEST(MeshShells, TouchingSolidsAreSeparate) {
  // They touch at a face that both divide along the same diagonal, at an edge, or at a corner.
  for (const Vec3& shift : {Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(1, 1, 1)}) {
    const TriangleMesh mesh = cubes({{zero, ones}, {shift, shift + ones}});
    EXPECT_EQ(connected_shells(mesh).size(), 2u);
    const Solid both = solid_of(mesh);
    EXPECT_NEAR(both.volume(), 2, 1e-9);
    EXPECT_LT(both.shape->distance({0.5, 0.5, 0.5}), -0.4);
    EXPECT_LT(both.shape->distance(shift + ones / 2), -0.4);
  }
}

TEST(MeshShells, OmitsSheetsWithoutVolume) {
  TriangleMesh mesh = cubes({{zero, ones}});
  TriangleMesh sheet;
  sheet.vertices = {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  add(sheet, mesh);
  const Solid solid = solid_of(mesh);
  EXPECT_NEAR(solid.volume(), 1, 1e-9);
  ASSERT_EQ(solid.notes.size(), 1u);
  EXPECT_NE(solid.notes.front().find("no volume"), std::string::npos);
  expect_input_error([&] { solid_of_shells(sheet, "sheet.stl"); }, "sheet.stl: the mesh encloses");
}

TEST(MeshShells, RefusesSelfIntersectingSurfaces) {
  // A tube along a path that crosses itself: its end runs through its beginning.
  TriangleMesh mesh;
  const std::vector<Vec3> path{{-2, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}, {0, 0, -2}};
  for (const Vec3& p : path)
    for (const Vec3& corner :
         {Vec3(-0.5, -0.5, 0), Vec3(0, -0.5, 0.5), Vec3(0.5, 0.5, 0), Vec3(0, 0.5, -0.5)})
      mesh.vertices.push_back(p + corner);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const auto last = std::uint32_t(4 * (path.size() - 1));
  for (std::uint32_t s = 0; s < last; s += 4)
    for (std::uint32_t k = 0; k < 4; ++k)
      quad(s + k, s + (k + 1) % 4, s + 4 + (k + 1) % 4, s + 4 + k);
  quad(3, 2, 1, 0);
  quad(last, last + 1, last + 2, last + 3);
  require_closed(mesh, "m");
  expect_input_error([&] { solid_of_shells(mesh, "tube.stl"); }, "runs through itself");
}

}  // namespace
}  // namespace snowshed::geometry
