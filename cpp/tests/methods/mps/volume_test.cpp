// A body of snow keeps its volume as it flows.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "mps_testing.hpp"

namespace snowshed::methods::mps {
namespace {

/// Mean of n/n0 - 1 over the particles below the surface: the share of volume that the inside of a
/// body has lost.
double mean_excess(const Method& method, double surface_ratio) {
  const particles::FieldView density = method.field("number_density");
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < density.count; ++i) {
    const double n = *density.at<double>(i);
    if (n < surface_ratio) continue;
    sum += n - 1;
    ++count;
  }
  return sum / count;
}

// Viscosity acts after the pressure. Without coupling it would leave a velocity that compresses the
// fluid.
TEST(MpsVolume, AStiffSlumpKeepsItsVolume) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    Options o = tank(2, 10, 0.02);
    o.settings.walls = walls;
    o.settings.viscosity = 1e4;
    const auto mps = body_of(o, {0.3, 0, 0.2});
    double max_density = 0;
    while (mps->time() < 2) {
      mps->step();
      max_density = std::max(max_density, mps->report().largest_density);
    }
    EXPECT_LT(std::abs(mean_excess(*mps, o.settings.surface_ratio)), 0.01) << int(walls);
    EXPECT_LT(mps->report().density_error, 0.02) << int(walls);
    EXPECT_LT(max_density, 1.08) << int(walls);
  }
}

/// The mean space per particle, relative to a lattice, deeper than three spacings below the
/// surface. The space of a particle consists of the points that are nearest to it. The heap lies on
/// z = 0, beside x = 0.
double mean_space(const Method& method, double spacing) {
  const std::vector<Vec3> points = method.state().positions;
  constexpr int parts = 16;
  const double part = spacing / parts, length = 10;
  std::vector<double> top(std::size_t(length / spacing) + 1);
  const auto column = [&](const Vec3& x) { return std::size_t(x.x() / spacing); };
  for (const Vec3& x : points)
    for (std::size_t c = std::max<std::size_t>(column(x), 2) - 2; c <= column(x) + 2; ++c)
      top[c] = std::max(top[c], x.z());
  std::vector<std::vector<Vec3>> in_column(top.size());
  for (const Vec3& x : points) in_column[column(x)].push_back(x);
  double samples = 0, deep = 0;
  const auto is_deep = [&](const Vec3& x) { return x.z() < top[column(x)] - 3 * spacing; };
  for (const Vec3& x : points) deep += is_deep(x);
  for (std::size_t c = 0; c + 2 < top.size() && top[c] > 0; ++c)
    for (int i = 0; i < parts; ++i)
      for (double z = 0.5 * part; z < top[c]; z += part) {
        const Vec3 sample((double(c) + (i + 0.5) / parts) * spacing, 0, z);
        const Vec3* nearest = nullptr;
        for (std::size_t b = std::max<std::size_t>(c, 2) - 2; b <= c + 2; ++b)
          for (const Vec3& x : in_column[b])
            if (!nearest || (x - sample).squaredNorm() < (*nearest - sample).squaredNorm())
              nearest = &x;
        samples += nearest && is_deep(*nearest);
      }
  return samples / (parts * parts) / deep;
}

// At the same density disordered particles have a higher number density than a lattice. When the
// compensation used the number density, the heap took up 1.8 % more space while it flowed.
TEST(MpsVolume, ABinghamHeapKeepsItsVolume) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    Options o = tank(2, 10, 0.01);
    o.settings.walls = walls;
    o.settings.rheology = ShearLaw::bingham;
    o.settings.cohesion = 100;
    o.settings.friction_angle = 0;
    o.settings.viscosity = 5;
    const auto mps = body_of(o, {0.3, 0, 0.2});
    flow_until(*mps, 0.5);  // still fast, and most disordered
    EXPECT_NEAR(mean_space(*mps, 0.01), 1, 0.015) << int(walls);
    for (const double time : {1.0, 2.0}) {
      flow_until(*mps, time);
      EXPECT_NEAR(mean_space(*mps, 0.01), 1, 0.01) << int(walls) << ' ' << time;
    }
  }
}

}  // namespace
}  // namespace snowshed::methods::mps
