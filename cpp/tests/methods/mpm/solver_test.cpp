#include "snowshed/methods/mpm/solver.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed::methods::mpm {
namespace {

class MpmSolverVariants : public testing::TestWithParam<SolverVariant> {};
INSTANTIATE_TEST_SUITE_P(All, MpmSolverVariants, testing::ValuesIn(all_solver_variants()),
                         [](const auto& info) { return info.param.name(); });

/// A swarm of particles with random velocities, a few per cell.
void add_swarm(Method& solver, const SolverVariant& variant, int particles, double size,
               double speed) {
  Random random(11);
  for (int i = 0; i < particles; ++i) {
    ParticleBatch particle;
    particle.positions = {random_vector(random, variant.dimension, size)};
    particle.velocity = random_vector(random, variant.dimension, speed);
    particle.mass = 1e-3 * (0.5 + random.uniform());
    solver.add(particle);
  }
}

double sum_of_speeds(const ParticleState& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.masses.size(); ++i) sum += s.masses[i] * s.velocities[i].norm();
  return sum;
}

TEST_P(MpmSolverVariants, FreeFlightKeepsMassAndMomentum) {
  const SolverVariant variant = GetParam();
  Options o = options_for(variant);
  o.gravity = 0;
  const auto solver = make_solver(o, {});
  add_swarm(*solver, variant, 80, 0.025, 1.0);
  const ParticleState before = solver->state();
  run_steps(*solver, 70);  // past a sort
  const ParticleState after = solver->state();
  EXPECT_EQ(after.masses, before.masses);
  // Every step rounds each particle's momentum a few times; the errors do not all add up.
  const double round_off = 70 * variant.epsilon() * sum_of_speeds(before);
  EXPECT_LT((momentum(after) - momentum(before)).norm(), round_off);
  EXPECT_GT((after.velocities[0] - before.velocities[0]).norm(),
            0.01);  // the particles did interact
}

TEST_P(MpmSolverVariants, FreeFallIsExact) {
  const SolverVariant variant = GetParam();
  const auto solver = make_solver(options_for(variant), {});
  ParticleBatch batch = filled_box(variant.dimension, Vec3(0, 0, 1), Vec3(0.03, 0.03, 1.03), 0.005);
  batch.velocity = Vec3(0.5, 0, 1);
  solver->add(batch);
  const ParticleState before = solver->state();
  double height = 0, speed = 1;  // symplectic Euler by hand
  for (int i = 0; i < 300; ++i) {
    solver->step();
    speed -= 9.81 * solver->time_step();
    height += speed * solver->time_step();
  }
  const SnowState after = snow_state(*solver);
  const double t = solver->time();
  EXPECT_NEAR(speed, 1 - 9.81 * t, 1e-12);
  // Positions are sums of 300 displacements, rounded to a block of 8 cells.
  const double rounding = 300 * variant.epsilon();
  for (std::size_t i = 0; i < after.positions.size(); ++i) {
    const Vec3 displacement = after.positions[i] - before.positions[i];
    ASSERT_NEAR(displacement.x(), 0.5 * t, 0.08 * rounding);
    ASSERT_NEAR(displacement.z(), height, 0.08 * rounding);
    ASSERT_NEAR(after.velocities[i].x(), 0.5, rounding);
    ASSERT_NEAR(after.velocities[i].z(), speed, 2 * rounding);
    ASSERT_NEAR(after.volume_ratios[i], 1.0, 10 * rounding);
  }
}

