#include "snowshed/geometry/rebuild_distance.hpp"

#include "geometry/geometry_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

constexpr double spacing = 0.1, radius = 1.0;

/// Returns signed distances to a ball about the origin, clamped to `band`.
GridSamples clamped_ball(double band) {
  constexpr std::size_t n = 51;
  GridSamples ball{Vec3::Constant(-2.47), spacing, {n, n, n}, {}};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) {
        const double d = (ball.origin + spacing * Vec3(i, j, k)).norm() - radius;
        ball.values.push_back(float(std::clamp(d, -band, band)));
      }
  return ball;
}

void expect_ball(const GridSamples& ball, double tolerance) {
  const Shape shape = make_sampled_grid(ball, "ball");
  Random random(5);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 x = random_point(random, 2.4);
    if (x.norm() < 0.3) continue;  // the samples do not resolve the kink at the centre
    ASSERT_NEAR(shape->distance(x), x.norm() - radius, tolerance) << x.transpose();
  }
}

TEST(RebuildDistance, RestoresDistancesBeyondTheBand) {
  GridSamples ball = clamped_ball(3 * spacing);
  const std::vector<float> clamped = ball.values;
  rebuild_distance(ball, 0.999 * 3 * spacing, "ball");
  expect_ball(ball, 0.2 * spacing);
  for (std::size_t n = 0; n < clamped.size(); ++n)
    ASSERT_TRUE(ball.values[n] == clamped[n] || std::abs(clamped[n]) > 2.9f * float(spacing));
}

TEST(RebuildDistance, RestoresAllDistancesFromTheSurface) {
  GridSamples ball = clamped_ball(0.5 * spacing);
  rebuild_distance(ball, 0, "ball");
  expect_ball(ball, 0.35 * spacing);  // near the surface, because only its crossings are known
}

TEST(RebuildDistance, NeedsASurface) {
  GridSamples nothing = clamped_ball(1);
  for (float& value : nothing.values) value = 1;
  expect_input_error([&] { rebuild_distance(nothing, 0, "nowhere"); }, "nowhere: no value");
}

}  // namespace
}  // namespace snowshed::geometry
