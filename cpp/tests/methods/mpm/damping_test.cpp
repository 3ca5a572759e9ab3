// Damping by PIC: with a given rate it does not depend on the step, with a given ratio it does.
#include <gtest/gtest.h>

#include <cmath>

#include "methods/mpm/solver_testing.hpp"

namespace snowshed::methods::mpm {
namespace {

TEST(Damping, TheRateOfAFlipRatioDependsOnTheStep) {
  Settings s;
  s.flip_ratio = 0.99;
  EXPECT_EQ(s.flip_share(1e-4), 0.99);
  EXPECT_DOUBLE_EQ(*s.mean_damping_rate(1000, 0.1), -std::log(0.99) / 1e-4);
  EXPECT_FALSE(s.mean_damping_rate(0, 0.0));
  s.flip_ratio = 0;  // PIC keeps nothing
  EXPECT_FALSE(s.mean_damping_rate(1000, 0.1));
  s.flip_ratio = 1;
  EXPECT_EQ(*s.mean_damping_rate(1000, 0.1), 0.0);
}

TEST(Damping, AGivenRateDoesNotDependOnTheStep) {
  Settings s;
  s.damping_rate = 50;
  EXPECT_DOUBLE_EQ(s.flip_share(1e-4) * s.flip_share(3e-4), std::exp(-50 * 4e-4));
  EXPECT_EQ(*s.mean_damping_rate(7, 0.1), 50.0);
  s.transfer = Transfer::apic;
  EXPECT_FALSE(s.mean_damping_rate(7, 0.1));
  s.transfer = Transfer::affine_flip;
  EXPECT_EQ(*s.mean_damping_rate(7, 0.1), 50.0);
}

TEST(Damping, ADampingLengthReplacesDampingByPic) {
  Settings s;
  s.transfer = Transfer::affine_flip;
  s.damping_rate = 50;
  EXPECT_LT(s.flip_share(1e-3), 1.0);
  s.damping_length = 0.01;
  EXPECT_EQ(s.flip_share(1e-3), 1.0);
}

/// Returns the share of spin that a disc of elastic snow keeps for 0.02 s. The radius of the disc
/// is two cells. The grid does not resolve the spin of such a small disc completely, and PIC damps
/// the unresolved part.
double remaining_spin(const Settings& numerics) {
  constexpr double radius = 0.02, spin = 20, duration = 0.02;
  Options o = options_for({2, Precision::float64});
  o.settings.flip_ratio = numerics.flip_ratio;
  o.settings.damping_rate = numerics.damping_rate;
  o.settings.courant_factor = numerics.courant_factor;
  o.gravity = 0;
  o.snows[0].model = material::SnowModel::elastic;
  const auto solver = make_solver(o, {});
  add_spinning_disc(*solver, radius, spin, 0.0025);
  const auto angular_momentum = [](const ParticleState& s) {
    double sum = 0;
    for (std::size_t i = 0; i < s.masses.size(); ++i)
      sum += s.masses[i] * s.positions[i].cross(s.velocities[i]).y();
    return sum;
  };
  const double before = angular_momentum(solver->state());
  run_until(*solver, duration);
  return angular_momentum(solver->state()) / before;
}

Settings settings_with(double flip_ratio, std::optional<double> damping_rate,
                       double courant_factor) {
  Settings s;
  s.flip_ratio = flip_ratio;
  s.damping_rate = damping_rate;
  s.courant_factor = courant_factor;
  return s;
}

TEST(Damping, SpinDampingDependsOnTheStepOnlyForAFlipRatio) {
  const double undamped = remaining_spin(settings_with(1.0, std::nullopt, 0.9));
  const double by_rate = remaining_spin(settings_with(0.99, 180.0, 0.9));
  const double by_ratio = remaining_spin(settings_with(0.99, std::nullopt, 0.9));
  EXPECT_GT(undamped, 0.85);
  EXPECT_LT(by_rate, 0.8 * undamped);
  EXPECT_LT(by_ratio, 0.8 * undamped);
  for (const double courant_factor : {0.6, 0.3}) {
    EXPECT_NEAR(std::log(remaining_spin(settings_with(0.99, 180.0, courant_factor))),
                std::log(by_rate), 0.1 * std::abs(std::log(by_rate)))
        << courant_factor;
    EXPECT_LT(std::log(remaining_spin(settings_with(0.99, std::nullopt, courant_factor))),
              1.3 * std::log(by_ratio))
        << courant_factor;
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