class MpmRotation : public io::TemporaryFolder {
 protected:
  /// Sum over the particles of the antisymmetric part of APIC's affine matrix, as a vector.
  Vec3 affine_spin(const Method& solver, int dimension) {
    io::BinaryWriter out;
    solver.save(out);
    out.save(path("state"));
    const io::BinaryReader in = io::BinaryReader::load(path("state"));
    const auto masses = in.get<double>("particles/mass");
    Mat3 sum = Mat3::Zero();
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j < dimension; ++j) {
        const auto c = in.get<double>("particles/affine" + std::to_string(i * dimension + j));
        const int row = dimension == 2 ? 2 * i : i, column = dimension == 2 ? 2 * j : j;
        for (std::size_t k = 0; k < c.size(); ++k) sum(row, column) += masses[k] * c[k];
      }
    return {sum(2, 1) - sum(1, 2), sum(0, 2) - sum(2, 0), sum(1, 0) - sum(0, 1)};
  }
  /// Angular momentum about the origin, including that of the affine velocities (inertia dx^2/4 or
  /// dx^2/3).
  Vec3 angular_momentum(const Method& solver, const SolverVariant& variant, double dx) {
    const ParticleState s = solver.state();
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < s.masses.size(); ++i)
      sum += s.masses[i] * s.positions[i].cross(s.velocities[i]);
    if (variant.transfer != Transfer::flip)
      sum += dx * dx / (variant.basis == Basis::quadratic ? 4 : 3) *
             affine_spin(solver, variant.dimension);
    return sum;
  }
};

TEST_F(MpmRotation, ApicKeepsAngularMomentum) {
  for (const SolverVariant& variant : all_solver_variants()) {
    if (variant.transfer != Transfer::apic || variant.precision != Precision::float64) continue;
    Options o = options_for(variant);
    o.gravity = 0;
    const auto solver = make_solver(o, {});
    add_swarm(*solver, variant, 80, 0.025, 1.0);
    const Vec3 before = angular_momentum(*solver, variant, 0.01);
    run_steps(*solver, 70);
    const Vec3 after = angular_momentum(*solver, variant, 0.01);
    // Round-off as for the momentum, times arms of some 3 cm.
    const double round_off = 70 * variant.epsilon() * 0.05 * sum_of_speeds(solver->state());
    EXPECT_LT((after - before).norm(), round_off) << variant.name();
    EXPECT_GT(before.norm(), 1e-5) << variant.name();
  }
}

/// Affine FLIP keeps the angular momentum if the affine velocities fit the particles' velocities,
/// as in a spin.
TEST_F(MpmRotation, AffineFlipKeepsTheAngularMomentumOfASpin) {
  const SolverVariant variant{2, Precision::float64, Transfer::affine_flip};
  Options o = options_for(variant);
  o.gravity = 0;
  o.settings.flip_ratio = 1;
  const auto solver = make_solver(o, {});
  add_spinning_disc(*solver, 0.02, 10, 0.004);
  run_until(*solver, 0.01);
  const Vec3 before = angular_momentum(*solver, variant, 0.01);
  run_until(*solver, 0.11);
  const Vec3 after = angular_momentum(*solver, variant, 0.01);
  EXPECT_NEAR(after.y(), before.y(), 0.005 * before.y());  // FLIP loses four fifths, at 16 1/s
}

TEST_F(MpmRotation, ADiscKeepsSpinning) {
  constexpr double radius = 0.05, spin = 20, duration = 0.04;
  for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip}) {
    const SolverVariant variant{2, Precision::float64, transfer};
    Options o = options_for(variant);
    o.gravity = 0;
    o.settings.flip_ratio = 1;  // each percent of PIC damps a spin of so few cells visibly
    o.snows[0].model = material::SnowModel::elastic;
    const auto solver = make_solver(o, {});
    add_spinning_disc(*solver, radius, spin, 0.005);
    const ParticleState before = solver->state();
    double inertia = 0;
    for (std::size_t i = 0; i < before.masses.size(); ++i)
      inertia += before.masses[i] * before.positions[i].squaredNorm();
    // The grid's moment of inertia is larger by M dx^2/4 in each direction. Affine FLIP's affine
    // velocities, which are zero at first, follow the particles' velocities.
    const double grid_inertia = inertia + total_mass(before) * 1e-4 / 2;
    const double expected =
        transfer == Transfer::affine_flip ? spin : spin * inertia / grid_inertia;
    run_until(*solver, duration);
    const ParticleState after = solver->state();
    const double angle = expected * solver->time();
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    double max_error = 0;
    for (std::size_t i = 0; i < after.positions.size(); ++i)
      max_error = std::max(max_error, (after.positions[i] - turn * before.positions[i]).norm());
    // The limit is relative to the distance that the rim has moved. FLIP's rim lags a little,
    // because the velocity is not quite affine there.
    EXPECT_LT(max_error, (transfer == Transfer::flip ? 0.03 : 0.01) * angle * radius)
        << variant.name();
  }
}

