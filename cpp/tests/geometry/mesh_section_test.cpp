#include "snowshed/geometry/mesh_section.hpp"

#include "geometry/mesh_testing.hpp"
#include "snowshed/geometry/mesh_level_set.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

Shape section_of(const TriangleMesh& mesh) {
  const std::vector<TriangleMesh> surfaces = sections_at_y0({mesh}, "m");
  EXPECT_EQ(surfaces.size(), 1u);
  return make_mesh(surfaces.front());
}

TEST(MeshSection, ABoxHasARectangularSectionWhereverItEnds) {
  const Shape rectangle = make_box(Vec3(0.5, 0, 1), Vec3(1, infinity, 2));
  for (const auto& [low, high] :
       {std::pair{-0.5, 0.5}, {0.0, 1.0}, {-1.0, 0.0}, {-1e-9, 1.0}, {1e-9, 1.0}, {-0.01, 0.01}}) {
    const Shape section = section_of(box_mesh({0, low, 0}, {1, high, 2}));
    Random random(3);
    for (int n = 0; n < 500; ++n) {
      Vec3 x = random_point(random, 2.5);
      x.y() = 0;
      ASSERT_NEAR(section->distance(x), rectangle->distance(x), 1e-10)
          << low << " " << x.transpose();
      const Vec3 normal = section->normal(x);
      ASSERT_NEAR(normal.y(), 0, 1e-9);
      if (rectangle->distance(x) > 0.01) {
        ASSERT_LT((normal - rectangle->normal(x)).norm(), 1e-6);
      }
    }
    EXPECT_NEAR(sampling::measure(*section, 2, 0.05), 2, 1e-9);
    EXPECT_NEAR(section->inradius(), 0.5, 1e-6);
  }
}

TEST(MeshSection, ABallHasACircularSection) {
  const double radius = 1.0;
  TriangleMesh ball = sphere_mesh(radius, 64);
  for (const double shift : {0.0, 0.3, -0.6}) {
    TriangleMesh moved = ball;
    for (Vec3& v : moved.vertices) v.y() += shift;
    const double expected = std::sqrt(radius * radius - shift * shift);
    const Shape section = section_of(moved);
    EXPECT_NEAR(section->distance({0, 0, 2}), 2 - expected, 3e-3);
    EXPECT_NEAR(section->distance({0, 0, 0}), -expected, 3e-3);
    EXPECT_NEAR(sampling::measure(*section, 2, 0.02) / (pi * expected * expected), 1, 5e-3);
  }
}

TEST(MeshSection, TheLargerOfTwoSolidsThatTouchThePlaneCounts) {
  // Two shells: a wide box behind the plane and a narrow one in front of it.
  const std::vector<TriangleMesh> both = {box_mesh({0, 0, 0}, {4, 1, 1}),
                                          box_mesh({6, -1, 0}, {7, 0, 1})};
  const auto surfaces = sections_at_y0(both, "m");
  ASSERT_EQ(surfaces.size(), 1u);
  EXPECT_NEAR(sampling::measure(*make_mesh(surfaces.front()), 2, 0.05), 4, 1e-9);
}

TEST(MeshSection, RefusesMeshesThatMissThePlane) {
  expect_input_error([] { sections_at_y0({box_mesh({0, 2, 0}, {1, 3, 1})}, "a.stl"); },
                     "a.stl: the mesh lies between y = 2 and 3 m");
  EXPECT_NO_THROW(
      sections_at_y0({box_mesh({0, 2, 0}, {1, 3, 1}), box_mesh({0, -2, 0}, {1, 3, 1})}, "a.stl"));
}

}  // namespace
}  // namespace snowshed::geometry
