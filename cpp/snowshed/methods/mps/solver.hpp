// The moving particle semi-implicit method (Koshizuka and Oka 1996, doi:10.13182/NSE96-A24205) for
// snow as a Bingham and dilatant fluid (Saito and others 2012).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/obstacle.hpp"
#include "snowshed/methods/obstacle_forces.hpp"

namespace snowshed::methods::mps {

struct Options {
  int dimension = 3;
  Settings settings;
  Vec3 gravity{0, 0, -9.81};  // m/s2
  std::vector<Obstacle> obstacles;
  bool energy = false;  // whether to keep the energy balance
  bool forces = false;  // whether to record the forces on obstacles
  double period = 0;    // m, period along x, from x = 0; 0: not periodic
};

/// Solution of the equations in the last step and on average, and density of the snow.
struct Report {
  int pressure_iterations = 0, viscosity_iterations = 0;
  double pressure_residual = 0, viscosity_residual = 0;  // relative
  double mean_pressure_iterations = 0, mean_viscosity_iterations = 0;
  double density_error = 0;    // root mean square of n/n0 - 1 within the snow
  double largest_density = 0;  // largest n/n0
};

/// MPS as a method, with its own additions.
class Solver : public Method, public KeepsEnergy, public KeepsForces, public ReportsRun {
 public:
  virtual Report report() const = 0;
};

/// Throws InputError if the settings `order` and `splitting` contradict each other.
void check_order(const Settings&);

/// Throws InputError if the settings do not fit each other.
std::unique_ptr<Solver> make_solver(Options);

}  // namespace snowshed::methods::mps