TEST(MpmSolver, AnElasticBarVibratesAtItsNaturalFrequency) {
  // Free at both ends, nu = 0: f = c/(2 L) with c = sqrt(E/rho), no lateral motion.
  constexpr double length = 0.6, amplitude = 0.05;
  Options o = options_for({2, Precision::float64});
  o.gravity = 0;
  o.snows[0].model = material::SnowModel::elastic;
  o.snows[0].poissons_ratio = 0;
  const double c = std::sqrt(o.snows[0].youngs_modulus / o.snows[0].density);
  const double frequency = c / (2 * length);
  const auto solver = make_solver(o, {});
  const ParticleBatch bar = filled_box(2, Vec3(0, 0, 0), Vec3(length, 0, 0.03), 0.005);
  for (double x = 0.0025; x < length; x += 0.005) {  // columns of equal velocity
    ParticleBatch column;
    for (const Vec3& p : bar.positions)
      if (std::abs(p.x() - x) < 1e-6) column.positions.push_back(p);
    column.mass = bar.mass;
    column.velocity.x() = amplitude * std::cos(pi * x / length);
    solver->add(column);
  }
  const auto mode = [&] {
    const ParticleState s = solver->state();
    double sum = 0;
    for (std::size_t i = 0; i < s.masses.size(); ++i)
      sum += s.velocities[i].x() * std::cos(pi * s.positions[i].x() / length);
    return 2 * sum / double(s.masses.size());
  };
  std::vector<double> zeros;
  double before = mode(), last_amplitude = 0;
  while (zeros.size() < 5) {
    solver->step();
    const double now = mode();
    if (before * now < 0) {
      zeros.push_back(solver->time() - solver->time_step() * now / (now - before));
      last_amplitude = 0;
    }
    last_amplitude = std::max(last_amplitude, std::abs(now));
    before = now;
    ASSERT_LT(solver->time(), 4 / frequency);
  }
  EXPECT_NEAR(2 / (zeros[4] - zeros[0]) / frequency, 1.0, 0.02);
  RecordProperty("lost_amplitude_percent_in_2_periods",
                 int(100 * (1 - last_amplitude / amplitude)));
}

TEST(MpmSolver, AColumnCarriesItsWeight) {
  // Elastic snow stands on a sticky floor between frictionless walls. With s = lambda + 2 mu, the
  // vertical stress is rho g (H - z), the pressure is (lambda + mu)/s of it, and the settlement is
  // rho g (H z - z^2/2)/s. The snow vibrates about this state. Its average over four of the longest
  // periods, 4 H/c, is the static state.
  constexpr double height = 0.2, width = 0.04, spacing = 0.005;
  Options o = options_for({2, Precision::float64});
  o.snows[0].model = material::SnowModel::elastic;
  o.snows[0].youngs_modulus = 1e5;
  const double nu = o.snows[0].poissons_ratio, mu = 1e5 / (2 * (1 + nu));
  const double lambda = 1e5 * nu / ((1 + nu) * (1 - 2 * nu)), s = lambda + 2 * mu;
  const double weight = o.snows[0].density * o.gravity;
  const auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky),
          fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitX()), Condition::separate),
          fixed(geometry::make_plane(Vec3(width, 0, 0), -Vec3::UnitX()), Condition::separate)});
  solver->add(filled_box(2, Vec3::Zero(), Vec3(width, 0, height), spacing));
  const ParticleState start = solver->state();
  const std::size_t n = start.positions.size();
  std::vector<double> pressure(n), settlement(n);
  const double duration = 16 * height / std::sqrt(s / o.snows[0].density);
  average(*solver, duration, [&](double part, const SnowState& now) {
    for (std::size_t i = 0; i < n; ++i) {
      pressure[i] += part * now.pressures[i];
      settlement[i] += part * (start.positions[i].z() - now.positions[i].z());
    }
  });
  const double bottom = weight * height * (lambda + mu) / s;
  const double top = weight / s * height * height / 2;
  for (int cell = 2; cell < 20;
       ++cell) {  // means over cells, because stress scatters within a cell
    const double z = (cell + 0.5) * 0.01;
    double mean_pressure = 0, mean_settlement = 0, particles = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (std::abs(start.positions[i].z() - z) > 0.005) continue;
      mean_pressure += pressure[i];
      mean_settlement += settlement[i];
      ++particles;
    }
    EXPECT_NEAR(mean_pressure / particles, bottom * (1 - z / height), 0.04 * bottom) << z;
    EXPECT_NEAR(mean_settlement / particles, weight / s * (height * z - z * z / 2), 0.04 * top)
        << z;
  }
}

