#include "snowshed/particles/point_grid.hpp"

#include <set>

#include "geometry/geometry_testing.hpp"

namespace snowshed::particles {
namespace {

using namespace geometry_testing;

void expect_all_near_visited(const std::vector<Vec3>& points, double edge) {
  const PointGrid grid(points, edge);
  for (const Vec3& x : points) {
    std::set<std::uint32_t> near;
    grid.for_each_near(x, [&](std::uint32_t i, const Vec3& point) {
      EXPECT_EQ(point, points[i]);
      EXPECT_TRUE(near.insert(i).second) << "visited twice";
    });
    for (std::uint32_t i = 0; i < points.size(); ++i)
      ASSERT_TRUE(near.count(i) || (points[i] - x).norm() > edge);
  }
}

TEST(PointGrid, FindsEveryPointWithinAnEdge) {
  Random random(20);
  std::vector<Vec3> points(400), flat(400);
  for (Vec3& x : points) x = random_point(random, 1.0);
  for (Vec3& x : flat) {
    x = random_point(random, 1.0);
    x.y() = 0;
  }
  expect_all_near_visited(points, 0.3);
  expect_all_near_visited(flat, 0.1);
}

TEST(PointGrid, AnEmptyGridVisitsNothing) {
  const PointGrid grid({}, 1.0);
  grid.for_each_near(Vec3::Zero(), [](std::uint32_t, const Vec3&) { FAIL(); });
}

TEST(PointGrid, StopsDuringTheSort) {
  Random random(21);
  std::vector<Vec3> points(50000);
  for (Vec3& x : points) x = random_point(random, 1.0);
  int calls = 0;
  const auto never = [&] { return ++calls, false; };
  PointGrid(points, 0.05, never);
  EXPECT_GT(calls, 100);  // sorting makes more than ten comparisons per point
  for (int turn : {1, calls / 2, calls}) {
    int remaining = turn;
    EXPECT_THROW(PointGrid(points, 0.05, [&] { return --remaining == 0; }), Stopped);
  }
}

}  // namespace
}  // namespace snowshed::particles
