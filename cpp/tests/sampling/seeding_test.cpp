#include "snowshed/sampling/seeding.hpp"

#include <algorithm>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/particles/point_grid.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::sampling {
namespace {

using namespace geometry_testing;
constexpr double voxel_edge = 0.01;
constexpr SeedPattern patterns[] = {SeedPattern::regular, SeedPattern::jittered,
                                    SeedPattern::poisson};

geometry::Shape tilted_slab_2d() {
  return geometry::transform(geometry::make_box(Vec3::Zero(), Vec3(0.5, geometry::infinity, 0.05)),
                             rotation_about_y(0.7), {0.1, 0, 1.2});
}

geometry::Shape tilted_slab_3d() {
  return geometry::make_plate({0.1, 0, 1.2}, {std::sin(0.7), 0, std::cos(0.7)}, 0.2, 0.1, 0.03);
}

geometry::Shape dome() {
  return geometry::subtract(geometry::make_sphere({0, 0, -0.05}, 0.1),
                            {geometry::make_plane({0, 0, 0}, {0, 0, 1})});
}

void expect_strictly_inside(const geometry::LevelSet& shape, const std::vector<Vec3>& points) {
  for (const Vec3& x : points) ASSERT_LT(shape.distance(x), 0) << x.transpose();
}

double min_spacing(const std::vector<Vec3>& points, double reach) {
  const particles::PointGrid grid(points, reach);
  double min_separation = reach;
  for (std::size_t i = 0; i < points.size(); ++i)
    grid.for_each_near(points[i], [&](std::uint32_t j, const Vec3& other) {
      if (j != i) min_separation = std::min(min_separation, (other - points[i]).norm());
    });
  return min_separation;
}

TEST(Seeding, PointsAreStrictlyInsideAndAsManyAsExpected) {
  for (const SeedPattern pattern : patterns) {
    for (const geometry::Shape& shape : {tilted_slab_2d(), dome()}) {
      const auto points = seed(*shape, 2, voxel_edge, 6, pattern, 1);
      expect_strictly_inside(*shape, points);
      const auto expected = expected_count(*shape, 2, voxel_edge, 6, pattern);
      EXPECT_NEAR(points.size(), expected, shape->oriented_box() ? 0 : 0.05 * expected);
      for (const Vec3& x : points) ASSERT_EQ(x.y(), 0);
    }
    for (const geometry::Shape& shape : {tilted_slab_3d(), dome()}) {
      const auto points = seed(*shape, 3, voxel_edge, 8, pattern, 1);
      expect_strictly_inside(*shape, points);
      const auto expected = expected_count(*shape, 3, voxel_edge, 8, pattern);
      EXPECT_NEAR(points.size(), expected, shape->oriented_box() ? 0 : 0.05 * expected);
    }
  }
}

TEST(Seeding, PoissonGivesTheCountRoundedUp) {
  EXPECT_EQ(seed(*tilted_slab_2d(), 2, voxel_edge, 6, SeedPattern::poisson, 1).size(), 1500u);
  EXPECT_EQ(seed(*tilted_slab_3d(), 3, voxel_edge, 8, SeedPattern::poisson, 1).size(), 4800u);
  const double volume = measure(*dome(), 3, voxel_edge);
  EXPECT_EQ(seed(*dome(), 3, voxel_edge, 6, SeedPattern::poisson, 1).size(),
            std::ceil(6 * volume / 1e-6));
  // A solid smaller than a voxel still gets a particle.
  EXPECT_EQ(seed(*geometry::make_sphere({0, 0, 0}, 1e-3), 3, voxel_edge, 6, SeedPattern::poisson, 1)
                .size(),
            1u);
}

TEST(Seeding, RegularTilesATiltedSlabExactly) {
  const geometry::Shape slab = tilted_slab_3d();
  const auto points = seed(*slab, 3, voxel_edge, 8, SeedPattern::regular, 1);
  ASSERT_EQ(points.size(), 40u * 20u * 6u);
  const geometry::OrientedBox box = *slab->oriented_box();
  for (const Vec3& x : points) {
    const Vec3 cells = (box.axes.transpose() * (x - box.center) + box.half) / 0.005;
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(cells[axis] - std::floor(cells[axis]), 0.5, 1e-6);
  }
}

TEST(Seeding, LatticesInBoxesHaveAtLeastTheRequestedCount) {
  for (const double per_voxel : {1.0, 4.0, 5.0, 6.0, 7.3, 8.0}) {
    const geometry::Shape box = geometry::make_box(Vec3::Zero(), Vec3(0.101, 0.043, 0.0217));
    const double requested = per_voxel * measure(*box, 3, voxel_edge) / 1e-6;
    EXPECT_GE(seed(*box, 3, voxel_edge, per_voxel, SeedPattern::regular, 1).size(),
              requested - 1e-6);
    EXPECT_GE(seed(*box, 3, voxel_edge, per_voxel, SeedPattern::jittered, 1).size(),
              requested - 1e-6);
  }
}

TEST(Seeding, JitteredPutsOnePointInEachCell) {
  const geometry::Shape box = geometry::make_box(Vec3(0.1, 0.05, 0.025), Vec3(0.2, 0.1, 0.05));
  const auto points = seed(*box, 3, voxel_edge, 8, SeedPattern::jittered, 1);
  std::vector<int> counts(40 * 20 * 10, 0);
  for (const Vec3& x : points)
    ++counts[(int(x.x() / 0.005) * 20 + int(x.y() / 0.005)) * 10 + int(x.z() / 0.005)];
  EXPECT_EQ(*std::min_element(counts.begin(), counts.end()), 1);
  EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), 1);
}

