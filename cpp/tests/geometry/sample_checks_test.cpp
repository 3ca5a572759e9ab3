#include "snowshed/geometry/sample_checks.hpp"

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

constexpr double step = 0.05;

GridSamples samples_of(const Shape& shape, const Vec3& low, const Vec3& high, bool flat) {
  GridSamples s{low, step, {}, {}};
  for (int axis = 0; axis < 3; ++axis)
    s.counts[axis] =
        axis == 1 && flat ? 1 : std::size_t(std::lround((high - low)[axis] / step)) + 1;
  if (flat) s.origin.y() = 0;
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    s.values.push_back(float(shape->distance(s.origin + step * Vec3(i, j, k))));
  });
  return s;
}

GridSamples clipped(GridSamples s, double inside, double outside) {
  for (float& v : s.values) v = std::clamp(v, float(-inside), float(outside));
  return s;
}

const Vec3 low(-1.02, -1.01, -1.03), high(1.1, 1.1, 1.1);

TEST(SampleChecks, ClippedDistancesAreRebuilt) {
  const Shape solids[] = {
      make_box(Vec3(0.1, 0, 0), Vec3(0.9, 0.8, 0.7)), make_sphere(Vec3(0, 0.1, 0), 0.6),
      unite({make_box(Vec3(0, 0, -0.3), Vec3(1.4, 1.2, 0.3)), make_sphere(Vec3(0, 0, 0.2), 0.4)})};
  for (const Shape& solid : solids)
    for (const bool flat : {false, true})
      for (const auto& [inside, outside] : {std::pair{3 * step, 3 * step},
                                            {2 * step, 5 * step},
                                            {10.0, 4 * step},
                                            {2 * step, 10.0}}) {
        const GridSamples full = samples_of(solid, low, high, flat);
        GridSamples repaired = clipped(full, inside, outside);
        std::vector<std::string> notes;
        repair_distances(repaired, "g", &notes);
        ASSERT_EQ(notes.size(), 1u) << inside << " " << outside;
        EXPECT_NE(notes.front().find("clipped"), std::string::npos);
        for (std::size_t n = 0; n < full.values.size(); ++n) {
          ASSERT_EQ(repaired.values[n] < 0, full.values[n] < 0);
          ASSERT_NEAR(repaired.values[n], full.values[n],
                      0.5 * step + 0.2 * std::abs(full.values[n]));
        }
      }
}

TEST(SampleChecks, ExactDistancesAreUnchanged) {
  // A slab whose middle lies on samples, or between them; a plane; nothing outside.
  const Shape solids[] = {make_box(Vec3(0.03, 0, -0.03), Vec3(0.8, 3, 0.3)),
                          make_box(Vec3(0.03, 0, -0.005), Vec3(0.8, 3, 0.3)),
                          make_plane(Vec3(0, 0, 0.2), Vec3::UnitZ()),
                          make_sphere(Vec3(0.03, 0.04, 0.02), 0.5)};
  for (const Shape& solid : solids)
    for (const bool flat : {false, true}) {
      const GridSamples full = samples_of(solid, low, high, flat);
      GridSamples repaired = full;
      std::vector<std::string> notes;
      repair_distances(repaired, "g", &notes);
      EXPECT_TRUE(notes.empty()) << notes.front();
      EXPECT_EQ(repaired.values, full.values);
    }
}

TEST(SampleChecks, DistancesInAnotherUnitAreRebuilt) {
  const GridSamples full = samples_of(make_sphere(Vec3(0, 0.1, 0), 0.6), low, high, false);
  GridSamples scaled = full;
  for (float& v : scaled.values) v *= 0.1f;
  std::vector<std::string> notes;
  repair_distances(scaled, "g", &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes.front().find("is the unit wrong?"), std::string::npos);
  for (std::size_t n = 0; n < full.values.size(); ++n)
    ASSERT_NEAR(scaled.values[n], full.values[n], 0.7 * step);
}

TEST(SampleChecks, InvertedSignsAreRefused) {
  const Shape solids[] = {make_box(Vec3::Zero(), Vec3(0.8, 0.8, 0.7)),
                          make_sphere(Vec3(0.2, 0.1, 0), 0.5),
                          make_box(Vec3(0, 0, -1), Vec3(0.8, 0.8, 1)),  // stands on the bottom
                          make_plane(Vec3(0, 0, -0.2), Vec3::UnitZ()),
                          subtract(make_box(Vec3::Zero(), Vec3(1.8, 1.8, 1.8)),
                                   {make_box(Vec3(0, 0, 0.2), Vec3(1.6, 1.6, 2))})};
  for (const Shape& solid : solids)
    for (const bool flat : {false, true}) {
      GridSamples s = samples_of(solid, low, high, flat);
      EXPECT_NO_THROW(require_distances(s, "g"));
      for (float& v : s.values) v = -v;
      expect_input_error([&] { require_distances(s, "g.npy"); }, "the sign is the other way round");
    }
}

TEST(SampleChecks, SolidsMayFillTheGrid) {
  const Shape solids[] = {make_plane(Vec3(0, 0, 0.9), Vec3::UnitZ()),   // deep ground
                          make_plane(Vec3(0, 0, 0.2), -Vec3::UnitZ()),  // a ceiling
                          make_box(Vec3::Zero(), Vec3(9, 9, 1.9)),      // a slab
                          make_sphere(Vec3::Zero(), 1.2)};              // cut at all sides
  for (const Shape& solid : solids)
    for (const bool flat : {false, true})
      EXPECT_NO_THROW(require_distances(samples_of(solid, low, high, flat), "g"));
}

TEST(SampleChecks, TheSectionMatchesTheSolidAtThePlane) {
  const Shape ball = make_sphere(Vec3(0, 0.02, 0), 0.6);
  const GridSamples s = samples_of(ball, low, high, false), section = samples_at_y0(s, "g");
  const Shape grid = make_sampled_grid(section, "g");
  Random random(9);
  for (int n = 0; n < 300; ++n) {
    Vec3 x = random_point(random, 1);
    x.y() = 0;
    if (x.norm() < 0.2) continue;
    ASSERT_NEAR(grid->distance(x), ball->distance(x), 0.01);
    ASSERT_EQ(grid->normal(x).y(), 0);
  }
  GridSamples beside = s;
  beside.origin.y() = 0.3;
  expect_input_error([&] { samples_at_y0(beside, "g.npy"); }, "does not reach the plane y = 0");
  beside.origin.y() = -2;
  expect_input_error([&] { samples_at_y0(beside, "g.npy"); }, "does not meet");
  // A grid that ends at the plane, and whose solid reaches that end.
  const GridSamples half = samples_of(ball, Vec3(low.x(), 0, low.z()), high, false);
  EXPECT_LT(make_sampled_grid(samples_at_y0(half, "g"), "g")->distance(Vec3::Zero()), -0.5);
}

}  // namespace
}  // namespace snowshed::geometry
