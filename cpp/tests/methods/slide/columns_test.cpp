// Columns of snow, and the mixing of velocities.
#include "snowshed/methods/slide/columns.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "slide_testing.hpp"
#include "snowshed/core/angles.hpp"

namespace snowshed::methods::slide {
namespace {

TEST(SlideColumns, AcrossTheFlowAreNormalToThePlaneThatSnowFlowsDown) {
  const double nz = std::cos(radians(30)), fall = std::sin(radians(30));
  EXPECT_NEAR(across_flow_column_factor(nz, 20 * nz, 0, -20 * fall), nz, 1e-12);
  EXPECT_NEAR(across_flow_column_factor(nz, 0, 0, 0), nz, 1e-12);  // at rest
  // Snow that crosses the slope on the level has vertical columns.
  EXPECT_NEAR(across_flow_column_factor(nz, 0, 20, 0), vertical_column_factor(nz), 1e-4);
}

/// A trough with a parabolic cross-section, filled up to 4 m with snow without friction.
Options pool() {
  constexpr double curvature = 0.08, middle = 16;
  const auto height = [](double, double y) { return curvature * (y - middle) * (y - middle); };
  Options o = slide_on(geometry::terrain_of(61, 33, 1, height), rectangle(10, 9, 50, 23));
  o.areas.release.clear();
  constexpr int strips = 14;
  for (int i = 0; i < strips; ++i) {
    const double south = 9 + i, y = south + 0.5 - middle;
    const double depth = 4 - curvature * y * y, slope = 2 * curvature * y;
    o.areas.release.push_back(
        rectangle(10, south, 50, south + 1, depth / std::sqrt(1 + slope * slope)));
  }
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.friction = 0;
  o.settings.bonds = false;
  o.settings.mixing_rate = 1;
  o.settings.layer_thickness = 0.1;
  return o;
}

/// Root of the mean square of y about its mean, in the middle of the trough.
double width(const Solver& slide) {
  double sum = 0, square = 0, mass = 0;
  const ParticleState s = slide.state();
  for (std::size_t i = 0; i < s.masses.size(); ++i) {
    const Vec3& x = s.positions[i];
    if (std::abs(x.x() - 30) > 8) continue;
    sum += s.masses[i] * x.y();
    square += s.masses[i] * x.y() * x.y();
    mass += s.masses[i];
  }
  return std::sqrt(square / mass - sum / mass * sum / mass);
}

TEST(SlideColumns, SnowWithALevelSurfaceStaysWithVerticalColumns) {
  const auto slide = released_slide(pool());
  const double before = width(*slide);
  step(*slide, 100);
  EXPECT_NEAR(width(*slide) / before, 1, 0.02);
}

TEST(SlideMixing, TakesOverVelocitiesAtARateThatDoesNotDependOnTheStep) {
  Options o = slide_on(geometry::terrain_of(41, 41, 2, [](double, double) { return 0.0; }),
                       rectangle(20, 20, 60, 60));
  o.gravity = 0;
  o.settings.friction = 0;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.bonds = false;
  const auto left = [&](double time_step) {  // share of a shear's energy after a tenth of a second
    o.settings.time_step = time_step;
    const auto slide = released_slide(o);
    std::vector<Vec3> velocities;
    for (const Vec3& x : slide->state().positions)
      velocities.push_back({0.01 * std::sin(2 * pi * (x.y() - 20) / 10), 0, 0});
    slide->add_velocity(velocities);
    const double before = slide->motion(0).rms_speed;
    while (slide->time() < 0.1 - 1e-9) slide->step();
    return slide->motion(0).rms_speed / before;
  };
  const double coarse = left(0.02), fine = left(0.002);
  EXPECT_LT(coarse, 0.95);
  EXPECT_NEAR(coarse, fine, 0.005);
}

TEST(SlideMixing, DividesLongStepsInTheImprovedModeOnly) {
  Options o = slide_on(inclined(35), rectangle(20.3, 18.3, 50.3, 42.3));
  o.settings.bonds = false;
  o.settings.time_step = 0.1;
  const auto first_step = [&] {
    const auto slide = released_slide(o);
    slide->step();
    return slide->time_step();
  };
  EXPECT_NEAR(first_step(), 0.025, 1e-12);
  o.settings.mixing_rate = 0;
  EXPECT_EQ(first_step(), 0.1);
  o.settings = Settings();
  o.settings.mode = Mode::compatible;
  o.settings.time_step = 0.1;
  EXPECT_EQ(first_step(), 0.1);
}

}  // namespace
}  // namespace snowshed::methods::slide
