#include "snowshed/material/elasticity.hpp"

#include <gtest/gtest.h>

namespace snowshed::material {
namespace {

TEST(Elasticity, UniaxialStressGivesYoungsModulusAndPoissonsRatio) {
  // The strain (-nu, -nu, 1) gives the stress E along z and no other stress.
  for (double nu : {0.0, 0.2, 0.49}) {
    const auto e = Elasticity<double>::from(1e6, nu, 3);
    const double volumetric = 1 - 2 * nu;
    EXPECT_NEAR(2 * e.mu * -nu + e.lambda * volumetric, 0.0, 1e-6);
    EXPECT_NEAR(2 * e.mu + e.lambda * volumetric, 1e6, 1e-6);
  }
}

TEST(Elasticity, BulkModulusDependsOnTheDimension) {
  const double E = 1e6, nu = 0.3;
  EXPECT_NEAR(Elasticity<double>::from(E, nu, 3).bulk, E / (3 * (1 - 2 * nu)), 1e-6);
  // Plane strain: p = -(tau_xx + tau_zz)/2 = -(lambda + mu) tr(e).
  EXPECT_NEAR(Elasticity<double>::from(E, nu, 2).bulk, E / (2 * (1 + nu) * (1 - 2 * nu)), 1e-6);
}

}  // namespace
}  // namespace snowshed::material
