// Small bodies of particles for the tests of MPS.
#pragma once

#include <cmath>
#include <memory>

#include "snowshed/geometry/primitives.hpp"
#include "snowshed/methods/fields_by_id.hpp"
#include "snowshed/methods/mps/solver.hpp"

namespace snowshed::methods::mps {

/// A particle at the middle of every cell of a box, or of its section y = 0 in 2D.
inline ParticleBatch block_of(const Options& o, const Vec3& low, const Vec3& high) {
  const double l0 = o.settings.spacing;
  ParticleBatch batch;
  batch.mass = o.settings.density * std::pow(l0, o.dimension);
  const auto count = [&](int axis) { return int(std::lround((high[axis] - low[axis]) / l0)); };
  for (int k = 0; k < count(2); ++k)
    for (int j = 0; j < (o.dimension == 3 ? count(1) : 1); ++j)
      for (int i = 0; i < count(0); ++i)
        batch.positions.push_back({low.x() + (i + 0.5) * l0,
                                   o.dimension == 3 ? low.y() + (j + 0.5) * l0 : 0.0,
                                   low.z() + (k + 0.5) * l0});
  return batch;
}

inline Obstacle wall(const Vec3& point, const Vec3& normal) {
  return {"wall", geometry::make_plane(point, normal), {Condition::sticky, 0.0}, std::nullopt};
}

/// An open tank with a viscous fluid.
inline Options tank(int dimension, double width, double spacing) {
  Options o;
  o.dimension = dimension;
  o.settings.spacing = spacing;
  o.settings.density = 1000;
  o.settings.rheology = ShearLaw::newtonian;
  o.settings.viscosity = 1;
  o.obstacles = {wall(Vec3::Zero(), Vec3::UnitZ()), wall(Vec3::Zero(), Vec3::UnitX()),
                 wall({width, 0, 0}, -Vec3::UnitX())};
  if (dimension == 3) {
    o.obstacles.push_back(wall(Vec3::Zero(), Vec3::UnitY()));
    o.obstacles.push_back(wall({0, width, 0}, -Vec3::UnitY()));
  }
  return o;
}

/// A channel between two plates, with a force along x in place of gravity and the period `length`.
inline Options channel(double length, double half_gap, int across, double force) {
  Options o;
  o.dimension = 2;
  o.settings.spacing = 2 * half_gap / across;
  o.settings.density = 1000;
  o.settings.rheology = ShearLaw::bingham;
  o.settings.viscosity = 1;
  o.settings.friction_angle = 0;
  o.gravity = {force / o.settings.density, 0, 0};
  o.period = length;
  o.obstacles = {wall(Vec3::Zero(), Vec3::UnitZ()), wall({0, 0, 2 * half_gap}, -Vec3::UnitZ())};
  return o;
}

/// A body from the origin to a corner, at rest.
inline std::unique_ptr<Solver> body_of(const Options& o, const Vec3& corner) {
  std::unique_ptr<Solver> mps = make_solver(o);
  mps->add(block_of(o, Vec3::Zero(), corner));
  return mps;
}

/// Mean velocity along x.
inline double mean_speed(const Method& method) {
  double speed = 0;
  for (const Vec3& u : method.state().velocities) speed += u.x() / double(method.size());
  return speed;
}

inline void flow_until(Method& method, double time) {
  while (method.time() < time) method.step();
}

}  // namespace snowshed::methods::mps