// --- the same bits ----------------------------------------------------------------------------

/// Snow thrown onto a slippery slope: contact, plasticity, blocks that come and go.
std::unique_ptr<Solver> thrown_snow(SolverVariant variant, int threads, double size,
                                    bool energy_balance) {
  Options o = options_for(variant);
  o.settings.threads = threads;
  o.energy = energy_balance;
  auto solver =
      make_solver(o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3(0.5, 0, 1).normalized()),
                            Condition::separate, 0.3)});
  ParticleBatch batch =
      filled_box(variant.dimension, Vec3(0, 0, 0.01), Vec3(size, size, size), 0.005);
  batch.velocity = Vec3(1, 0, -3);
  solver->add(batch);
  return solver;
}

/// The energy balance has its own kernels.
class MpmReproducibility : public MpmRotation, public testing::WithParamInterface<bool> {};

TEST_P(MpmReproducibility, ThreadsDoNotChangeTheBits) {
  const bool energy_balance = GetParam();
  for (const SolverVariant& variant :
       {SolverVariant{2, Precision::float32}, SolverVariant{3, Precision::float32},
        SolverVariant{2, Precision::float64, Transfer::apic, Basis::cubic},
        SolverVariant{2, Precision::float64, Transfer::affine_flip, Basis::cubic}}) {
    const double size = variant.dimension == 2 ? 0.25 : 0.08;
    const int steps = variant.dimension == 2 ? 150 : 80;
    const auto single = thrown_snow(variant, 1, size, energy_balance);
    run_steps(*single, steps);
    EXPECT_GT(single->sorts(), 1);
    for (int threads : {2, 4}) {
      const auto several = thrown_snow(variant, threads, size, energy_balance);
      run_steps(*several, steps);
      SCOPED_TRACE(variant.name() + " on " + std::to_string(threads) + " threads");
      expect_same_bits(snow_state(*several), snow_state(*single));
      EXPECT_EQ(several->time(), single->time());
      EXPECT_EQ(energy_of(*several).friction, energy_of(*single).friction);
      EXPECT_EQ(energy_of(*several).residual(), energy_of(*single).residual());
    }
  }
}

TEST_P(MpmReproducibility, ResumingDoesNotChangeTheBits) {
  const bool energy_balance = GetParam();
  for (SolverVariant variant : all_solver_variants()) {
    if (variant.dimension == 3 && variant.precision == Precision::float64) continue;
    const auto reference = thrown_snow(variant, 1, 0.05, energy_balance);
    run_steps(*reference, 40);
    while (!reference->at_safe_point()) reference->step();
    io::BinaryWriter out;
    reference->save(out);
    out.save(path(variant.name()));
    const auto resumed = thrown_snow(variant, 1, 0.05, energy_balance);
    resumed->load(io::BinaryReader::load(path(variant.name())));
    run_steps(*reference, 70);
    run_steps(*resumed, 70);
    SCOPED_TRACE(variant.name());
    expect_same_bits(snow_state(*resumed), snow_state(*reference));
    EXPECT_EQ(resumed->time(), reference->time());
    EXPECT_EQ(resumed->counters().steps, reference->counters().steps);
    EXPECT_EQ(energy_of(*resumed).residual(), energy_of(*reference).residual());
  }
}

