#include "snowshed/scene/build_shape.hpp"

#include "geometry/mesh_testing.hpp"
#include "geometry/readers/npy_testing.hpp"

namespace snowshed::scene {
namespace {

using namespace geometry_testing;

ShapeSpec spec_of(const std::string& type) {
  ShapeSpec spec;
  spec.type = type;
  return spec;
}

ShapeSpec ball(double radius) {
  ShapeSpec spec = spec_of("sphere");
  spec.radius = radius;
  return spec;
}

ShapeSpec rod() {
  ShapeSpec spec = spec_of("capsule");
  spec.to = {1, 0, 0};
  spec.radius = 0.1;
  return spec;
}

ShapeSpec panel() {
  ShapeSpec spec = spec_of("plate");
  spec.normal = {1, 0, 1};
  spec.length = 2;
  spec.width = 1;
  spec.thickness = 0.1;
  return spec;
}

geometry::Shape build(const ShapeSpec& spec, int dimension = 3) {
  return build_shape(spec, dimension, "/obstacles/0/shape", ".");
}

void expect_refused(const ShapeSpec& spec, const std::string& where, int dimension = 3) {
  expect_input_error([&] { build(spec, dimension); }, "/obstacles/0/shape" + where + ": ");
}

TEST(BuildShape, BuildsEveryPrimitive) {
  EXPECT_DOUBLE_EQ(build(spec_of("plane"))->distance({0, 0, 2}), 2);
  ShapeSpec box = spec_of("box");
  box.size = {1, 2, 3};
  EXPECT_DOUBLE_EQ(build(box)->distance({0, 2, 0}), 1);
  EXPECT_DOUBLE_EQ(build(ball(0.5))->distance({2, 0, 0}), 1.5);
  EXPECT_DOUBLE_EQ(build(rod())->distance({0.5, 0, 1}), 0.9);
  ShapeSpec cylinder = rod();
  cylinder.type = "cylinder";
  EXPECT_DOUBLE_EQ(build(cylinder)->distance({2, 0, 0}), 1);
  EXPECT_NEAR(build(panel())->distance({1, 0, 1}), std::sqrt(2.0), 1e-12);
}

TEST(BuildShape, BoxesAndPlatesAreUnboundedAlongYIn2D) {
  ShapeSpec box = spec_of("box");
  box.size = {1, 0, 3};
  EXPECT_EQ(build(box, 2)->bounds().max.y(), geometry::infinity);
  ShapeSpec plate = panel();
  plate.width = 0;
  EXPECT_NEAR(build(plate, 2)->distance({0, 1e6, 0}), 0, 1e-12);
}

TEST(BuildShape, CombinesShapes) {
  ShapeSpec both = spec_of("union");
  both.shapes = {ball(1), rod()};
  ShapeSpec hollow = spec_of("difference");
  hollow.shapes = {both, ball(0.5)};
  ShapeSpec turned = spec_of("transform");
  turned.axis = {0, 2, 0};
  turned.angle = 90;
  turned.translate = {0, 0, 5};
  turned.shapes = {hollow};
  const geometry::Shape shape = build(turned);
  EXPECT_DOUBLE_EQ(build(hollow)->distance({0, 0, 0}), 0.5);
  EXPECT_NEAR(shape->distance({0, 0, 5 - 1.05}), -0.05, 1e-12);  // the rod's end, turned down
  EXPECT_NEAR(shape->distance({0, 0, 5}), 0.5, 1e-12);
}

TEST(BuildShape, NamesTheInvalidField) {
  expect_refused(spec_of("blob"), "/type");
  expect_refused(ball(0), "/radius");
  expect_refused(ball(-1), "/radius");
  expect_refused(ball(geometry::infinity), "/radius");
  expect_refused(ball(std::nan("")), "/radius");
  ShapeSpec s = ball(1);
  s.center.x() = geometry::infinity;
  expect_refused(s, "/center");
  s = spec_of("box");
  s.size = {1, -1, 1};
  expect_refused(s, "/size");
  s = spec_of("plane");
  s.normal.setZero();
  expect_refused(s, "/normal");
  s = panel();
  s.normal = {0, 1, 0};
  expect_refused(s, "/normal");
  s = panel();
  s.width = 0;
  expect_refused(s, "/width");
  s = panel();
  s.thickness = 0;
  expect_refused(s, "/thickness");
  s = rod();
  s.to = s.from;
  expect_refused(s, "/to");
  s = spec_of("union");
  expect_refused(s, "/shapes");
  s = spec_of("difference");
  s.shapes = {ball(1)};
  expect_refused(s, "/shapes");
  s.shapes = {ball(1), rod(), ball(-2)};
  expect_refused(s, "/shapes/2/radius");
  s = spec_of("transform");
  s.shapes = {ball(1)};
  s.axis.setZero();
  expect_refused(s, "/axis");
  s.axis = {0, 1, 0};
  s.angle = geometry::infinity;
  expect_refused(s, "/angle");
  expect_refused(spec_of("mesh"), "/file");
  s = spec_of("grid");
  s.file = "g.npy";
  expect_refused(s, "/spacing");
  s = spec_of("mesh");
  s.scale = 0;
  expect_refused(s, "/scale");
}

TEST(BuildShape, RefusesShapesOutsideThePlaneIn2D) {
  ShapeSpec s = ball(1);
  s.center.y() = 0.1;
  EXPECT_NO_THROW(build(s, 3));
  expect_refused(s, "/center", 2);
  s = spec_of("transform");
  s.shapes = {ball(1)};
  s.axis = {1, 0, 0};
  EXPECT_NO_THROW(build(s, 3));
  expect_refused(s, "/axis", 2);
}

TEST(BuildShape, LimitsTheNesting) {
  ShapeSpec s = ball(1);
  for (int level = 1; level < max_shape_depth; ++level) {
    ShapeSpec outer = spec_of("union");
    outer.shapes = {s};
    s = outer;
  }
  EXPECT_NO_THROW(build(s));
  ShapeSpec outer = spec_of("union");
  outer.shapes = {s};
  expect_input_error([&] { build(outer); }, "deeper than 32");
}

TEST(BuildShape, ReadsMeshesRelativeToTheScene) {
  const TempDir dir;
  dir.write("cube.obj",
            "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 1000 1000 0\nv 0 0 1000\nv 1000 0 1000\n"
            "v 0 1000 1000\nv 1000 1000 1000\n"
            "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  ShapeSpec s = spec_of("mesh");
  s.file = "cube.obj";
  s.scale = 1e-3;
  const geometry::Shape cube = build_shape(s, 3, "", dir.path());
  EXPECT_NEAR(cube->distance({0.5, 0.5, 3}), 2, 1e-12);
  s.file = "nowhere.obj";
  expect_input_error([&] { build_shape(s, 3, "", dir.path()); }, "nowhere.obj: no such file");
}

TEST(BuildShape, ReadsGridsInTwoAndThreeDimensions) {
  const TempDir dir;
  std::vector<double> flat, full;
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 4; ++k) flat.push_back(0.1 * k - 0.15);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 4; ++k) full.push_back(0.1 * k - 0.15);
  dir.write("flat.npy", npy_file(1, npy_header("<f8", "(5, 4)"), npy_data(flat)));
  dir.write("full.npy", npy_file(1, npy_header("<f8", "(5, 3, 4)"), npy_data(full)));
  ShapeSpec s = spec_of("grid");
  s.spacing = 0.1;
  s.origin = {1, 0, 2};
  for (const char* file : {"flat.npy", "full.npy"}) {
    s.file = file;
    const geometry::Shape grid = build_shape(s, 2, "", dir.path());
    EXPECT_NEAR(grid->distance({1.2, 0, 2.22}), 0.07, 1e-6);
    EXPECT_LT((grid->normal({1.2, 0, 2.15}) - Vec3::UnitZ()).norm(), 1e-6);
  }
  EXPECT_NEAR(build_shape(s, 3, "", dir.path())->distance({1.2, 0.1, 2.22}), 0.07, 1e-6);
  s.file = "flat.npy";
  expect_input_error([&] { build_shape(s, 3, "", dir.path()); }, "[x][y][z]");
}

}  // namespace
}  // namespace snowshed::scene
