// Slopes and slides for the tests.
#pragma once

#include <cmath>
#include <memory>

#include "geometry/terrain_testing.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed::methods::slide {

/// A plane that falls toward the east.
inline geometry::HeightField inclined(double degrees, int columns = 60, int rows = 30,
                                      double cell = 2) {
  const double slope = std::tan(radians(degrees));
  return geometry::terrain_of(columns, rows, cell,
                              [=](double x, double) { return 200 - slope * x; });
}

inline Area rectangle(double west, double south, double east, double north,
                      double thickness = 0.5) {
  return {"area", {{{west, south}, {east, south}, {east, north}, {west, north}}, {}}, thickness};
}

inline Options slide_on(geometry::HeightField terrain, Area release) {
  Options o;
  o.terrain = std::move(terrain);
  o.areas.release = {std::move(release)};
  o.settings.threads = 1;
  return o;
}

inline std::unique_ptr<Solver> released_slide(const Options& options) {
  auto slide = make_solver(options);
  slide->add(slide->seed());
  return slide;
}

inline void step(Method& method, int steps) {
  for (int i = 0; i < steps; ++i) method.step();
}

inline double total_mass(const Method& method) {
  double mass = 0;
  for (const double m : method.state().masses) mass += m;
  return mass;
}

/// The mean velocity of the snow, weighted by mass.
inline Vec3 mean_slide_velocity(const Method& method) {
  const ParticleState s = method.state();
  Vec3 momentum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < s.masses.size(); ++i) {
    momentum += s.masses[i] * s.velocities[i];
    mass += s.masses[i];
  }
  return momentum / mass;
}

}  // namespace snowshed::methods::slide