INSTANTIATE_TEST_SUITE_P(All, MpmReproducibility, testing::Bool(), [](const auto& info) {
  return info.param ? "with_energy_balance" : "without_energy_balance";
});

// --- steps that are too large -----------------------------------------------------------------

TEST(MpmSolver, AViolentImpactStaysFinite) {
  for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip}) {
    Options o = options_for({2, Precision::float32, transfer});
    o.snows[0].youngs_modulus = 1e4;
    const auto solver = make_solver(
        o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
    ParticleBatch batch = filled_box(2, Vec3(0, 0, 0.02), Vec3(0.1, 0, 0.12), 0.005);
    batch.velocity.z() = -100;
    solver->add(batch);
    try {
      run_until(*solver, 0.01);
      for (const Vec3& x : solver->state().positions) ASSERT_TRUE(x.allFinite());
      EXPECT_GT(solver->counters().rejected, 0);
    } catch (const SimulationError& error) {
      EXPECT_NE(std::string(error.what()).find("step"), std::string::npos) << error.what();
    }
  }
}

TEST(MpmSolver, RejectsStepsWithTooMuchStrain) {
  for (double limit : {0.2, 0.002}) {
    Options o = options_for({2, Precision::float64});
    o.settings.strain_limit = limit;
    const auto solver = make_solver(
        o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
    ParticleBatch batch = filled_box(2, Vec3(0, 0, 0.005), Vec3(0.05, 0, 0.055), 0.005);
    batch.velocity.z() = -1;
    solver->add(batch);
    run_until(*solver, 0.02);
    if (limit < 0.1) {
      EXPECT_GT(solver->counters().rejected, 10);
    } else {
      EXPECT_EQ(solver->counters().rejected, 0);
    }
  }
}

TEST(MpmSolver, FastSnowMovesLessThanHalfACellPerStep) {
  const auto solver = make_solver(options_for({2, Precision::float32}), {});
  ParticleBatch batch = filled_box(2, Vec3::Zero(), Vec3(0.03, 0, 0.03), 0.005);
  batch.velocity.x() = 200;
  solver->add(batch);
  for (int step = 0; step < 30; ++step) {
    solver->step();
    EXPECT_LT(solver->time_step() * 200, 0.5 * 0.01) << step;
  }
}

TEST(MpmSolver, FailsWithAClearErrorIfNoStepIsSmallEnough) {
  Options o = options_for({2, Precision::float64});
  o.settings.strain_limit = 1e-12;
  const auto solver =
      make_solver(o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
  ParticleBatch batch = filled_box(2, Vec3::Zero(), Vec3(0.05, 0, 0.05), 0.005);
  batch.velocity.z() = -1;
  solver->add(batch);
  const SnowState before = snow_state(*solver);
  try {
    run_steps(*solver, 10);
    FAIL();
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("time step fell"), std::string::npos);
  }
  expect_same_bits(snow_state(*solver), before);
}

TEST(MpmSolver, ParticlesOnAndNextToNodesFallFreely) {
  // Their farthest nodes receive next to no mass.
  for (const SolverVariant& variant : all_solver_variants())
    for (double dx : {1e-3, 0.01, 1.0}) {
      SCOPED_TRACE(variant.name() + ", dx " + std::to_string(dx));
      const auto solver = make_solver(options_for(variant, dx), {});
      const double node = base_offset(variant.basis) * dx;
      ParticleBatch batch;
      int k = 0;
      for (double off : {0.0, 1.2e-16, 1e-12, 1e-9, 1e-7})
        batch.positions.push_back(Vec3(node + (k++ + off) * dx,
                                       variant.dimension == 2 ? 0 : node + off * dx,
                                       node + off * dx));
      batch.mass = 210 * std::pow(dx, variant.dimension) / 8;
      solver->add(batch);
      ASSERT_NO_THROW(run_steps(*solver, 20));
      for (const Vec3& v : solver->state().velocities)
        ASSERT_NEAR(v.z(), -9.81 * solver->time(), 1e-3 * 9.81 * solver->time());
    }
}

}  // namespace
}  // namespace snowshed::methods::mpm
