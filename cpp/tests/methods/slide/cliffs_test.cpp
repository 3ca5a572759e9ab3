#include "snowshed/methods/slide/cliffs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/terrain_testing.hpp"

namespace snowshed::methods::slide {
namespace {

/// A slope of 17 degrees with one node of another height.
geometry::HeightField with_node(double height, double cell = 5, double low = 900) {
  geometry::HeightField f =
      geometry::terrain_of(20, 20, cell, [=](double x, double) { return low - 0.3 * x; });
  f.heights[f.index(10, 8)] = height;
  return f;
}

geometry::Polygon square(double west, double south, double side) {
  return {{{west, south}, {west + side, south}, {west + side, south + side}, {west, south + side}},
          {}};
}

TEST(Cliffs, ZerosForMissingElevationsAreDetected) {
  const std::string message = impossible_cliff(with_node(0), 70);
  EXPECT_NE(message.find("beside 0 m within 5 m, at ("), std::string::npos) << message;
  EXPECT_NE(impossible_cliff(with_node(0, 5, 60), 70), "");  // 45 m, to exactly 0
  EXPECT_EQ(impossible_cliff(with_node(1, 5, 60), 70), "");  // a pit
  EXPECT_NE(impossible_cliff(with_node(1), 70), "");         // 884 m
  EXPECT_EQ(impossible_cliff(with_node(800), 70), "");       // a face of 85 m
  EXPECT_EQ(impossible_cliff(with_node(0, 5, 20), 70), "");  // the sea
  EXPECT_EQ(impossible_cliff(with_node(std::nan("")), 70), "");
  EXPECT_EQ(impossible_cliff(with_node(0), 90), "");
}

TEST(Cliffs, OnlyCliffsUnderTheAreaCount) {
  const geometry::HeightField f = with_node(860);  // 25 m lower than its neighbours at (50, 40)
  EXPECT_EQ(impossible_cliff(f, 70), "");
  EXPECT_NE(cliff_under(square(30, 30, 30), f, 70), "");
  EXPECT_NE(cliff_under(square(30, 30, 16), f, 70), "");  // beside it
  EXPECT_EQ(cliff_under(square(60, 60, 20), f, 70), "");
  EXPECT_EQ(cliff_under(square(30, 30, 30), f, 80), "");
  EXPECT_EQ(cliff_under(square(30, 30, 30), with_node(878), 50), "");  // 9 m: a rock
}

TEST(Cliffs, AnAreaMayReachBeyondTheField) {
  EXPECT_EQ(cliff_under(square(-1e9, -1e9, 2e9), with_node(885), 70), "");
}

}  // namespace
}  // namespace snowshed::methods::slide
