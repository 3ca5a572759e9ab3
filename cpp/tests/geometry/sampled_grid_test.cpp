#include "snowshed/geometry/sampled_grid.hpp"

#include <cmath>
#include <limits>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

GridSamples sampled(const LevelSet& shape, const Vec3& origin, double spacing,
                    const std::array<std::size_t, 3>& counts) {
  GridSamples s{origin, spacing, counts, {}};
  for (std::size_t i = 0; i < counts[0]; ++i)
    for (std::size_t j = 0; j < counts[1]; ++j)
      for (std::size_t k = 0; k < counts[2]; ++k)
        s.values.push_back(float(shape.distance(origin + spacing * Vec3(i, j, k))));
  return s;
}

TEST(SampledGrid, IsExactForAPlaneWithinTheGrid) {
  const Shape plane = make_plane({0.1, 0.2, 0.3}, {1, 2, 3});
  const Shape grid = make_sampled_grid(sampled(*plane, {-1, -1, -1}, 0.1, {21, 21, 21}), "g");
  Random random(17);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 x = random_point(random, 0.9);
    const double border = x.cwiseAbs().maxCoeff() - 1;  // where the solid ends
    ASSERT_NEAR(grid->distance(x), std::max(plane->distance(x), border), 1e-6);
    if (border > plane->distance(x) - 0.1) continue;  // the edge between both
    ASSERT_LT((grid->normal(x) - plane->normal(x)).norm(), 1e-5);
  }
}

TEST(SampledGrid, ApproachesTheSphere) {
  const Shape ball = make_sphere({0.1, 0, -0.1}, 0.6);
  const Shape grid = make_sampled_grid(sampled(*ball, {-1, -1, -1}, 0.05, {41, 41, 41}), "g");
  Random random(18);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 x = random_point(random, 1.0);
    if (std::abs(ball->distance(x)) > 0.3) continue;
    ASSERT_NEAR(grid->distance(x), ball->distance(x), 0.003);
    ASSERT_GT(grid->normal(x).dot(ball->normal(x)), 0.999);
  }
  EXPECT_NEAR(grid->inradius(), 0.6, 0.05);
  EXPECT_NEAR(sampling::measure(*grid, 3, 0.05) / sampling::measure(*ball, 3, 0.05), 1, 0.01);
  expect_bounds_hold(*grid, 1.0);
  EXPECT_LT(grid->bounds().max.x(), 0.8);
}

TEST(SampledGrid, AddsTheDistanceBeyondTheGrid) {
  const Shape ball = make_sphere({0, 0, 0}, 0.5);
  const Shape grid = make_sampled_grid(sampled(*ball, {-1, -1, -1}, 0.1, {21, 21, 21}), "g");
  EXPECT_NEAR(grid->distance({4, 0, 0}), 3.5, 1e-6);
  EXPECT_NEAR(grid->distance({1, 1 + 3, 1 + 4}), std::sqrt(3.0) - 0.5 + 5, 1e-6);
  EXPECT_LT((grid->normal({4, 0, 0}) - Vec3::UnitX()).norm(), 1e-3);
}

TEST(SampledGrid, EndsAtTheBorderOfTheGrid) {
  for (const std::size_t along_y : {std::size_t(5), std::size_t(1)}) {
    const GridSamples all_inside{
        {0, 0, 0}, 0.1, {5, along_y, 5}, std::vector<float>(25 * along_y, -1)};
    const Shape grid = make_sampled_grid(all_inside, "g");
    const int dimension = along_y == 1 ? 2 : 3;
    EXPECT_NEAR(sampling::measure(*grid, dimension, 0.02), std::pow(0.4, dimension), 1e-3);
    EXPECT_NEAR(grid->inradius(), 0.2, 1e-6);
    EXPECT_GT(grid->distance({0.5, 0.2, 0.2}), 0.09);
    EXPECT_LE(grid->bounds().max.x(), 0.4 + 1e-12);
  }
}

TEST(SampledGrid, ASingleSampleAlongYMeansConstantInY) {
  const Shape ball = make_sphere({0, 0, 0}, 0.5);
  const Shape grid = make_sampled_grid(sampled(*ball, {-1, 0, -1}, 0.1, {21, 1, 21}), "g");
  EXPECT_EQ(grid->distance({0.3, 50, 0.2}), grid->distance({0.3, 0, 0.2}));
  EXPECT_EQ(grid->normal({0.45, 3, 0}).y(), 0);
  EXPECT_EQ(grid->bounds().max.y(), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(sampling::measure(*grid, 2, 0.05) / (pi * 0.25), 1, 0.02);
}

TEST(SampledGrid, BoundsHoldWhereTheSolidReachesTheEdgeOfTheGrid) {
  const Shape box = make_box(Vec3(0, 0, 0), Vec3(4, 1, 1));
  const Shape grid = make_sampled_grid(sampled(*box, {-1, -1, -1}, 0.1, {21, 21, 21}), "g");
  EXPECT_LT(grid->distance({0.9, 0, 0}), 0);
  EXPECT_GT(grid->distance({1.1, 0, 0}), 0);  // where there are no samples
  expect_bounds_hold(*grid, 2.0);
}

TEST(SampledGrid, RefusesInvalidSamples) {
  const auto check = [](const GridSamples& s, const std::string& expected) {
    expect_input_error([&] { make_sampled_grid(s, "g.npy"); }, expected);
  };
  const GridSamples good = sampled(*make_sphere({0, 0, 0}, 0.5), {-1, -1, -1}, 0.5, {5, 5, 5});
  GridSamples bad = good;
  bad.values[7] = std::nanf("");
  check(bad, "sample [0][1][2] is not finite");
  bad = good;
  for (float& v : bad.values) v = v < 0 ? -1 : 1;
  check(bad, "not a signed distance");
  bad = good;
  for (float& v : bad.values) v += 10;
  check(bad, "empty");
  bad = good;
  bad.values.pop_back();
  check(bad, "fit");
  bad = good;
  bad.counts = {1, 25, 5};
  check(bad, "at least 2");
  bad.counts = {std::size_t(1) << 40, std::size_t(1) << 40, 5};
  check(bad, "along axis");
}

}  // namespace
}  // namespace snowshed::geometry
