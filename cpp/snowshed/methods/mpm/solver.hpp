// The material point method: one explicit step at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/obstacle.hpp"
#include "snowshed/methods/obstacle_forces.hpp"
#include "snowshed/methods/user_laws.hpp"

namespace snowshed::methods::mpm {

struct Options {
  int dimension = 3;
  double gravity = 9.81;  // m/s2, along -z
  std::vector<material::Snow> snows{
      material::Snow()};  // indexed by material_id; at least one, at most `max_materials`
  Settings settings;
  std::vector<Obstacle> obstacles;
  // Shapes that contact by touch uses, one for each obstacle in the same order. Leave this empty:
  // contact then uses the shapes of `obstacles`, and the solver itself thickens parts that are too
  // thin for the grid. Give the original shapes only if those of `obstacles` have already been
  // thickened.
  std::vector<geometry::Shape> surfaces;
  bool energy = false;  // whether to keep the energy balance
  bool forces = false;  // whether to record the forces on obstacles
  UserLaws laws;        // except those of obstacles
};

/// A solver of MPM: a method that can also settle, balance energy, record forces and sleep.
class Solver : public Method,
               public Settles,
               public KeepsEnergy,
               public KeepsForces,
               public Sleeps {
 public:
  /// Number of sorts of the particles by blocks since the method was made.
  virtual std::int64_t sorts() const = 0;
};

inline constexpr int steps_between_sorts = 64;
/// If particles have more contacts than this on average, there are fewer steps between sorts. With
/// thousands of overlapping obstacles steps take long, and a run can stop only at the safe point
/// before a sort.
inline constexpr double contacts_per_particle = 100;

/// Steps between two sorts.
inline int steps_until_sort(std::size_t particles, std::size_t contacts) {
  const double share = contacts_per_particle * double(particles) / std::max(double(contacts), 1.0);
  return int(steps_between_sorts * std::clamp(share, 1.0 / steps_between_sorts, 1.0));
}

std::unique_ptr<Solver> make_solver(Options);

}  // namespace snowshed::methods::mpm
