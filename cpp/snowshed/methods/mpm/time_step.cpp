#include "snowshed/methods/mpm/time_step.hpp"

#include <cmath>

#include "snowshed/material/elasticity.hpp"

namespace snowshed::methods::mpm {

double elastic_time_step(double youngs_modulus, double poissons_ratio, double density,
                         int dimension, double dx, Transfer transfer, Basis basis) {
  const auto e = material::Elasticity<double>::from(youngs_modulus, poissons_ratio, dimension);
  const double stiffness = dimension * e.bulk;  // d lambda + 2 mu
  return dx * std::sqrt(2 / (transfer_stability_number(transfer, basis) * stiffness / density));
}

}  // namespace snowshed::methods::mpm
