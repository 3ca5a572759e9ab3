#include "snowshed/sampling/voxel_set.hpp"

#include <algorithm>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"

namespace snowshed::sampling {
namespace {

using namespace geometry_testing;

/// Returns a box without `oriented_box`, so that its volume is measured by subdivision.
geometry::Shape anonymous(geometry::Shape box) { return geometry::dilate(std::move(box), 0.0); }

TEST(Measure, IsExactForBoxes) {
  Random random(2);
  const geometry::OrientedBox box{{1, 2, 3}, random_rotation(random), {0.5, 0.3, 0.025}};
  EXPECT_NEAR(measure(*geometry::make_box(box), 3, 0.01), 8 * 0.5 * 0.3 * 0.025, 1e-12);
  const geometry::Shape plate =
      geometry::make_plate({0, 0, 1}, {1, 0, 1}, 2.0, geometry::infinity, 0.05);
  EXPECT_NEAR(measure(*plate, 2, 0.01), 0.1, 1e-12);
}

TEST(Measure, IsAccurateForRotatedThinSlabs) {
  Random random(9);
  for (int n = 0; n < 3; ++n) {
    const geometry::OrientedBox box{
        random_point(random, 1), random_rotation(random), {0.2, 0.1, 0.025}};
    EXPECT_NEAR(measure(*anonymous(geometry::make_box(box)), 3, 0.01), 0.004, 0.004 * 1e-3);
  }
  for (const double tilt : {0.0, 13.0, 40.0, 45.0, 70.0}) {
    const geometry::Shape slab =
        geometry::transform(geometry::make_box(Vec3::Zero(), Vec3(1, geometry::infinity, 0.05)),
                            rotation_about_y(radians(tilt)), {0.3, 0, 0.2});
    EXPECT_NEAR(measure(*anonymous(slab), 2, 0.01), 0.05, 0.05 * 1e-3) << tilt;
  }
}

TEST(Measure, IsAccurateForRoundSolids) {
  const double r = 0.05;
  EXPECT_NEAR(measure(*geometry::make_sphere({1, 0, 2}, r), 3, 0.01) / (4 * pi * r * r * r / 3), 1,
              1e-3);
  EXPECT_NEAR(measure(*geometry::make_sphere({1, 0, 2}, r), 2, 0.01) / (pi * r * r), 1, 1e-3);
  const geometry::Shape rod = geometry::make_cylinder({0, 0, 0}, {0.2, 0.1, 0.1}, r);
  EXPECT_NEAR(measure(*rod, 3, 0.01) / (pi * r * r * std::sqrt(0.06)), 1, 1e-3);
}

TEST(Measure, IsAccurateForHollowSpheres) {
  const geometry::Shape shell = geometry::subtract(geometry::make_sphere({0, 0, 0}, 0.1),
                                                   {geometry::make_sphere({0, 0, 0}, 0.08)});
  EXPECT_NEAR(measure(*shell, 3, 0.01) / (4 * pi / 3 * (1e-3 - 0.512e-3)), 1, 1e-3);
}

TEST(Measure, RefusesUnboundedSolids) {
  const geometry::Shape ground = geometry::make_plane({0, 0, 0}, {0, 0, 1});
  expect_input_error([&] { measure(*ground, 2, 0.01); }, "unbounded");
  const geometry::Shape deep = geometry::make_box(Vec3::Zero(), Vec3(1, geometry::infinity, 1));
  expect_input_error([&] { measure(*deep, 3, 0.01); }, "unbounded");
}

TEST(Measure, RefusesAbsurdSizes) {
  const geometry::Shape moon = geometry::make_sphere({0, 0, 0}, 1.7e6);
  expect_input_error([&] { measure(*moon, 3, 1e-3); }, "voxels");
}

TEST(Voxelize, CoversTheSolidAndMarksInnerVoxels) {
  const geometry::Shape ball = geometry::make_sphere({0.3, 0.1, 0.2}, 0.1);
  const double edge = 0.02;
  const auto voxels = voxelize(*ball, 3, edge);
  Random random(11);
  const auto holding = [&](const Vec3& x) {
    return std::count_if(voxels.begin(), voxels.end(), [&](const Voxel& v) {
      return (x - v.center).cwiseAbs().maxCoeff() <= edge / 2;
    });
  };
  for (int n = 0; n < 300; ++n) {
    const Vec3 x = Vec3(0.3, 0.1, 0.2) + random_point(random, 0.1 / std::sqrt(3.0));
    EXPECT_EQ(holding(x), 1) << x.transpose();
  }
  int inside = 0;
  for (const Voxel& v : voxels) {
    if (!v.inside) continue;
    ++inside;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      EXPECT_LT(ball->distance(v.center + edge / 2 * sign), 0);
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(Voxelize, KeepsPlaneSolidsInTheirPlane) {
  const auto voxels = voxelize(
      *geometry::make_box(Vec3::Zero(), Vec3(0.1, geometry::infinity, 0.1)), 2, 0.01, 0.005);
  EXPECT_GE(voxels.size(), 144u);
  EXPECT_LE(voxels.size(), 200u);
  for (const Voxel& v : voxels) EXPECT_EQ(v.center.y(), 0);
}

}  // namespace
}  // namespace snowshed::sampling
