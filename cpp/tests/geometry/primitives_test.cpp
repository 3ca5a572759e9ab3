#include "snowshed/geometry/primitives.hpp"

#include "geometry/geometry_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

void expect_normals_and_bounds(const Shape& shape) {
  expect_normal_is_gradient(*shape, 2.0);
  expect_bounds_hold(*shape, 2.0);
}

TEST(Plane, DistanceIsTheHeightAboveIt) {
  const Shape plane = make_plane({1, 2, 3}, {0, 0, 5});
  EXPECT_DOUBLE_EQ(plane->distance({9, 9, 7}), 4);
  EXPECT_DOUBLE_EQ(plane->distance({9, 9, 1}), -2);
  EXPECT_EQ(plane->normal({0, 0, -4}), Vec3::UnitZ());
  EXPECT_EQ(plane->inradius(), infinity);
  EXPECT_EQ(plane->bounds().min.z(), -infinity);
}

TEST(Box, DistanceMatchesClosedForms) {
  const Shape box = make_box(Vec3(1, 1, 1), Vec3(2, 4, 6));
  EXPECT_DOUBLE_EQ(box->distance({1, 1, 1}), -1);
  EXPECT_DOUBLE_EQ(box->distance({1.5, 1, 1}), -0.5);
  EXPECT_DOUBLE_EQ(box->distance({4, 1, 1}), 2);
  EXPECT_DOUBLE_EQ(box->distance({2 + 2, 3 + 3, 4 + 6}), 7);  // 2, 3, 6 beyond a corner
  EXPECT_EQ(box->normal({1.5, 1, 1}), Vec3::UnitX());
  EXPECT_EQ(box->normal({1, -1.2, 1}), Vec3(-Vec3::UnitY()));
  EXPECT_LT((box->normal({4, 6, 10}) - Vec3(2, 3, 6) / 7).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(box->inradius(), 1);
}

TEST(Box, HasNormalsAndBoundsInAnyOrientation) {
  expect_normals_and_bounds(make_box(Vec3(0.2, -0.1, 0.3), Vec3(1.0, 1.5, 0.6)));
  Random random(3);
  expect_normals_and_bounds(
      make_box(OrientedBox{{0.1, 0.2, 0.1}, random_rotation(random), {0.5, 0.7, 0.3}}));
}

TEST(Box, MayBeUnboundedAlongY) {
  const Shape box = make_box(Vec3(0, 0, 0), Vec3(2, infinity, 1));
  EXPECT_DOUBLE_EQ(box->distance({0, 0, 0}), -0.5);
  EXPECT_DOUBLE_EQ(box->distance({4, 1e6, 4.5}), 5);
  EXPECT_LT((box->normal({4, 0, 4.5}) - Vec3(0.6, 0, 0.8)).norm(), 1e-12);
  EXPECT_EQ(box->normal({0, 3, 0.2}), Vec3::UnitZ());
  EXPECT_DOUBLE_EQ(box->inradius(), 0.5);
  EXPECT_EQ(box->bounds().max.x(), 1);
  EXPECT_EQ(box->bounds().max.y(), infinity);
}

TEST(Sphere, DistanceMatchesTheClosedForm) {
  const Shape sphere = make_sphere({1, 0, 0}, 0.5);
  Random random(4);
  for (int n = 0; n < 100; ++n) {
    const Vec3 x = random_point(random, 2.0);
    EXPECT_NEAR(sphere->distance(x), (x - Vec3(1, 0, 0)).norm() - 0.5, 1e-15);
  }
  EXPECT_NEAR(sphere->normal({1, 0, 0}).norm(), 1, 1e-15);
  expect_normals_and_bounds(sphere);
}

TEST(Cylinder, DistanceMatchesClosedForms) {
  const Shape cylinder = make_cylinder({0, 0, -1}, {0, 0, 1}, 0.5);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 0, 0}), -0.5);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 0, 0.9}), 0.9 - 1);
  EXPECT_DOUBLE_EQ(cylinder->distance({2, 0, 0}), 1.5);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 0, 4}), 3);
  EXPECT_DOUBLE_EQ(cylinder->distance({0.5 + 3, 0, 1 + 4}), 5);
  EXPECT_DOUBLE_EQ(cylinder->inradius(), 0.5);
  EXPECT_NEAR(cylinder->normal({0, 0, 0}).z(), 0,
              1e-15);  // on the axis any radial direction will do
}

