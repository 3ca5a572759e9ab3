#include "snowshed/geometry/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snowshed::geometry {
namespace {

const Ring square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
const Ring clockwise{{0, 4}, {4, 4}, {4, 0}, {0, 0}};

TEST(Polygon, ContainsPointsInsideExceptInHoles) {
  const Polygon p{square, {{{1, 1}, {2, 1}, {2, 2}, {1, 2}}}};
  EXPECT_TRUE(contains(p, {3, 3}));
  EXPECT_FALSE(contains(p, {1.5, 1.5}));
  EXPECT_FALSE(contains(p, {5, 1}));
}

TEST(Polygon, ContainmentIsRightLevelWithACorner) {
  const Ring diamond{{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  EXPECT_TRUE(contains(diamond, {0.5, 0}));
  EXPECT_FALSE(contains(diamond, {-2, 0}));
  EXPECT_FALSE(contains(diamond, {2, 0}));
}

TEST(Polygon, SignedAreaOfClockwiseRingsIsNegative) {
  EXPECT_DOUBLE_EQ(twice_signed_area(square), 32);
  EXPECT_DOUBLE_EQ(twice_signed_area(clockwise), -32);
}

TEST(Polygon, AreaWithinRectanglesAddsUp) {
  const Polygon u{{{0.3, 0.2}, {6.1, 0}, {6, 5}, {4, 5.5}, {4, 2}, {2, 2}, {2, 5}, {0, 5}},
                  {{{0.5, 0.5}, {0.5, 1.5}, {5.5, 1.5}, {5.5, 0.5}}}};
  double sum = 0;
  for (int j = -1; j < 7; ++j)
    for (int i = -1; i < 7; ++i) sum += area_within(u, {double(i), double(j)}, {i + 1.0, j + 1.0});
  EXPECT_NEAR(sum, std::abs(twice_signed_area(u.outline)) / 2 - 5.0, 1e-12);
  // The rectangle between the arms has no area, though their ends lie on either side of it.
  EXPECT_EQ(area_within(u, {2.5, 3}, {3.5, 4}), 0.0);
}

TEST(Polygon, WidensRingsOfEitherSense) {
  for (const Ring& ring : {square, clockwise}) {
    const Ring wide = widened(ring, 0.5);
    ASSERT_EQ(wide.size(), 4u);
    EXPECT_NEAR(std::abs(twice_signed_area(wide)), 2 * 25, 1e-12);  // mitred corners
  }
}

TEST(Polygon, WideningCutsSharpCornersOff) {
  const Ring needle{{0, 0}, {10, 0.5}, {0, 1}};
  double reach = 0;
  for (const Point2& p : widened(needle, 0.1)) reach = std::max(reach, p[0]);
  EXPECT_GT(reach, 10.1);
  EXPECT_LT(reach, 10.0 + 4 * 0.1 + 1e-9);  // a full mitre would reach 2 m farther
}

TEST(Polygon, DetectsEdgesThatCross) {
  EXPECT_FALSE(crosses_itself(square));
  EXPECT_TRUE(crosses_itself({{0, 0}, {4, 4}, {4, 0}, {0, 4}}));
  EXPECT_TRUE(crosses_itself({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}));  // touches
}

}  // namespace
}  // namespace snowshed::geometry
