#include "snowshed/sampling/particle_voxels.hpp"

#include <algorithm>
#include <limits>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/sampling/seeding.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::sampling {
namespace {

using namespace geometry_testing;
constexpr double voxel = 0.01;

/// Returns the distance from a point inside the solid to its surface in direction u.
double reach(const geometry::LevelSet& solid, const Vec3& from, const Vec3& u) {
  double s = 0;
  while (solid.distance(from + s * u) < 0) s += 1e-4;
  return s;
}

class Pile : public ::testing::TestWithParam<int> {
 protected:
  static constexpr double height = 0.1, length = 0.4;  // a flat dome on z = 0
  const int dimension = GetParam();
  const double per_voxel = dimension == 2 ? 6 : 8;
  const geometry::Shape pile = geometry::subtract(geometry::make_sphere({0, 0, -0.15}, 0.25),
                                                  {geometry::make_plane({0, 0, 0}, {0, 0, 1})});
  const std::vector<Vec3> points =
      seed(*pile, dimension, voxel, per_voxel, SeedPattern::poisson, 3);
  const geometry::Shape solid = particles_to_level_set(
      points, dimension, voxel, particle_radius(dimension, voxel, per_voxel));
};

TEST_P(Pile, KeepsVolumeHeightAndLength) {
  EXPECT_NEAR(measure(*solid, dimension, voxel) / measure(*pile, dimension, voxel), 1, 0.02);
  // Height and length of a stack are those of its outermost particles (thesis A.4).
  const auto cloud_extent = [&](const Vec3& u) {
    double farthest = -1;
    for (const Vec3& x : points) farthest = std::max(farthest, x.dot(u));
    return farthest;
  };
  const auto extent = [&](const Vec3& u) {
    const double cloud = cloud_extent(u);
    double farthest = cloud - voxel;
    for (const Vec3& x : points)
      if (x.dot(u) > cloud - voxel) farthest = std::max(farthest, x.dot(u) + reach(*solid, x, u));
    return farthest;
  };
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  EXPECT_NEAR(extent(z), cloud_extent(z), voxel / 2);
  EXPECT_NEAR(extent(z), height, voxel / 2);
  EXPECT_NEAR(extent(x) + extent(-x), cloud_extent(x) + cloud_extent(-x), voxel / 2);
  EXPECT_NEAR(extent(x) + extent(-x), length, voxel);  // no particles in the sharp tips
}

TEST_P(Pile, HasNoHolesAndContainsItsParticles) {
  const auto is_inside = [&](const Vec3& x) { return solid->distance(x) < 0; };
  const auto inside = std::count_if(points.begin(), points.end(), is_inside);
  EXPECT_GT(inside, 0.99 * points.size());
  Random random(1);
  for (int n = 0; n < 5000; ++n) {
    Vec3 x = random_point(random, 0.25);
    if (dimension == 2) x.y() = 0;
    if (std::abs(pile->distance(x)) < 0.75 * voxel) continue;
    ASSERT_EQ(solid->distance(x) < 0, pile->distance(x) < 0) << x.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Pile, ::testing::Values(2, 3));

TEST(ParticlesToLevelSet, ASingleParticleIsABall) {
  const Vec3 x(0.3, -0.2, 0.1);
  const geometry::Shape ball = particles_to_level_set({x}, 3, voxel, 0.02);
  EXPECT_NEAR(measure(*ball, 3, voxel) / (4 * pi / 3 * 8e-6), 1, 0.05);
  EXPECT_NEAR(ball->distance(x), -0.02, 2e-4);
  EXPECT_LT((ball->normal(x + Vec3(0.015, 0, 0)) - Vec3::UnitX()).norm(), 0.05);
}

TEST(ParticlesToLevelSet, FillsGapsButKeepsValleys) {
  const double r = 0.006;
  const auto pair = [&](double gap) { return std::vector<Vec3>{{0, 0, 0}, {gap, 0, 0}}; };
  EXPECT_LT(particles_to_level_set(pair(0.016), 2, voxel, r)->distance({0.008, 0, 0}), 0);
  EXPECT_GT(particles_to_level_set(pair(0.08), 2, voxel, r)->distance({0.04, 0, 0}), 0.01);
}

TEST(ParticlesToLevelSet, KeepsIsolatedParticles) {
  Random random(5);
  for (const int dimension : {2, 3})
    for (int n = 0; n < 50; ++n) {
      Vec3 x = random_point(random, 0.1);
      if (dimension == 2) x.y() = 0;
      const geometry::Shape ball = particles_to_level_set({x, {0.3, 0, 0}}, dimension, voxel, 1e-3);
      EXPECT_LT(ball->distance(x), 0) << x.transpose();
      const auto seeds = seed(*ball, dimension, voxel, 6, SeedPattern::poisson, n);
      const auto near = [&](const Vec3& particle) { return (particle - x).norm() < 0.6 * voxel; };
      EXPECT_GE(std::count_if(seeds.begin(), seeds.end(), near), 1) << x.transpose();
    }
}

TEST(ParticlesToLevelSet, RefusesInvalidParticles) {
  const double nan = std::nan("");
  expect_input_error([] { particles_to_level_set({}, 2, voxel, 1e-3); }, "no particles");
  expect_input_error([&] { particles_to_level_set({{0, 0, nan}}, 2, voxel, 1e-3); }, "finite");
  expect_input_error([] { particles_to_level_set({{0, 0, 0}, {900, 900, 900}}, 3, voxel, 1e-3); },
                     "grid nodes");
  expect_input_error([] { particles_to_level_set({{0, 0, 0}}, 2, 0, 1e-3); }, "voxel size");
  expect_input_error([] { particles_to_level_set({{0, 0, 0}}, 2, voxel, -1); }, "radius");
}

}  // namespace
}  // namespace snowshed::sampling
