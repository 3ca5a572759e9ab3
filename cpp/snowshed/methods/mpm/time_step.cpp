#include "snowshed/methods/mpm/time_step.hpp"

#include <cmath>
#include <sstream>

#include "snowshed/material/elasticity.hpp"

namespace snowshed::methods::mpm {

double elastic_time_step(double youngs_modulus, double poissons_ratio, double density,
                         int dimension, double dx, Transfer transfer, Basis basis) {
  const auto e = material::Elasticity<double>::from(youngs_modulus, poissons_ratio, dimension);
  const double stiffness = dimension * e.bulk;  // d lambda + 2 mu
  return dx * std::sqrt(2 / (transfer_stability_number(transfer, basis) * stiffness / density));
}

std::string describe_stuck(double dt, double time, double strain, double limit) {
  std::ostringstream message;
  message << "the time step fell to " << dt << " s at t = " << time
          << " s: the snow would strain by " << strain << " in one step (limit " << limit
          << "); try a smaller numerics.courant_factor";
  return message.str();
}

}  // namespace snowshed::methods::mpm