TEST(Cylinder, HasNormalsAndBoundsInAnyOrientation) {
  const Shape cylinder = make_cylinder({-0.6, 0.2, -0.4}, {0.7, 0.5, 0.6}, 0.5);
  expect_normals_and_bounds(cylinder);
  const Vec3 u = Vec3(1.3, 0.3, 1.0).normalized();
  const double reach = (1.3 / 2) + 0.5 * std::sqrt(1 - u.x() * u.x());
  EXPECT_NEAR(cylinder->bounds().max.x(), 0.05 + reach, 1e-12);
}

TEST(Capsule, DistanceMatchesClosedForms) {
  const Shape capsule = make_capsule({-1, 0, 0}, {1, 0, 0}, 0.25);
  EXPECT_DOUBLE_EQ(capsule->distance({0, 0, 0}), -0.25);
  EXPECT_DOUBLE_EQ(capsule->distance({0.3, 3, 4}), 4.75);
  EXPECT_DOUBLE_EQ(capsule->distance({4, 4, 0}), 4.75);
  EXPECT_DOUBLE_EQ(capsule->inradius(), 0.25);
  EXPECT_NEAR(capsule->normal({0, 0, 0}).x(), 0, 1e-15);
  expect_normals_and_bounds(make_capsule({-0.6, 0.2, -0.4}, {0.7, 0.5, 0.6}, 0.5));
}

class TiltedPlate : public ::testing::Test {
 protected:
  const double tilt = radians(40);
  const Vec3 n{std::sin(tilt), 0, std::cos(tilt)};
  const Vec3 t{std::cos(tilt), 0, -std::sin(tilt)};
  const Vec3 top{0.1, 0.2, 0.7};
  const Shape plate = make_plate(top, n, 2.0, 1.0, 0.1);
};

TEST_F(TiltedPlate, HangsBelowItsFace) {
  EXPECT_NEAR(plate->distance(top), 0, 1e-15);
  EXPECT_NEAR(plate->distance(top + 0.3 * n), 0.3, 1e-12);
  EXPECT_NEAR(plate->distance(top + 1.5 * t - 0.05 * n), 0.5, 1e-12);
  EXPECT_NEAR(plate->distance(top + Vec3(0, 0.9, 0) - 0.05 * n), 0.4, 1e-12);
  EXPECT_NEAR(plate->distance(top - 0.3 * n), 0.2, 1e-12);
  EXPECT_NEAR(plate->inradius(), 0.05, 1e-15);
  const auto box = plate->oriented_box();
  ASSERT_TRUE(box);
  EXPECT_LT((box->axes.col(0) - t).norm(), 1e-12);
  EXPECT_LT((box->axes.col(1) - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((box->axes.col(2) - n).norm(), 1e-12);
  expect_bounds_hold(*plate, 2.0);
}

TEST_F(TiltedPlate, InnerNormalsPointToTheFacesNotTheEdges) {
  const Vec3 at_edge = top + 0.9999 * t;
  EXPECT_LT((plate->normal(at_edge - 0.01 * n) - n).norm(), 1e-12);
  EXPECT_LT((plate->normal(at_edge - 0.09 * n) + n).norm(), 1e-12);
  EXPECT_LT((plate->normal(top - 0.4999 * Vec3::UnitY() - 0.01 * n) - n).norm(), 1e-12);
}

TEST_F(TiltedPlate, OuterNormalsFollowTheBox) {
  EXPECT_LT((plate->normal(top + 1.1 * t - 0.05 * n) - t).norm(), 1e-12);
  EXPECT_LT((plate->normal(top + 1.3 * t + 0.4 * n) - (0.6 * t + 0.8 * n)).norm(), 1e-12);
}

}  // namespace
}  // namespace snowshed::geometry
