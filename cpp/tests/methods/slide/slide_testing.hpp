// Slopes and slides for the tests.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>

#include "geometry/terrain_testing.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/io/binary_archive.hpp"
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

/// A solver that begins at the state of another, by way of a checkpoint in this file.
inline std::unique_ptr<Solver> resumed_slide(const Options& options, const Solver& slide,
                                             const std::filesystem::path& file) {
  io::BinaryWriter out;
  slide.save(out);
  out.save(file, [](const std::filesystem::path&) {});
  auto resumed = make_solver(options);
  resumed->load(io::BinaryReader::load(file));
  return resumed;
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
