// Changes of the snow between steps, and the fields of particles.
#include <gtest/gtest.h>

#include <cmath>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::mpm {
namespace {

TEST(MpmSolver, AddedVelocitiesCountInTheEnergyBalance) {
  Options options = options_for({3, Precision::float64});
  options.energy = true;
  options.gravity = 0;
  const auto solver = make_solver(options, {});
  solver->add(filled_box(3, Vec3::Zero(), Vec3(0.04, 0.04, 0.04), 0.005));
  std::vector<Vec3> changes(solver->size(), Vec3(1, 0, 2));
  solver->add_velocity(changes);
  solver->step();
  const ParticleState s = solver->state();
  for (const Vec3& v : s.velocities) EXPECT_LT((v - Vec3(1, 0, 2)).norm(), 1e-12);
  EXPECT_NEAR(energy_of(*solver).added, 2.5 * total_mass(s), 1e-12);
  EXPECT_NEAR(energy_of(*solver).residual(), 0, 1e-12);
  changes.pop_back();
  EXPECT_THROW(solver->add_velocity(changes), InputError);
}

TEST(MpmSolver, SettlingLowersAndCompactsSnow) {
  Options options = options_for({3, Precision::float64});
  options.energy = true;
  const auto solver = make_solver(options, {});
  solver->add(filled_box(3, Vec3(0, 0, 1), Vec3(0.1, 0.04, 1.3), 0.01));
  run_steps(*solver, 10);
  const ParticleState before = solver->state();
  std::vector<double> drops, changes;
  for (const Vec3& x : before.positions) {
    drops.push_back(0.5 * (x.z() - 1));
    changes.push_back(-std::log(2.0));
  }
  const double residual = energy_of(*solver).residual();
  solver->settle(drops, changes);
  const ParticleState after = solver->state();
  double fallen = 0;
  for (std::size_t i = 0; i < drops.size(); ++i) {
    ASSERT_LT((after.positions[i] - (before.positions[i] - drops[i] * Vec3::UnitZ())).norm(), 1e-9);
    ASSERT_NEAR(after.densities[i], 2 * before.densities[i], 1e-6);
    ASSERT_EQ(after.velocities[i], before.velocities[i]);
    fallen += 9.81 * before.masses[i] * drops[i];
  }
  const EnergyBalance energy_balance = energy_of(*solver);
  EXPECT_NEAR(energy_balance.added, 9.81 * total_mass(before) * 1.15 - fallen, 0.01 * fallen);
  EXPECT_NEAR(energy_balance.residual(), residual, 1e-9 * energy_balance.added);
  ASSERT_NO_THROW(run_steps(*solver, 10));
  drops.back() = std::nan("");
  EXPECT_THROW(solver->settle(drops, changes), InputError);
  drops.pop_back();
  EXPECT_THROW(solver->settle(drops, changes), InputError);
}

TEST(MpmSolver, StateListsItsParticles) {
  const auto solver = make_solver(options_for({3, Precision::float64}), {});
  ParticleBatch batch = filled_box(3, Vec3(-0.05, 0, 0), Vec3(0.05, 0.02, 0.03), 0.01);
  batch.velocity = Vec3(1, 2, 2);
  batch.event = 3;
  solver->add(batch);
  const SnowState s = snow_state(*solver);
  ASSERT_EQ(s.positions.size(), batch.positions.size());
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    EXPECT_LT((s.positions[i] - batch.positions[i]).norm(), 1e-15);
    EXPECT_EQ(s.velocities[i], batch.velocity);
    EXPECT_EQ(s.ids[i], i);
    EXPECT_EQ(s.events[i], 3);
    EXPECT_DOUBLE_EQ(s.volume_ratios[i], 1.0);
    EXPECT_EQ(s.pressures[i], 0.0);
  }
  EXPECT_DOUBLE_EQ(solver->motion(2.9).rms_speed, 3.0);
  EXPECT_DOUBLE_EQ(solver->motion(2.9).moving_mass, total_mass(s));
  EXPECT_EQ(solver->motion(3.1).moving_mass, 0.0);
  solver->replace({});
  EXPECT_EQ(solver->size(), 0u);
  EXPECT_THROW(solver->step(), SimulationError);
}

}  // namespace
}  // namespace snowshed::methods::mpm
