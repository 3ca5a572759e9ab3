#include "snowshed/methods/energy_balance.hpp"

#include <gtest/gtest.h>

#include "methods/mpm/solver_testing.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Largest of these energies: the work of the weight, the kinetic energy, and the energy spent.
double turnover(const EnergyBalance& now, double gravitational_at_start) {
  return std::max({gravitational_at_start - now.gravitational, now.kinetic, now.spent()});
}

/// Expects that no dissipated energy flows back, up to round-off. Impact and transfer are not
/// checked: normal forces of contact may return energy, and so may transfers.
void expect_dissipation(const EnergyBalance& before, const EnergyBalance& now, double scale) {
  const double round_off = 1e-5 * scale;
  EXPECT_GE(now.plastic - before.plastic, -round_off);
  EXPECT_GE(now.friction - before.friction, -round_off);
  EXPECT_GE(now.sticking - before.sticking, -round_off);
}

TEST(EnergyBalance, FreeFallTurnsHeightIntoSpeed) {
  Options o = options_for({2, Precision::float64});
  o.energy = true;
  const auto solver = make_solver(o, {});
  ParticleBatch batch = filled_box(2, Vec3(0, 0, 1), Vec3(0.05, 0, 1.05), 0.005);
  batch.velocity.x() = 2;
  solver->add(batch);
  const EnergyBalance start = energy_of(*solver);
  const double mass = 210 * 0.05 * 0.05;
  EXPECT_NEAR(start.kinetic, 0.5 * mass * 4, 1e-12);
  EXPECT_NEAR(start.gravitational, mass * 9.81 * 1.025, 1e-12);
  EXPECT_EQ(start.elastic, 0.0);
  EXPECT_NEAR(start.added, start.stored(), 1e-12);
  run_until(*solver, 0.2);
  const EnergyBalance end = energy_of(*solver);
  const double v = 9.81 * solver->time();
  EXPECT_NEAR(end.kinetic, 0.5 * mass * (4 + v * v), 1e-9);
  // Symplectic Euler falls m g v dt/2 too far.
  EXPECT_NEAR(end.residual(), 0.0, mass * 9.81 * v * solver->time_step());
  EXPECT_NEAR(end.spent(), 0.0, 1e-9);
}

TEST(EnergyBalance, ClosesForASlidingSlab) {
  const double tilt = radians(40);
  const Vec3 normal(std::sin(tilt), 0, std::cos(tilt)), slope(std::cos(tilt), 0, -std::sin(tilt));
  for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip}) {
    Options o = options_for({2, Precision::float32, transfer});
    o.energy = true;
    const auto solver = make_solver(
        o, {fixed(geometry::make_plane(Vec3::Zero(), normal), Condition::separate, 0.3)});
    ParticleBatch batch = filled_box(2, Vec3::Zero(), Vec3(0.3, 0, 0.05), 0.005);
    for (Vec3& x : batch.positions) x = x.x() * slope + x.z() * normal;
    solver->add(batch);
    const double height = energy_of(*solver).gravitational;
    const ParticleState start = solver->state();
    EnergyBalance last = energy_of(*solver);
    while (solver->time() < 0.3) {
      run_steps(*solver, 200);
      const EnergyBalance now = energy_of(*solver);
      expect_dissipation(last, now, turnover(now, height));
      last = now;
    }
    EXPECT_NEAR(last.residual(), 0.0, 0.01 * turnover(last, height));
    // Friction's work is mu m g cos(tilt) times the distance.
    const ParticleState end = solver->state();
    const double distance =
        (weighted_mean(end, end.positions) - weighted_mean(start, start.positions)).norm();
    const double work = 0.3 * total_mass(end) * 9.81 * std::cos(tilt) * distance;
    EXPECT_NEAR(last.friction, work, 0.03 * work);  // friction sets in a little late
    EXPECT_EQ(last.sticking, 0.0);
  }
}

TEST(EnergyBalance, ClosesForACollapsingColumn) {
  for (const SolverVariant& variant :
       {SolverVariant{2, Precision::float32}, SolverVariant{2, Precision::float64, Transfer::apic},
        SolverVariant{3, Precision::float32},
        SolverVariant{2, Precision::float32, Transfer::affine_flip}}) {
    Options o = options_for(variant);
    o.energy = true;
    if (variant.transfer == Transfer::affine_flip) {
      o.settings.damping_rate = 380;
      o.settings.damping_length = 0.01;
      o.settings.crack_band_length = 0.02;
    }
    o.snows[0].preconsolidation_pressure = 200;  // too weak to stand
    o.snows[0].cohesion = 0;
    const auto solver = make_solver(
        o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
    const double height = variant.dimension == 2 ? 0.25 : 0.12;
    ParticleBatch batch =
        filled_box(variant.dimension, Vec3::Zero(), Vec3(0.05, 0.05, height), 0.005);
    batch.velocity.x() = 0.5;
    solver->add(batch);
    const EnergyBalance start = energy_of(*solver);
    EnergyBalance last = start;
    while (solver->time() < (variant.dimension == 2 ? 0.2 : 0.1)) {
      run_steps(*solver, 200);
      const EnergyBalance now = energy_of(*solver);
      expect_dissipation(last, now, turnover(now, start.gravitational));
      last = now;
    }
    EXPECT_GT(last.plastic, 0.05 * turnover(last, start.gravitational)) << variant.name();
    // Particles that soften completely within a step lose their last elastic energy.
    EXPECT_NEAR(last.residual(), 0.0, 0.02 * turnover(last, start.gravitational)) << variant.name();
  }
}

TEST(EnergyBalance, ContinuesWhenSnowIsAddedOrRemoved) {
  Options o = options_for({2, Precision::float64});
  o.energy = true;
  const auto solver = make_solver(o, {});
  solver->add(filled_box(2, Vec3(0, 0, 1), Vec3(0.05, 0, 1.05), 0.005));
  run_until(*solver, 0.1);  // the first body falls, then a second appears
  const double residual = energy_of(*solver).residual(), added = energy_of(*solver).added;
  solver->add(filled_box(2, Vec3(1, 0, 1), Vec3(1.05, 0, 1.05), 0.005));
  const double weight = 210 * 0.05 * 0.05 * 9.81;
  EXPECT_NEAR(energy_of(*solver).added - added, weight * 1.025, 1e-9);
  EXPECT_NEAR(energy_of(*solver).residual(), residual, 1e-9);
  run_until(*solver, 0.15);
  solver->replace({});
  EXPECT_EQ(energy_of(*solver).stored(), 0.0);
  EXPECT_NEAR(energy_of(*solver).residual(), 2 * residual, std::abs(3 * residual));
}

}  // namespace
}  // namespace snowshed::methods::mpm
