#include "snowshed/geometry/mesh_level_set.hpp"

#include "geometry/mesh_testing.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

TEST(MeshLevelSet, CubeMatchesTheBox) {
  const Shape mesh = make_mesh(box_mesh({-0.5, -0.7, -0.3}, {0.5, 0.7, 0.3}));
  const Shape box = make_box(Vec3::Zero(), Vec3(1, 1.4, 0.6));
  Random random(12);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 x = random_point(random, 1.5);
    ASSERT_NEAR(mesh->distance(x), box->distance(x), 1e-12) << x.transpose();
    ASSERT_LT((mesh->normal(x) - box->normal(x)).norm(), 1e-7) << x.transpose();
  }
  EXPECT_NEAR(mesh->inradius(), 0.3, 1e-6);
  EXPECT_EQ(mesh->bounds().max, Vec3(0.5, 0.7, 0.3));
  expect_normal_is_gradient(*mesh, 1.5);
}

TEST(MeshLevelSet, SignIsRightBeyondEdgesAndCorners) {
  // The normal of a single face gives the wrong sign here, for a spike more often than for a cube.
  TriangleMesh spike = box_mesh({-1, -1, 0}, {1, 1, 0.2});
  for (const int top : {4, 5, 6, 7})
    spike.vertices[top] = {0.01 * spike.vertices[top].x(), 0.01 * spike.vertices[top].y(), 3};
  const Shape mesh = make_mesh(spike);
  Random random(13);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 outside = Vec3(0, 0, 3.2) + random_point(random, 0.15);
    ASSERT_GT(mesh->distance(outside), 0) << outside.transpose();
    const double z = 2.9 * random.uniform();
    ASSERT_LT(mesh->distance({0, 0, 0.01 + z}), 0);
  }
}

TEST(MeshLevelSet, TessellatedSphereMatchesTheSphere) {
  const Shape mesh = make_mesh(sphere_mesh(1.0, 48)), ball = make_sphere({0, 0, 0}, 1.0);
  const double sagitta = 1 - std::cos(pi / 48);
  Random random(14);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 x = random_point(random, 2.0);
    const double above = mesh->distance(x) - ball->distance(x);
    ASSERT_GE(above, -1e-9);  // the facets lie within the sphere
    ASSERT_LE(above, 2 * sagitta);
    if (std::abs(ball->distance(x)) > 0.5) continue;
    ASSERT_GT(mesh->normal(x).dot(x.normalized()), 0.98);
  }
  EXPECT_NEAR(mesh->inradius(), 1.0, 2 * sagitta);
  EXPECT_NEAR(sampling::measure(*mesh, 3, 0.1) / (4 * pi / 3), 1, 5e-3);
}

TEST(MeshLevelSet, NormalsOnTheSurfaceAverageTheAdjacentFaces) {
  const Shape mesh = make_mesh(box_mesh({0, 0, 0}, {1, 1, 1}));
  EXPECT_LT((mesh->normal({0.3, 0.4, 1}) - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((mesh->normal({1, 1, 1}) - Vec3::Ones().normalized()).norm(), 1e-12);
  EXPECT_LT((mesh->normal({1, 0.5, 1}) - Vec3(1, 0, 1).normalized()).norm(), 1e-12);
}

TEST(MeshLevelSet, InradiusOfAThinPlateIsHalfItsThickness) {
  EXPECT_NEAR(make_mesh(box_mesh({0, 0, 0}, {5, 3, 0.01}))->inradius(), 0.005, 1e-8);
}

}  // namespace
}  // namespace snowshed::geometry
