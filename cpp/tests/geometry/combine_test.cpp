#include "snowshed/geometry/combine.hpp"

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/primitives.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

const Shape large_ball = make_sphere({0, 0, 0}, 1.0);
const Shape small_ball = make_sphere({1, 0, 0}, 0.5);

TEST(Combine, AUnionHasTheSmallestDistance) {
  const Shape both = unite({large_ball, small_ball});
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    const Vec3 x = random_point(random, 2.0);
    const double a = large_ball->distance(x), b = small_ball->distance(x);
    EXPECT_EQ(both->distance(x), std::min(a, b));
    EXPECT_EQ(both->normal(x), (a <= b ? large_ball : small_ball)->normal(x));
  }
  EXPECT_DOUBLE_EQ(both->bounds().max.x(), 1.5);
  EXPECT_DOUBLE_EQ(both->bounds().min.x(), -1.0);
  EXPECT_DOUBLE_EQ(both->inradius(), 1.0);
  expect_normal_is_gradient(*both, 2.0);
}

TEST(Combine, ADifferenceExcludesTheOtherSolids) {
  const Shape bitten = subtract(large_ball, {small_ball, make_sphere({0, 0, 1}, 0.5)});
  Random random(6);
  for (int n = 0; n < 500; ++n) {
    const Vec3 x = random_point(random, 1.5);
    const bool inside =
        x.norm() < 1 && (x - Vec3(1, 0, 0)).norm() > 0.5 && (x - Vec3(0, 0, 1)).norm() > 0.5;
    EXPECT_EQ(bitten->distance(x) < 0, inside);
  }
  // The surface of the hole faces the centre of the ball that was subtracted.
  EXPECT_LT((bitten->normal({0.55, 0, 0}) - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(bitten->inradius(), 1.0);
  expect_normal_is_gradient(*bitten, 1.5);
  expect_bounds_hold(*bitten, 1.5);
}

TEST(Combine, ATransformRotatesThenTranslates) {
  const Mat3 quarter = rotation_about_y(pi / 2);  // turns the x axis to -z
  const Shape rod = make_box(Vec3(2, 0, 0), Vec3(2, 0.2, 0.2));
  const Shape moved = transform(rod, quarter, {10, 0, 0});
  EXPECT_NEAR(moved->distance({10, 0, -2}), -0.1, 1e-12);
  EXPECT_NEAR(moved->distance({10, 0, -4}), 1.0, 1e-12);
  EXPECT_LT((moved->normal({10, 0, -4}) + Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(moved->bounds().min.z(), -3, 1e-12);
  EXPECT_NEAR(moved->bounds().max.x(), 10.1, 1e-12);
  ASSERT_TRUE(moved->oriented_box());
  EXPECT_LT((moved->oriented_box()->center - Vec3(10, 0, -2)).norm(), 1e-12);
}

TEST(Combine, RotatedPlaneSolidsStayBoundedInTheirPlane) {
  const Shape box = make_box(Vec3::Zero(), Vec3(2, infinity, 1));
  const Bounds bounds = transform(box, rotation_about_y(pi / 2), Vec3::Zero())->bounds();
  EXPECT_NEAR(bounds.max.x(), 0.5, 1e-12);
  EXPECT_NEAR(bounds.max.z(), 1.0, 1e-12);
  EXPECT_EQ(bounds.max.y(), infinity);
}

TEST(Combine, DilationMovesTheSurfaceOutward) {
  const Shape grown = dilate(make_box(Vec3::Zero(), Vec3::Ones()), 0.25);
  EXPECT_DOUBLE_EQ(grown->distance({2, 0, 0}), 1.25);
  EXPECT_DOUBLE_EQ(grown->bounds().max.y(), 0.75);
  EXPECT_DOUBLE_EQ(grown->inradius(), 0.75);
  EXPECT_FALSE(grown->oriented_box());
  expect_bounds_hold(*grown, 1.0);
}

}  // namespace
}  // namespace snowshed::geometry
