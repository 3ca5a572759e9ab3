// The material point method: one explicit step at a time.
#pragma once

#include <memory>
#include <vector>

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/obstacle.hpp"

namespace snowshed::mpm {

struct Options {
  int dimension = 3;
  double gravity = 9.81;            // m/s2, along -z
  std::vector<Snow> snows{Snow()};  // indexed by material_id; at least one, at most `max_materials`
  Settings settings;
  std::vector<Obstacle> obstacles;
  // Surfaces of the obstacles, before thin parts were made thicker; or none.
  std::vector<Shape> surfaces;
  bool energy = false;  // whether to keep the energy balance
};

/// MPM as a method, with its own additions.
class Solver : public Method, public Settles, public KeepsEnergy, public Sleeps {
 public:
  virtual EnergyBalance energy() const = 0;
  NamedEnergies energies() const override { return named_energies(energy()); }
};

inline constexpr int steps_between_sorts = 64;
/// Fewer steps if each particle has more contacts than this: with thousands of overlapping
/// obstacles steps take long, and a run that shall stop would wait for its safe point.
inline constexpr double contacts_per_particle = 100;

std::unique_ptr<Solver> make_solver(Options);

}  // namespace snowshed::mpm
