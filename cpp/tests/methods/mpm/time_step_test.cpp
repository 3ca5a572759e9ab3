#include "snowshed/methods/mpm/time_step.hpp"

#include <gtest/gtest.h>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/methods/mpm/kernels/bspline.hpp"

namespace snowshed::methods::mpm {
namespace {

TEST(MpmTimeStep, ScalesLikeACourantCondition) {
  for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip}) {
    const auto step = [&](double modulus, double density, int dimension, double dx, Basis basis) {
      return elastic_time_step(modulus, 0.3, density, dimension, dx, transfer, basis);
    };
    const double limit = step(1e6, 210, 3, 0.01, Basis::quadratic);
    EXPECT_NEAR(step(1e6, 210, 3, 0.02, Basis::quadratic), 2 * limit, 1e-15);
    EXPECT_NEAR(step(4e6, 210, 3, 0.01, Basis::quadratic), limit / 2, 1e-15);
    EXPECT_NEAR(step(1e6, 840, 3, 0.01, Basis::quadratic), 2 * limit, 1e-15);
    EXPECT_GT(step(1e6, 210, 2, 0.01, Basis::quadratic), limit);
    EXPECT_GT(step(1e6, 210, 3, 0.01, Basis::cubic), limit);
  }
}

template <Basis basis>
double max_stability_number() {
  double max_value = 0;
  for (double f = 1e-6; f < 1; f += 1e-4) {
    double w[support(basis)], g[support(basis)], sum = 0;
    BSpline<basis>::evaluate(f, w, g);
    for (int k = 0; k < support(basis); ++k) sum += g[k] * g[k] / w[k];
    max_value = std::max(max_value, sum);
  }
  return max_value;
}

TEST(MpmTimeStep, StabilityNumbersBoundTheWeights) {
  const double quadratic = max_stability_number<Basis::quadratic>();
  const double cubic = max_stability_number<Basis::cubic>();
  EXPECT_LE(quadratic, stability_number(Basis::quadratic) + 1e-9);
  EXPECT_LE(cubic, stability_number(Basis::cubic) + 1e-9);
  EXPECT_GT(quadratic, 0.98 * stability_number(Basis::quadratic));
  EXPECT_GT(cubic, 0.98 * stability_number(Basis::cubic));
}

TEST(MpmTimeStep, FastSnowMovesLessThanHalfACell) {
  EXPECT_DOUBLE_EQ(next_time_step(1e-4, 0.0, 0.01, 0.9), 0.9e-4);
  for (double speed : {0.1, 10.0, 1e4}) {
    const double dt = next_time_step(1e-4, speed, 0.01, 1.0);
    EXPECT_LT(dt, 1e-4);
    EXPECT_LT(dt * speed, 0.5 * 0.01);
  }
}

/// Largest pressure of a lone elastic particle after some hundred steps, which comes from round-off
/// alone. A lone particle has the highest frequency of snow on a grid.
double pressure_from_round_off(Transfer transfer, Basis basis, double fraction, double factor) {
  Options o = options_for({2, Precision::float64, transfer, basis});
  o.gravity = 0;
  o.snows[0].model = material::SnowModel::elastic;
  o.settings.courant_factor = factor;
  o.settings.strain_limit = 1e6;
  const auto solver = make_solver(o, {});
  ParticleBatch particle;
  const double x = (3 + base_offset(basis) + fraction) * 0.01;
  particle.positions = {Vec3(x, 0, x)};
  particle.velocity = Vec3(1e-7, 0, 3e-8);
  particle.mass = 0.005;
  solver->add(particle);
  double max_value = 0;
  for (int i = 0; i < 500 && max_value < 1; ++i) {
    solver->step();
    max_value = std::max(max_value, std::abs(*solver->field("pressure").at<double>(0)));
  }
  return max_value;
}

TEST(MpmTimeStep, StepsWithinTheLimitAreStable) {
  for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip})
    for (Basis basis : {Basis::quadratic, Basis::cubic})
      for (double fraction : {1e-3, 0.1, 0.25, 0.5, 0.8})
        EXPECT_LT(pressure_from_round_off(transfer, basis, fraction, 0.95), 1e-10)
            << name_of(transfer) << " " << support(basis) << " nodes at " << fraction;
}

TEST(MpmTimeStep, StepsJustBeyondTheLimitAreUnstable) {
  // Just beyond the limit, a lone particle blows up at the worst position.
  for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip}) {
    EXPECT_GT(pressure_from_round_off(transfer, Basis::quadratic, 1e-3, 1.1), 1.0);
    EXPECT_GT(pressure_from_round_off(transfer, Basis::cubic, 0.5, 1.1), 1.0);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
