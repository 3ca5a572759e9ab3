#include "snowshed/sampling/lattice.hpp"

#include <cmath>

#include "geometry/geometry_testing.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/particles/point_grid.hpp"

namespace snowshed {
namespace {

using namespace geometry_testing;

Shape slab_2d(double length, double thickness, double tilt) {
  return transform(make_box(Vec3::Zero(), Vec3(length, infinity, thickness)),
                   rotation_about_y(tilt), {0.1, 0, 1.2});
}

void expect_none_outside(const LevelSet& shape, const std::vector<Vec3>& points) {
  for (const Vec3& x : points) ASSERT_LT(shape.distance(x), 1e-9) << x.transpose();
}

double smallest_distance(const std::vector<Vec3>& points, double reach) {
  const PointGrid grid(points, reach);
  double smallest = reach;
  for (std::size_t i = 0; i < points.size(); ++i)
    grid.for_each_near(points[i], [&](std::uint32_t j, const Vec3& other) {
      if (j != i) smallest = std::min(smallest, (other - points[i]).norm());
    });
  return smallest;
}

TEST(Lattice, HoldsAsManyPointsAsASlabHoldsCells) {
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
      const Shape slab = slab_2d(1.0, c.thickness, tilt);
      const LatticeFilling filling = fill_lattice(*slab, 2, c.spacing);
      EXPECT_EQ(filling.positions.size(), c.count) << c.thickness << " " << tilt;
      EXPECT_EQ(count_lattice(*slab, 2, c.spacing), c.count);
      EXPECT_NEAR(filling.volume, c.thickness, 1e-12);
      expect_none_outside(*slab, filling.positions);
      EXPECT_GT(smallest_distance(filling.positions, 2 * c.spacing), 0.69 * c.spacing);
    }
}

TEST(Lattice, FillsBoxesInSpaceByTheirVolume) {
  for (const double spacing : {0.01, 0.013, 0.02}) {
    const Shape box = transform(make_box(Vec3::Zero(), Vec3(0.21, 0.13, 0.047)),
                                rotation_about_y(0.4), {0, 0, 1});
    const LatticeFilling filling = fill_lattice(*box, 3, spacing);
    EXPECT_EQ(double(filling.positions.size()),
              std::round(0.21 * 0.13 * 0.047 / std::pow(spacing, 3)));
    expect_none_outside(*box, filling.positions);
  }
}

TEST(Lattice, FillsOtherSolidsByTheirVolume) {
  for (const double spacing : {0.011, 0.02, 0.03}) {
    const double radius = 0.1;
    const Shape ball = make_sphere({0.003, 0, 0.5}, radius);
    const auto flat = fill_lattice(*ball, 2, spacing), solid = fill_lattice(*ball, 3, spacing);
    EXPECT_NEAR(flat.volume, pi * radius * radius, 2e-3 * flat.volume);
    EXPECT_NEAR(solid.volume, 4.0 / 3.0 * pi * std::pow(radius, 3), 2e-3 * solid.volume);
    EXPECT_EQ(double(flat.positions.size()), std::round(flat.volume / std::pow(spacing, 2)));
    EXPECT_EQ(double(solid.positions.size()), std::round(solid.volume / std::pow(spacing, 3)));
    for (const auto& points : {flat.positions, solid.positions}) {
      expect_none_outside(*ball, points);
      EXPECT_GT(smallest_distance(points, 2 * spacing), 0.5 * spacing);
    }
  }
}

TEST(Lattice, SpreadsHalfALayerOverTheTop) {
  const Shape slab = slab_2d(1.0, 0.05, 0.0);
  std::vector<double> top;
  for (const Vec3& x : fill_lattice(*slab, 2, 0.02).positions)
    if (x.z() > 1.2 + 0.02) top.push_back(x.x());
  std::sort(top.begin(), top.end());
  ASSERT_EQ(top.size(), 25u);
  for (std::size_t i = 1; i < top.size(); ++i) EXPECT_LT(top[i] - top[i - 1], 0.061);
}

TEST(Lattice, StandsOnTheLowestFaceHoweverABoxIsTurned) {
  for (const double turn : {0.0, pi / 2, pi}) {
    const Shape box = transform(make_box(Vec3::Zero(), Vec3(0.11, infinity, 0.05)),
                                rotation_about_y(turn), {0, 0, 1});
    double lowest = 2;
    for (const Vec3& x : fill_lattice(*box, 2, 0.02).positions) lowest = std::min(lowest, x.z());
    EXPECT_NEAR(lowest - box->bounds().min.z(), 0.01, 1e-9) << turn;
  }
}

TEST(Lattice, IsTheSameForABoxWhoeverDescribesIt) {
  // Subtracting a solid that does not touch the box hides that it is a box.
  const Shape box = make_box(Vec3::Zero(), Vec3(0.4, infinity, 0.1));
  const Shape hidden = subtract(box, {make_sphere({5, 0, 5}, 0.1)});
  auto one = fill_lattice(*box, 2, 0.02).positions,
       other = fill_lattice(*hidden, 2, 0.02).positions;
  ASSERT_EQ(one.size(), other.size());
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::round(a.x() * 1e6) != std::round(b.x() * 1e6) ? a.x() < b.x() : a.z() < b.z();
  };
  std::sort(one.begin(), one.end(), before);
  std::sort(other.begin(), other.end(), before);
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_LT((one[i] - other[i]).norm(), 1e-9);
}

TEST(Lattice, RefusesWhatHoldsNoParticle) {
  expect_input_error([] { fill_lattice(*make_sphere({0, 0, 0}, 0.004), 3, 0.02); }, "too small");
  expect_input_error([] { fill_lattice(*make_box({0, 0, 0}, {1, 1, 1}), 3, 1e-4); }, "2e8");
}

}  // namespace
}  // namespace snowshed
