#include "snowshed/scene/thicken_obstacles.hpp"

#include "geometry/mesh_testing.hpp"
#include "scene/panel_scene.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/build_surroundings.hpp"

namespace snowshed::scene {
namespace {

using namespace geometry_testing;

ShapeSpec box_spec(const Vec3& center, const Vec3& size) {
  ShapeSpec spec;
  spec.type = "box";
  spec.center = center;
  spec.size = size;
  return spec;
}

ShapeSpec combined(const std::string& type, std::vector<ShapeSpec> shapes) {
  ShapeSpec spec;
  spec.type = type;
  spec.shapes = std::move(shapes);
  return spec;
}

ObstacleSpec obstacle(const std::string& name, const ShapeSpec& shape) {
  ObstacleSpec spec;
  spec.name = name;
  spec.shape = shape;
  return spec;
}

/// A bin cut from a block, a thin shelf and a thick post.
Scene scene_with(const methods::MethodChoice& numerics, int dimension) {
  Scene scene;
  scene.dimension = dimension;
  scene.numerics = std::move(numerics);
  scene.obstacles = {
      obstacle("bin", combined("difference", {box_spec({0, 0, 0.65}, {0.6, 0.6, 0.3}),
                                              box_spec({0, 0, 0.71}, {0.58, 0.58, 0.4})})),
      obstacle("shelf", box_spec({2, 0, 0.3}, {0.5, 0.5, 0.004})),
      obstacle("post", box_spec({1, 0, 0.2}, {0.2, 0.2, 0.4}))};
  return scene;
}

methods::mpm::Settings cells() {
  methods::mpm::Settings settings;
  settings.dx = 0.02;
  return settings;
}

methods::mps::Settings spacings() {
  methods::mps::Settings settings;
  settings.spacing = 0.02;
  return settings;
}

TEST(ThickenObstacles, ThinPartsBecomeTwoCellsThickWithANote) {
  for (const int dimension : {2, 3}) {
    const Scene scene = scene_with(cells(), dimension);
    std::vector<std::string> notes;
    const std::vector<methods::Obstacle> given = build_obstacles(scene, ".");
    const std::vector<methods::Obstacle> thickened = thicken_obstacles(scene, given, notes);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_NE(notes[0].find("obstacle 'bin' has parts thinner than two cells, down to 10 mm at ("),
              std::string::npos)
        << notes[0];
    EXPECT_NE(notes[0].find("made 40 mm thick, up to 15 mm more on each side"), std::string::npos)
        << notes[0];
    EXPECT_EQ(notes[1],
              "obstacle 'shelf' is 4 mm thick, less than two cells: it is made 40 mm thick, 18 mm "
              "more on each side");
    EXPECT_NEAR(thickened[0].shape->distance({0, 0, 0.505 + 0.03}), 0.01, 2e-4);
    EXPECT_NEAR(thickened[1].shape->distance({2, 0, 0.33}), 0.01, 1e-9);
    EXPECT_EQ(thickened[2].shape, given[2].shape);
  }
}

TEST(ThickenObstacles, ThinBoxesStayThinForMps) {
  const Scene scene = scene_with(spacings(), 2);
  std::vector<std::string> notes;
  const std::vector<methods::Obstacle> given = build_obstacles(scene, ".");
  const std::vector<methods::Obstacle> thickened = thicken_obstacles(scene, given, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("thinner than two spacings"), std::string::npos);
  EXPECT_NEAR(thickened[0].shape->distance({0, 0, 0.505 + 0.03}), 0.01, 2e-4);
  EXPECT_EQ(thickened[1].shape, given[1].shape);
}

std::string obj_box(const Vec3& low, const Vec3& high) {
  std::string text;
  const geometry::TriangleMesh mesh = box_mesh(low, high);
  for (const Vec3& v : mesh.vertices)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\n";
  for (const geometry::Triangle& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text;
}

TEST(FileNotes, SolidsInAnotherUnitAreNoted) {
  TempDir dir;
  ShapeSpec mesh;
  mesh.type = "mesh";
  mesh.file = "post.obj";
  dir.write(mesh.file, obj_box({0, -1, 0}, {1, 1, 2}));
  Scene scene;
  scene.dimension = 2;
  scene.numerics = cells();
  BodySpec body;
  body.shape = box_spec({0, 0, 5}, {1, 0, 1});
  scene.bodies = {body};
  const auto notes_at = [&](double scale, bool as_body) {
    mesh.scale = scale;
    Scene changed = scene;
    if (as_body) {
      changed.bodies.push_back(body);
      changed.bodies.back().shape = mesh;
    } else {
      changed.obstacles = {obstacle("post", mesh)};
    }
    return build_surroundings(changed, dir.path()).notes;
  };
  for (const bool as_body : {false, true}) {
    EXPECT_TRUE(notes_at(1, as_body).empty());
    const auto large = notes_at(1000, as_body), small = notes_at(1e-3, as_body);
    ASSERT_EQ(large.size(), 1u);
    EXPECT_EQ(large[0],
              "post.obj: the solid is 2e+03 m large, and everything else at most 1 m; if the file "
              "is in another unit, set its \"scale\"");
    ASSERT_FALSE(small.empty());
    EXPECT_NE(small.back().find("0.002 m large, less than a cell of 0.02 m"), std::string::npos);
  }
}

TEST(FileNotes, SolidsOfNoFileInAnotherUnitAreNoted) {
  TempDir dir;
  Scene scene = panel_scene(40);
  const auto notes = [&] { return build_surroundings(scene, dir.path()).notes; };
  scene.obstacles = {obstacle("post", box_spec({5, 0, 1}, {0.2, 0.2, 2}))};
  EXPECT_TRUE(notes().empty());
  scene.obstacles = {obstacle("post", box_spec({50, 0, 1000}, {200, 200, 2000}))};
  ASSERT_EQ(notes().size(), 1u);
  EXPECT_EQ(notes()[0],
            "/obstacles/0/shape: the solid is 2e+03 m large, and everything else at most 2 m; "
            "check its unit");
}

TEST(FileNotes, SnowThatDoesNotFitThePanelIsNoted) {
  TempDir dir;
  Scene scene = panel_scene(40);
  const auto notes = [&] { return build_surroundings(scene, dir.path()).notes; };
  for (const double thickness : {0.001, 2.5}) {
    scene.slab->thickness = thickness;
    ASSERT_EQ(notes().size(), 1u) << thickness;
    EXPECT_NE(notes()[0].find(" m thick beside a panel of 2 m; check the units of both"),
              std::string::npos);
  }
  scene.slab->thickness = 0.1;
  scene.slab->length = 0.015;
  EXPECT_EQ(notes().size(), 1u);
  scene.slab->length = 0;
  BodySpec& body = scene.bodies.emplace_back();
  body.shape = box_spec({0, 0, 500}, {250, 1, 1});
  ASSERT_EQ(notes().size(), 1u);
  EXPECT_EQ(notes()[0],
            "/bodies/0/shape: 250 m large beside a panel of 2 m; check the units of both");
}

TEST(FileNotes, APanelInCentimetresIsNotedAlsoIfItsSlabIsPlausible) {
  TempDir dir;
  Scene scene = panel_scene(40);
  scene.slab->thickness = 0.2;
  const auto notes = [&] { return build_surroundings(scene, dir.path()).notes; };
  scene.panel->length = 30;
  scene.panel->height = 0.4;
  ASSERT_EQ(notes().size(), 1u);
  EXPECT_EQ(notes()[0],
            "/panel/height: 0.4 m high beside a panel of 30 m; check the units of both");
  scene.panel->height = 2;
  EXPECT_TRUE(notes().empty());
  scene.panel->length = 0.5;
  scene.panel->height = 18;
  EXPECT_EQ(notes().size(), 1u);
  scene.panel->height = 0;  // a panel that ends at the ground
  EXPECT_TRUE(notes().empty());
  scene.dimension = 3;
  scene.panel->length = 30;
  scene.panel->width = 0.6;
  scene.slab->width = 0.4;
  ASSERT_EQ(notes().size(), 1u);
  EXPECT_EQ(notes()[0].substr(0, 13), "/panel/width:");
}

TEST(FileNotes, RepairsAreNoted) {
  TempDir dir;
  std::string content = obj_box({0, -1, 0}, {1, 1, 2});
  // A second box that faces inward.
  const geometry::TriangleMesh other = box_mesh({3, -1, 0}, {4, 1, 2});
  for (const Vec3& v : other.vertices)
    content += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
               std::to_string(v.z()) + "\n";
  for (const geometry::Triangle& t : other.triangles)
    content += "f " + std::to_string(t[0] + 9) + " " + std::to_string(t[2] + 9) + " " +
               std::to_string(t[1] + 9) + "\n";
  dir.write("two.obj", content);
  ShapeSpec mesh;
  mesh.type = "mesh";
  mesh.file = "two.obj";
  for (const int dimension : {2, 3}) {
    Scene scene;
    scene.dimension = dimension;
    scene.numerics = cells();
    scene.obstacles = {obstacle("two", mesh)};
    const auto notes = build_surroundings(scene, dir.path()).notes;
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("two.obj: a shell faced inward and was turned"), std::string::npos);
  }
}

}  // namespace
}  // namespace snowshed::scene
