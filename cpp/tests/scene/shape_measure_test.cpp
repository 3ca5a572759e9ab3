#include "snowshed/scene/shape_measure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "snowshed/core/angles.hpp"

namespace snowshed::scene {
namespace {

ShapeSpec make(const char* type) {
  ShapeSpec shape;
  shape.type = type;
  return shape;
}

ShapeSpec box(const Vec3& center, const Vec3& size) {
  ShapeSpec shape = make("box");
  shape.center = center;
  shape.size = size;
  return shape;
}

ShapeSpec rod(const char* type) {
  ShapeSpec shape = make(type);
  shape.from = {0, 0, 0};
  shape.to = {0, 0, 2};
  shape.radius = 0.5;
  return shape;
}

void expect_bounds(const ShapeSpec& shape, const Vec3& min, const Vec3& max) {
  const auto bounds = shape_bounds(shape);
  ASSERT_TRUE(bounds);
  EXPECT_LT((bounds->min() - min).norm(), 1e-12) << bounds->min().transpose();
  EXPECT_LT((bounds->max() - max).norm(), 1e-12) << bounds->max().transpose();
}

TEST(ShapeMeasure, SolidsHaveTheirBoundsAndVolumes) {
  expect_bounds(box({1, 2, 3}, {2, 4, 6}), {0, 0, 0}, {2, 4, 6});
  EXPECT_DOUBLE_EQ(*shape_volume(box({1, 2, 3}, {2, 4, 6}), 3), 48);
  EXPECT_DOUBLE_EQ(*shape_volume(box({1, 2, 3}, {2, 0, 6}), 2), 12);

  ShapeSpec ball = make("sphere");
  ball.center = {1, 0, 0};
  ball.radius = 2;
  expect_bounds(ball, {-1, -2, -2}, {3, 2, 2});
  EXPECT_DOUBLE_EQ(*shape_volume(ball, 3), 32 * pi / 3);
  EXPECT_DOUBLE_EQ(*shape_volume(ball, 2), 4 * pi);

  expect_bounds(rod("cylinder"), {-0.5, -0.5, 0}, {0.5, 0.5, 2});
  EXPECT_DOUBLE_EQ(*shape_volume(rod("cylinder"), 3), pi / 2);
  EXPECT_DOUBLE_EQ(*shape_volume(rod("cylinder"), 2), 2);

  expect_bounds(rod("capsule"), {-0.5, -0.5, -0.5}, {0.5, 0.5, 2.5});
  EXPECT_DOUBLE_EQ(*shape_volume(rod("capsule"), 3), pi / 2 + pi / 6);
}

TEST(ShapeMeasure, ASlantedCylinderReachesItsRim) {
  ShapeSpec rod45 = rod("cylinder");
  rod45.to = {1, 0, 1};
  const double rim = 0.5 * std::sqrt(0.5);
  expect_bounds(rod45, {-rim, -0.5, -rim}, {1 + rim, 0.5, 1 + rim});
}

TEST(ShapeMeasure, APlateHangsBelowItsFace) {
  ShapeSpec plate = make("plate");
  plate.center = {0, 0, 5};
  plate.length = 4;
  plate.width = 2;
  plate.thickness = 1;
  expect_bounds(plate, {-2, -1, 4}, {2, 1, 5});
  plate.normal = {3, 0, 0};  // upright: the length points down
  expect_bounds(plate, {-1, -1, 3}, {0, 1, 7});
  EXPECT_DOUBLE_EQ(*shape_volume(plate, 3), 8);
  EXPECT_DOUBLE_EQ(*shape_volume(plate, 2), 4);
}

TEST(ShapeMeasure, ATransformRotatesThenTranslates) {
  ShapeSpec turned = make("transform");
  turned.shapes = {box({1, 0, 0}, {2, 4, 6})};
  turned.angle = 90;  // about +y: x becomes -z, z becomes x
  turned.translate = {10, 0, 0};
  expect_bounds(turned, {7, -2, -2}, {13, 2, 0});
  EXPECT_DOUBLE_EQ(*shape_volume(turned, 3), 48);
}

TEST(ShapeMeasure, CombinationsAreBoundedFromAbove) {
  ShapeSpec both = make("union");
  both.shapes = {box({0, 0, 0}, {2, 2, 2}), box({5, 0, 0}, {2, 4, 2})};
  expect_bounds(both, {-1, -2, -1}, {6, 2, 1});
  EXPECT_DOUBLE_EQ(*shape_volume(both, 3), 24);
  both.type = "difference";
  expect_bounds(both, {-1, -1, -1}, {1, 1, 1});
  EXPECT_DOUBLE_EQ(*shape_volume(both, 3), 8);
}

TEST(ShapeMeasure, UnboundedShapesStayUnbounded) {
  ShapeSpec turned = make("transform");
  turned.shapes = {make("plane")};
  turned.angle = 30;
  EXPECT_FALSE(shape_bounds(turned)->sizes().allFinite());
  EXPECT_TRUE(std::isinf(*shape_volume(turned, 3)));
}

TEST(ShapeMeasure, FilesAreNotOpened) {
  EXPECT_FALSE(shape_bounds(make("mesh")));
  EXPECT_FALSE(shape_volume(make("grid"), 3));
  EXPECT_FALSE(shape_volume(make("vdb"), 3));
  ShapeSpec both = make("union");
  both.shapes = {box({0, 0, 0}, {2, 2, 2}), make("mesh")};
  EXPECT_FALSE(shape_bounds(both));
  EXPECT_FALSE(shape_volume(both, 3));
}

}  // namespace
}  // namespace snowshed::scene
