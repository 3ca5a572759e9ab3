#include "snowshed/geometry/height_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/terrain_testing.hpp"

namespace snowshed::geometry {
namespace {

TEST(HeightField, APositionIsACellAndAnOffset) {
  const CellPosition p = find_cell(2.25, 1.5, 4, 3);
  EXPECT_EQ(p.column, 2);
  EXPECT_EQ(p.row, 1);
  EXPECT_DOUBLE_EQ(p.east, 0.25);
  EXPECT_DOUBLE_EQ(p.north, 0.5);
  EXPECT_FALSE(find_cell(3.0, 1.0, 4, 3).inside());  // no cell begins at the last node
  EXPECT_FALSE(find_cell(-1e-9, 1.0, 4, 3).inside());
  EXPECT_FALSE(find_cell(std::nan(""), 1.0, 4, 3).inside());
}

TEST(HeightField, ResamplingKeepsAQuadraticSurface) {
  const auto surface = [](double x, double y) { return 3 + 0.2 * x - 0.1 * y + 0.01 * x * y; };
  const HeightField fine = resampled(terrain_of(12, 9, 5.0, surface), 2.0);
  ASSERT_EQ(fine.columns, 28);  // 55 m
  ASSERT_EQ(fine.rows, 21);
  for (int j = 0; j < fine.rows; ++j)
    for (int i = 0; i < fine.columns; ++i)
      ASSERT_NEAR(fine.height(i, j), surface(2.0 * i, 2.0 * j), 1e-10);
}

TEST(HeightField, ResamplingKeepsHolesAndKnownNeighbours) {
  HeightField f = terrain_of(9, 9, 1.0, [](double x, double) { return x; });
  f.heights[f.index(4, 4)] = std::nan("");
  const HeightField fine = resampled(f, 0.5);
  EXPECT_TRUE(std::isnan(fine.height(8, 8)));
  EXPECT_NEAR(fine.height(5, 8), 2.5, 1e-12);  // the four nodes around are known
}

}  // namespace
}  // namespace snowshed::geometry
