#include "snowshed/sampling/lattice.hpp"

#include <cmath>

#include "geometry/geometry_testing.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/particles/point_grid.hpp"

namespace snowshed::sampling {
namespace {

using namespace geometry_testing;

geometry::Shape slab_2d(double length, double thickness, double tilt) {
  return geometry::transform(
      geometry::make_box(Vec3::Zero(), Vec3(length, geometry::infinity, thickness)),
      rotation_about_y(tilt), {0.1, 0, 1.2});
}

void expect_none_outside(const geometry::LevelSet& shape, const std::vector<Vec3>& points) {
  for (const Vec3& x : points) ASSERT_LT(shape.distance(x), 1e-9) << x.transpose();
}

double min_distance(const std::vector<Vec3>& points, double reach) {
  const particles::PointGrid grid(points, reach);
  double min_separation = reach;
  for (std::size_t i = 0; i < points.size(); ++i)
    grid.for_each_near(points[i], [&](std::uint32_t j, const Vec3& other) {
      if (j != i) min_separation = std::min(min_separation, (other - points[i]).norm());
    });
  return min_separation;
}

TEST(Lattice, GivesASlabOnePointPerCell) {
  struct Case {
    double thickness, spacing;
    std::size_t count;
  };
  for (const Case& c : {Case{0.05, 0.02, 125},
                        {0.009, 0.02, 23},
                        {0.04, 0.02, 100},
                        {0.05, 0.01, 500},
                        {0.033, 0.01, 330},
                        {0.07, 0.03, 78}})
    for (const double tilt : {0.0, 0.8, -2.5}) {
      const geometry::Shape slab = slab_2d(1.0, c.thickness, tilt);
      const LatticeFilling filling = fill_lattice(*slab, 2, c.spacing);
      EXPECT_EQ(filling.positions.size(), c.count) << c.thickness << " " << tilt;
      EXPECT_EQ(count_lattice(*slab, 2, c.spacing), c.count);
      EXPECT_NEAR(filling.volume, c.thickness, 1e-12);
      expect_none_outside(*slab, filling.positions);
      EXPECT_GT(min_distance(filling.positions, 2 * c.spacing), 0.69 * c.spacing);
    }
}

TEST(Lattice, TheNumberOfPointsMatchesTheVolumeOfABox) {
  for (const double spacing : {0.01, 0.013, 0.02}) {
    const geometry::Shape box =
        geometry::transform(geometry::make_box(Vec3::Zero(), Vec3(0.21, 0.13, 0.047)),
                            rotation_about_y(0.4), {0, 0, 1});
    const LatticeFilling filling = fill_lattice(*box, 3, spacing);
    EXPECT_EQ(double(filling.positions.size()),
              std::round(0.21 * 0.13 * 0.047 / std::pow(spacing, 3)));
    expect_none_outside(*box, filling.positions);
  }
}

TEST(Lattice, TheNumberOfPointsMatchesTheVolumeOfABall) {
  for (const double spacing : {0.011, 0.02, 0.03}) {
    const double radius = 0.1;
    const geometry::Shape ball = geometry::make_sphere({0.003, 0, 0.5}, radius);
    const auto flat = fill_lattice(*ball, 2, spacing), solid = fill_lattice(*ball, 3, spacing);
    EXPECT_NEAR(flat.volume, pi * radius * radius, 2e-3 * flat.volume);
    EXPECT_NEAR(solid.volume, 4.0 / 3.0 * pi * std::pow(radius, 3), 2e-3 * solid.volume);
    EXPECT_EQ(double(flat.positions.size()), std::round(flat.volume / std::pow(spacing, 2)));
    EXPECT_EQ(double(solid.positions.size()), std::round(solid.volume / std::pow(spacing, 3)));
    for (const auto& points : {flat.positions, solid.positions}) {
      expect_none_outside(*ball, points);
      EXPECT_GT(min_distance(points, 2 * spacing), 0.5 * spacing);
    }
  }
}

TEST(Lattice, SpreadsAPartialLayerOverTheTop) {
  const geometry::Shape slab = slab_2d(1.0, 0.05, 0.0);
  std::vector<double> top;
  for (const Vec3& x : fill_lattice(*slab, 2, 0.02).positions)
    if (x.z() > 1.2 + 0.02) top.push_back(x.x());
  std::sort(top.begin(), top.end());
  ASSERT_EQ(top.size(), 25u);
  for (std::size_t i = 1; i < top.size(); ++i) EXPECT_LT(top[i] - top[i - 1], 0.061);
}

TEST(Lattice, StartsAtTheLowestFaceOfATurnedBox) {
  for (const double turn : {0.0, pi / 2, pi}) {
    const geometry::Shape box =
        geometry::transform(geometry::make_box(Vec3::Zero(), Vec3(0.11, geometry::infinity, 0.05)),
                            rotation_about_y(turn), {0, 0, 1});
    double min_height = 2;
    for (const Vec3& x : fill_lattice(*box, 2, 0.02).positions)
      min_height = std::min(min_height, x.z());
    EXPECT_NEAR(min_height - box->bounds().min.z(), 0.01, 1e-9) << turn;
  }
}

TEST(Lattice, DoesNotDependOnTheDescriptionOfABox) {
  // Subtracting a solid that does not touch the box hides that it is a box.
  const geometry::Shape box = geometry::make_box(Vec3::Zero(), Vec3(0.4, geometry::infinity, 0.1));
  const geometry::Shape hidden = geometry::subtract(box, {geometry::make_sphere({5, 0, 5}, 0.1)});
  auto direct = fill_lattice(*box, 2, 0.02).positions,
       indirect = fill_lattice(*hidden, 2, 0.02).positions;
  ASSERT_EQ(direct.size(), indirect.size());
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::round(a.x() * 1e6) != std::round(b.x() * 1e6) ? a.x() < b.x() : a.z() < b.z();
  };
  std::sort(direct.begin(), direct.end(), before);
  std::sort(indirect.begin(), indirect.end(), before);
  for (std::size_t i = 0; i < direct.size(); ++i) ASSERT_LT((direct[i] - indirect[i]).norm(), 1e-9);
}

TEST(Lattice, RefusesTooFewAndTooManyParticles) {
  expect_input_error([] { fill_lattice(*geometry::make_sphere({0, 0, 0}, 0.004), 3, 0.02); },
                     "too small");
  expect_input_error([] { fill_lattice(*geometry::make_box({0, 0, 0}, {1, 1, 1}), 3, 1e-4); },
                     "2e8");
}

}  // namespace
}  // namespace snowshed::sampling