TEST(Seeding, PoissonKeepsItsDistance) {
  // In mean spacings, the smallest distance is 1.07 (2D) and 1.12 (3D) in the densest packing and
  // about 0 in white noise.
  const double spacing_2d = voxel_edge / std::sqrt(6.0), spacing_3d = voxel_edge / 2;
  const auto flat = seed(*tilted_slab_2d(), 2, voxel_edge, 6, SeedPattern::poisson, 5);
  EXPECT_GT(min_spacing(flat, 2 * spacing_2d), 0.6 * spacing_2d);
  const auto solid = seed(*tilted_slab_3d(), 3, voxel_edge, 8, SeedPattern::poisson, 5);
  EXPECT_GT(min_spacing(solid, 2 * spacing_3d), 0.6 * spacing_3d);
}

TEST(Seeding, PoissonIsAsDenseAtTheSurfaceAsInside) {
  const geometry::Shape slab = geometry::make_box(Vec3::Zero(), Vec3(0.4, 0.3, 0.04));
  const auto points = seed(*slab, 3, voxel_edge, 8, SeedPattern::poisson, 2);
  // Counts in layers one spacing thick, from the top.
  std::vector<double> layers(8, 0);
  for (const Vec3& x : points) ++layers[std::min(7, int((0.02 - x.z()) / 0.005))];
  for (const double count : layers) EXPECT_NEAR(count / (points.size() / 8.0), 1, 0.06);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : points) mean += x / points.size();
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 4e-4);
}

TEST(Seeding, DependsOnlyOnTheSeed) {
  for (const SeedPattern pattern : {SeedPattern::jittered, SeedPattern::poisson}) {
    const auto points = [&](std::uint64_t s) {
      return seed(*dome(), 2, voxel_edge, 6, pattern, s);
    };
    EXPECT_EQ(points(7), points(7));
    EXPECT_NE(points(7), points(8));
  }
}

TEST(Seeding, RefusesInvalidSolidsAndCounts) {
  const auto seed_it = [](const geometry::Shape& shape, int dimension, double dx,
                          double per_voxel) {
    return [=] { seed(*shape, dimension, dx, per_voxel, SeedPattern::poisson, 1); };
  };
  const geometry::Shape box = geometry::make_box(Vec3::Zero(), Vec3(1, 1, 1));
  expect_input_error(seed_it(geometry::make_plane({0, 0, 0}, {0, 0, 1}), 3, voxel_edge, 8),
                     "unbounded");
  expect_input_error(seed_it(box, 3, 1e-4, 8), "2e8");
  expect_input_error(seed_it(geometry::make_sphere({0, 0, 0}, 1e5), 3, 1e-3, 8), "voxels");
  expect_input_error(seed_it(box, 3, 0, 8), "voxel size");
  expect_input_error(seed_it(box, 3, voxel_edge, -1), "particles per voxel");
  expect_input_error(seed_it(box, 3, voxel_edge, std::nan("")), "particles per voxel");
  expect_input_error(seed_it(box, 4, voxel_edge, 8), "2 or 3");
  const geometry::Shape nothing = geometry::subtract(box, {geometry::make_sphere({0, 0, 0}, 2)});
  expect_input_error(seed_it(nothing, 3, 0.1, 8), "empty");
  EXPECT_THROW(expected_count(*box, 3, 1e-4, 8, SeedPattern::regular), InputError);
}

TEST(Seeding, StopsOnRequest) {
  const geometry::Shape ball = geometry::make_sphere({0, 0, 0}, 0.3);
  for (const SeedPattern pattern : patterns) {
    int calls = 0;
    const auto third = [&] { return ++calls == 3; };
    EXPECT_THROW(seed(*ball, 3, voxel_edge, 8, pattern, 1, third), Stopped);
    EXPECT_EQ(calls, 3);
  }
}

}  // namespace
}  // namespace snowshed::sampling
